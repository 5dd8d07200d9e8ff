from __future__ import annotations

import pytest
from jinja2 import Environment, PackageLoader, StrictUndefined

from flockana.ensemble import clopper_pearson, ensemble
from flockana.errors import ArgumentError, UnknownNameError
from flockana.report.statistics import TEMPLATE, Share, statistics, statistics_section
from flockana.scenarios import scenario


@pytest.fixture(scope="module")
def section():
    return statistics(["notebook-algorithm1"], range(3), jobs=1)


def test_a_row_counts_what_each_run_says_by_itself(section):
    (entry,) = section.entries
    (row,) = entry.rows
    found = []
    for seed in range(3):
        item = scenario("notebook-algorithm1", seed)
        found.append(item.reports[0].check(item.run(), None).status)
    assert (row.theorem, row.claim, row.text) == ("source", "push", "a tenfold push below 0.05 keeps agents apart")
    assert [row.verified.count, row.refuted.count] == [found.count("verified"), found.count("refuted")]
    assert [row.vacuous, row.inconclusive] == [found.count("vacuous"), found.count("inconclusive")]
    low, high = clopper_pearson(row.verified.count, 3)
    assert (row.verified.low, row.verified.high, row.verified.runs) == (low, high, 3)
    assert (entry.runs, entry.incomplete, entry.options) == (3, 0, "")


def test_the_page_holds_every_row(section):
    environment = Environment(loader=PackageLoader("flockana.report", "."), autoescape=True, undefined=StrictUndefined)
    text = environment.get_template(TEMPLATE).render(statistics=section)
    row = section.entries[0].rows[0]
    for words in ("95 % interval", "notebook-algorithm1", row.text, str(row.verified), str(row.refuted), "3 seeds"):
        assert words in text
    assert text.count("<tr>") == text.count("</tr>") == 2


def test_expectations_and_options_of_the_scenario_are_shown():
    found = ensemble("phase", [0, 1], theorems=["energy", "os-3"], metrics=[], parameters={"n": 4}, jobs=1)
    (entry,) = statistics_section([found], level=0.9).entries
    assert entry.options == "n = 4"
    assert entry.title.startswith("4 agents")
    assert {row.theorem for row in entry.rows} == {"energy", "os-3"}


def test_shares_as_text():
    assert str(Share(57, 200, 0.22356, 0.35295)) == "28.5 % [22.4, 35.3]"
    assert str(Share(0, 0, 0.0, 1.0)) == "—"


def test_bad_input_is_refused():
    with pytest.raises(UnknownNameError, match="unknown scenario 'zone'"):
        statistics(["zone"], range(2))
    wide = ensemble("phase", [0], theorems=[], metrics=[], parameters={"n": [3, 4]}, jobs=1)
    with pytest.raises(ArgumentError, match="an ensemble of phase over n, seed: expected one of a scenario"):
        statistics_section([wide])
