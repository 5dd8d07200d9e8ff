"""Energies of Algorithms 1 and 2 in the moving frame, on boxes of states, as balls."""

from collections.abc import Sequence
from itertools import combinations
from typing import Any

from flint import arb, ctx

from flockana.certified.balls import exact, minus, norm2, square
from flockana.certified.pair_laws_in_series import PairNumbers
from flockana.laws.olfati_saber import Algorithm2

BITS = 100
Vectors = Sequence[Sequence[arb]]


def structural_energy(law: Any, q: Vectors, p: Vectors) -> arb:
    """Return the energy of Algorithm 1 or 2 in the moving frame, on a box of states."""
    with ctx.workprec(BITS):
        total = pair_energy(law, q) + _inertia(p)
        return total + arb(exact(law.gains.c1_gamma)) * _inertia(q) if isinstance(law, Algorithm2) else total


def pair_energy(law: Any, q: Vectors) -> arb:
    """Return the pair energy c1α V on a box of states."""
    squares = (norm2(minus(y, x)) for x, y in combinations(q, 2))
    return gain(law) * sum(map(PairNumbers.of_alpha(law.alpha).potential, squares), arb(0))


def _inertia(x: Vectors) -> arb:
    """Return ½ Σ‖x_i − x_c‖², the moment of inertia about the centre."""
    columns = list(zip(*x, strict=True))
    means = [sum(column, arb(0)) / len(x) for column in columns]
    return sum((square(a - mean) for column, mean in zip(columns, means, strict=True) for a in column), arb(0)) / 2


def gain(law: Any) -> arb:
    """Return the gain c1α, the factor of V, the sum of pair potentials, in the energy."""
    return arb(exact(law.gains.c1_alpha))
