"""Erratum E4: how large a flock below c* can be; of every configuration in the plane, and of α-lattices.

Call a pair bound if its ψ_α is below ψ_α(r_α), which all pairs out of range have. Bound pairs have lengths within a
small factor of each other, so that few agents can be pairwise bound; the many pairs that are not add ψ_α(r_α) each.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import count, product

import sympy as sp
import z3
from flint import arb, ctx

from flockana.certified.decimals import at_least, at_most, decimal, interval
from flockana.certified.intervals import AlphaParameters, ball, c_star, far_potential, psi_alpha, sigma_norm
from flockana.lattice import harborth
from proofs.enclosures import parameter_sets
from proofs.proof import Proof, Step
from proofs.signs_of_phi import potential_signs
from proofs.smt import implication
from proofs.theorem5_crossings import HALF, short_side

DIGITS = 30
PARTS = 1000  # of a unit of length, to which the shortest bound pair is enclosed
STATED = AlphaParameters()  # the parameters of the statement
SIZES = {"states": "23", "lattices": "14"}


def least_ratio(points: int) -> arb:
    """Longest over shortest distance of so many points of the plane: at least that.

    That of four is proved here; those of six and seven are cited (Bateman and Erdős 1951).
    """
    return {4: arb(2).sqrt(), 6: 2 * (arb(2) / 5).sin_pi(), 7: arb(2)}[points]


def mean_or_crossing(signs: tuple[int, ...]) -> bool:
    """Whether weights of these signs make a point a mean of others, or a point of one segment one of another.

    As Σλ_i = 0 and Σλ_i q_i = 0, the positive ones and the negative ones have the same weighted mean.
    """
    sides = sorted((signs.count(1), signs.count(-1)))
    return sides[0] == 1 or sides == [2, 2]


def four_points() -> Iterator[Step]:
    """Of four points of the plane some two are √2 times as far apart as some two others."""
    x, y = sp.symbols("x_1:5"), sp.symbols("y_1:5")
    places = sp.Matrix([x, y, (1,) * 4])
    signs = [s for s in product((-1, 0, 1), repeat=4) if 1 in s and -1 in s]
    yield Step(
        "four points of the plane have weights λ ≠ 0 with Σλ_i = 0, Σλ_i q_i = 0 (four columns of three rows); by "
        "their signs one point is a mean of others, or two segments cross (Radon)",
        places.shape == (3, 4) and all(map(mean_or_crossing, signs)),
        evidence=f"{len(signs)} patterns of signs with both signs among them, as the sum is 0",
    )
    mu, nu, xi, aa, bb, cc, ab, ac, bc = z3.Reals("mu nu xi aa bb cc ab ac bc")
    mean = (mu * aa + nu * ab + xi * ac == 0, mu * ab + nu * bb + xi * bc == 0, mu * ac + nu * bc + xi * cc == 0)
    least = z3.Real("least²")
    longest = z3.Or(*(side >= 2 * least for side in (aa + bb - 2 * ab, aa + cc - 2 * ac, bb + cc - 2 * bc)))
    yield implication(
        "a point that is a mean of others, at vectors a, b, c from it, sees two of them at 90° or more: their squared "
        "distance is at least the sum of the squares of two others",
        longest,
        *(mu >= 0, nu >= 0, xi >= 0, mu + nu + xi == 1, *mean),
        *(least > 0, aa >= least, bb >= least, cc >= least),
        latex=r"\mu a + \nu b + \xi c = 0 \implies \max(\|a-b\|^2, \|a-c\|^2, \|b-c\|^2) \ge "
        r"2\min(\|a\|^2, \|b\|^2, \|c\|^2)",
    )
    yield short_side("if two segments of lengths at most 1 cross, some two of the four ends are within 1/√2", HALF)


def missing(text: str, *, bound_to_all: int = 0) -> Step:
    """The step of the induction that n²/(2r) - n/2 pairs at least are not bound, no r + 1 agents being pairwise bound.

    Of the n - s agents outside a largest clique, so many would be bound to all of it: none, as it would be larger.
    """
    n, r, s, rest = z3.Reals("n r s rest")
    turan = lambda n: n * n / (2 * r) - n / 2  # noqa: E731
    return implication(
        text,
        (n - s - bound_to_all) + rest >= turan(n),
        *(s >= 1, s <= r, n >= s, rest >= turan(n - s)),
        latex=r"\tfrac{n^2}{2r} - \tfrac n2 \le (n-s) + \tfrac{(n-s)^2}{2r} - \tfrac{n-s}2, \qquad 1 \le s \le r",
    )


def _turan() -> Iterator[Step]:
    n, r = z3.Reals("n r")
    yield missing(
        "no more than r agents pairwise bound (Turán): let s be as many as are. Each of the n - s others is not bound "
        "to one of these, and they are fewer than n: by induction at least n²/(2r) - n/2 pairs are not bound"
    )
    yield implication(
        "that many rise with n",
        (n + 1) ** 2 / (2 * r) - (n + 1) / 2 > n**2 / (2 * r) - n / 2,
        *(r >= 1, n >= r),
    )


def shortest_bound(par: AlphaParameters) -> Fraction:
    """The largest length, in thousandths, at which ψ_α is certainly above ψ_α(r_α), d not reached."""
    above = lambda k: psi_alpha(sigma_norm(ball(Fraction(k, PARTS)), par.eps), par) > far_potential(par)  # noqa: E731
    low, high = 0, int(par.d * PARTS)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if above(middle) else (low, middle)
    return Fraction(low, PARTS)


def largest_clique(ratio: arb) -> int | None:
    """How many agents can be pairwise bound: fewer than the points whose distances differ by more than that."""
    return next((points - 1 for points in (4, 6, 7) if ratio < least_ratio(points)), None)


def floor_of(n: int, clique: int, par: AlphaParameters) -> arb:
    """ψ_α(r_α)(n²/(2r) - n/2) <= V."""
    return far_potential(par) * ball(Fraction(n * n, 2 * clique) - Fraction(n, 2))


def lattice_energy(n: int, par: AlphaParameters) -> arb:
    """V of an α-lattice with the most links possible."""
    return far_potential(par) * (n * (n - 1) // 2 - harborth(n))


def every_state(par: AlphaParameters) -> Iterator[Step]:
    """From which n on no state is below c*."""
    shortest = shortest_bound(par)
    beyond = psi_alpha(sigma_norm(ball(shortest + Fraction(1, PARTS)), par.eps), par)
    ratio = ball(par.r) / ball(shortest)
    clique = largest_clique(ratio)
    yield Step(
        f"{par}: bound pairs are longer than {decimal(shortest)}, as ψ_α falls up to d, and shorter than r",
        bool(psi_alpha(sigma_norm(ball(shortest), par.eps), par) > far_potential(par) > beyond),
        rf"\psi_\alpha(\|{decimal(shortest)}\|_\sigma) > \psi_\alpha(r_\alpha) \in {interval(far_potential(par), 10)}",
        f"a ratio below {at_most(ratio)}",
    )
    if clique is None:
        yield Step("no more than six agents are pairwise bound", None, evidence=f"a ratio up to {ratio.str(6)}")
        return
    n = next(n for n in count(clique) if not floor_of(n, clique, par) <= c_star(par))
    yield Step(
        f"so that at most {clique} agents are pairwise bound, and V > c* for n >= {n}"
        + ("" if clique == 3 else f" (the least ratio of {clique + 1} points is cited)"),
        bool(ratio < least_ratio(clique + 1) and floor_of(n, clique, par) > c_star(par)),
        rf"V \ge \psi_\alpha(r_\alpha)\Bigl(\tfrac{{n^2}}{{{2 * clique}}} - \tfrac n2\Bigr) \ge "
        rf"{at_least(floor_of(n, clique, par))} > {at_most(c_star(par))} \ge c^*",
        f"at n = {n - 1} it is in {interval(floor_of(n - 1, clique, par))}",
        {"states": str(n)} if par == STATED else {},
    )


def every_lattice(par: AlphaParameters) -> Step:
    """Up to which n an α-lattice is below c*."""
    n = next(n for n in count(1) if not lattice_energy(n + 1, par) < c_star(par))
    below, above = lattice_energy(n, par), lattice_energy(n + 1, par)
    return Step(
        f"{par}: an α-lattice of {n} agents has V < c*, none of {n + 1} has (Harborth's theorem, cited), nor of more: "
        "without one of its agents it still is one, and V is no larger",
        bool(below < c_star(par) < above and par.r**2 <= 3 * par.d**2),
        rf"V \le {at_most(below)} < c^* \in {interval(c_star(par))} < {at_least(above)}",
        f"{harborth(n)} and {harborth(n + 1)} links; r² <= 3d², so that the hexagonal ones are α-lattices",
        {"lattices": str(n)} if par == STATED else {},
    )


def _steps() -> Iterator[Step]:
    yield from potential_signs()
    yield from four_points()
    yield from _turan()
    with ctx.workdps(DIGITS):
        for par in parameter_sets():
            if isinstance(par, AlphaParameters):
                yield from every_state(par)
                yield every_lattice(par)


PROOF = Proof(
    id="n-max",
    title="Erratum E4: beyond some n no state is below c*",
    statement=(
        f"In the plane, with {STATED}, no state of {SIZES['states']} agents or more has V <= c*, and "
        f"α-lattices of up to {SIZES['lattices']} agents only have V < c*; the two sizes of every scenario's "
        "parameters are in the "
        "certificate. With r the most agents that can be pairwise bound, V >= ψ_α(r_α)(n²/(2r) - n/2)."
    ),
    hypotheses=(
        "m = 2; cited, not proved: Harborth's theorem on the links of a lattice; for the two sets of the notebook, "
        "whose bound pairs differ by more than √2, the least ratio of six and of seven points (Bateman and Erdős)"
    ),
    rigour="interval",
    steps=_steps,
    size=29,
    values=SIZES,
    theorems=("E4",),
)
