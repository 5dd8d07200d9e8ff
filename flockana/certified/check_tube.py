"""The checker of tube certificates, to be read in one sitting: it follows no step of the prover.

A certificate holds a path of polynomials in time, one for each coordinate of q and each step, and claims that the run
from its start is never farther from it than a stated error. That is proved here by another theorem than Lohner's
method: with y the path, |·| the norm √(w²|q|² + |p|²), δ = y' − f(y) its defect and μ a bound of the logarithmic norm
of ∂f/∂x on all states within the error of y,

    |x(t + s) − y(t + s)| <= e^{μ⁺ s} (|x(t) − y(t)| + s sup|δ|),

as long as the right-hand side keeps the run within the error that μ was bounded for, so that it never leaves it. f is
C¹ at the distances where the pair law has two pieces, so that nothing special happens there. Only the scalar functions
of `intervals` are shared with the prover. Algorithms 1 and 2 are known, with a γ-agent on a straight path.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, pairwise
from math import comb
from typing import Any

import numpy as np
from flint import arb, arb_mat, arb_series, ctx

from flockana.certified.check import check_data, ensure
from flockana.certified.decimals import at_least, at_most
from flockana.certified.intervals import (
    AlphaParameters,
    adjacency,
    ball,
    bump_slope,
    c_star,
    d_alpha,
    phi_alpha,
    phi_alpha_slope,
    psi_alpha,
    r_alpha,
    shift,
    sigma_of_square,
    square,
)

BITS = 128
Vector = list[arb]


def check(data: Mapping[str, Any]) -> Iterator[str]:
    """Verify a certificate and say what was verified, step by step."""
    with ctx.workprec(BITS):
        run = Run.of(data)
        yield from run.follow(data)


@dataclass(frozen=True)
class Run:
    """The law and the weight w of the norm; what is given as text counts as the decimal that it is."""

    par: AlphaParameters
    gain: Mapping[str, arb]
    start: Vector
    velocity: Vector
    told: Vector
    weight: arb
    n: int
    m: int

    @classmethod
    def of(cls, data: Mapping[str, Any]) -> Run:
        """As the certificate says."""
        law, n, m = data["law"], len(data["q0"]), len(data["q0"][0])
        ensure(law["algorithm"] in ("Algorithm1", "Algorithm2"), "its law is unknown")
        gain = {name: number(law[name]) for name in ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma")}
        ensure(all(g >= 0 for g in gain.values()), "a gain is negative")
        ensure(law["algorithm"] == "Algorithm2" or not any(gain[k] > 0 for k in ("c1_gamma", "c2_gamma")), "a γ-agent")
        start, velocity, told = ([number(x) for x in law[name]] for name in ("start", "velocity", "told"))
        ensure(len(start) == len(velocity) == len(told) == m, "the γ-agent has another dimension")
        par = AlphaParameters(**{name: law[name] for name in ("d", "r", "eps", "h", "a", "b")})
        weight = number(data["weight"])
        ensure(bool(weight > 0), "the weight is not positive")
        return cls(par, gain, start, velocity, told, weight, n, m)

    def follow(self, data: Mapping[str, Any]) -> Iterator[str]:
        """The run step by step, then what is claimed of all of it."""
        size, times = self.n * self.m, [exact(t) for t in data["times"]]
        x0 = [exact(x) for rows in (data["q0"], data["p0"]) for row in rows for x in row]
        ensure(len(times) == len(data["paths"]) + 1 == len(data["errors"]) + 1 and len(x0) == 2 * size, "its length")
        ensure(all(a < b for a, b in pairwise(times)), "its times do not rise")
        state, error = [ball(x) for x in x0], arb(0)
        least, widest = [], []
        for t, end, coefficients, stated in zip(times[:-1], times[1:], data["paths"], data["errors"], strict=True):
            h, path = ball(end - t), [[ball(exact(c)) for c in row] for row in coefficients]
            ensure(
                len(path) == size and all(len(row) == len(path[0]) in range(4, 65) for row in path),
                "a path of another size",
            )
            error, bound = self.jumped(state, path, error), number(stated)
            found, box = self.grown(ball(t), h, path, error, bound)
            ensure(bool(found < bound), f"t = {float(t):.6g}: the error may exceed what is stated")
            ensure(
                bool(bound < 2 * found + arb(2) ** -90), f"t = {float(t):.6g}: the error stated is not the one proved"
            )
            state, error = self.at(path, h), found
            least.append(min(length.lower() for length in self.lengths(box)))
            widest.append(max(radius.upper() for radius in self.radii(box)))
        yield f"the run is within the errors stated of the path, through {len(times) - 1} steps"
        ensure(same(data["distance"], min(least), down=True), "the least distance is not the one stated")
        yield f"no two agents come nearer than {data['distance']}"
        ensure(same(data["cohesion_radius"], max(widest), down=False), "the largest radius is not the one stated")
        yield f"no agent is farther than {data['cohesion_radius']} from the centre of mass"
        level = self.energy([ball(x) for x in x0])
        ensure(same(data["energy"], level.lower(), down=True), "the energy at the start is not the one stated")
        ensure(data["below_c_star"] is bool(level < self.gain["c1_alpha"] * c_star(self.par)), "H(0) < c*")
        yield f"the energy at the start is {data['energy']}, rounded down"
        if data["basin"] is not None:
            yield from self.ends_in(data["basin"], data["law"], number(data["turn"]), state, error)

    def ends_in(
        self, basin: Mapping[str, Any], own: Mapping[str, str], turn: arb, state: Vector, error: arb
    ) -> Iterator[str]:
        """The end of the run lies in the basin of a certificate of its own, turned by an angle."""
        ensure(basin.get("kind") == "basin", "what stands for the basin is no certificate of one")
        yield from (f"basin: {step}" for step in check_data(basin).steps)
        law, size = basin["law"], self.n * self.m
        alike = (Fraction(own[name]) == Fraction(law[name]) for name in ("d", "r", "eps", "h", "a", "b", *self.gain))
        ensure(own["algorithm"] == law["algorithm"] and all(alike), "the basin is of another law")
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
        """The error where one path follows another."""
        return error + self.norm([a - b for a, b in zip(state, self.at(path, arb(0)), strict=True)])

    def grown(self, t: arb, h: arb, path: Sequence[Vector], error: arb, bound: arb) -> tuple[arb, Vector]:
        """(the error at the end of a step, a box of all states within a bound of its path)."""
        span = arb(0).union(h)
        reach = self.at(path, span)
        half, size = bound / self.weight, self.n * self.m
        box = [x + arb(0, (half if k < size else bound).upper()) for k, x in enumerate(reach)]
        rate = self.logarithmic_norm(self.slope(box))
        defect = self.defect(t, h, path)
        return (rate.max(arb(0)) * h).exp() * (error + h * defect), box

    def defect(self, t: arb, h: arb, path: Sequence[Vector]) -> arb:
        """A bound of |y'' − u(t, y, y')| on a step. (y is the integral of its velocity, and has no other defect.)

        Where every pair is on one piece of its law: the coefficients of the difference at the begin of the step, and of
        u the next one at any time of it. Elsewhere: the difference at the begin, and its slope during the step.
        """
        span, size, order = arb(0).union(h), self.n * self.m, len(path[0]) - 1
        whole = self.shifted(path, span)
        pieces = self.pieces([row[0] for row in whole[:size]])
        total = []
        if None in pieces:
            begin, during = self.at(path, arb(0)), [row[0] for row in whole]
            with capped(1):
                bend = self.force(t, [arb_series([x]) for x in begin], pieces)
            along = (self.slope(during) * arb_mat([[row[1]] for row in whole])).entries()
            drift = [self.gain["c1_gamma"] * self.velocity[k % self.m] for k in range(size)]
            for k in range(size):
                jerk = 6 * whole[k][3] - along[size + k] - drift[k]
                total.append(abs(2 * path[k][2] - bend[k][0]) + h * abs(jerk))
            return self.length(total)
        with capped(order):
            first = self.force(t, [arb_series(row) for row in self.shifted(path, arb(0))], pieces)
            last = self.force(t + span, [arb_series(row) for row in whole], pieces)
            for k in range(size):
                terms = [abs((j + 2) * (j + 1) * path[k][j + 2] - first[k][j]) * h**j for j in range(order - 1)]
                total.append(sum(terms, abs(last[k][order - 1]) * h ** (order - 1)))
        return self.length(total)

    def shifted(self, path: Sequence[Vector], s: arb) -> list[Vector]:
        """Coefficients of q and then of p = q' about a time s into the step."""
        rows = [
            [sum((comb(i, j) * row[i] * s ** (i - j) for i in range(j, len(row))), arb(0)) for j in range(len(row))]
            for row in path
        ]
        return rows + [[(j + 1) * row[j + 1] for j in range(len(row) - 1)] for row in rows]

    def at(self, path: Sequence[Vector], s: arb) -> Vector:
        """(q, p) at a time s into the step."""
        return [row[0] for row in self.shifted(path, s)]

    def agents(self, x: Sequence[Any]) -> list[Sequence[Any]]:
        """Coordinates, agent by agent."""
        return [x[k : k + self.m] for k in range(0, len(x), self.m)]

    def gaps(self, x: Sequence[Any]) -> Iterator[tuple[int, int, list[Any]]]:
        """(i, j, q_j − q_i) of every pair."""
        q = self.agents(x[: self.n * self.m])
        return ((i, j, [b - a for a, b in zip(q[i], q[j], strict=True)]) for i, j in combinations(range(self.n), 2))

    def pieces(self, q: Vector) -> list[int | None]:
        """0 up to h r_α, 1 up to r_α, 2 beyond; None for a pair that may be on two."""
        found: list[int | None] = []
        for _, _, gap in self.gaps(q):
            z, cutoff = sigma_of_square(sum(map(square, gap), arb(0)), self.par.eps), r_alpha(self.par)
            knee = ball(self.par.h) * cutoff
            found.append(0 if z < knee else 2 if z > cutoff else 1 if z > knee and z < cutoff else None)
        return found

    def force(self, t: arb, x: Sequence[arb_series], pieces: Sequence[int | None]) -> list[Any]:
        """u along series of q and p about a time."""
        size, m = self.n * self.m, self.m
        p, g = self.agents(x[size:]), self.gain
        u = [
            -g["c1_gamma"] * (x[k] - arb_series([self.start[k % m] + self.velocity[k % m] * t, self.velocity[k % m]]))
            - g["c2_gamma"] * (x[size + k] - self.told[k % m])
            for k in range(size)
        ]
        for (i, j, gap), piece in zip(self.gaps(x), pieces, strict=True):
            if piece == 2:
                continue
            stress, weight = self.pair(gap, piece)
            for k in range(m):
                pull = g["c1_alpha"] * stress * gap[k] + g["c2_alpha"] * weight * (p[j][k] - p[i][k])
                u[i * m + k] += pull
                u[j * m + k] -= pull
        return u

    def pair(self, gap: Sequence[arb_series], piece: int | None) -> tuple[Any, Any]:
        """(φ_α/√(1 + εs²), a_ij) of a pair, a series; of an unknown piece its value at the begin, as a number."""
        par, s2 = self.par, sum((x * x for x in gap[1:]), gap[0] * gap[0])
        if piece is None:
            z = sigma_of_square(s2[0], par.eps)
            return phi_alpha(z, par) / (1 + ball(par.eps) * s2[0]).sqrt(), adjacency(z, par)
        root = (1 + ball(par.eps) * s2).sqrt()
        z, h = (root - 1) / ball(par.eps), ball(par.h)
        rho = arb_series([1]) if piece == 0 else (1 + ((z / r_alpha(par) - h) / (1 - h)).cos_pi()) / 2
        s = z + (shift(par.a, par.b) - d_alpha(par))
        a, b = ball(par.a), ball(par.b)
        return rho * ((a + b) * s / (1 + s * s).sqrt() + (a - b)) / 2 / root, rho

    def slope(self, box: Vector) -> arb_mat:
        """∂(p, u)/∂(q, p) on a box, across the pieces of the pair law."""
        size, m, g, par = self.n * self.m, self.m, self.gain, self.par
        rows = [[arb(int(c == r + size)) for c in range(2 * size)] for r in range(2 * size)]
        for k in range(size):
            rows[size + k][k], rows[size + k][size + k] = -g["c1_gamma"], -g["c2_gamma"]
        p = self.agents(box[size:])
        for i, j, gap in self.gaps(box):
            s2 = sum(map(square, gap), arb(0))
            z, root = sigma_of_square(s2, par.eps), (1 + ball(par.eps) * s2).sqrt()
            stress, weight = phi_alpha(z, par) / root, adjacency(z, par)
            steeper = (phi_alpha_slope(z, par) - ball(par.eps) * stress) / square(root)
            fading = bump_slope(z / r_alpha(par), par.h) / r_alpha(par) / root
            for k in range(m):
                relative = p[j][k] - p[i][k]
                for c in range(m):
                    block = (g["c1_alpha"] * steeper * gap[k] + g["c2_alpha"] * fading * relative) * gap[c]
                    block += g["c1_alpha"] * stress if k == c else 0
                    for r, o, sign in ((i, j, 1), (j, i, 1), (i, i, -1), (j, j, -1)):
                        rows[size + r * m + k][o * m + c] += sign * block
                        if k == c:
                            rows[size + r * m + k][size + o * m + c] += sign * g["c2_alpha"] * weight
        return arb_mat(rows)

    def logarithmic_norm(self, slope: arb_mat) -> arb:
        """A bound μ of ⟨e, A e⟩/|e|² for every matrix A in the balls, e in the weighted coordinates (w q, p)."""
        size, w, a = self.n * self.m, self.weight, slope.tolist()
        scale = [w] * size + [arb(1)] * size
        rows = [
            [(scale[r] * a[r][c] / scale[c] + scale[c] * a[c][r] / scale[r]) / 2 for c in range(2 * size)]
            for r in range(2 * size)
        ]
        guess = float(np.linalg.eigvalsh(np.array([[float(x) for x in row] for row in rows]))[-1])
        for more in (0.01, 0.1, 1.0, 10.0, 1e3, 1e6):
            bound = arb(guess + more * (1 + abs(guess)))
            if positive([[(bound if r == c else 0) - x for c, x in enumerate(row)] for r, row in enumerate(rows)]):
                return bound
        ensure(False, "no bound of the growth of errors")
        raise AssertionError

    def norm(self, x: Vector) -> arb:
        """√(w²|q|² + |p|²)."""
        size = self.n * self.m
        return self.length([*(self.weight * y for y in x[:size]), *x[size:]])

    def length(self, x: Sequence[arb]) -> arb:
        """The Euclidean norm, an upper end."""
        return arb(sum(map(square, x), arb(0)).nonnegative_part().sqrt().upper())

    def lengths(self, box: Vector) -> list[arb]:
        """Distances of the pairs."""
        return [sum(map(square, gap), arb(0)).nonnegative_part().sqrt() for _, _, gap in self.gaps(box)]

    def radii(self, box: Vector) -> list[arb]:
        """Distances of the agents from their centre of mass."""
        return [sum(map(square, row), arb(0)).nonnegative_part().sqrt() for row in self.centred(box[: self.n * self.m])]

    def centred(self, x: Vector) -> list[Vector]:
        """Deviations from the mean of all agents."""
        rows = self.agents(x)
        means = [sum((row[k] for row in rows), arb(0)) / self.n for k in range(self.m)]
        return [[a - b for a, b in zip(row, means, strict=True)] for row in rows]

    def energy(self, x: Vector) -> arb:
        """The structural energy: c1α V + c1γ J + K in the moving frame."""
        size = self.n * self.m
        pairs = (psi_alpha(sigma_of_square(square(length), self.par.eps), self.par) for length in self.lengths(x))
        inertia, kinetic = (
            sum((square(y) for row in self.centred(part) for y in row), arb(0)) / 2 for part in (x[:size], x[size:])
        )
        return self.gain["c1_alpha"] * sum(pairs, arb(0)) + self.gain["c1_gamma"] * inertia + kinetic


@contextmanager
def capped(length: int) -> Iterator[None]:
    """Series to so many coefficients."""
    before, ctx.cap = ctx.cap, length
    try:
        yield
    finally:
        ctx.cap = before


def positive(rows: list[list[arb]]) -> bool:
    """Whether every symmetric matrix in the balls is certainly positive definite: L D Lᵀ has D > 0."""
    for k, pivot in enumerate(rows):
        if not pivot[k] > 0:
            return False
        for row in rows[k + 1 :]:
            factor = row[k] / pivot[k]
            for j in range(k + 1, len(rows)):
                row[j] -= factor * pivot[j]
    return True


def same(stated: str, value: arb, *, down: bool) -> bool:
    """Whether a decimal is the one that bounds a number."""
    return stated == (at_least(value) if down else at_most(value))


def number(text: str) -> arb:
    """A decimal as the ball of its value."""
    return ball(Fraction(text))


def exact(text: str) -> Fraction:
    """A number in hexadecimal, mantissa and exponent of 2: -0x3p-1 is −3/2."""
    mantissa, _, exponent = text.partition("p")
    return Fraction(int(mantissa, 16)) * Fraction(2) ** int(exponent)
