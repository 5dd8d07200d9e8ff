"""Right-hand side of Algorithms 1 to 3 for the checker of tubes, in balls and series.

Only the scalar functions of `intervals` are shared with the prover. With w = x − y, D = ‖w‖, e = w/D, the clearance
c = D − R of a sphere and z = ‖c‖_σ, an agent is pushed by −c1β φ_β(z) c/√(1 + εc²) e and braked by −c2β ρ_h G,
G = v − (R/D)(v − ⟨e, v⟩ e), its velocity past its β-agent.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations, product
from math import comb
from typing import Any

from flint import arb, arb_mat, arb_series

from flockana.certified.balls import AlphaParameters, BetaParameters, ball, dot, norm, norm2, square
from flockana.certified.scalar_functions_in_balls import (
    adjacency,
    bump,
    bump_slope,
    d_alpha,
    d_beta,
    phi_alpha,
    phi_alpha_slope,
    phi_beta,
    phi_beta_slope,
    psi_alpha,
    psi_beta,
    r_alpha,
    shift,
    sigma_of_square,
)

Vector = list[arb]


@dataclass(frozen=True)
class Motion:
    """Right-hand side of a tube certificate's law for n agents in m dimensions, with exact decimals."""

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
        """Return the Taylor coefficients of positions and velocities, re-expanded about time s of a step."""
        rows = [
            [sum((comb(i, j) * row[i] * s ** (i - j) for i in range(j, len(row))), arb(0)) for j in range(len(row))]
            for row in path
        ]
        return rows + [[(j + 1) * row[j + 1] for j in range(len(row) - 1)] for row in rows]

    def at(self, path: Sequence[Vector], s: arb) -> Vector:
        """Return positions and velocities on a polynomial path at a time s into its step."""
        return [row[0] for row in self.shifted(path, s)]

    def agents(self, x: Sequence[Any]) -> list[Sequence[Any]]:
        """Return a vector of coordinates as a list of agents."""
        return [x[k : k + self.m] for k in range(0, len(x), self.m)]

    def gaps(self, x: Sequence[Any]) -> Iterator[tuple[int, int, list[Any]]]:
        """Return (i, j, q_j − q_i) of every pair."""
        q = self.agents(x[: self.n * self.m])
        return ((i, j, [b - a for a, b in zip(q[i], q[j], strict=True)]) for i, j in combinations(range(self.n), 2))

    def pieces(self, q: Vector) -> list[int | None]:
        """Return the piece (0, 1, 2; None if undecided) of ρ_h for each pair and each agent with a sphere."""
        norms = (sigma_of_square(norm2(gap), self.par.eps) for _, _, gap in self.gaps(q))
        piece_numbers = [piece_of(z, r_alpha(self.par), self.par.h) for z in norms]
        return piece_numbers + [sphere.piece(x) for sphere in self.spheres for x in self.agents(q)]

    def force(self, t: arb, x: Sequence[arb_series], pieces: Sequence[int | None]) -> list[Any]:
        """Return the accelerations u along Taylor series of q and p."""
        size, m = self.n * self.m, self.m
        q, p, g = self.agents(x[:size]), self.agents(x[size:]), self.gain
        leader = [arb_series([q + p * t, p]) for q, p in zip(self.start, self.velocity, strict=True)]
        away = [x[k] - leader[k % m] for k in range(size)]
        if self.bounded:
            away = [a / (1 + norm2(components)).sqrt() for components in self.agents(away) for a in components]
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
        """Return (i, sphere) for every agent i and every spherical obstacle."""
        return [(i, sphere) for sphere in self.spheres for i in range(self.n)]

    def pull(self, x: Vector) -> list[Vector]:
        """Return the slope c1γ ∂σ₁(x − q_r)/∂x of the pull to a γ-agent at rest, on a box."""
        displacement = [a - b for a, b in zip(x, self.start, strict=True)]
        slant = (1 + norm2(displacement)).rsqrt()
        cube, gain, rows = slant * slant * slant, self.gain["c1_gamma"], list(enumerate(displacement))
        return [[gain * ((slant if k == c else 0) - cube * a * b) for c, b in rows] for k, a in rows]

    def pair(self, gap: Sequence[arb_series], piece: int | None) -> tuple[Any, Any]:
        """Return (φ_α/√(1 + εs²), a_ij) of a pair; as constant balls if its piece of ρ_h is undecided."""
        par, s2 = self.par, norm2(gap)
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
        """Return the Jacobian ∂(p, u)/∂(q, p) of the equations of motion on a box of states."""
        size, m, g, par = self.n * self.m, self.m, self.gain, self.par
        rows = [[arb(int(c == r + size)) for c in range(2 * size)] for r in range(2 * size)]
        for k in range(size):
            rows[size + k][k], rows[size + k][size + k] = -g["c1_gamma"], -g["c2_gamma"]
        q, p = self.agents(box[:size]), self.agents(box[size:])
        for i in range(self.n if self.bounded else 0):
            for k, row in enumerate(self.pull(list(q[i]))):
                rows[size + i * m + k][i * m : i * m + m] = [-value for value in row]
        for i, sphere in self.near():
            for first_column, table in zip((i * m, size + i * m), sphere.slope(q[i], p[i]), strict=True):
                for k, c in product(range(m), repeat=2):
                    rows[size + i * m + k][first_column + c] += table[k][c]
        for i, j, gap in self.gaps(box):
            s2 = norm2(gap)
            z, root = sigma_of_square(s2, par.eps), (1 + ball(par.eps) * s2).sqrt()
            stress, weight = phi_alpha(z, par) / root, adjacency(z, par)
            stress_slope = (phi_alpha_slope(z, par) - ball(par.eps) * stress) / square(root)
            fading = bump_slope(z / r_alpha(par), par.h) / r_alpha(par) / root
            for k, c in product(range(m), repeat=2):
                block = (g["c1_alpha"] * stress_slope * gap[k] + g["c2_alpha"] * fading * (p[j][k] - p[i][k])) * gap[c]
                block += g["c1_alpha"] * stress if k == c else 0
                for r, o, sign in ((i, j, 1), (j, i, 1), (i, i, -1), (j, j, -1)):
                    rows[size + r * m + k][o * m + c] += sign * block
                    if k == c:
                        rows[size + r * m + k][size + o * m + c] += sign * g["c2_alpha"] * weight
        return arb_mat(rows)

    def length(self, x: Sequence[arb]) -> arb:
        """Return an upper bound of the Euclidean norm of a vector of balls."""
        return arb(norm(x).upper())

    def lengths(self, box: Vector) -> list[arb]:
        """Return the distances of all pairs of agents on a box of states."""
        return [norm(gap) for _, _, gap in self.gaps(box)]

    def radii(self, box: Vector) -> list[arb]:
        """Return the distances of the agents from their centre of mass."""
        return [norm(row) for row in self.centred(box[: self.n * self.m])]

    def centred(self, x: Vector) -> list[Vector]:
        """Return the deviations from the mean of all agents."""
        rows = self.agents(x)
        mean_values = [sum((row[k] for row in rows), arb(0)) / self.n for k in range(self.m)]
        return [[a - b for a, b in zip(row, mean_values, strict=True)] for row in rows]

    def energy(self, x: Vector) -> arb:
        """Return the energy c1α V + c1γ J + K in the moving frame; under Algorithm 3, H in the fixed frame."""
        size = self.n * self.m
        pairs = (psi_alpha(sigma_of_square(square(distance), self.par.eps), self.par) for distance in self.lengths(x))
        total = self.gain["c1_alpha"] * sum(pairs, arb(0))
        if not self.bounded:
            inertia, kinetic = (sum(map(norm2, self.centred(block)), arb(0)) / 2 for block in (x[:size], x[size:]))
            return total + self.gain["c1_gamma"] * inertia + kinetic
        for y in self.agents(x[:size]):
            squared_distance = norm2([a - b for a, b in zip(y, self.start, strict=True)])
            total += self.gain["c1_gamma"] * ((1 + squared_distance).sqrt() - 1)
            total += sum((sphere.energy(y) for sphere in self.spheres), arb(0))
        return total + norm2(x[size:]) / 2


def number(text: str) -> arb:
    """Return the ball around a decimal's value."""
    return ball(Fraction(text))


@dataclass(frozen=True)
class Sphere:
    """Sphere of centre y and radius R with the β-pair law and its gains."""

    par: BetaParameters
    centre: tuple[arb, ...]
    radius: arb
    push: arb
    drag: arb

    @classmethod
    def of(cls, law: Mapping[str, Any], one: Mapping[str, Any]) -> Sphere:
        """Return the sphere of a certificate, its numbers as exact decimals."""
        par = BetaParameters(d=law["beta_d"], eps=law["beta_eps"], h=law["beta_h"])
        centre = tuple(ball(Fraction(x)) for x in one["centre"])
        parameters = (ball(Fraction(x)) for x in (one["radius"], law["c1_beta"], law["c2_beta"]))
        return cls(par, centre, *parameters)

    def clearance(self, x: Sequence[arb]) -> arb:
        """Return the clearance ‖x − y‖ − R of a point x from the sphere."""
        return norm([a - b for a, b in zip(x, self.centre, strict=True)]) - self.radius

    def height(self, x: Sequence[arb]) -> arb:
        """Return the σ-norm ‖c‖_σ of a clearance c from the sphere."""
        return sigma_of_square(square(self.clearance(x)), self.par.eps)

    def energy(self, x: Sequence[arb]) -> arb:
        """Return the potential c1β ψ_β of an agent near the sphere."""
        return self.push * psi_beta(self.height(x), self.par)

    def piece(self, x: Sequence[arb]) -> int | None:
        """Return the piece (0, 1, 2; None if undecided) of ρ_h on which an agent's clearance lies."""
        return piece_of(self.height(x), d_beta(self.par), self.par.h)

    def force(self, x: Sequence[Any], v: Sequence[Any], piece: int | None) -> list[Any]:
        """Return the sphere's force on an agent as series in time; as balls if the piece of ρ_h is undecided."""
        if piece is None:
            x, v = [a[0] for a in x], [a[0] for a in v]
        e, distance = self._direction(x)
        c, eps = distance - self.radius, ball(self.par.eps)
        if piece is None:
            z = sigma_of_square(square(c), self.par.eps)
            action, rho = phi_beta(z, self.par), bump(z / d_beta(self.par), self.par.h)
        else:
            z, h = ((1 + eps * (c * c)).sqrt() - 1) / eps, ball(self.par.h)
            rho = taper(z / d_beta(self.par), h, piece)
            s = z - d_beta(self.par)
            action = rho * (s / (1 + s * s).sqrt() - 1)
        size, axial_part = self.push * action * c / (1 + eps * (c * c)).sqrt(), dot(e, v)
        share = self.radius / distance
        return [-size * a - self.drag * rho * (w - share * (w - axial_part * a)) for a, w in zip(e, v, strict=True)]

    def slope(self, x: Sequence[arb], v: Sequence[arb]) -> tuple[list[list[arb]], list[list[arb]]]:
        """Return the Jacobians of the sphere's force by an agent's position and velocity, on a box."""
        e, distance = self._direction(x)
        c, along, share = distance - self.radius, dot(e, v), self.radius / distance
        stretch, z = 1 + ball(self.par.eps) * square(c), sigma_of_square(square(c), self.par.eps)
        action, rho = phi_beta(z, self.par), bump(z / d_beta(self.par), self.par.h)
        fading = bump_slope(z / d_beta(self.par), self.par.h) / d_beta(self.par) * c / stretch.sqrt()
        size = self.push * action * c / stretch.sqrt()
        steeper = self.push * (phi_beta_slope(z, self.par) * square(c) + action / stretch.sqrt()) / stretch
        by_x, by_v = ([[arb(0)] * len(x) for _ in x] for _ in range(2))
        for k, h in product(range(len(x)), repeat=2):
            a, w, b, u = e[k], v[k], e[h], v[h]
            slip, aside = w - share * (w - along * a), int(k == h) - a * b
            turn = share / distance * (b * (w - a * along) + aside * along + a * (u - b * along))
            by_x[k][h] = -steeper * a * b - size * aside / distance - self.drag * (fading * b * slip + rho * turn)
            by_v[k][h] = -self.drag * rho * ((1 - share) * int(k == h) + share * a * b)
        return by_x, by_v

    def _direction(self, x: Sequence[Any]) -> tuple[list[Any], Any]:
        """Return the unit vector e from the sphere's centre to an agent, and the distance D between them."""
        displacement = [a - b for a, b in zip(x, self.centre, strict=True)]
        distance = norm2(displacement).sqrt()
        return [a / distance for a in displacement], distance


def piece_of(z: arb, cutoff: arb, h: Any) -> int | None:
    """Return the piece of ρ_h for a σ-norm: 0 below h·cutoff, 1 to the cutoff, 2 beyond; None if undecided."""
    knee = ball(h) * cutoff
    return 0 if z < knee else 2 if z > cutoff else 1 if z > knee and z < cutoff else None


def taper(z: Any, h: arb, piece: int) -> Any:
    """Return the bump ρ_h(z) of a series: 1 on piece 0, a half-cosine on piece 1."""
    return arb_series([1]) if piece == 0 else (1 + ((z - h) / (1 - h)).cos_pi()) / 2
