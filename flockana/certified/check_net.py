"""Flock of a basin certificate for its checker: law, equilibrium, matrices, and bounds of pairs.

Nothing of the prover but the scalar functions of `intervals`.
"""

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import combinations
from typing import Any

from flint import arb, arb_mat

from flockana.certified.balls import AlphaParameters, ball, square
from flockana.certified.check import ensure
from flockana.certified.intervals import adjacency, phi_alpha, phi_alpha_slope, sigma_of_square

ROOT_TWO = Fraction("1.4142136")  # its square is above 2: |w_j − w_i| <= √2 ‖w‖
_DEEPEST = 24  # halvings of a cell of lengths
Pair = tuple[int, int]


class Net:
    """Law and positions of a certificate."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        self.text = data["law"]
        self.par = AlphaParameters(**{name: self.text[name] for name in ("d", "r", "eps", "h", "a", "b")})
        gains = (Fraction(self.text[name]) for name in ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma"))
        self.c1_alpha, self.c2_alpha, self.c1_gamma, self.c2_gamma = gains
        self.centre = [[arb(float.fromhex(y)) for y in row] for row in data["positions"]]
        self.n, self.m = len(self.centre), len(self.centre[0])
        self.box = ball(Fraction(data["box"]))
        ensure(self.text["algorithm"] in ("Algorithm1", "Algorithm2"), "its law is neither Algorithm 1 nor 2")
        led = self.text["algorithm"] == "Algorithm2"
        ensure(led or self.c1_gamma == self.c2_gamma == 0, "Algorithm 1 has no gains of a γ-agent")
        ensure(self.n > 1 and self.m in (1, 2, 3) and all(len(row) == self.m for row in self.centre), "no flock")
        ensure(min(self.c1_alpha, self.c2_alpha, self.c1_gamma, self.c2_gamma) >= 0, "a gain is negative")

    def tension(self, length: arb) -> arb:
        """Return F'(ℓ)/ℓ of the pair potential F."""
        s = square(length)
        root = (1 + ball(self.par.eps) * s).sqrt()
        return ball(self.c1_alpha) * phi_alpha(sigma_of_square(s, self.par.eps), self.par) / root

    def stiffness(self, length: arb) -> arb:
        """Return F''(ℓ) of the pair potential F."""
        s = square(length)
        root, z = (1 + ball(self.par.eps) * s).sqrt(), sigma_of_square(s, self.par.eps)
        slope, action = phi_alpha_slope(z, self.par), phi_alpha(z, self.par)
        return ball(self.c1_alpha) * (slope * s / root**2 + action / root**3)

    def weight(self, length: arb) -> arb:
        """Return the weight a_ij at a length."""
        return adjacency(sigma_of_square(square(length), self.par.eps), self.par)

    def equilibrium(self) -> list[list[arb]]:
        """Return balls around the equilibrium, by Krawczyk's test of the equations with multipliers μ = 0."""
        # The turns are those of the positions, to which they are orthogonal.
        n, m = self.n, self.m
        turns = self.rotation_tangents(self.centre)
        held = turns + self.translations()
        start = [y for row in self.centre for y in row]
        moving = self.rotation_tangents([[y + arb(0, self.box) for y in row] for row in self.centre])
        products = [[inner(a, b) for b in turns] for a in moving]
        ensure(not turns or bool(arb_mat(products).det() != 0), "the rotations are not independent")
        size = len(start) + len(held)
        shift = self.krawczyk(start, [self.box] * size, held)
        ensure(all(abs(y) < self.box for y in shift), "Krawczyk's test fails: no isolated equilibrium in the box")
        near = [y + change for y, change in zip(start, shift, strict=False)]
        middles, radii = [y.mid() for y in near], [y.rad() for y in near] + [arb(0)] * len(held)
        shift = self.krawczyk(middles, radii, held)  # once more, about what was found: the zero stays inside
        found = [y + change for y, change in zip(middles, shift, strict=False)]
        return [found[m * i : m * i + m] for i in range(n)]

    def krawczyk(self, centre: list[arb], radii: list[arb], held: list[list[arb]]) -> list[arb]:
        """Return Krawczyk's image (1 − Y F'(B)) (B − c) − Y F(c) of the box B about c."""
        size = len(centre)
        wide = self.slope(self.rows([y + arb(0, r) for y, r in zip(centre, radii, strict=False)]), held)
        factor = middle(middle(wide).inv())
        value = self.force(self.rows(centre)) + [inner(motion, centre) for motion in held]
        one = arb_mat([[arb(int(i == j)) for j in range(size + len(held))] for i in range(size + len(held))])
        moved = (one - factor * wide) * arb_mat([[arb(0, r)] for r in radii]) - factor * arb_mat([[y] for y in value])
        return [row[0] for row in moved.tolist()]

    def rows(self, flat: Sequence[arb]) -> list[list[arb]]:
        """Return coordinates grouped by agent."""
        return [list(flat[self.m * i : self.m * (i + 1)]) for i in range(self.n)]

    def translations(self) -> list[list[arb]]:
        """Return the translations along the axes."""
        return [[arb(int(k % self.m == a)) for k in range(self.n * self.m)] for a in range(self.m)]

    def slope(self, x: Sequence[Sequence[arb]], held: Sequence[Sequence[arb]]) -> arb_mat:
        """Return ∇²U, bordered by the motions that are held."""
        blocks = {}
        for (i, j), gap, length in self.pairs(x):
            pull = self.tension(length)
            blocks[i, j] = block(gap, pull, (self.stiffness(length) - pull) / square(length))
        rows = [[*row, *(motion[k] for motion in held)] for k, row in enumerate(self.assembled(blocks))]
        return arb_mat(rows + [[*motion, *[arb(0)] * len(held)] for motion in held])

    def force(self, x: Sequence[Sequence[arb]]) -> list[arb]:
        """Return ∇U."""
        total = [[ball(self.c1_gamma) * y for y in row] for row in x]
        for (i, j), gap, length in self.pairs(x):
            for a, y in enumerate(gap):
                total[i][a] -= self.tension(length) * y
                total[j][a] += self.tension(length) * y
        return [y for row in total for y in row]

    def pairs(self, x: Sequence[Sequence[arb]]) -> Iterator[tuple[Pair, list[arb], arb]]:
        """Return pairs that are not certainly out of range: indices, relative position, length."""
        for i, j in combinations(range(self.n), 2):
            gap = [b - a for a, b in zip(x[i], x[j], strict=True)]
            length = sum(map(square, gap), arb(0)).sqrt()
            if not length >= ball(self.par.r):
                yield (i, j), gap, length

    def assembled(self, blocks: Mapping[Pair, list[list[arb]]]) -> list[list[arb]]:
        """Return the matrix of c1γ‖w‖² + Σ ⟨w_j − w_i, B (w_j − w_i)⟩."""
        m, size = self.m, self.n * self.m
        total = [[ball(self.c1_gamma) * int(i == j) for j in range(size)] for i in range(size)]
        for (i, j), own in blocks.items():
            for p, q, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
                for a in range(m):
                    for b in range(m):
                        total[m * p + a][m * q + b] += sign * own[a][b]
        return total

    def radial(
        self,
        x: Sequence[Sequence[arb]],
        gaps: Mapping[Pair, list[arb]],
        floors: Mapping[Pair, tuple[Fraction, Fraction]],
    ) -> arb_mat:
        """Return a lower bound of the Hessian from bounds of its pairs, with large eigenvalues for rigid motions."""
        blocks = {}
        for pair, (along, across) in floors.items():
            gap = gaps[pair]
            blocks[pair] = block(gap, ball(across), ball(along - across) / sum(map(square, gap), arb(0)))
        total = arb_mat(self.assembled(blocks))
        for motion in self.rotation_tangents(x) + self.translations():
            column = arb_mat([[y] for y in motion])
            total += column * column.transpose() * (10**9 * ball(self.c1_alpha) / sum(map(square, motion), arb(0)))
        return total

    def rotation_tangents(self, x: Sequence[Sequence[arb]]) -> list[list[arb]]:
        """Return the tangents of the orbit under rotations: (−y, x) of each agent in each coordinate plane."""
        return [
            [-row[b] if k == a else row[a] if k == b else arb(0) for row in x for k in range(self.m)]
            for a, b in combinations(range(self.m), 2)
        ]

    def laplacian(self, weights: Mapping[Pair, arb]) -> arb_mat:
        """Return the Laplacian of the weighted net, with the translation's eigenvalue 0 shifted to n."""
        rows = [[arb(1)] * self.n for _ in range(self.n)]
        for (i, j), weight in weights.items():
            for p, q, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
                rows[p][q] += sign * weight
        return arb_mat(rows)

    def floor_holds(self, rest: arb, eta: Fraction, along: Fraction, across: Fraction) -> bool:
        """Return whether ⟨e, ∇²f e⟩ >= along ⟨u, e⟩² + across (|e|² − ⟨u, e⟩²) for every displacement |e| <= eta."""
        # With x the change of length and b = 1 − cos of the turn, left − right is a square in b, of which a bound below
        # is linear on [0, most]: see `pair_floors`. Intervals of x are halved until the bound is certain.
        cells = [(-eta, eta, 0)]
        while cells:
            low, high, depth = cells.pop()
            x = ball(low).union(ball(high))
            length = rest + x
            stiff, pull, alpha, beta = self.stiffness(length), self.tension(length), ball(along), ball(across)
            nearest = Fraction(0) if low <= 0 <= high else min(abs(low), abs(high))
            farthest, spare = max(abs(low), abs(high)), (stiff - alpha).lower()
            zeroth = spare * ball(nearest if spare >= 0 else farthest) ** 2
            first = 2 * x * (stiff * rest + alpha * length) + 2 * (pull * square(rest) - beta * square(length))
            twice = (stiff - pull) * square(rest) - (alpha - beta) * square(length)
            most = (ball(eta**2 - nearest**2) / (2 * length * rest)).upper()
            worst = first.lower() + twice.lower().min(arb(0)) * most
            if zeroth + worst.min(arb(0)) * most >= 0:
                continue
            if depth == _DEEPEST:
                return False
            half = (low + high) / 2
            cells += [(low, half, depth + 1), (half, high, depth + 1)]
        return True

    def unique_projection(self, x: Sequence[Sequence[arb]], radius: arb) -> bool:
        """Return whether the nearest point of the orbit is unique up to the radius."""
        gram = [[sum((row[a] * row[b] for row in x), arb(0)) for b in range(self.m)] for a in range(self.m)]
        trace = sum((gram[a][a] for a in range(self.m)), arb(0))
        if self.m < 3:
            return self.m == 1 or bool(square(radius) < trace)
        largest = sum((square(y) for row in gram for y in row), arb(0)).sqrt()
        return bool((1 + arb(3).sqrt()) * radius * largest.sqrt() < trace - largest)


def inner(a: Sequence[arb], b: Sequence[arb]) -> arb:
    """Return ⟨a, b⟩."""
    return sum((y * z for y, z in zip(a, b, strict=True)), arb(0))


def block(gap: Sequence[arb], across: arb, more: arb) -> list[list[arb]]:
    """Return the matrix across·1 + more·gap gapᵀ."""
    return [[more * y * z + (across if a == b else 0) for b, z in enumerate(gap)] for a, y in enumerate(gap)]


def middle(matrix: arb_mat) -> arb_mat:
    """Return the midpoints of a matrix of balls, for proposals only."""
    return arb_mat([[entry.mid() for entry in row] for row in matrix.tolist()])
