import json
from dataclasses import replace
from io import StringIO

import pytest
from rich.console import Console

from flockana import clopper_pearson, ensemble, scenario, shares
from flockana.ensemble.one_run import Job, Record, Request, run_batch
from flockana.report.console import statistics_table
from flockana.report.report_writer import page_environment, verdicts_json, write_report
from flockana.report.seed_surveys import make_survey, surveys
from flockana.report.statistics import TEMPLATE, Share, entry_of, gather
from flockana.report.verify_catalogue import check_all


@pytest.fixture(scope="module")
def section():
    asked = surveys("notebook-algorithm1", 3)
    return gather(asked, check_all(asked))


@pytest.mark.slow
def test_a_row_counts_what_each_run_says_by_itself(section):
    (entry,) = section.entries
    row, directions = entry.rows
    assert (directions.claim, directions.refuted.count) == ("unit-direction", 3)  # false of every start
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


@pytest.mark.slow
def test_the_page_holds_every_row(section):
    text = page_environment().get_template(TEMPLATE).render(statistics=section)
    row = section.entries[0].rows[0]
    for words in ("95 % interval", "notebook-algorithm1", row.text, str(row.verified), str(row.refuted), "3 seeds"):
        assert words in text
    assert text.count("<tr>") == text.count("</tr>") == 3


def test_expectations_and_options_of_the_scenario_are_shown():
    jobs = tuple(Job(seed, (("n", 4),)) for seed in (0, 1))
    entry = entry_of("phase", run_batch(Request("phase", ("energy", "os-3"), ()), jobs), 0.9)
    assert (entry.options, entry.runs) == ("n = 4", 2)
    assert (entry.rows[0].verified.low, entry.rows[0].verified.high) == clopper_pearson(2, 2, level=0.9)
    assert entry.title.startswith("4 agents")
    assert (str(Share(57, 200, 0.22356, 0.35295)), str(Share(0, 0, 0.0, 1.0))) == ("28.5 % [22.4, 35.3]", "—")
    assert {row.theorem for row in entry.rows} == {"energy", "os-3"}


def test_the_catalogue_asks_for_itself_and_seeds_are_split_among_processes():
    asked = surveys(None, None, seed=7)
    names = list(dict.fromkeys(one.scenario for one in asked))
    audited = {"zone-51", "zone-51-printed", "zone-52", "minimal-3d-printed", "dead-zone", "dead-zone-hard"}
    assert audited <= set(names)
    assert {scenario(name).seeds for name in audited} == {200}
    assert "hexagon" not in names
    for name in names:
        seeds = [seed for one in asked if one.scenario == name for seed in one.seeds]
        assert seeds == list(range(7, 7 + scenario(name).seeds))
        assert scenario(name).settings.startswith(("printed", "recommended"))
    assert max(len(one.seeds) for one in asked) == 10
    assert {one.seeds for one in surveys(None, 2)} == {(0, 1)}
    assert [one.scenario for one in surveys(None, 2)] == names
    assert surveys(None, 0) == surveys("zone-51", None) == surveys("zone-51", 0) == surveys("os-1", None) == ()


def test_surveys_in_any_order_give_what_one_ensemble_gives():
    asked = surveys("zone-51", 30)
    made = [make_survey(one) for one in reversed(asked)]
    (entry,) = gather(asked, made, figures=False).entries
    assert (entry.runs, entry.incomplete, entry.settings) == (30, 0, "recommended settings")
    table = shares(ensemble("zone-51", range(30), theorems=["source"], metrics=[], jobs=1))
    assert [f"{row.theorem}:{row.claim}" for row in entry.rows] == table.claim.values.tolist()
    for row in entry.rows:
        part = table.sel(claim=f"{row.theorem}:{row.claim}")
        for of, found in (("verified", row.verified), ("refuted", row.refuted)):
            ends = (float(part[name].sel(of=of)) for name in ("share", "low", "high"))
            assert (found.count, found.runs) == (int(part[of]), int(part.runs))
            assert (found.share, found.low, found.high) == tuple(ends)
        assert (row.vacuous, row.inconclusive) == (int(part.vacuous), int(part.inconclusive))


def test_half_a_scenario_is_left_out():
    asked = (*surveys("zone-51", 30), *surveys("zone-gap", 2))
    made = [make_survey(one) for one in asked if one.seeds[0] == 0]
    assert [one.scenario for one in gather(asked, made, figures=False).entries] == ["zone-gap"]
    assert gather(asked, made[:1]) is None


def test_runs_that_fail_are_counted_and_not_hidden():
    (asked,) = surveys("zone-gap", 2)
    done = make_survey(asked)
    failed = replace(done, records=(done.records[0], Record(done.records[1].job, "error", "ValueError: no")))
    (entry,) = gather([asked], [failed], figures=False).entries
    assert (entry.runs, entry.incomplete, entry.rows[0].verified.runs) == (2, 1, 1)


def test_the_section_is_in_the_page_in_the_json_and_on_the_terminal(section, tmp_path):
    page = write_report([], tmp_path, statistics=section).read_text(encoding="utf-8")
    assert 'href="#statistics"' in page
    assert 'id="statistics"' in page
    assert page.count('class="drawn"') == 1
    data = json.loads(verdicts_json([], statistics=section))
    row = section.entries[0].rows[0]
    (found,) = data["statistics"]["scenarios"]
    assert data["statistics"]["level"] == 0.95
    assert (found["scenario"], found["runs"], found["rows"][0]["claim"]) == ("notebook-algorithm1", 3, "push")
    assert found["rows"][0]["verified"]["count"] == row.verified.count
    assert json.loads((tmp_path / "verdicts.json").read_text(encoding="utf-8"))["statistics"] == data["statistics"]
    assert "Many seeds" not in write_report([], tmp_path).read_text(encoding="utf-8")
    console = Console(width=80, file=StringIO())
    console.print(statistics_table(section))
    assert "notebook-algorithm1, 3 seeds" in console.file.getvalue()
    assert str(row.verified) in console.file.getvalue()
