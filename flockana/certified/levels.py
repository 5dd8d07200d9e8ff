"""Energy levels as balls: below which no two agents can coincide, and no agent can leave.

The counting is that of `flockana.equilibria.barrier`, with every length and level enclosed, and each count rounded to
the side that is safe.
"""

from itertools import combinations
from math import ceil, floor
from typing import Any

from flint import arb, ctx, fmpq

from flockana.certified.balls import ball, exact, square
from flockana.certified.series import PairNumbers
from flockana.certified.structural_energy import BITS
from flockana.equilibria.barrier import coincident_lattice, turan_pairs
from flockana.lattice import harborth

_HALVINGS = 40  # of the bracket of the shortest length of a bound pair


def gain(law: Any) -> arb:
    """Return c1α, the factor of V."""
    return arb(exact(law.gains.c1_alpha))


def coincident_floor(alpha: Any, n: int, m: int) -> arb:
    """Return a lower bound of V of n agents, two of which coincide."""
    with ctx.workprec(BITS):
        pair, clique = PairNumbers.of_alpha(alpha), _largest_clique(alpha, m)
        if clique is None:
            return pair.c_star
        return pair.c_star + ((n - 1) * (n - 2) // 2 - turan_pairs(n - 1, clique)) * pair.far


def coincident_state(alpha: Any, n: int, m: int) -> arb:
    """Return V of a state of n agents two of which coincide."""
    q = coincident_lattice(alpha, n, m)
    with ctx.workprec(BITS):
        s2 = (
            sum((square(arb(float(a)) - arb(float(b))) for a, b in zip(x, y, strict=True)), arb(0))
            for x, y in combinations(q, 2)
        )
        return sum(map(PairNumbers.of_alpha(alpha).potential, s2), arb(0))


def disconnected_state(alpha: Any, n: int, m: int) -> arb | None:
    """Return V of the best lattice of n − 1 agents with one agent far away; None if unknown."""
    with ctx.workprec(BITS):
        square_of_kappa = (exact(alpha.r) / exact(alpha.d)) ** 2
        if n < 2 or square_of_kappa >= (4 if m == 1 else 3):
            return None
        bonds = n - 2 if m == 1 else harborth(n - 1)
        return (n * (n - 1) // 2 - bonds) * PairNumbers.of_alpha(alpha).far


def _shortest_bound(alpha: Any) -> fmpq | None:
    """Return a length below which a pair certainly has ψ_α > ψ_α(r_α); None if there is none."""
    # ψ_α falls up to d_α, so that it holds below any length at which it holds.
    pair, low, high = PairNumbers.of_alpha(alpha), fmpq(0), exact(alpha.d)
    if not pair.c_star > pair.far:
        return None
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        low, high = (middle, high) if pair.potential(square(ball(middle))) > pair.far else (low, middle)
    return low


def _largest_clique(alpha: Any, m: int) -> int | None:
    """Return a bound of the number of points whose pairs all have ψ_α < ψ_α(r_α); None if unbounded."""
    shortest = _shortest_bound(alpha)
    if not shortest:
        return None
    ratio = ball(exact(alpha.r) / shortest)
    packed = floor(float(((1 + 2 * ratio * ball(fmpq(m, 2 * (m + 1))).sqrt()) ** m).upper()) * (1 + 2.0**-40))
    if m == 1:
        return min(packed, ceil(float(ratio.upper()) * (1 + 2.0**-40)))
    known = [points - 1 for points, least in _least_ratios(m).items() if ratio < least]
    return min([packed, *known])


def _least_ratios(m: int) -> dict[int, arb]:
    """Return the least ratio of longest to shortest distance by number of points (`equilibria.barrier`)."""
    if m == 2:
        return {4: arb(2).sqrt(), 5: (1 + arb(5).sqrt()) / 2, 6: 2 * arb(fmpq(2, 5)).sin_pi(), 7: arb(2)}
    return {5: arb(fmpq(12, 7)).sqrt()} if m == 3 else {}
