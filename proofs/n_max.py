"""Erratum E4: how large a flock below c* can be; of every configuration in the plane, and of α-lattices.

Call a pair bound if its ψ_α is below ψ_α(r_α), which all pairs out of range have. Bound pairs have lengths within a
small factor of each other, so that few agents can be pairwise bound; the many pairs that are not add ψ_α(r_α) each.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import count

import z3
from flint import arb, ctx

from flockana.certified.balls import AlphaParameters, ball
from flockana.certified.decimal_rounding import at_least, at_most, decimal, interval
from flockana.certified.scalar_functions_in_balls import c_star, far_potential, psi_alpha, sigma_norm
from flockana.lattice import harborth
from proofs.enclosures import parameter_sets
from proofs.point_ratios import DIMENSIONS, cited, largest_clique, least_ratio, radon_points
from proofs.proof import Proof, Step
from proofs.signs_of_phi import potential_signs
from proofs.smt import implication

DIGITS = 30
PARTS = 1000  # of a unit of length, to which the shortest bound pair is enclosed
STATED = AlphaParameters()  # the parameters of the statement
SIZES = {"states": "23", "lattices": "14", "states, m = 1": "18", "lattices, m = 1": "13", "states, m = 3": "26"}
SPACE = {1: "on a line", 2: "in the plane", 3: "in space"}


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


def floor_of(n: int, clique: int, par: AlphaParameters) -> arb:
    """ψ_α(r_α)(n²/(2r) - n/2) <= V."""
    return far_potential(par) * ball(Fraction(n * n, 2 * clique) - Fraction(n, 2))


def most_links(n: int, m: int) -> int:
    """Of an α-lattice: on a line each agent but the last has one neighbour ahead; in the plane Harborth's count."""
    return n - 1 if m == 1 else harborth(n)


def lattice_energy(n: int, par: AlphaParameters, m: int = 2) -> arb:
    """V of an α-lattice with the most links possible."""
    return far_potential(par) * (n * (n - 1) // 2 - most_links(n, m))


def sizes(kind: str, n: int, par: AlphaParameters, m: int) -> dict[str, str]:
    """The number as the statement has it, of its own parameters."""
    return {} if par != STATED else {kind if m == 2 else f"{kind}, m = {m}": str(n)}


def bound_lengths(par: AlphaParameters) -> tuple[Step, arb]:
    """Between which lengths pairs are bound, and the ratio of the two."""
    shortest = shortest_bound(par)
    beyond = psi_alpha(sigma_norm(ball(shortest + Fraction(1, PARTS)), par.eps), par)
    ratio = ball(par.r) / ball(shortest)
    return Step(
        f"{par}: bound pairs are longer than {decimal(shortest)}, as ψ_α falls up to d, and shorter than r",
        bool(psi_alpha(sigma_norm(ball(shortest), par.eps), par) > far_potential(par) > beyond),
        rf"\psi_\alpha(\|{decimal(shortest)}\|_\sigma) > \psi_\alpha(r_\alpha) \in {interval(far_potential(par), 10)}",
        f"a ratio below {at_most(ratio)}",
    ), ratio


def every_state(par: AlphaParameters, m: int, ratio: arb) -> Step:
    """From which n on no state is below c*."""
    clique = largest_clique(ratio, m)
    if clique is None:
        return Step(f"{SPACE[m]} no seven agents are pairwise bound", None, evidence=f"a ratio up to {ratio.str(6)}")
    n = next(n for n in count(clique) if not floor_of(n, clique, par) <= c_star(par))
    least = least_ratio(clique + 1, m)
    return Step(
        f"so that {SPACE[m]} at most {clique} agents are pairwise bound, and V > c* for n >= {n}{cited(clique, m)}",
        bool(least is not None and ratio < least and floor_of(n, clique, par) > c_star(par)),
        rf"V \ge \psi_\alpha(r_\alpha)\Bigl(\tfrac{{n^2}}{{{2 * clique}}} - \tfrac n2\Bigr) \ge "
        rf"{at_least(floor_of(n, clique, par))} > {at_most(c_star(par))} \ge c^*",
        f"at n = {n - 1} it is in {interval(floor_of(n - 1, clique, par))}",
        sizes("states", n, par, m),
    )


def every_lattice(par: AlphaParameters, m: int) -> Step:
    """Up to which n an α-lattice is below c*."""
    n = next(n for n in count(1) if not lattice_energy(n + 1, par, m) < c_star(par))
    below, above = lattice_energy(n, par, m), lattice_energy(n + 1, par, m)
    fits, links = (par.r < 2 * par.d, "r < 2d") if m == 1 else (par.r**2 <= 3 * par.d**2, "r² <= 3d²")
    why = "one link ahead of each agent but the last" if m == 1 else "Harborth's theorem, cited"
    return Step(
        f"{par}: {SPACE[m]} an α-lattice of {n} agents has V < c*, none of {n + 1} has ({why}), nor of more: "
        "without one of its agents it still is one, and V is no larger",
        bool(below < c_star(par) < above and fits),
        rf"V \le {at_most(below)} < c^* \in {interval(c_star(par))} < {at_least(above)}",
        f"{most_links(n, m)} and {most_links(n + 1, m)} links; {links}, so that lattices with so many exist",
        sizes("lattices", n, par, m),
    )


def _steps() -> Iterator[Step]:
    yield from potential_signs()
    for m in DIMENSIONS:
        yield from radon_points(m)
    yield from _turan()
    with ctx.workdps(DIGITS):
        for par in parameter_sets():
            if isinstance(par, AlphaParameters):
                step, ratio = bound_lengths(par)
                yield step
                yield from (every_state(par, m, ratio) for m in DIMENSIONS)
                yield from (every_lattice(par, m) for m in (1, 2))


PROOF = Proof(
    id="n-max",
    title="Erratum E4: beyond some n no state is below c*",
    statement=(
        f"In the plane, with {STATED}, no state of {SIZES['states']} agents or more has V <= c*, and "
        f"α-lattices of up to {SIZES['lattices']} agents only have V < c*. On a line these are "
        f"{SIZES['states, m = 1']} and {SIZES['lattices, m = 1']}; in space no state of {SIZES['states, m = 3']} or "
        "more has. The sizes of every scenario's parameters are in the "
        "certificate. With r the most agents that can be pairwise bound, V >= ψ_α(r_α)(n²/(2r) - n/2)."
    ),
    hypotheses=(
        "m = 1, 2, 3; cited, not proved: Harborth's theorem on the links of a lattice of the plane; for the two sets "
        "of the notebook, whose bound pairs differ by more than √2, the least ratio of six and of seven points of the "
        "plane (Bateman and Erdős), and Jung's theorem in space"
    ),
    rigour="interval",
    steps=_steps,
    size=50,
    values=SIZES,
    theorems=("E4",),
)
