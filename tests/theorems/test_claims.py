"""Each constructor of claims: what a margin, a proof and hypotheses come to; and what no claim may say."""

import numpy as np
import pytest

from flockana.base.errors import ArgumentError
from flockana.theorems.claims import counted, erratum, exact, judged, undecided, vacuous
from flockana.theorems.theorem_toolkit import Certificate, Claim, Enclosure, Hypothesis, Tolerances, limit_claim

MET, ASSUMED, UNMET = (Hypothesis(status, status) for status in ("met", "assumed", "unmet"))
HOLDS, OPEN, FAILS = Enclosure.around(1.0, 0.1), Enclosure.around(0.0, 0.1), Enclosure.around(-1.0, 0.1)


@pytest.mark.parametrize(
    ("margin", "need", "status"),
    [
        (HOLDS, MET, "verified"),
        (OPEN, MET, "inconclusive"),
        (FAILS, MET, "refuted"),
        (HOLDS, ASSUMED, "verified"),  # a fact about the run
        (FAILS, ASSUMED, "inconclusive"),
        (HOLDS, UNMET, "vacuous"),
        (FAILS, UNMET, "vacuous"),
        (Enclosure.of(0.0), MET, "verified"),  # >= 0 is what is claimed
        (Enclosure.around(np.nan, 0.0), MET, "inconclusive"),
        (Enclosure.around(1.0, np.inf), MET, "inconclusive"),
    ],
)
def test_a_claim_about_a_run_is_judged_by_the_sign_of_its_margin(margin, need, status):
    assert judged("i", margin, [need]).status == status


def test_over_time_one_instant_that_certainly_fails_refutes_and_one_that_may_leaves_open():
    good, bad = Enclosure.around(np.array([1.0, 2.0, 3.0]), 0.5), Enclosure.around(np.array([1.0, -2.0, 3.0]), 0.5)
    assert judged("i", good).status == "verified"
    refuted = judged("i", bad)
    assert (refuted.status, refuted.margin) == ("refuted", -2.0)
    assert refuted.error == pytest.approx(0.5, rel=1e-15)
    wide = Enclosure.around(np.array([1.0, 2.0, 3.0]), np.array([0.5, 2.5, 0.5]))
    assert judged("i", wide).status == "inconclusive"


@pytest.mark.parametrize(
    ("about", "statuses"), [("all", ("inconclusive", "refuted")), ("limit", ("inconclusive",) * 2)]
)
def test_numbers_of_one_run_verify_nothing_about_all_cases_and_decide_no_limit(about, statuses):
    assert tuple(judged("i", margin, about=about).status for margin in (HOLDS, FAILS)) == statuses


def test_a_proof_decides_where_its_needs_are_met_and_numbers_stand_beside_it():
    proved = judged("i", OPEN, [MET], proof="energy-identities")
    assert (proved.status, proved.rigour, proved.margin) == ("verified", "symbolic", 0.0)
    refuted = judged("i", OPEN, [MET], disproof="collisions")
    assert (refuted.status, refuted.rigour) == ("refuted", "smt")
    for need, status in ((ASSUMED, "inconclusive"), (UNMET, "vacuous")):
        assert judged("i", OPEN, [need], proof="cohesion").status == status
    assert judged("i", HOLDS, about="all", proof="cohesion").status == "verified"


@pytest.mark.parametrize(("margin", "fields"), [(FAILS, {"proof": "cohesion"}), (HOLDS, {"disproof": "cohesion"})])
def test_numbers_against_a_proof_decide_nothing_and_say_so(margin, fields):
    claim = judged("i", margin, [MET], detail="R <= 3", **fields)
    assert (claim.status, claim.contradicts) == ("inconclusive", "cohesion")
    assert claim.detail == ("R <= 3; the numbers contradict the proof 'cohesion': the run or the library is at fault")


@pytest.mark.parametrize(
    ("status", "about", "need", "allowed"),
    [
        ("verified", "run", ASSUMED, True), ("verified", "limit", ASSUMED, False),
        ("verified", "all", ASSUMED, False), ("refuted", "run", ASSUMED, False), ("verified", "run", UNMET, False),
        ("refuted", "all", MET, True), ("vacuous", "limit", UNMET, True), ("inconclusive", "limit", ASSUMED, True),
    ],
)  # fmt: skip
def test_a_claim_refuses_a_status_that_its_hypotheses_do_not_allow(status, about, need, allowed):
    if allowed:
        assert Claim("i", status, about=about, needs=(need,)).status == status
        return
    with pytest.raises(ArgumentError, match=rf"claim 'i' is {status} though '{need.name}' is {need.status}"):
        Claim("i", status, about=about, needs=(need,))


def test_the_error_is_how_far_the_margin_may_be_off_towards_0_and_never_below_0():
    claims = [judged("i", Enclosure(*ends)) for ends in ((-np.inf, -3.0, -1.0), (0.5, 3.0, np.inf), (-1.0, 3.0, 4.0))]
    assert [claim.status for claim in claims] == ["refuted", "verified", "inconclusive"]
    assert [(claim.margin, claim.error) for claim in claims] == [(-3.0, 2.0), (3.0, 2.5), (3.0, 4.0)]
    with pytest.raises(ArgumentError, match=r"claim 'i' has error = -1: expected none below 0"):
        Claim("i", "verified", error=-1.0)


@pytest.mark.parametrize(
    ("certain", "possible", "status"),
    [(0, 3, "verified"), (3, 4, "inconclusive"), (4, 9, "refuted"), (3, 3, "verified")],
)
def test_whole_numbers_are_judged_by_what_certainly_and_what_possibly_happens(certain, possible, status):
    claim = counted("links", 3, certain, possible)
    assert claim.status == status
    assert claim.margin == (3.5 - certain if status == "refuted" else 3.5 - possible)


def test_a_margin_that_a_search_compares_is_finite():
    assert judged("i", Enclosure(-np.inf, np.nan, -2.0)).margin == -2.0
    assert judged("i", Enclosure(-np.inf, np.nan, np.inf)).margin == 0.0


def test_vacuous_and_undecided_claims_name_their_reason():
    assert vacuous("iv", Hypothesis("c1α > 0", "unmet", 0.0, "c1α = 0")).detail == "c1α > 0 does not hold: c1α = 0"
    assert undecided("rate", "at rest from the start", [UNMET]).status == "vacuous"
    assert undecided("rate", "at rest from the start", [ASSUMED]).status == "inconclusive"


def test_a_limit_needs_a_certificate_and_nothing_assumed():
    sure, unsure = Certificate(0.5, "certified to stay"), Certificate(-1.0, "a saddle")
    assert limit_claim("ii", [MET], [unsure, sure]).status == "verified"
    assert limit_claim("ii", [ASSUMED], [sure]).status == "inconclusive"
    assert limit_claim("ii", [MET], [unsure], evidence="consistent: K̃ falls").detail == "a saddle; consistent: K̃ falls"
    assert limit_claim("ii", [MET], [unsure]).status == "inconclusive"
    assert limit_claim("ii", [MET], proof="cucker-smale").status == "verified"
    assert limit_claim("ii", [MET], [unsure], escape=Certificate(0.2, "they part")).status == "refuted"
    assert limit_claim("ii", [ASSUMED], escape=Certificate(0.2, "they part")).status == "inconclusive"
    assert limit_claim("ii", [MET], [Certificate(1e-13, "rounding")]).status == "inconclusive"


def test_an_erratum_has_the_status_of_its_claims():
    @erratum("E0", title="1 + 1 is 2", source="arithmetic")
    def item(tolerances):
        """1 + 1 = 2,
        not 3.
        """
        return [exact("printed", 1 + 1 == 3), exact("corrected", 1 + 1 == 2)]

    assert item.statement == "1 + 1 = 2, not 3."
    assert dict(item.expected) == {"E0": "refuted", "E0:printed": "refuted", "E0:corrected": "verified"}
    assert [claim.status for claim in item.examine(Tolerances())[1]] == ["refuted", "verified"]
