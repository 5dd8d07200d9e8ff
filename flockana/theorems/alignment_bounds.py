"""Alignment bounds from a functional |v| + ∫φ of the spreads x and v, and claims on a run.

With y = c s/ℓ and y = sinh w the integral of φ(s) = λ (1 + (c s/ℓ)²)^−β is λℓ/c times that of (cosh w)^(1 − 2β), which
is as smooth at all distances.
"""

from dataclasses import dataclass
from functools import cached_property
from math import asinh, cosh, inf

import numpy as np

from flockana.interactions.weights import RationalWeight
from flockana.theorems.claims import judged, undecided
from flockana.theorems.theorem_toolkit import (
    Checked,
    Claim,
    Enclosure,
    Hypothesis,
    Observed,
    limit_claim,
    positive_room,
    unmet,
)

QUADRATURE = 1e-11  # of an integral: what quadrature, the incomplete beta function and a root are off by, together
_FARTHEST = 300.0  # w, beyond which a distance e^w has no meaning any more


@dataclass(frozen=True)
class AlignmentRate:
    """Decay rate φ(s) = λ (1 + (c s/ℓ)²)^−β of a velocity spread at position spread s."""

    weight: RationalWeight  # β and ℓ
    strength: float  # λ
    stretch: float  # c: 2 as printed, √2 where it is sharp, 1 for the distance of two agents

    def __call__(self, s: float) -> float:
        """Return the decay rate φ(s) at position spread s."""
        return self.strength * float((1.0 + (self.stretch * s / self.weight.length) ** 2) ** -self.weight.decay)

    @property
    def _unit(self) -> float:
        """Factor λℓ/c of the integrals of φ after substitution by w."""
        return self.strength * self.weight.length / self.stretch

    def _w(self, s: float) -> float:
        return asinh(self.stretch * s / self.weight.length)

    def between(self, start: float, end: float) -> float:
        """Return the integral ∫φ of the decay rate between two position spreads."""
        return self._unit * self._over(self._w(start), self._w(end))

    def _over(self, start: float, end: float) -> float:
        """Return the integral of (cosh w)^(1 − 2β) between two values of w."""
        from scipy.integrate import quad

        power = 1.0 - 2.0 * self.weight.decay
        return quad(lambda w: cosh(w) ** power, start, end, epsabs=0.0, epsrel=1e-12, limit=200)[0]

    def beyond(self, start: float) -> float:
        """Return the integral ∫φ from a position spread to infinity; infinite for β <= ½."""
        from scipy.special import beta, betainc

        power = self.weight.decay - 0.5
        if power <= 0.0:
            return inf
        y, full_beta = self.stretch * abs(start) / self.weight.length, float(beta(power, 0.5))
        tail = 0.5 * full_beta * float(betainc(power, 0.5, 1.0 / (1.0 + y * y)))
        return self._unit * (tail if start >= 0.0 else full_beta - tail)

    def reached(self, start: float, speed: float) -> float:
        """Return the spread x_M at which ∫φ from `start` equals a velocity spread; infinite without one."""
        from scipy.optimize import brentq

        speed_ratio, low = speed / self._unit, self._w(start)
        if speed >= self.beyond(start):
            return inf
        if speed == 0.0:
            return start
        high, step = low, 1.0
        while self._over(low, high) < speed_ratio:
            high, step = high + step, 2.0 * step
            if high > _FARTHEST:
                return inf
        w = float(brentq(lambda at: self._over(low, at) - speed_ratio, low, high, xtol=1e-14, rtol=1e-14))
        return self.weight.length / self.stretch * float(np.sinh(w))

    def beyond_enclosed(self, start: Enclosure) -> Enclosure:
        """Return an enclosure of ∫φ from an enclosed position spread to infinity."""
        return start.falling(np.vectorize(self.beyond, otypes=[float])).scaled_out(QUADRATURE)

    def reached_by(self, start: Enclosure, speed: Enclosure) -> Enclosure:
        """Return an enclosure of the spread x_M reached from an enclosed start with an enclosed speed."""
        ends = (self.reached(float(getattr(start, end)), float(getattr(speed, end))) for end in ("lo", "mid", "hi"))
        return Enclosure(*ends).scaled_out(QUADRATURE)


@dataclass(frozen=True, eq=False)
class Guarantee:
    """Guarantee of the alignment functional on a run: x <= x_M and v <= v(0) e^(−φ(x_M) t)."""

    seen: Observed
    phi: AlignmentRate
    x: Enclosure  # Spread of the positions at the samples
    over: Enclosure  # The largest x of the run, between samples too
    v: Enclosure  # Spread of the velocities at the samples
    proof: str
    names: tuple[str, str] = ("‖x{}‖", "‖v{}‖")  # with room for a time

    @cached_property
    def integral_to_infinity(self) -> Enclosure:
        """Integral ∫φ from x(0) to infinity."""
        return self.phi.beyond_enclosed(self.x[0])

    @cached_property
    def bound(self) -> Enclosure:
        """Bound x_M of the position spread."""
        return self.phi.reached_by(self.x[0], self.v[0])

    def hypothesis(self, name: str) -> Hypothesis:
        """Return the hypothesis v(0) < ∫φ from x(0) on, always met for β <= ½."""
        v0 = self.v[0]
        if self.integral_to_infinity.lo == inf:
            return Hypothesis(name, "met", 1.0, f"β = {self.phi.weight.decay:g}: the integral is infinite")
        detail = f"{self.names[1].format('(0)')} = {v0.mid:.6g}, the integral {self.integral_to_infinity.mid:.6g}"
        remedy = "start with velocities that differ less, or nearer together"
        return positive_room(name, self.integral_to_infinity - v0, detail, remedy=remedy)

    def claims(self, needs: list[Hypothesis], limit: str = "velocities") -> Checked:
        """Return the claims that positions spread at most to x_M and velocities match, with rate and limit."""
        if unmet(needs):
            return needs, []
        return needs, [self._bounded(needs), self._falls(needs), self._limit(limit, needs)]

    def _bounded(self, needs: list[Hypothesis]) -> Claim:
        x, x_m, name = self.over, self.bound, self.names[0].format("")
        is_finite = x_m.mid > 0.0 and x_m.mid < inf
        k = int(self.x.mid.argmax())
        margin = 1.0 - x / x_m if is_finite else Enclosure.around(0.0, inf)
        return judged("bounded", margin, needs, proof=self.proof, computed=float(x.mid)).described(
            stated=f"{self.names[0].format('(t)')} <= x_M = {x_m.mid:.6g}",
            witness={"time": float(self.seen.t[k])},
            detail=f"{name} is at most {x.mid:.6g} at the samples, {x.hi:.6g} between them, and x_M = {x_m.mid:.6g}",
        )

    def _falls(self, needs: list[Hypothesis]) -> Claim:
        """Return the claim that the velocity spread falls at the guaranteed rate, while it exceeds its error."""
        observation, v, name, rate = self.seen, self.v, self.names[1], self.bound.falling(np.vectorize(self.phi))
        count = observation.known_samples(v.lo > 0.0)
        if count < 2 or not rate.lo > 0.0:
            return undecided("rate", "no fall above the error of the run", needs, proof=self.proof)
        t = observation.t[1:count] - observation.t[0]
        fall = (v[0] / v[1:count]).log() / t
        margin = fall / rate - 1.0
        k = margin.worst_index
        return judged("rate", margin, needs, proof=self.proof, computed=float(fall.mid[k])).described(
            stated=f"{name.format('(t)')} <= {name.format('(0)')} exp(-φ(x_M) t), φ(x_M) = {rate.mid:.6g}",
            witness={"time": float(t[k] + observation.t[0])},
            detail=f"from the start to any sample {self.names[1].format('')} falls at a mean rate of {fall.mid[k]:.6g} "
            f"at least, {observation.until(count)}",
        )

    def _limit(self, what: str, needs: list[Hypothesis]) -> Claim:
        v, x_m = self.v.mid, float(self.bound.mid)
        x_name, name = (item.format("") for item in self.names)
        text = (
            f"{x_name} never exceeds {x_m:.6g}, so {name} falls exponentially"
            if x_m < inf
            else "x_M cannot be computed"
        )
        return limit_claim(what, needs, proof=self.proof, computed=float(v[-1])).described(
            stated=f"{self.names[1].format('(t)')} -> 0, and every q_j - q_i has a limit",
            witness={"time": float(self.seen.t[-1])},
            detail=f"{name} goes from {v[0]:.4g} to {v[-1]:.4g} at t = {self.seen.t[-1]:g}; {text}",
        )
