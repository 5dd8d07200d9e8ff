"""Right-hand side of Algorithms 1 to 3 for the checker of tubes, in balls and series.

Only the scalar functions of `intervals` are shared with the prover.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import comb
from typing import Any

from flint import arb, arb_mat, arb_series

from flockana.certified.balls import AlphaParameters, ball, square
from flockana.certified.check_sphere import Sphere, piece_of, taper
from flockana.certified.intervals import (
    adjacency,
    bump_slope,
    d_alpha,
    phi_alpha,
    phi_alpha_slope,
    psi_alpha,
    r_alpha,
    shift,
    sigma_of_square,
)

Vector = list[arb]


@dataclass(frozen=True)
class Motion:
    """Law for n agents in m dimensions; numbers given as text are exact decimals."""

    par: AlphaParameters
    gain: Mapping[str, arb]
    start: Vector
    velocity: Vector
    declared: Vector
    n: int
    m: int
    bounded: bool
    spheres: tuple[Sphere, ...]

    def shifted(self, path: Sequence[Vector], s: arb) -> list[Vector]:
        """Return coefficients of q and then of p = q' about a time s into the step."""
        rows = [
            [sum((comb(i, j) * row[i] * s ** (i - j) for i in range(j, len(row))), arb(0)) for j in range(len(row))]
            for row in path
        ]
        return rows + [[(j + 1) * row[j + 1] for j in range(len(row) - 1)] for row in rows]

    def at(self, path: Sequence[Vector], s: arb) -> Vector:
        """Return (q, p) at a time s into the step."""
        return [row[0] for row in self.shifted(path, s)]

    def agents(self, x: Sequence[Any]) -> list[Sequence[Any]]:
        """Return coordinates grouped by agent."""
        return [x[k : k + self.m] for k in range(0, len(x), self.m)]

    def gaps(self, x: Sequence[Any]) -> Iterator[tuple[int, int, list[Any]]]:
        """Return (i, j, q_j − q_i) of every pair."""
        q = self.agents(x[: self.n * self.m])
        return ((i, j, [b - a for a, b in zip(q[i], q[j], strict=True)]) for i, j in combinations(range(self.n), 2))

    def pieces(self, q: Vector) -> list[int | None]:
        """Return each pair's piece: 0 up to h r_α, 1 up to r_α, 2 beyond, None if it may be on two."""
        norms = (sigma_of_square(sum(map(square, gap), arb(0)), self.par.eps) for _, _, gap in self.gaps(q))
        found = [piece_of(z, r_alpha(self.par), self.par.h) for z in norms]
        return found + [sphere.piece(x) for sphere in self.spheres for x in self.agents(q)]

    def force(self, t: arb, x: Sequence[arb_series], pieces: Sequence[int | None]) -> list[Any]:
        """Return u along series of q and p about a time."""
        size, m = self.n * self.m, self.m
        q, p, g = self.agents(x[:size]), self.agents(x[size:]), self.gain
        leader = [
            arb_series([start + speed * t, speed]) for start, speed in zip(self.start, self.velocity, strict=True)
        ]
        away = [x[k] - leader[k % m] for k in range(size)]
        if self.bounded:
            away = [a / (1 + sum((b * b for b in own), 0 * a)).sqrt() for own in self.agents(away) for a in own]
        u = [-g["c1_gamma"] * a - g["c2_gamma"] * (x[size + k] - self.declared[k % m]) for k, a in enumerate(away)]
        for (i, sphere), piece in zip(self.near(), pieces[self.n * (self.n - 1) // 2 :], strict=True):
            if piece != 2:
                for k, push in enumerate(sphere.force(q[i], p[i], piece)):
                    u[i * m + k] += push
        for (i, j, gap), piece in zip(self.gaps(x), pieces, strict=False):
            if piece == 2:
                continue
            stress, weight = self.pair(gap, piece)
            for k in range(m):
                pull = g["c1_alpha"] * stress * gap[k] + g["c2_alpha"] * weight * (p[j][k] - p[i][k])
                u[i * m + k] += pull
                u[j * m + k] -= pull
        return u

    def near(self) -> list[tuple[int, Sphere]]:
        """Return every agent with every sphere, in the order of `pieces`."""
        return [(i, sphere) for sphere in self.spheres for i in range(self.n)]

    def pull(self, x: Vector) -> list[Vector]:
        """Return the derivative c1γ ∂σ₁(x − q_r)/∂x of the pull to a γ-agent at rest, on a box."""
        away = [a - b for a, b in zip(x, self.start, strict=True)]
        slant = (1 + sum(map(square, away), arb(0))).rsqrt()
        cube, gain, rows = slant * slant * slant, self.gain["c1_gamma"], list(enumerate(away))
        return [[gain * ((slant if k == c else 0) - cube * a * b) for c, b in rows] for k, a in rows]

    def pair(self, gap: Sequence[arb_series], piece: int | None) -> tuple[Any, Any]:
        """Return (φ_α/√(1 + εs²), a_ij) of a pair as a series; on an unknown piece as numbers at the begin."""
        par, s2 = self.par, sum((x * x for x in gap[1:]), gap[0] * gap[0])
        if piece is None:
            z = sigma_of_square(s2[0], par.eps)
            return phi_alpha(z, par) / (1 + ball(par.eps) * s2[0]).sqrt(), adjacency(z, par)
        root = (1 + ball(par.eps) * s2).sqrt()
        z, h = (root - 1) / ball(par.eps), ball(par.h)
        rho = taper(z / r_alpha(par), h, piece)
        s = z + (shift(par.a, par.b) - d_alpha(par))
        a, b = ball(par.a), ball(par.b)
        return rho * ((a + b) * s / (1 + s * s).sqrt() + (a - b)) / 2 / root, rho

    def slope(self, box: Vector) -> arb_mat:
        """Return ∂(p, u)/∂(q, p) on a box, across the pieces of the pair law."""
        size, m, g, par = self.n * self.m, self.m, self.gain, self.par
        rows = [[arb(int(c == r + size)) for c in range(2 * size)] for r in range(2 * size)]
        for k in range(size):
            rows[size + k][k], rows[size + k][size + k] = -g["c1_gamma"], -g["c2_gamma"]
        q, p = self.agents(box[:size]), self.agents(box[size:])
        for i in range(self.n if self.bounded else 0):
            for k, row in enumerate(self.pull(list(q[i]))):
                for c, value in enumerate(row):
                    rows[size + i * m + k][i * m + c] = -value
        for i, sphere in self.near():
            for first, block in zip((i * m, size + i * m), sphere.slope(q[i], p[i]), strict=True):
                for k in range(m):
                    for c in range(m):
                        rows[size + i * m + k][first + c] += block[k][c]
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

    def length(self, x: Sequence[arb]) -> arb:
        """Return an upper bound of the Euclidean norm."""
        return arb(sum(map(square, x), arb(0)).nonnegative_part().sqrt().upper())

    def lengths(self, box: Vector) -> list[arb]:
        """Return the distances of the pairs."""
        return [sum(map(square, gap), arb(0)).nonnegative_part().sqrt() for _, _, gap in self.gaps(box)]

    def radii(self, box: Vector) -> list[arb]:
        """Return the distances of the agents from their centre of mass."""
        return [sum(map(square, row), arb(0)).nonnegative_part().sqrt() for row in self.centred(box[: self.n * self.m])]

    def centred(self, x: Vector) -> list[Vector]:
        """Return the deviations from the mean of all agents."""
        rows = self.agents(x)
        means = [sum((row[k] for row in rows), arb(0)) / self.n for k in range(self.m)]
        return [[a - b for a, b in zip(row, means, strict=True)] for row in rows]

    def energy(self, x: Vector) -> arb:
        """Return the energy c1α V + c1γ J + K in the moving frame; with a bounded pull in the given frame."""
        size = self.n * self.m
        pairs = (psi_alpha(sigma_of_square(square(length), self.par.eps), self.par) for length in self.lengths(x))
        total = self.gain["c1_alpha"] * sum(pairs, arb(0))
        if not self.bounded:
            inertia, kinetic = (
                sum((square(y) for row in self.centred(part) for y in row), arb(0)) / 2 for part in (x[:size], x[size:])
            )
            return total + self.gain["c1_gamma"] * inertia + kinetic
        for y in self.agents(x[:size]):
            far = sum((square(a - b) for a, b in zip(y, self.start, strict=True)), arb(0))
            total += self.gain["c1_gamma"] * ((1 + far).sqrt() - 1)
            total += sum((sphere.energy(y) for sphere in self.spheres), arb(0))
        return total + sum(map(square, x[size:]), arb(0)) / 2


def number(text: str) -> arb:
    """Return a decimal as the ball of its value."""
    return ball(Fraction(text))
