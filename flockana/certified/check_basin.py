"""Independent checker of basin certificates, with the argument of `basin`.

It shares with the prover the scalar functions of `intervals` and nothing else. Everything is in balls or
exact; "true" means certainly true.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import accumulate, combinations, product
from typing import Any

from flint import arb, arb_mat, ctx

from flockana.certified.balls import AlphaParameters, ball, dot, hull, norm, norm2, square
from flockana.certified.certificate_check import BINARY, NUMBER, PAIR_LAW, WHOLE, ensure, positive, unit
from flockana.certified.scalar_functions_in_balls import adjacency, phi_alpha, phi_alpha_slope, sigma_of_square

DIGITS = 45
STATED, OF_RATE = 4, 3  # significant digits
ROOT_TWO = Fraction("1.4142136")  # its square is above 2: |w_j − w_i| <= √2 ‖w‖
_DEEPEST = 24  # halvings of a cell of lengths
Pair = tuple[int, int]


def form(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the form of a basin certificate: the expected kind of each entry, by key."""
    numbers = ("box", "second_eigenvalue", "degree", "radius", "level", "curvature", "surplus", "rate", "overshoot")
    return dict.fromkeys((*numbers, "distance"), NUMBER) | {
        "law": PAIR_LAW,
        "positions": [[BINARY]],
        "bonds": [{"pairs": [[WHOLE]], "along": [NUMBER], "across": [NUMBER]}],
        "curvatures": [NUMBER],
        "lyapunov": dict.fromkeys(("eps", "theta", "kappa", "tau"), NUMBER),
    }


def check(data: Mapping[str, Any]) -> Iterator[str]:
    """Verify a basin certificate and return the verified facts, step by step."""
    with ctx.workdps(DIGITS):
        net = Net(data)
        x = net.equilibrium()
        yield "exactly one equilibrium, modulo rigid motions, lies in the box about the positions (Krawczyk)"
        radius, shells = Fraction(data["radius"]), len(data["curvatures"])
        reach = radius * ROOT_TWO
        ensure(radius > 0 and ROOT_TWO**2 > 2 and shells > 0, "no radius")
        gaps = {(i, j): [b - a for a, b in zip(x[i], x[j], strict=True)] for i, j in combinations(range(net.n), 2)}
        lengths = {pair: norm(gap) for pair, gap in gaps.items()}
        bonds = [tuple((i, j) for i, j in bond["pairs"]) for bond in data["bonds"]]
        listed = [pair for bond in bonds for pair in bond]
        ensure(len(set(listed)) == len(listed) and set(listed) <= set(gaps), "a pair is listed twice, or is none")
        out = ball(Fraction(str(net.text["r"]))) + ball(reach)
        ensure(all(lengths[pair] >= out for pair in set(gaps) - set(listed)), "a pair may come into range unseen")
        yield f"all but the {len(listed)} pairs listed stay out of range"
        apart = min((lengths[pair] - ball(reach)).lower() for pair in gaps)
        ensure(apart > 0, "agents may collide")
        ensure(round_down_float(data["distance"], apart), "the distance is not that of the closest pair")
        yield "no two agents come nearer than the distance stated"
        for bond, pairs in zip(data["bonds"], bonds, strict=True):
            rest_length = hull(*(lengths[pair] for pair in pairs))
            fault = "a bond has other than one bound for each shell"
            ensure(len(bond["along"]) == len(bond["across"]) == shells, fault)
            for k, floor in enumerate(zip(bond["along"], bond["across"], strict=True)):
                holds = net.floor_holds(rest_length, reach * (k + 1) / shells, *map(Fraction, floor))
                ensure(holds, f"pairs {pairs}, shell {k}: no bound")
        yield f"the curvatures along and across of {len(bonds)} kinds of pairs are bounds in each of {shells} shells"
        curvatures = [Fraction(k) for k in data["curvatures"]]
        for k, stated in enumerate(curvatures):
            floors = {
                pair: (Fraction(bond["along"][k]), Fraction(bond["across"][k]))
                for bond, pairs in zip(data["bonds"], bonds, strict=True)
                for pair in pairs
            }
            matrix = net.radial(x, gaps, floors)
            ensure(positive(matrix.tolist(), ball(stated)), f"shell {k}: the curvature is not proved")
            ensure(stated % unit(stated, STATED) == 0, f"shell {k}: the curvature has too many digits")
            has_more = positive(matrix.tolist(), ball(stated + unit(stated, STATED)))
            ensure(not has_more, f"shell {k}: more than the curvature stated is true")
        yield "the curvature of U along displacements is at least what is stated, shell by shell"
        yield from _check_bounds(data, net, x, lengths, curvatures)


def _check_bounds(
    data: Mapping[str, Any], net: Net, x: Sequence[Sequence[arb]], lengths: Mapping[Pair, arb], k: Sequence[Fraction]
) -> Iterator[str]:
    """Check the stated energy level, curvature, surplus, damping and rate against the shells and the net."""
    radius = Fraction(data["radius"])
    step = radius / len(k)
    slopes = [step * total for total in accumulate(k)]  # G' at the shells' ends
    level = step * (sum(slopes, Fraction(0)) - slopes[-1] / 2)
    lowest_ratio = min(s / (step * i) for i, s in enumerate(slopes, start=1))
    sums = accumulate(y * (2 * j + 1) for j, y in enumerate(k))
    moments = [total / (2 * i**2) for i, total in enumerate(sums, start=1)]
    ensure(round_down_float(data["level"], level), "the level is not that of the shells")
    ensure(round_down_float(data["curvature"], lowest_ratio), "the least curvature")
    ensure(round_down_float(data["surplus"], min(moments)), "the surplus is not that of the shells")
    curvature, surplus = Fraction(data["curvature"]), Fraction(data["surplus"])
    ensure(curvature > 0 and level > 0, "the potential does not rise")
    yield "U at the boundary of the ball exceeds its minimum by the level; all equilibria in the ball are on the orbit"
    length_change = ball(radius * ROOT_TWO)
    second, degree = Fraction(data["second_eigenvalue"]), Fraction(data["degree"])
    weak_weights = {pair: net.weight(distance + length_change).lower() for pair, distance in lengths.items()}
    laplacian = net.laplacian(weak_weights)
    proved = second >= 0 and (second == 0 or positive(laplacian.tolist(), ball(second)))
    ensure(proved, "the net's second eigenvalue is not proved")
    next_value = second + unit(second, STATED) if second else Fraction(1, 10**6)
    ensure(not positive(laplacian.tolist(), ball(next_value)), "the net's second eigenvalue is larger than stated")
    weight_bounds = {pair: net.weight((distance - length_change).max(arb(0))) for pair, distance in lengths.items()}
    degrees = [sum((w for pair, w in weight_bounds.items() if i in pair), arb(0)).upper() for i in range(net.n)]
    ensure(round_down_float(str(-degree), -max(degrees)), "the largest degree is not that of the net")
    lowest_ratio, maximum = net.c2_gamma + net.c2_alpha * second, net.c2_gamma + 2 * net.c2_alpha * degree
    ensure(lowest_ratio > 0, "nothing damps")
    yield "relative velocities are damped, the net's part from its second eigenvalue at its longest lengths"
    eps, theta, kappa, tau = (Fraction(data["lyapunov"][name]) for name in ("eps", "theta", "kappa", "tau"))
    ensure(0 < eps <= 2 * kappa and 0 <= theta <= 1 and tau > 0 and eps**2 < curvature, "no Lyapunov function")
    mean = theta * surplus + (1 - theta) * curvature
    rate = min(
        eps * theta,
        eps * (theta * curvature + 2 * mean - kappa * maximum) / (curvature + eps * tau),
        2 * ((1 - eps / (2 * kappa)) * lowest_ratio - eps) / (1 + eps / tau),
    )
    ensure(rate > 0 and round_down_float(data["rate"], rate / 2, OF_RATE), "the rate is not that of F")
    share = ball(eps) / ball(curvature).sqrt()
    ensure(round_down_float(str(-Fraction(data["overshoot"])), -(1 + share) / (1 - share), OF_RATE), "the overshoot")
    yield "F = E + ε⟨w, v⟩ falls at twice the rate, and is E but for the overshoot"
    ensure(net.unique_projection(x, ball(radius)), "the nearest point of the orbit may not be unique")
    yield "the nearest point of the orbit is unique, and not degenerate"


def round_down_float(stated: str, value: Any, digits: int = STATED) -> bool:
    """Return whether a stated decimal is the given value rounded down."""
    number = Fraction(stated)
    next_value = number + unit(number, digits)
    if number % unit(number, digits):
        return False
    if isinstance(value, Fraction):
        return number <= value < next_value
    return bool(ball(number) <= value) and bool(value < ball(next_value))


class Net:
    """Law and equilibrium positions stated in a basin certificate."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        self.text = data["law"]
        self.par = AlphaParameters(**{name: self.text[name] for name in ("d", "r", "eps", "h", "a", "b")})
        gains = (Fraction(self.text[name]) for name in ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma"))
        self.c1_alpha, self.c2_alpha, self.c1_gamma, self.c2_gamma = gains
        self.centre = [[arb(float.fromhex(y)) for y in row] for row in data["positions"]]
        self.n, self.m = len(self.centre), len(self.centre[0])
        self.box = ball(Fraction(data["box"]))
        ensure(self.text["algorithm"] in ("Algorithm1", "Algorithm2"), "its law is neither Algorithm 1 nor 2")
        has_target = self.text["algorithm"] == "Algorithm2"
        ensure(has_target or self.c1_gamma == self.c2_gamma == 0, "Algorithm 1 has no gains of a γ-agent")
        ensure(self.n > 1 and self.m in (1, 2, 3) and all(len(row) == self.m for row in self.centre), "no flock")
        ensure(min(self.c1_alpha, self.c2_alpha, self.c1_gamma, self.c2_gamma) >= 0, "a gain is negative")

    def tension(self, length: arb) -> arb:
        """Return the tension F'(ℓ)/ℓ of a pair of length ℓ with the potential F."""
        s, eps = square(length), ball(self.par.eps)
        return ball(self.c1_alpha) * phi_alpha(sigma_of_square(s, eps), self.par) / (1 + eps * s).sqrt()

    def stiffness(self, length: arb) -> arb:
        """Return the stiffness F''(ℓ) of a pair of length ℓ with the potential F."""
        s = square(length)
        root, z = (1 + ball(self.par.eps) * s).sqrt(), sigma_of_square(s, self.par.eps)
        slope, action = phi_alpha_slope(z, self.par), phi_alpha(z, self.par)
        return ball(self.c1_alpha) * (slope * s / root**2 + action / root**3)

    def weight(self, length: arb) -> arb:
        """Return the weight a_ij of a pair of a given length."""
        return adjacency(sigma_of_square(square(length), self.par.eps), self.par)

    def equilibrium(self) -> list[list[arb]]:
        """Return balls around the equilibrium, by Krawczyk's test of the equations with multipliers μ = 0."""
        # The turns are those of the positions, to which they are orthogonal.
        turns = self.rotation_tangents(self.centre)
        motion_rows = turns + self.translations()
        start = [y for row in self.centre for y in row]
        moving = self.rotation_tangents([[y + arb(0, self.box) for y in row] for row in self.centre])
        products = [[dot(a, b) for b in turns] for a in moving]
        ensure(not turns or bool(arb_mat(products).det() != 0), "the rotations are not independent")
        dimension = len(start) + len(motion_rows)
        shift = self.krawczyk(start, [self.box] * dimension, motion_rows)
        ensure(all(abs(y) < self.box for y in shift), "Krawczyk's test fails: no isolated equilibrium in the box")
        near = [y + change for y, change in zip(start, shift, strict=False)]
        middles, radii = [y.mid() for y in near], [y.rad() for y in near] + [arb(0)] * len(motion_rows)
        shift = self.krawczyk(middles, radii, motion_rows)  # once more, about what was found: the zero stays inside
        return self.rows([y + change for y, change in zip(middles, shift, strict=False)])

    def krawczyk(self, centre: list[arb], radii: list[arb], held: list[list[arb]]) -> list[arb]:
        """Return Krawczyk's image (1 − Y F'(B)) (B − c) − Y F(c); inside B − c it proves a zero."""
        size = len(centre)
        wide = self.slope(self.rows([y + arb(0, r) for y, r in zip(centre, radii, strict=False)]), held)
        factor = proposed_inverse(wide)
        value = self.force(self.rows(centre)) + [dot(motion, centre) for motion in held]
        one = arb_mat([[int(i == j) for j in range(size + len(held))] for i in range(size + len(held))])
        image = (one - factor * wide) * arb_mat([[arb(0, r)] for r in radii]) - factor * arb_mat([[y] for y in value])
        return image.entries()

    def rows(self, flat: Sequence[arb]) -> list[list[arb]]:
        """Return a vector of coordinates as a list of agents."""
        return [list(flat[self.m * i : self.m * (i + 1)]) for i in range(self.n)]

    def translations(self) -> list[list[arb]]:
        """Return the displacement vectors of all agents by one unit along each axis."""
        return [[arb(int(k % self.m == a)) for k in range(self.n * self.m)] for a in range(self.m)]

    def slope(self, x: Sequence[Sequence[arb]], held: Sequence[Sequence[arb]]) -> arb_mat:
        """Return the Hessian ∇²U, bordered by the fixed rigid motions."""
        blocks = {}
        for (i, j), gap, distance in self.pairs(x):
            pull = self.tension(distance)
            blocks[i, j] = block(gap, pull, (self.stiffness(distance) - pull) / square(distance))
        rows = [[*row, *(motion[k] for motion in held)] for k, row in enumerate(self.assembled(blocks))]
        return arb_mat(rows + [[*motion, *[arb(0)] * len(held)] for motion in held])

    def force(self, x: Sequence[Sequence[arb]]) -> list[arb]:
        """Return the gradient ∇U of the structural potential."""
        total = [[ball(self.c1_gamma) * y for y in row] for row in x]
        for (i, j), gap, distance in self.pairs(x):
            for a, y in enumerate(gap):
                total[i][a] -= self.tension(distance) * y
                total[j][a] += self.tension(distance) * y
        return [y for row in total for y in row]

    def pairs(self, x: Sequence[Sequence[arb]]) -> Iterator[tuple[Pair, list[arb], arb]]:
        """Return pairs that are not certainly out of range: indices, relative position, length."""
        for i, j in combinations(range(self.n), 2):
            gap = [b - a for a, b in zip(x[i], x[j], strict=True)]
            distance = norm(gap)
            if not distance >= ball(self.par.r):
                yield (i, j), gap, distance

    def assembled(self, blocks: Mapping[Pair, list[list[arb]]]) -> list[list[arb]]:
        """Return the matrix of the form c1γ‖w‖² + Σ ⟨w_j − w_i, B (w_j − w_i)⟩ over pairs with their blocks B."""
        m, size = self.m, self.n * self.m
        total = [[ball(self.c1_gamma) * int(i == j) for j in range(size)] for i in range(size)]
        for (i, j), block in blocks.items():
            for p, q, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
                for a, b in product(range(m), repeat=2):
                    total[m * p + a][m * q + b] += sign * block[a][b]
        return total

    def radial(
        self, x: list[list[arb]], gaps: Mapping[Pair, list[arb]], floors: Mapping[Pair, tuple[Fraction, Fraction]]
    ) -> arb_mat:
        """Return a matrix below the Hessian from pair bounds, with large eigenvalues on rigid motions."""
        blocks = {}
        for pair, (axial_floor, transverse_floor) in floors.items():
            gap = gaps[pair]
            blocks[pair] = block(gap, ball(transverse_floor), ball(axial_floor - transverse_floor) / norm2(gap))
        total = arb_mat(self.assembled(blocks))
        for motion in self.rotation_tangents(x) + self.translations():
            column = arb_mat([[y] for y in motion])
            total += column * column.transpose() * (10**9 * ball(self.c1_alpha) / norm2(motion))
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
        """Return whether lower bounds of a pair's curvatures hold for all displacements of length at most eta."""
        # With x the change of length and b = 1 − cos of the turn, left − right is a square in b, of which a bound below
        # is linear on [0, most]: see `shells`. Intervals of x are halved until the bound is certain.
        cells = [(-eta, eta, 0)]
        while cells:
            low, high, depth = cells.pop()
            x = ball(low).union(ball(high))
            distance = rest + x
            stiff, pull, alpha, beta = self.stiffness(distance), self.tension(distance), ball(along), ball(across)
            nearest = Fraction(0) if low <= 0 <= high else min(abs(low), abs(high))
            farthest, spare = max(abs(low), abs(high)), (stiff - alpha).lower()
            zeroth_term = spare * ball(nearest if spare >= 0 else farthest) ** 2
            first_term = 2 * x * (stiff * rest + alpha * distance) + 2 * (pull * square(rest) - beta * square(distance))
            second_term = (stiff - pull) * square(rest) - (alpha - beta) * square(distance)
            maximum = (ball(eta**2 - nearest**2) / (2 * distance * rest)).upper()
            worst = first_term.lower() + second_term.lower().min(arb(0)) * maximum
            if zeroth_term + worst.min(arb(0)) * maximum >= 0:
                continue
            if depth == _DEEPEST:
                return False
            midpoint = (low + high) / 2
            cells += [(low, midpoint, depth + 1), (midpoint, high, depth + 1)]
        return True

    def unique_projection(self, x: Sequence[Sequence[arb]], radius: arb) -> bool:
        """Return whether states within the radius have a unique nearest point on the equilibrium's orbit."""
        columns = list(zip(*x, strict=True))
        gram = [[dot(a, b) for b in columns] for a in columns]
        trace = sum((gram[a][a] for a in range(self.m)), arb(0))
        if self.m < 3:
            return self.m == 1 or bool(square(radius) < trace)
        largest = norm([y for row in gram for y in row])
        return bool((1 + arb(3).sqrt()) * radius * largest.sqrt() < trace - largest)


def proposed_inverse(matrix: arb_mat) -> arb_mat:
    """Return an approximate inverse of a matrix of balls; no proof depends on its accuracy."""
    return matrix.mid().inv().mid()


def block(gap: Sequence[arb], across: arb, more: arb) -> list[list[arb]]:
    """Return the m × m matrix across·1 + more·gap gapᵀ of a pair with relative position gap."""
    return [[more * y * z + (across if a == b else 0) for b, z in enumerate(gap)] for a, y in enumerate(gap)]
