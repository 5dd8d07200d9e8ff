"""What the Lyapunov functional ‖v‖ + ∫φ of Ha and Liu bounds: integrals of the weight, and claims on a run.

With y = c s/ℓ and y = sinh w the integral of φ(s) = λ (1 + (c s/ℓ)²)^−β is λℓ/c times that of (cosh w)^(1 − 2β), which
is as smooth at all distances.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import asinh, cosh, inf, sqrt

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.interactions.weights import RationalWeight
from flockana.laws.cucker_smale import spread
from flockana.theorems.claims import judged
from flockana.theorems.hypotheses import below
from flockana.theorems.limits import Certificate, limit_claim
from flockana.theorems.rounding import EPS, frame_error
from flockana.theorems.sampling import spread_between
from flockana.theorems.theorem import Claim, Hypothesis

_QUADRATURE = 1e-11  # of an integral: what quadrature, the incomplete beta function and a root are off by, together
_FARTHEST = 300.0  # w, beyond which a distance e^w has no meaning any more


@dataclass(frozen=True)
class Decline:
    """φ(s) = λ (1 + (c s/ℓ)²)^−β, at which a velocity spread falls when the position spread is s.

    Parameters
    ----------
    weight : RationalWeight
        β and ℓ.
    strength : float
        λ.
    stretch : float
        c: 2 as printed, √2 where it is sharp, 1 for the distance of two agents.
    """

    weight: RationalWeight
    strength: float
    stretch: float

    def __call__(self, s: float) -> float:
        """φ(s).

        Examples
        --------
        >>> Decline(RationalWeight(decay=1.0), 3.0, 1.0)(1.0)
        1.5
        """
        return self.strength * float((1.0 + (self.stretch * s / self.weight.length) ** 2) ** -self.weight.decay)

    @property
    def _unit(self) -> float:
        """λℓ/c, by which integrals over w are multiplied."""
        return self.strength * self.weight.length / self.stretch

    def _w(self, s: float) -> float:
        return asinh(self.stretch * s / self.weight.length)

    def between(self, start: float, end: float) -> float:
        """∫φ from one number to another, of either sign.

        Examples
        --------
        >>> from math import pi
        >>> round(Decline(RationalWeight(decay=1.0), 1.0, 1.0).between(-1.0, 1.0) / pi, 12)
        0.5
        """
        return self._unit * self._over(self._w(start), self._w(end))

    def _over(self, start: float, end: float) -> float:
        """∫ (cosh w)^(1 − 2β) dw."""
        from scipy.integrate import quad

        power = 1.0 - 2.0 * self.weight.decay
        value: float = quad(lambda w: cosh(w) ** power, start, end, epsabs=0.0, epsrel=1e-12, limit=200)[0]
        return value

    def beyond(self, start: float) -> float:
        """∫φ from a number on for ever; infinite for β <= ½.

        Examples
        --------
        >>> from math import pi
        >>> line = Decline(RationalWeight(decay=1.0), 1.0, 1.0)
        >>> round(line.beyond(1.0) / pi, 12), round(line.beyond(-1.0) / pi, 12)
        (0.25, 0.75)
        """
        from scipy.special import beta, betainc

        power = self.weight.decay - 0.5
        if power <= 0.0:
            return inf
        y, whole = self.stretch * abs(start) / self.weight.length, float(beta(power, 0.5))
        tail = 0.5 * whole * float(betainc(power, 0.5, 1.0 / (1.0 + y * y)))
        return self._unit * (tail if start >= 0.0 else whole - tail)

    def reached(self, start: float, speed: float) -> float:
        """The x_M at which ∫φ from `start` is the speed; infinite if there is none.

        Examples
        --------
        >>> round(Decline(RationalWeight(decay=0.0), 2.0, 1.0).reached(1.0, 6.0), 9)
        4.0
        """
        from scipy.optimize import brentq

        asked, low = speed / self._unit, self._w(start)
        if speed >= self.beyond(start):
            return inf
        if speed == 0.0:
            return start
        high, step = low, 1.0
        while self._over(low, high) < asked:
            high, step = high + step, 2.0 * step
            if high > _FARTHEST:
                return inf
        w = float(brentq(lambda at: self._over(low, at) - asked, low, high, xtol=1e-14, rtol=1e-14))
        return self.weight.length / self.stretch * float(np.sinh(w))


@dataclass(frozen=True, eq=False)
class Guarantee:
    """What the functional guarantees of a run of the law: ‖x‖ <= x_M and ‖v‖ <= ‖v(0)‖ e^(−φ(x_M) t).

    Parameters
    ----------
    run : Trajectory
        A run of `CuckerSmale`.
    stretch : float
        c of φ.
    """

    run: Trajectory
    stretch: float

    @cached_property
    def phi(self) -> Decline:
        """φ, with λ = K where sums are divided by n and λ = nK where they are not."""
        law = self.run.law
        return Decline(law.weight, law.weight.strength * (1.0 if law.mean else self.run.n), self.stretch)

    @cached_property
    def x(self) -> FloatArray:
        """‖x‖ at the samples."""
        return spread(self.run.q)

    @cached_property
    def v(self) -> FloatArray:
        """‖v‖ at the samples."""
        return spread(self.run.p)

    @property
    def _blur(self) -> tuple[float, float]:
        """Rounding of ‖x‖ and of ‖v‖."""
        root = sqrt(self.run.n * self.run.m)
        return root * frame_error(self.run.q), root * frame_error(self.run.p)

    @cached_property
    def room(self) -> float:
        """∫φ from ‖x(0)‖ on."""
        return self.phi.beyond(float(self.x[0]))

    @cached_property
    def bound(self) -> float:
        """x_M."""
        return self.phi.reached(float(self.x[0]), float(self.v[0]))

    @cached_property
    def _error(self) -> float:
        """Of the difference of ‖v(0)‖ and an integral of φ from ‖x(0)‖ on."""
        blur_x, blur_v = self._blur
        size = float(self.v[0]) + (0.0 if self.room == inf else self.room)
        return blur_v + self.phi(float(self.x[0])) * blur_x + _QUADRATURE * size

    def hypothesis(self, name: str) -> Hypothesis:
        """‖v(0)‖ < ∫φ from ‖x(0)‖ on, which always holds for β <= ½."""
        v0 = float(self.v[0])
        if self.room == inf:
            return Hypothesis(name, "met", 1.0, f"β = {self.run.law.weight.decay:g}: the integral is infinite")
        return below(name, v0, self.room, self._error, f"‖v(0)‖ = {v0:.6g}, the integral {self.room:.6g}")

    def claims(self, names: tuple[str, str, str], proof: str) -> list[Claim]:
        """The spread of positions is bounded, that of velocities falls at the rate told, and so the flock is one."""
        bounded = self._bounded(names[0])
        return [bounded, self._falls(names[1], bounded), self._limit(names[2], proof)]

    def _bounded(self, name: str) -> Claim:
        """By a bound of the path between the samples; refuted by a sample alone."""
        k, x_m = int(self.x.argmax()), self.bound
        most = max(spread_between(self.run), float(self.x[k]))
        share = 1.0 - float(self.x[k]) / x_m if 0.0 < x_m < inf else 0.0
        error = (self._blur[0] + self._error / self.phi(x_m)) / x_m if 0.0 < x_m < inf else inf
        error += (most - float(self.x[k])) / x_m if share > 0.0 else 0.0
        return judged(
            name,
            share,
            error,
            computed=float(self.x[k]),
            stated=f"‖x(t)‖ <= x_M = {x_m:.6g}",
            witness={"time": float(self.run.t[k])},
            detail=f"‖x‖ is at most {self.x[k]:.6g} at the samples, {most:.6g} between them, and x_M = {x_m:.6g}",
        )

    def _falls(self, name: str, bounded: Claim) -> Claim:
        """At the samples; between two of them ‖v‖ falls at φ(x_M) or more wherever ‖x‖ <= x_M, which is `bounded`."""
        t, v = self.run.t[1:] - self.run.t[0], self.v[1:]
        rate = self.phi(self.bound) if self.bound < inf else 0.0
        if not (t.size and rate > 0.0 and self.v.min() > 0.0):
            return judged(name, 0.0, inf, detail="no fall to be seen: the velocities match from the start")
        seen = np.log(self.v[0] / v) / t
        margin = seen / rate - 1.0
        known = 2.0 * self.run.law.weight.decay * self._error / (rate * max(self.bound, self.run.law.weight.length))
        with np.errstate(over="ignore"):  # at the threshold x_M is anything, and the error infinite
            error = (self._blur[1] * (1.0 / v + 1.0 / self.v[0]) + 4.0 * EPS) / (t * rate) + known * (
                1.0 + np.abs(seen) / rate
            )
        k = int(np.argmin(margin + error))
        if margin[k] + error[k] >= 0.0:
            k = int(np.argmin(margin - error))
        return judged(
            name,
            float(np.clip(margin[k], -1.0, 1.0)),
            float(error[k]),
            verifies=bounded.status == "verified",
            computed=float(seen[k]),
            stated=f"‖v(t)‖ <= ‖v(0)‖ exp(-φ(x_M) t), φ(x_M) = {rate:.6g}",
            witness={"time": float(t[k] + self.run.t[0])},
            detail=f"from the start to any sample ‖v‖ falls at a mean rate of {seen[k]:.6g} at least",
        )

    def _limit(self, name: str, proof: str) -> Claim:
        v0, known = float(self.v[0]), self.bound < inf
        margin, error = (1.0, 0.0) if self.room == inf else ((self.room - v0) / self.room, self._error / self.room)
        bound = f"‖x‖ <= {self.bound:.6g} for ever, so ‖v‖ falls exponentially"
        text = bound if known else "x_M is farther than can be told"
        return limit_claim(
            name,
            [],
            [Certificate(margin if known else -1.0, text, error)],
            computed=float(self.v[-1]),
            stated="‖v(t)‖ -> 0, and every q_j - q_i has a limit",
            witness={"time": float(self.run.t[-1])},
            proof=proof,
            detail=f"‖v‖ goes from {v0:.4g} to {self.v[-1]:.4g} at t = {self.run.t[-1]:g}",
        )
