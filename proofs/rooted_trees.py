"""All numbered rooted trees of a size, and rational directions for their edges."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import sympy as sp

Tree = tuple[tuple[int, int], ...]

_HEADINGS = ((sp.Rational(3, 5), sp.Rational(4, 5)), (sp.Rational(-5, 13), sp.Rational(12, 13)), (sp.S.Zero, sp.S.One))


def trees(agents: int) -> Iterator[Tree]:
    """Every way to number a rooted tree so that parents come first: edge i is (parent(i), i), i = 1, 2, ..."""
    for parents in product(*(range(i) for i in range(1, agents))):
        yield tuple((parent, i) for i, parent in enumerate(parents, start=1))


def unit_edge(agent: int, d: int) -> sp.Matrix:
    """Direction of an agent's link to its parent, in rational numbers."""
    return sp.Matrix([*_HEADINGS[agent % len(_HEADINGS)], *(0,) * (d - 2)])
