"""The table of errata against the catalogue."""

from __future__ import annotations

import pytest

from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.scenarios import scenario
from flockana.theorems import theorem, theorems
from flockana.theorems.errata import SORTS, Erratum, errata, erratum_of, printed

RUNS = {"E11": "collapse", "E12": "msn-case4", "E13": "three-agents-1d"}  # a scenario that expects it
OTHER = ("tanner-minimum", "zone-separation")  # errata of the classics, and one without a number


def test_each_erratum_of_the_catalogue_stands_in_the_table_once():
    names = [item.id for item in errata()]
    assert len(set(names)) == len(names)
    numbered = {name for name in theorems() if name[0].isupper()}
    assert {name for name in names if not name.startswith("misprint")} == {*numbered, *OTHER}


@pytest.mark.parametrize("item", errata(), ids=lambda item: item.id)
def test_statuses_are_those_expected_of_the_catalogue(item):
    assert all((item.printer, item.where, item.in_paper))
    if item.id.startswith("misprint"):
        assert (item.claim, item.right_claim, item.mark) == (("", ""), ("", ""), "·")
        return
    expected = scenario(RUNS[item.id]).expected if item.id in RUNS else theorem(item.id).expected
    for name, status in (item.claim, item.right_claim):
        assert not name or expected[f"{item.id}:{name}"] == status
    assert item.right_claim[1] in ("verified", "")
    assert item.claim[1] in {"wrong": ("refuted",), "incomplete": ("refuted", ""), "confirmed": ("verified",)}.get(
        item.sort, ("verified", "vacuous")
    )


@pytest.mark.parametrize("item", [item for item in errata() if item.claim[0]], ids=lambda item: item.id)
def test_what_is_printed_is_the_sources_claim_and_what_is_right_is_its_own_or_a_correction(item):
    checked = theorem(item.id)
    assert checked.by(item.claim[0]) == "source"
    assert checked.erratum is item
    if item.sort == "wrong" and item.right_claim[0]:
        # what is right may be a part of what the source says
        assert item.right_claim != item.claim
    assert (checked.title == printed(item.id)) or item.id == "J6"


def test_the_title_of_an_erratum_reads_as_its_status():
    for name, status in (("E1", "refuted"), ("E4", "verified"), ("J17", "verified"), ("L4", "refuted")):
        assert theorem(name).expected[name] == status
        assert theorem(name).title == printed(name)
    assert theorem("E1").title == "H = V + Σ‖p_i‖² falls (as printed)"


def test_sorts_are_those_that_are_explained():
    assert {item.sort for item in errata()} == set(SORTS)
    assert erratum_of("E4").sort == "vacuous"
    assert erratum_of("os-1") is None
    with pytest.raises(ArgumentError, match="erratum E0: sort = 'odd', expected one of wrong, incomplete, vacuous"):
        Erratum("E0", "a", "b", "c", ("", ""), "d", ("", ""), "odd", "no")
    with pytest.raises(UnknownNameError, match="unknown erratum 'E99'"):
        printed("E99")


def test_none_says_that_the_paper_has_it_unless_it_is_the_paper():
    assert {item.in_paper for item in errata() if item.id[0] == "E"} == {"not looked up", "no, the project's own"}
    assert {item.in_paper for item in errata() if item.id[0] in "JL"} == {"it is the paper"}
