"""Structural energy of Algorithms 1 and 2 in the moving frame, in balls."""

from collections.abc import Sequence
from itertools import combinations
from typing import Any

from flint import arb, ctx

from flockana.certified.balls import exact, norm2, square
from flockana.certified.series import PairNumbers
from flockana.laws.olfati_saber import Algorithm2

BITS = 100


def structural_energy(law: Any, q: Sequence[Sequence[arb]], p: Sequence[Sequence[arb]]) -> arb:
    """Return the energy of Algorithm 1 or 2 in the moving frame, on a box of states."""
    with ctx.workprec(BITS):
        s2 = (norm2([b - a for a, b in zip(x, y, strict=True)]) for x, y in combinations(q, 2))
        pairs = sum(map(PairNumbers.of_alpha(law.alpha).potential, s2), arb(0))
        total = arb(exact(law.gains.c1_alpha)) * pairs + _inertia(p)
        return total + arb(exact(law.gains.c1_gamma)) * _inertia(q) if isinstance(law, Algorithm2) else total


def _inertia(x: Sequence[Sequence[arb]]) -> arb:
    """Return ½ Σ‖x_i − x_c‖²."""
    columns = list(zip(*x, strict=True))
    means = [sum(column, arb(0)) / len(x) for column in columns]
    return sum((square(a - mean) for column, mean in zip(columns, means, strict=True) for a in column), arb(0)) / 2
