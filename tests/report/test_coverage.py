import re
from pathlib import Path

import pytest

from flockana import scenarios, theorems
from flockana.report.coverage import coverage
from tools.coverage_references import faults

SOURCES = {source.key: source for source in coverage()}
ROOT = Path(__file__).parents[2]


def roman(*numbers):
    return tuple(f"({number})" for number in numbers)


def figures(*numbers):
    return tuple(f"Fig. {number}" for number in numbers)


def parts(name, *numbers):
    return tuple(f"{name}{part}" for part in roman(*numbers))


# what each source numbers, as it does
NUMBERED = {
    "geschwender-2016": (
        *figures(6, 7, "9(a)", "9(b)", 10, 11, 12, 13, 14, 15, 16, 17, "18(a)", "18(b)"),
        *parts("Theorem 1", "i", "ii", "iii"),
        *parts("Theorem 3", "i", "ii", "iii", "iv"),
        *parts("Theorem 5", "i", "ii", "iii"),
        "Theorem 6",
        *parts("Definition 5", "i", "ii", "iii", "iv"),
        "Definition 5, strict",
    ),
    "notebook-r2": ("Section 1", "Section 2", "Section 3", *(f"Section 4.{k}" for k in range(1, 8)), "Fig. 3"),
    "isola-2024": ("Case 1", "Case 2", "Case 3", "Case 4"),
    "jond-2025": (
        *figures(*range(1, 11)),
        "Remark 1",
        "Remark 2",
        "Remark 3",
        "Assumption 1",
        "Algorithm 1",
        "Theorem 1",
    ),
    "li-dead-zone": (
        *figures(1, 2, 3),
        "Definition 1",
        *(f"Theorem 1, {number} claim" for number in ("first", "second", "third")),
    ),
}
EQUATIONS = {"geschwender-2016": {76}, "isola-2024": {23}, "jond-2025": range(1, 40), "li-dead-zone": range(1, 10)}


def equations(place):
    """The equations that a place names: (4), (28) to (31)."""
    found = re.findall(r"\((\d+)\)(?: to \((\d+)\))?", place)
    return {number for first, last in found for number in range(int(first), int(last or first) + 1)}


def named(*kinds):
    """The names that rows give of some kinds; of a claim or a report, what it is of as well."""
    references = {one for source in SOURCES.values() for row in source.rows for one in row.held_by}
    return {one.name for one in references if one.kind in kinds}


def test_every_name_is_that_of_something():
    assert faults(SOURCES.values()) == ()


@pytest.mark.parametrize("key", NUMBERED)
def test_what_a_source_numbers_has_a_row(key):
    places = [row.place for row in SOURCES[key].rows]
    rowless = [x for x in NUMBERED[key] if not any(re.match(re.escape(x) + r"(?![\w.(])", place) for place in places)]
    assert rowless == []


@pytest.mark.parametrize("key", EQUATIONS)
def test_every_numbered_equation_has_a_row(key):
    stated = set().union(*(equations(row.place) for row in SOURCES[key].rows))
    assert stated == set(EQUATIONS[key])


def test_every_theorem_and_erratum_is_named_by_a_row():
    assert set(theorems()) - named("theorem", "erratum") == set()


def test_every_scenario_is_named_by_a_row():
    assert set(scenarios()) - named("scenario") - {name.partition("/")[0] for name in named("report")} == set()


@pytest.mark.parametrize(("folder", "kind"), [("proofs", "proof"), ("notebooks", "notebook")])
def test_every_proof_and_lecture_is_named_by_a_row(folder, kind):
    files = {path: path.read_text(encoding="utf-8") for path in (ROOT / folder).glob("[!_]*.py")}
    if kind == "proof":
        there = {path.stem for path, text in files.items() if re.search(r"^PROOF\b", text, re.MULTILINE)}
    else:
        there = {path.stem[:2] for path in files}
    assert there - named(kind) == set()


def test_texts_are_short_and_in_the_same_hand():
    rows = [(source.key, row) for source in SOURCES.values() for row in source.rows]
    long = [(key, row.place) for key, row in rows if len(row.what) > 110 or len(row.remark) > 150]
    stopped = [(key, row.place) for key, row in rows if row.what.endswith(".") or row.remark.endswith(".")]
    assert (long, stopped) == ([], [])
