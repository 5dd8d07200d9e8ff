"""Erratum E6: the condition n >= 3 of the bound on links, and the sharp bound."""

from __future__ import annotations

from flockana.lattice import harborth
from flockana.theorems.slides.e06 import link_counts


def test_the_counts_of_the_erratum(verdict_of):
    table = link_counts()
    assert list(table) == list(range(1, 61))
    assert table[2] == (1, 0, 1)
    assert table[37] == (90, 105, 90)
    assert all(found == sharp == harborth(n) for n, (found, _, sharp) in table.items())
    verdict = verdict_of("E6")
    assert verdict.claim("printed").witness == {"n": [1, 2]}
    assert verdict.claim("corrected").witness == {"n with 3n - 6 links": [3]}
    assert verdict.claim("corrected").margin == 0.5
