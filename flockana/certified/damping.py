"""Bounds of the damping c2γ + c2α L̂(x) of relative velocities near an equilibrium.

Weights fall with the length, and the eigenvalues of a Laplacian rise with its weights: the second eigenvalue is at
least that of the net with every pair at its longest, and none is above twice the largest degree with every pair at
its shortest.
"""

from collections.abc import Mapping

from flint import arb, arb_mat, fmpq

from flockana.certified.balls import ball, square
from flockana.certified.decimals import round_down, round_up
from flockana.certified.krawczyk import least_eigenvalue
from flockana.certified.structure import Structure

_DIGITS = 4


def damping(u: Structure, lengths: Mapping[tuple[int, int], arb], reach: fmpq) -> tuple[fmpq, fmpq]:
    """Return (second eigenvalue, largest degree) of the weighted net, rounded down and up."""
    # So c2γ + c2α second <= D <= c2γ + 2 c2α degree on Σ v_i = 0.
    away = ball(reach)
    weakest = {pair: u.weight(square(length + away)).lower() for pair, length in lengths.items()}
    strongest = {pair: u.weight(square((length - away).max(arb(0)))) for pair, length in lengths.items()}
    degrees = [sum((w for pair, w in strongest.items() if i in pair), arb(0)) for i in range(u.n)]
    second = _second_eigenvalue(u.n, weakest)
    floor = fmpq(0) if second is None else round_down(second, _DIGITS)
    return floor, round_up(max(degree.upper() for degree in degrees), _DIGITS)


def _second_eigenvalue(n: int, weights: Mapping[tuple[int, int], arb]) -> arb | None:
    """Return a positive lower bound of the Laplacian's second eigenvalue; None if none is certain."""
    rows = [[arb(1)] * n for _ in range(n)]  # 11ᵀ, whose eigenvalue n is above the second one, as all weights are <= 1
    for (i, j), weight in weights.items():
        for p, q, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
            rows[p][q] += sign * weight
    return least_eigenvalue(arb_mat(rows))
