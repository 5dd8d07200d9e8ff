"""Claims by a margin and by algebra, and errata: what decides them, and what they carry."""

from __future__ import annotations

import pytest

from flockana.theorems import Claim, Hypothesis, Tolerances, verify
from flockana.theorems.claims import equal, erratum, exact, judged

UNMET, ASSUMED = Hypothesis("a", "unmet"), Hypothesis("b", "assumed")


def test_a_judged_claim_keeps_what_decides_it():
    claim = judged("i", 0.5, 0.1, computed=3.0, stated="x", witness="w", proof="p", rigour="interval", detail="d")
    assert claim == Claim("i", "verified", "interval", 3.0, "x", 0.5, 0.1, "w", "p", "d")


@pytest.mark.parametrize(
    ("margin", "options", "expected"),
    [
        (0.5, {}, "verified"),
        (-0.5, {}, "refuted"),
        (0.05, {}, "inconclusive"),
        (0.5, {"verifies": False}, "inconclusive"),
        (-0.5, {"verifies": False}, "refuted"),
        (0.5, {"refutes": False}, "verified"),
        (-0.5, {"refutes": False}, "inconclusive"),
        (0.5, {"needs": [UNMET], "verifies": False}, "vacuous"),
        (-0.5, {"needs": [UNMET], "refutes": False}, "vacuous"),
        (-0.5, {"needs": [ASSUMED]}, "inconclusive"),
        (0.5, {"needs": [ASSUMED]}, "verified"),
    ],
)
def test_what_a_margin_may_decide(margin, options, expected):
    assert judged("i", margin, 0.1, **options).status == expected


def test_algebra_decides_without_an_error():
    assert exact("i", True, computed="0").rigour == "symbolic"
    assert [exact("i", holds).status for holds in (True, False)] == ["verified", "refuted"]


@pytest.mark.parametrize(
    ("residual", "status", "witness"),
    [
        (0, "verified", "0"),
        (1, "refuted", "1"),
        ([0, 0], "verified", ["0", "0"]),
        ((0, 2), "refuted", ["0", "2"]),
        ((2, 0), "refuted", ["2", "0"]),
    ],
)
def test_an_identity_is_judged_by_all_of_its_residual(residual, status, witness):
    claim = equal("i", residual, detail="d")
    assert (claim.status, claim.witness, claim.detail) == (status, witness, "d")
    assert claim.computed == ("residual 0" if status == "verified" else "a residual that is not 0")


@pytest.mark.parametrize(
    ("statuses", "whole"),
    [
        (("verified", "refuted"), "refuted"),
        (("verified", "verified"), "verified"),
        (("inconclusive", "verified"), "inconclusive"),
    ],
)
def test_an_erratum_expects_of_the_whole_what_its_claims_make_of_it(statuses, whole):
    item = erratum(
        "X1",
        title="t",
        statement="s",
        source="o",
        check=lambda tolerances: [judged("a", tolerances.energy, 0.0), exact("b-c", False)],
        expected=dict(zip(("a", "b-c"), statuses, strict=True)),
        references=("key",),
    )
    assert dict(item.expected) == {"X1": whole, "X1:a": statuses[0], "X1:b-c": statuses[1]}
    assert (item.kind, item.references) == ("fixed", ("key",))
    verdict = verify(item, tolerances=Tolerances(energy=0.25))
    assert verdict.claim("a").margin == 0.25
    assert [claim.status for claim in verdict.claims] == ["verified", "refuted"]
