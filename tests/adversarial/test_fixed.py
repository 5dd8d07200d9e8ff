"""Statements that need no run: what the sources print and what is true, claim by claim, asked again and again."""

from dataclasses import replace

import pytest

from flockana import Tolerances, theorem, theorems, verify
from tests.adversarial.cases import FALSE, REFUTED, TRUE, VERIFIED
from tests.adversarial.published import changes

THEOREMS = tuple(name for name in theorems() if theorem(name).kind == "fixed")
SLOW = ("E3", "J11", "delay-margin", "sampling-margins", "linearised-decay", "heterogeneous-gains")
CASES = [pytest.param(name, marks=pytest.mark.attack if name in SLOW else ()) for name in THEOREMS]


def expected(name):
    """Statuses that each claim may have; a search may come back without an answer."""
    marks = {"refuted": REFUTED, "verified": VERIFIED, "inconclusive": TRUE}
    each = ((key.partition(":")[2], status) for key, status in theorem(name).expected.items())
    return {claim: marks[status] for claim, status in each if claim}


@pytest.mark.parametrize("name", CASES)
def test_what_is_printed_and_what_is_true(name, verdict_of):
    said = {claim.name: claim.status for claim in verdict_of(name).claims}
    assert said.keys() == expected(name).keys()
    assert {claim: said[claim] for claim, allowed in expected(name).items() if said[claim] not in allowed} == {}
    assert said == {claim.name: claim.status for claim in verify(name).claims}  # and so the second time
    assert all(claim.detail for claim in verdict_of(name).claims)
    assert changes(verdict_of(name)) == [], "if it is meant: python -m tests.adversarial.published"


@pytest.mark.attack
@pytest.mark.parametrize("factor", [0.5, 2.0])
@pytest.mark.parametrize("name", THEOREMS)
def test_thresholds_do_not_decide_what_is_true(name, factor):
    """Half and twice the tolerances (shares in (0, 1) stay such): nothing turns from true to false."""
    own = Tolerances()
    numbers = "energy velocity force lattice quasi curvature contact deviation mismatch agreement"
    scaled = replace(own, **{field: factor * getattr(own, field) for field in numbers.split()})
    for claim in verify(name, tolerances=scaled).claims:
        assert claim.status in (FALSE if expected(name)[claim.name] == REFUTED else TRUE), claim
