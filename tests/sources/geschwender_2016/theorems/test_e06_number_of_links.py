"""Erratum E6: the condition n >= 3 of the bound on links, and the sharp bound."""

from flockana.lattice import harborth
from flockana.sources.geschwender_2016.theorems import e06_number_of_links as e06
from flockana.sources.geschwender_2016.theorems.e06_number_of_links import link_counts
from flockana.theorems.theorem import Tolerances


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


def test_one_link_too_many_would_refute_the_bound(monkeypatch):
    table = link_counts() | {7: (16, 15, 16)}
    monkeypatch.setattr(e06, "link_counts", lambda: table)
    printed, corrected, sharp = e06.theorem.check(Tolerances())[1]
    assert (corrected.status, corrected.margin, corrected.contradicts) == ("inconclusive", -0.5, "theorem5-counts")
    assert printed.witness == {"n": [1, 2, 7]}
    assert sharp.status == "verified"
