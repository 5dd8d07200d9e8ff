"""How a verdict follows from its claims, and how theorems are found and called."""

import json

import numpy as np
import pytest

from flockana.base.errors import ArgumentError
from flockana.scenarios.scenario import differences
from flockana.sources.olfati_saber_2006.theorems.theorem_5_planar_nets import CLAIMS
from flockana.theorems import Claim, Hypothesis, Theorem, Tolerances, Verdict, theorem, theorems, verify
from tests.refused import refused

UNMET = Hypothesis("connected", "unmet")
NOT = "'connected' does not hold"
ASSUMED = Hypothesis("connected", "assumed")
MET = Hypothesis("connected", "met")


@pytest.mark.parametrize(
    ("statuses", "expected"),
    [
        (("verified", "refuted", "inconclusive", "vacuous"), "refuted"),
        (("verified", "inconclusive", "vacuous"), "inconclusive"), (("verified", "vacuous"), "verified"),
        (("vacuous", "vacuous"), "vacuous"), ((), "vacuous"),
    ],
)  # fmt: skip
def test_a_verdict_takes_the_gravest_status_of_its_claims(statuses, expected):
    verdict = Verdict("x", (), tuple(Claim(str(k), s) for k, s in enumerate(statuses)))
    assert verdict.status == expected


@pytest.mark.parametrize(
    ("author", "expected"), [("source", "vacuous"), ("corrected", "verified"), ("flockana", "refuted")]
)
def test_only_the_claims_of_its_author_decide_a_verdict(author, expected):
    claims = (Claim("i", "vacuous"), Claim("ii", "verified", by="corrected"), Claim("iii", "refuted", by="flockana"))
    verdict = Verdict("x", (), claims, author=author)
    assert verdict.status == expected
    assert [claim.by for claim in verdict.main_claims] == [author]
    assert author not in [claim.by for claim in verdict.further_claims]
    assert verdict.to_dict()["author"] == author


@pytest.mark.parametrize(
    ("claims", "expected"),
    [
        (("verified", "verified", "verified"), "3 of 3 verified"),
        (("verified", "vacuous", "inconclusive"), f"1 of 3 inconclusive, 1 verified, 1 vacuous: {NOT}"),
        (("verified", "refuted", "refuted"), "2 of 3 refuted, 1 verified"),
        ((), "no claim"),
    ],
)
def test_the_summary_counts_the_claims(claims, expected):
    assert Verdict("x", (MET, UNMET), tuple(Claim(str(k), s) for k, s in enumerate(claims))).summary == expected


def test_the_summary_names_the_hypothesis_of_a_vacuous_claim_and_tells_extensions_apart():
    claims = (Claim("i", "verified"), Claim("iii", "vacuous", needs=(Hypothesis("H(0) < c*", "unmet"),)))
    assert Verdict("os-1", (UNMET,), claims).summary == "1 of 2 verified, 1 vacuous: H(0) < c* does not hold"
    ours = Claim("cross", "verified", stated="no two links cross", by="flockana")
    claims = (Claim("i", "vacuous", detail="no links"), ours, Claim("ii", "verified", by="corrected"))
    expected = "1 of 1 vacuous: no links; corrected: ii, verified; our extension: no two links cross, verified"
    assert Verdict("x", (), claims).summary == expected


def test_the_account_of_a_vacuous_claim_begins_with_the_need_that_does_not_hold():
    needs = (MET, UNMET)
    assert Claim("i", "vacuous", needs=needs, detail="3 links").explanation == f"{NOT}; 3 links"
    assert Claim("i", "vacuous", needs=needs, detail=f"{NOT}: 2 parts").explanation == f"{NOT}: 2 parts"
    assert Claim("i", "verified", needs=(MET,), detail="3 links").explanation == "3 links"


def test_claims_that_are_vacuous_for_one_reason_are_shown_as_one():
    verdict = a_theorem(lambda run, tolerances: ([UNMET], [])).examine(None, Tolerances())
    lines = str(Verdict("mine", *verdict)).splitlines()
    assert [line.split() for line in lines[-1:]] == [["i,", "ii,", "iii", "vacuous", *NOT.split()]]
    measured = tuple(Claim(name, "vacuous", computed=1, needs=(UNMET,), detail="1 link") for name in ("i", "ii"))
    assert len(str(Verdict("mine", (UNMET,), measured)).splitlines()) == 5


def test_a_theorem_says_whose_each_claim_is():
    def check(tolerances):
        return [UNMET], [Claim("mine", "verified"), Claim("theirs", "verified", by="corrected")]

    item = Theorem("x", "X", "x", "x", "fixed", check, claims=("i", "mine"), ours=("mine",))
    authors = {claim.name: claim.by for claim in item.examine(Tolerances())[1]}
    assert authors == {"i": "source", "mine": "flockana", "theirs": "corrected"}


def test_the_rigour_of_a_verdict_is_the_weakest_among_the_claims_that_decide_it():
    claims = (Claim("a", "refuted", "symbolic"), Claim("b", "refuted", "interval"), Claim("c", "verified", "numeric"))
    assert Verdict("x", (), claims).rigour == "interval"


def test_a_verdict_is_plain_json_whatever_its_witness():
    claim = Claim("i", "verified", computed=np.float64(2.0), margin=float("inf"), witness={"q": np.eye(2), 3: {1, 2}})
    data = json.loads(json.dumps(Verdict("x", (ASSUMED,), (claim,)).to_dict()))
    (said,) = data["claims"]
    assert (said["computed"], said["margin"], said["needs"]) == (2.0, "inf", [])
    assert said["witness"]["q"] == [[1.0, 0.0], [0.0, 1.0]]
    assert (data["tolerances"]["energy"], data["status"]) == (Tolerances().energy, "verified")


def test_every_theorem_has_what_its_users_read():
    for name in theorems():
        item = theorem(name)
        assert item.id == name
        assert len(item.statement) > 40
        assert item.references
        assert (item.kind == "fixed") == bool(item.expected), "fixed theorems carry their own expectation"
        assert (item.kind == "trajectory") == bool(item.claims), name
        source = item.source.lower()
        assert item.author == "source" or "ours" in source or "corrected" in source, name
        assert item.author != "source" or (source and not source.startswith("ours")), name
        known = {*item.claims, *(key.partition(":")[2] for key in item.expected)}
        assert {*item.corrected, *item.ours} <= known | (set(CLAIMS) if name == "os-5" else set()), name


def test_claims_are_found_by_name():
    with pytest.raises(KeyError, match="E8 has no claim 'ii'; it has printed, corrected"):
        verify("E8").claim("ii")


def test_differences_name_what_differs_and_what_is_missing():
    verdict = Verdict("x", (), (Claim("i", "verified"), Claim("ii", "vacuous")))
    assert differences(verdict, {"x": "verified", "x:i": "verified", "y": "refuted"}) == ()
    assert differences(verdict, {"x": "refuted", "x:iii": "verified"}) == (
        "x is verified, expected refuted",
        "x:iii is missing, expected verified",
    )


def a_theorem(check, **options):
    return Theorem("mine", "Mine", "One is one.", "nowhere", "trajectory", check, claims=("i", "ii", "iii"), **options)


def test_claims_that_the_check_leaves_out_are_vacuous_for_the_first_unmet_hypothesis():
    given = [MET, Hypothesis("b", "unmet", detail="b is 3"), Hypothesis("c", "unmet", detail="c is 4")]
    made = Claim("ii", "verified")
    hypotheses, claims = a_theorem(lambda run, tolerances: (given, [made])).examine(None, Tolerances())
    assert hypotheses == tuple(given)
    left_out = (Claim(name, "vacuous", detail="'b' does not hold: b is 3", needs=(given[1],)) for name in ("i", "iii"))
    assert claims == (made, *left_out)
    _, claims = a_theorem(lambda run, tolerances: (given, []), reason="not so: {name}").examine(None, Tolerances())
    assert [claim.detail for claim in claims] == ["not so: b"] * 3


def test_no_claim_is_added_where_no_hypothesis_is_unmet():
    """zone-1-corrected has claims about directed and claims about undirected trees."""
    made = Claim("ii", "verified")
    item = a_theorem(lambda run, tolerances: ([ASSUMED], [made]))
    assert item.examine(None, Tolerances()) == ((ASSUMED,), (made,))


def test_the_law_is_asked_before_the_check_and_comes_first():
    other, own = Hypothesis("it is the law", "unmet", detail="another"), Hypothesis("it is the law", "met")

    def never(run, tolerances):
        raise AssertionError("checked under another law")

    hypotheses, claims = a_theorem(never, law=lambda run: other).examine(None, Tolerances())
    assert hypotheses == (other,)
    assert [claim.detail for claim in claims] == ["'it is the law' does not hold: another"] * 3
    item = a_theorem(lambda run, tolerances: ([UNMET], []), law=lambda run: own)
    hypotheses, claims = item.examine(None, Tolerances())
    assert hypotheses == (own, UNMET)
    assert [claim.status for claim in claims] == ["vacuous"] * 3


def test_a_theorem_of_ones_own_is_checked_without_a_place_in_the_catalogue():
    claim = Claim("one", "verified", computed=1)
    mine = Theorem("mine", "Mine", "One is one.", "nowhere", "fixed", lambda tolerances: ((), (claim,)))
    verdict = verify(mine)
    assert (verdict.theorem, verdict.status, verdict.claims) == ("mine", "verified", (claim,))
    with pytest.raises(ArgumentError, match=r"mine is checked on nothing: got d"):
        verify(mine, d=1.0)


test_tolerances_are_validated = refused(
    ({"settle": 1.0}, r"tolerances.settle = 1: expected a share below 1"),
    ({"giant": 2.0}, r"tolerances.giant = 2: expected a share below 1"),
    make=Tolerances,
)
