"""Independent checker of tube certificates, by another method than the prover's.

A certificate holds a path of polynomials in time, one for each coordinate of q and each step, and claims that the run
from its start is never farther from it than a stated error. That is proved here by another theorem than Lohner's
method: with y the path, |·| the norm √(w²|q|² + |p|²), δ = y' − f(y) its defect and μ a bound of the logarithmic norm
of ∂f/∂x on all states within the error of y,

    |x(t + s) − y(t + s)| <= e^{μ⁺ s} (|x(t) − y(t)| + s sup|δ|),

as long as the right-hand side keeps the run within the error that μ was bounded for, so that it never leaves it. f is
C¹ at the distances where the pair law has two pieces, so that nothing special happens there. Only the scalar functions
of `intervals` are shared with the prover. Algorithms 1 and 2 are known, with a γ-agent on a straight path, and
Algorithm 3, with one at rest, among spheres.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
from flint import arb, arb_mat, arb_series, ctx

from flockana.certified.balls import AlphaParameters, ball, series_length
from flockana.certified.certificate_check import (
    ANY,
    BINARY,
    NUMBER,
    PAIR_LAW,
    TRUTH,
    RejectedError,
    check_data,
    ensure,
    positive,
)
from flockana.certified.check_motion import Motion, Sphere, Vector, number
from flockana.certified.decimal_rounding import at_least, at_most
from flockana.certified.scalar_functions_in_balls import c_star

BITS = 128
CLAIMS = (  # what a certificate states of all of a run, its name, and the step that is verified
    ("distance", "the least distance", "no two agents come nearer than {}"),
    ("cohesion_radius", "the largest radius", "no agent is farther than {} from the centre of mass"),
    ("clearance", "the least clearance", "no agent comes nearer than {} to a sphere"),
    ("below_c_star", "H(0) < c*", ""),
    ("energy", "the energy at the start", "the energy at the start is {}, rounded down"),
)


def form(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the form of a tube certificate: the expected kind of each entry, by key; Algorithm 3 alone has spheres."""
    law: dict[str, Any] = PAIR_LAW | {key: [NUMBER] for key in ("start", "velocity", "declared")}
    if has_spheres := data["law"]["algorithm"] == "Algorithm3":
        law |= dict.fromkeys(("beta_d", "beta_eps", "beta_h", "c1_beta", "c2_beta"), NUMBER)
        law |= {"spheres": [{"centre": [NUMBER], "radius": NUMBER}]}
    return {
        "law": law,
        "q0": [[BINARY]],
        "p0": [[BINARY]],
        "times": [BINARY],
        "paths": [[[BINARY]]],
        "errors": [NUMBER],
        **dict.fromkeys(("weight", "distance", "cohesion_radius", "energy", "turn"), NUMBER),
        "clearance": NUMBER if has_spheres and data["law"]["spheres"] else None,
        "below_c_star": TRUTH,
        "basin": None if data["basin"] is None else ANY,  # a certificate of its own
    }


def check(data: Mapping[str, Any]) -> Iterator[str]:
    """Verify a tube certificate and return the verified facts, step by step."""
    with ctx.workprec(BITS):
        run = Run.of(data)
        yield from run.follow(data)


@dataclass(frozen=True)
class Run(Motion):
    """Path of a tube certificate, and the weight w of positions in the norm of errors."""

    weight: arb

    @classmethod
    def of(cls, data: Mapping[str, Any]) -> Run:
        """Return the run of a certificate's data."""
        law, n, m = data["law"], len(data["q0"]), len(data["q0"][0])
        ensure(law["algorithm"] in ("Algorithm1", "Algorithm2", "Algorithm3"), "its law is unknown")
        bounded = law["algorithm"] == "Algorithm3"
        gain = {name: number(law[name]) for name in ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma")}
        start, velocity, declared = ([number(x) for x in law[name]] for name in ("start", "velocity", "declared"))
        led_values = (gain["c1_gamma"], gain["c2_gamma"], *start, *velocity, *declared)
        ensure(law["algorithm"] != "Algorithm1" or all(x == 0 for x in led_values), "Algorithm 1 has no γ-agent")
        ensure(len(start) == len(velocity) == len(declared) == m, "the γ-agent has another dimension")
        ensure(not (bounded and any(x != 0 for x in velocity)), "its γ-agent moves")
        spheres = tuple(Sphere.of(law, one) for one in law["spheres"]) if bounded else ()
        ensure(all(len(one.centre) == m and one.radius > 0 for one in spheres), "a sphere of another dimension")
        signs = (*gain.values(), *(g for one in spheres for g in (one.push, one.drag)))
        ensure(all(g >= 0 for g in signs), "a gain is negative")
        par = AlphaParameters(**{name: law[name] for name in ("d", "r", "eps", "h", "a", "b")})
        weight = number(data["weight"])
        ensure(bool(weight > 0), "the weight is not positive")
        return cls(par, gain, start, velocity, declared, n, m, bounded, spheres, weight)

    def follow(self, data: Mapping[str, Any]) -> Iterator[str]:
        """Check the run step by step, then the claims about the whole run."""
        size, times = self.n * self.m, [exact(t) for t in data["times"]]
        x0 = [exact(x) for rows in (data["q0"], data["p0"]) for row in rows for x in row]
        ensure(len(times) == len(data["paths"]) + 1 == len(data["errors"]) + 1 and len(x0) == 2 * size, "its length")
        ensure(all(a < b for a, b in pairwise(times)), "its times do not rise")
        state, error = [ball(x) for x in x0], arb(0)
        boxes = []
        for t, end, coefficients, stated in zip(times[:-1], times[1:], data["paths"], data["errors"], strict=True):
            h, path = ball(end - t), [[ball(exact(c)) for c in row] for row in coefficients]
            fits = len(path) == size and all(len(row) == len(path[0]) in range(4, 65) for row in path)
            ensure(fits, "a path of another size")
            error, bound, time_text = self.jumped(state, path, error), number(stated), f"t = {float(t):.6g}"
            enclosure, box = self.grown(ball(t), h, path, error, bound)
            ensure(bool(enclosure < bound), f"{time_text}: the error may exceed what is stated")
            ensure(bool(bound < 2 * enclosure + arb(2) ** -90), f"{time_text}: the error stated is not the one proved")
            state, error = self.at(path, h), enclosure
            boxes.append(box)
        yield f"the run is within the errors stated of the path, through {len(times) - 1} steps"
        stated = self.stated(boxes, [ball(x) for x in x0])
        for key, name, step in CLAIMS:
            ensure(data[key] == stated[key], f"{name} is not the one stated")
            if step and stated[key] is not None:
                yield step.format(data[key])
        ensure(data["basin"] is not None or data["turn"] == "0", "a turn of no basin")
        if data["basin"] is not None:
            ensure(not self.bounded, "a basin of Algorithm 3")
            yield from self.ends_in(data["basin"], data["law"], number(data["turn"]), state, error)

    def stated(self, boxes: Sequence[Vector], start: Vector) -> dict[str, Any]:
        """Return a certificate's statements about a run's boxes (distances, radii) and its initial energy."""
        size, level = self.n * self.m, self.energy(start)
        places = [(sphere, x) for box in boxes for sphere in self.spheres for x in self.agents(box[:size])]
        return {
            "distance": at_least(min(distance.lower() for box in boxes for distance in self.lengths(box))),
            "cohesion_radius": at_most(max(radius.upper() for box in boxes for radius in self.radii(box))),
            "clearance": at_least(min(sphere.clearance(x).lower() for sphere, x in places)) if places else None,
            "energy": at_least(level.lower()),
            "below_c_star": bool(level < self.gain["c1_alpha"] * c_star(self.par)),
        }

    def ends_in(
        self, basin: Mapping[str, Any], own: Mapping[str, str], turn: arb, state: Vector, error: arb
    ) -> Iterator[str]:
        """Check that the end of the run lies in the rotated basin of another certificate."""
        ensure(basin.get("kind") == "basin", "what stands for the basin is no certificate of one")
        yield from (f"basin: {step}" for step in check_data(basin).steps)
        law, size = basin["law"], self.n * self.m
        is_equal = (Fraction(own[name]) == Fraction(law[name]) for name in ("d", "r", "eps", "h", "a", "b", *self.gain))
        ensure(own["algorithm"] == law["algorithm"] and all(is_equal), "the basin is of another law")
        ensure(self.m <= 2 and len(basin["positions"]) == self.n, "a basin of another flock")
        off = arb(0, number(basin["box"]).upper())
        rest = [arb(float.fromhex(x)) + off for row in basin["positions"] for x in row]
        box = [x + arb(0, (error / self.weight if k < size else error).upper()) for k, x in enumerate(state)]
        c, s = turn.cos(), turn.sin()
        turned = rest if self.m == 1 else [y for a, b in self.agents(rest) for y in (c * a - s * b, s * a + c * b)]
        x = [y for row in self.centred(box[:size]) for y in row]
        apart = self.length([a - b for a, b in zip(x, turned, strict=True)])
        ensure(bool(apart < number(basin["radius"])), "the end may be too far from the basin's equilibrium")
        excess = self.energy(box) - self.energy([*rest, *[arb(0)] * size])
        ensure(bool(excess < number(basin["level"])), "the energy at the end may be too high for the basin")
        yield "all of the end lies in the basin: the run converges to its orbit, with matched velocities"

    def jumped(self, state: Vector, path: Sequence[Vector], error: arb) -> arb:
        """Return the error bound after the switch from one path polynomial to the next."""
        return error + self.norm([a - b for a, b in zip(state, self.at(path, arb(0)), strict=True)])

    def grown(self, t: arb, h: arb, path: Sequence[Vector], error: arb, bound: arb) -> tuple[arb, Vector]:
        """Return the error bound after a step, and a box that holds all states within `bound` of the step's path."""
        span = arb(0).union(h)
        reach = self.at(path, span)
        half_width, dimension = bound / self.weight, self.n * self.m
        box = [x + arb(0, (half_width if k < dimension else bound).upper()) for k, x in enumerate(reach)]
        rate = self.logarithmic_norm(self.slope(box))
        defect = self.defect(t, h, path)
        return (rate.max(arb(0)) * h).exp() * (error + h * defect), box

    def defect(self, t: arb, h: arb, path: Sequence[Vector]) -> arb:
        """Return a bound of the defect |y'' − u(t, y, y')| of a path on a step."""
        # Where every pair is on one piece of its law: the coefficients of the difference at the begin of the step, and
        # of u the next one at any time of it. Elsewhere: the difference at the begin, and its slope during the step.
        span, size, order = arb(0).union(h), self.n * self.m, len(path[0]) - 1
        whole = self.shifted(path, span)
        pieces = self.pieces([row[0] for row in whole[:size]])
        total = []
        if None in pieces:
            begin, state_range = self.at(path, arb(0)), [row[0] for row in whole]
            with series_length(1):
                force_jet = self.force(t, [arb_series([x]) for x in begin], pieces)
            force_rates = (self.slope(state_range) * arb_mat([[row[1]] for row in whole])).entries()
            for k in range(size):
                jerk = 6 * whole[k][3] - force_rates[size + k] - self.gain["c1_gamma"] * self.velocity[k % self.m]
                total.append(abs(2 * path[k][2] - force_jet[k][0]) + h * abs(jerk))
            return self.length(total)
        with series_length(order):
            start_force = self.force(t, [arb_series(row) for row in self.shifted(path, arb(0))], pieces)
            end_force = self.force(t + span, [arb_series(row) for row in whole], pieces)
            for k in range(size):
                terms = [abs((j + 2) * (j + 1) * path[k][j + 2] - start_force[k][j]) * h**j for j in range(order - 1)]
                total.append(sum(terms, abs(end_force[k][order - 1]) * h ** (order - 1)))
        return self.length(total)

    def logarithmic_norm(self, slope: arb_mat) -> arb:
        """Return an upper bound of ⟨e, A e⟩/|e|² over all A in the balls, in the weighted coordinates (w q, p)."""
        size, w, a = self.n * self.m, self.weight, slope.tolist()
        scale = [w] * size + [arb(1)] * size
        rows = [[(x * a[r][c] / y + y * a[c][r] / x) / 2 for c, y in enumerate(scale)] for r, x in enumerate(scale)]
        guess = float(np.linalg.eigvalsh(np.array([[float(x) for x in row] for row in rows]))[-1])
        for growth_step in (0.01, 0.1, 1.0, 10.0, 1e3, 1e6):
            bound = arb(guess + growth_step * (1 + abs(guess)))
            if positive([[(bound if r == c else 0) - x for c, x in enumerate(row)] for r, row in enumerate(rows)]):
                return bound
        raise RejectedError("no bound of the growth of errors")

    def norm(self, x: Vector) -> arb:
        """Return the weighted norm √(w²|q|² + |p|²) of a vector of positions q and velocities p."""
        size = self.n * self.m
        return self.length([*(self.weight * y for y in x[:size]), *x[size:]])


def exact(text: str) -> Fraction:
    """Return an exact number from its text of hexadecimal mantissa and exponent of 2: -0x3p-1 is −3/2."""
    mantissa, _, exponent = text.partition("p")
    return Fraction(int(mantissa, 16)) * Fraction(2) ** int(exponent)
