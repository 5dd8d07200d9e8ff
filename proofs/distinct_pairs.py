"""Erratum E13: with energy for one coincident pair, two pairs coincide in turn: the run of `three-agents-1d`, enclosed.

Agent 1 runs through agent 2, then through agent 3. While only two agents are in range of each other, with x their
difference and w = dx/dt, quadrature is enough, x taking the place of time:

- their mutual force cancels in the sum of the two: s'' = -c2γ s' - c1γ s, as of every agent alone, in closed form;
- E = ¼w² + U(x), U = ψ_α + ¼c1γ x², changes at the rate dE/dx = -(c2α a(x) + ½c2γ) w: E encloses w > 0;
- time is ∫ dx/w.

Each piece of the way is checked to keep the third agent out of range of both, which a continuous motion must then do.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction

import sympy as sp
from flint import arb, ctx

from flockana.certified.balls import AlphaParameters, ball, exact, hull, square
from flockana.certified.decimal_rounding import at_most, first_digits, interval
from flockana.certified.scalar_functions_in_balls import adjacency, c_star, psi_alpha, sigma_norm
from flockana.environment.targets import StaticTarget
from flockana.interactions import Gains
from flockana.laws.olfati_saber import Algorithm2
from flockana.scenarios import scenario
from proofs.proof import Proof, Step

DIGITS = 20
FINE = 12  # pieces of the way per unit of length: the finer, the narrower the enclosures
LATEST = "0.03"
STATED = {"ratio": "1.908", "latest": LATEST}
Motion = tuple[arb, arb]  # position and velocity


@dataclass(frozen=True)
class Start:
    """The runs of the erratum: c1α = 1, p₁(0) = √(boost c*) ± slack, agents 2 and 3 and the γ-agent, at 0, at rest."""

    par: AlphaParameters = field(default_factory=lambda: AlphaParameters(a=50000, b=50000))
    positions: tuple[int, int, int] = (-12, 0, 30)
    boost: str = "5.6"
    slack: str = "1e-9"
    c2_alpha: str = "1"
    c1_gamma: str = "0.01"
    c2_gamma: str = "0.01"

    def gain(self, name: str) -> arb:
        """A gain as a ball."""
        return ball(exact(getattr(self, name)))

    def agents(self) -> list[Motion]:
        """Positions and velocities at t = 0."""
        first, *rest = self.positions
        pace = (self.gain("boost") * c_star(self.par)).sqrt() + arb(0, self.gain("slack"))
        return [(arb(first), pace), *((arb(q), arb(0)) for q in rest)]

    def energy(self) -> arb:
        """H_λ(0) = V + ½c1γ Σx_i² + ½Σv_i² in the frame of the centre."""
        q, p = zip(*self.agents(), strict=True)
        apart = [psi_alpha(sigma_norm(q[j] - q[i], self.par.eps), self.par) for j in range(3) for i in range(j)]
        inertia, kinetic = (sum(square(s - sum(all_, arb(0)) / 3) for s in all_) / 2 for all_ in (q, p))
        return sum(apart, arb(0)) + self.gain("c1_gamma") * inertia + kinetic


@dataclass(frozen=True)
class Passage:
    """Two agents on their way through each other: time and energy E when their difference is x."""

    x: arb
    time: arb
    energy: arb


State = tuple[Passage, Motion, Motion]  # of the two, of their sum, of the third


def potential(x: arb, start: Start) -> arb:
    """U(x) = ψ_α(‖x‖_σ) + ¼c1γ x²."""
    return psi_alpha(sigma_norm(x, start.par.eps), start.par) + start.gain("c1_gamma") * square(x) / 4


def speed(energy: arb, u: arb) -> arb:
    """w = 2√(E - U); nan unless it is certain that E >= U."""
    return 2 * (energy - u).sqrt()


def free(motion: Motion, t: arb, start: Start) -> Motion:
    """s'' = -c2γ s' - c1γ s after the time t."""
    (s, v), c1, c2 = motion, start.gain("c1_gamma"), start.gain("c2_gamma")
    decay, rate = (-c2 * t / 2).exp(), (c1 - c2 * c2 / 4).sqrt()
    sine, cosine = (rate * t).sin_cos()
    return (
        decay * (s * cosine + (v + c2 * s / 2) / rate * sine),
        decay * (v * cosine - (c1 * s + c2 * v / 2) / rate * sine),
    )


def onward(here: Passage, there: arb, start: Start) -> Passage | None:
    """The state at the difference `there`, if the two certainly get there; else None."""
    way, advance = here.x.union(there), there - here.x
    near, u = adjacency(sigma_norm(way, start.par.eps), start.par), potential(way, start)
    loss = start.gain("c2_alpha") * near + start.gain("c2_gamma") / 2
    least = here.energy - loss * speed(here.energy, u) * advance  # as E falls, w is no larger than with E here
    w = speed(hull(least, here.energy), u)
    if not (w > 0 and advance >= 0):
        return None
    return Passage(there, here.time + advance / w, here.energy - loss * w * advance)


def passage(one: Motion, other: Motion, third: Motion, until: int, start: Start) -> list[State]:
    """From difference to difference up to `until`, as far as it is certain.

    Time starts at 0; the third agent is out of range of both all the way, and moves alone.
    """
    (q, p), (s, v), reach = one, other, ball(start.par.r)
    total, x = (q + s, p + v), q - s
    here = Passage(x, arb(0), square(p - v) / 4 + potential(x, start))
    states = []
    for stop in range(int(float(x.lower()) * FINE) - 1, until * FINE + 1):
        there = ball(Fraction(stop, FINE))
        if not there > x:
            continue
        after = onward(here, there, start)
        if after is None:
            break
        meanwhile, way = here.time.union(after.time), here.x.union(there)
        middle, alone = free(total, meanwhile, start)[0], free(third, meanwhile, start)[0]
        if not all(abs((middle + side * way) / 2 - alone) > reach for side in (-1, 1)):
            break
        states.append((after, free(total, after.time, start), free(third, after.time, start)))
        here = after
    return states


def separate(state: Passage, total: Motion, start: Start) -> tuple[Motion, Motion]:
    """Each of the two, from their difference and their sum."""
    (s, v), w = total, speed(state.energy, potential(state.x, start))
    return ((s + state.x) / 2, (v + w) / 2), ((s - state.x) / 2, (v - w) / 2)


@dataclass(frozen=True)
class Crossings:
    """When agents 1 and 2, then 1 and 3 have the same position; None if that is not certain."""

    first: arb | None
    second: arb | None


def crossings(start: Start) -> Crossings:
    """Agent 1 through agent 2, clear of its range, then through agent 3."""
    one, two, three = start.agents()
    clear = int(float(ball(start.par.r))) + 2
    way = passage(one, two, three, clear, start)
    met = next((state.time for state, _, _ in way if state.x.is_zero()), None)
    if met is None or way[-1][0].x != clear:
        return Crossings(met, None)
    state, total, three = way[-1]
    one, two = separate(state, total, start)
    way = passage(one, three, two, 0, start)
    if not (way and way[-1][0].x.is_zero()):
        return Crossings(met, None)
    return Crossings(met, state.time + way[-1][0].time)


def _reduction() -> Iterator[Step]:
    t, c1, c2, c2a = sp.symbols("t c_1 c_2 c_2^alpha", positive=True)
    a, force, x, w, s, v = sp.symbols("a f x w s v", real=True)
    q, other = (s + x) / 2, (s - x) / 2
    p, slower = (v + w) / 2, (v - w) / 2
    u = -force - c2a * a * w - c1 * q - c2 * p  # on the one in front, with f = ψ_α'(x) and p_j - p_i = -w
    u_other = force + c2a * a * w - c1 * other - c2 * slower
    yield Step(
        "two agents alone: the force between them cancels in their sum, which moves as one agent alone",
        sp.expand(u + u_other + c1 * s + c2 * v) == 0,
        r"\ddot s = -c_2^\gamma \dot s - c_1^\gamma s",
    )
    rate = w / 2 * (u - u_other) + (force + c1 * x / 2) * w
    yield Step(
        "and E = ¼w² + ψ_α(x) + ¼c1γx² has dE/dt = -(c2α a + ½c2γ) w², hence dE/dx = -(c2α a + ½c2γ) w",
        sp.expand(rate + (c2a * a + c2 / 2) * w**2) == 0,
        r"\frac{dE}{dx} = -\bigl(c_2^\alpha\,a(x) + \tfrac12 c_2^\gamma\bigr)\,w, \qquad "
        r"\frac{dt}{dx} = \frac1w, \qquad w = 2\sqrt{E - U(x)}",
    )
    root = sp.sqrt(c1 - c2**2 / 4)
    decay = sp.exp(-c2 * t / 2)
    place = decay * (s * sp.cos(root * t) + (v + c2 * s / 2) / root * sp.sin(root * t))
    pace = decay * (v * sp.cos(root * t) - (c1 * s + c2 * v / 2) / root * sp.sin(root * t))
    yield Step(
        "the closed form of the motion alone: s' = v, v' = -c1γ s - c2γ v, with the start (s, v)",
        sp.simplify(place.diff(t) - pace) == 0
        and sp.simplify(pace.diff(t) + c1 * place + c2 * pace) == 0
        and (place.subs(t, 0), pace.subs(t, 0)) == (s, v),
    )


def is_the_scenario(start: Start) -> bool:
    """Whether the catalogue's run is one of these: its law, target and start, its p₁(0) a float, and long enough."""
    run = scenario("three-agents-1d")
    numbers = {name: float(getattr(start, name)) for name in ("c2_alpha", "c1_gamma", "c2_gamma")}
    law = Algorithm2(run.law.alpha, Gains(c1_alpha=1.0, **numbers), StaticTarget((0.0,)))
    same = type(run.law) is Algorithm2 and run.law == law and AlphaParameters.of(run.law.alpha) == start.par
    placed = run.q0.shape == run.p0.shape == (3, 1) and run.q0.ravel().tolist() == list(start.positions)
    long = run.t_span[0] == 0.0 and run.t_span[1] >= float(LATEST)
    paces = zip(start.agents(), run.p0.ravel().tolist(), strict=True)
    return same and placed and long and all(bool(p.contains(v)) for (_, p), v in paces)


def _steps() -> Iterator[Step]:
    yield from _reduction()
    with ctx.workdps(DIGITS):
        start = Start()
        yield Step(
            "the catalogue's run three-agents-1d, with its rounded p₁(0), is among these", is_the_scenario(start)
        )
        ratio = start.energy() / c_star(start.par)
        yield Step(
            "c* < H_λ(0) < 2c*: k = 1, and as printed one pair at most collides",
            1 < ratio < 2,
            rf"H_\lambda(0) \in {interval(ratio, 10)}\,c^*",
            found={"ratio": str(first_digits(ratio, 3))},
        )
        found = crossings(start)
        for pair, time in (("1 and 2", found.first), ("1 and 3", found.second)):
            yield Step(
                f"agents {pair} coincide before t = {LATEST}; until then the third is out of range of both",
                None if time is None else bool(time < arb(LATEST)),
                evidence="not certain" if time is None else f"at t in {interval(time)}",
            )
        yield Step(
            "one pair after the other: two distinct pairs, and k = 1",
            None if found.first is None or found.second is None else bool(found.first < found.second),
            r"t_{12} < t_{13}",
            found={} if found.second is None else {"latest": at_most(found.second, 2)},
        )


_START = Start()
_GAINS = f"c1α = 1, c2α = {_START.c2_alpha}, c1γ = {_START.c1_gamma}, c2γ = {_START.c2_gamma}"
PROOF = Proof(
    id="distinct-pairs",
    title="Erratum E13: more than k distinct pairs collide",
    statement=(
        f"Three agents on a line under Algorithm 2, H_λ(0) = {STATED['ratio']}… c*, so that k = 1: agents 1 and 2 "
        f"coincide, and later agents 1 and 3, both before t = {STATED['latest']}. The printed Theorem 3(iv) is "
        "false of distinct pairs; what "
        "is true at each instant is proved in `collisions`."
    ),
    hypotheses=(
        f"q = {_START.positions}, p = (√({_START.boost} c*), 0, 0), give or take {_START.slack}; {_START.par}, "
        f"{_GAINS}, the γ-agent at rest at 0"
    ),
    rigour="interval",
    steps=_steps,
    size=8,
    values=STATED,
    theorems=("E13",),
)
