import base64
import json
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, StaticTarget
from flockana.base.errors import FileError
from flockana.player.run_codec import decode
from flockana.report.coverage import coverage
from flockana.report.coverage.report_anchors import scenario_id, verdict_id
from flockana.report.page_data import ScenarioPage, fixed_page, scenario_page
from flockana.report.report_writer import report_folder, verdicts_json, write_report
from flockana.report.value_texts import deciding_claim, parameters, show, tolerance_rows
from flockana.scenarios import Report, Scenario, scenario, scenarios
from flockana.theorems import Claim, Hypothesis, Tolerances, Verdict, theorems, verify

NASTY = "<script>alert('no')</script>"
VOID = {"link", "meta", "br", "input"}


def a_scenario(**changes):
    q = np.array([[0.0, 0.0], [8.0, 0.0]])
    saw = Report("saw", f"it moved {NASTY}", lambda run, tolerances: Claim("saw", "verified", detail=NASTY))
    given = {
        "name": "pair",
        "title": "Two agents",
        "source": f"ours {NASTY}",
        "law": Algorithm1(),
        "q0": q,
        "p0": 0.0 * q,
    }
    given |= {"t_span": (0.0, 1.0), "seed": 5, "expected": {"os-1": "refuted", "source": "verified"}, "reports": (saw,)}
    return Scenario(**(given | changes))


@pytest.fixture(scope="module")
def result():
    item = a_scenario()
    run = item.run()
    good = Claim("i", "verified", computed=1.0, stated="< 2", margin=1.0, error=1e-9)
    bad = Claim(
        "ii",
        "inconclusive",
        computed=float("nan"),
        stated=np.arange(3.0),
        margin=float("inf"),
        witness={"pair": (0, 1)},
    )
    verdict = Verdict(
        "os-1", (Hypothesis("h", "unmet", -2.0, "why", 0.125),), (good, bad), Tolerances(quasi=0.3), item.name
    )
    source = Verdict("source", (), (item.reports[0].check(run, Tolerances()),), Tolerances(), item.name)
    return item, run, (verdict, source)


@pytest.fixture(scope="module")
def shown(result):
    return scenario_page(*result)


class Checker(HTMLParser):
    """Balanced tags, every address, and drawings without a name."""

    def __init__(self):
        super().__init__()
        self.stack, self.ids, self.links, self.unnamed, self.scripts = [], [], [], [], []

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.ids += [values["id"]] if "id" in values else []
        self.links += [values["href"]] if "href" in values else []
        self.scripts += [values.get("type")] if tag == "script" else []
        named = values.get("aria-label") and values.get("role") == "img"
        self.unnamed += [self.getpos()] if tag in ("svg", "img") and not named else []
        if tag not in VOID:
            self.stack.append(tag)

    def handle_startendtag(self, tag, attrs):
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.stack.pop()

    def handle_endtag(self, tag):
        assert self.stack.pop() == tag


def read(path):
    checker = Checker()
    checker.feed(path.read_text(encoding="utf-8"))
    assert checker.stack == []
    return checker


def test_the_page_is_whole_self_contained_and_escaped(shown, tmp_path):
    written = write_report([shown, fixed_page(verify("E8"))], tmp_path / "new" / "folder", seed=5, seconds=1.5)
    text, found = written.read_text(encoding="utf-8"), read(written)
    assert written == tmp_path / "new" / "folder" / "index.html"
    assert found.scripts == ["text/plain", None]  # the run, and what plays it
    assert NASTY not in text
    assert "&lt;script&gt;" in text
    assert len(found.ids) == len(set(found.ids))
    inner = {link for link in found.links if not link.startswith(("data:application/json;base64,", "data:,"))}
    assert {link for link in inner if link[1:] not in found.ids} == set()
    assert "http" not in text.replace("http://www.w3.org/2000/svg", "")
    assert "flockana verify pair" not in text  # no scenario of the catalogue
    assert replace(shown, name="hexagon").command == "flockana verify hexagon"
    assert "src=" not in text
    assert "@import" not in text
    assert found.unnamed == []
    assert len(text) < 300_000
    for words in (
        "Two agents",
        "rank(A)/n",
        "c1_alpha = 30",
        '<a class="differs" href="#scenario-pair--os-1">os-1 is inconclusive, expected refuted</a>',
        "± 1e-09",
        "± 0.125",
        "seed 5",
        "quasi",
    ):
        assert words in text
    assert text.count("<td>quasi</td>") == 2  # all tolerances in use
    assert not list(written.parent.glob(".*partial"))


def test_the_coverage_is_in_reports_on_the_whole_catalogue_and_links_what_they_show(tmp_path):
    results = [fixed_page(verify("E8"))]
    whole = write_report(results, tmp_path / "whole").read_text(encoding="utf-8")
    section = whole[whole.index('id="coverage"') : whole.index('id="tolerances"')]
    assert 'erratum <a href="#fixed-E8">E8</a>' in section
    assert "scenario msn-static" in section  # not in this report
    assert section.count("<details>") == len(coverage())
    assert section.count("<tr><td>") == sum(len(source.rows) for source in coverage())
    assert 'href="#coverage"' in whole
    part = write_report(results, tmp_path / "part", of="E8").read_text(encoding="utf-8")
    assert "#coverage" not in part
    assert 'id="coverage"' not in part


WHOLE = '{"complete": true, "of": null}'


@pytest.mark.slow
@pytest.mark.parametrize("verdicts", [WHOLE, WHOLE[:-1], "", "[]", '{"complete": 1}', "[" * 100_000, None])
def test_a_whole_report_stays_even_if_its_verdicts_are_damaged(tmp_path, monkeypatch, verdicts):
    monkeypatch.chdir(tmp_path)
    folder = tmp_path / "report"
    folder.mkdir()
    (folder / "index.html").write_text("whole", encoding="utf-8")
    if verdicts is not None:
        (folder / "verdicts.json").write_text(verdicts, encoding="utf-8")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert write_report([], folder, complete=False) == folder / "unfinished" / "index.html"
    assert write_report([], folder, of="E8") == folder / "E8" / "index.html"
    assert write_report([], folder, of="E8", complete=False) == folder / "E8" / "unfinished" / "index.html"
    assert report_folder("E8") == Path("report/E8")
    assert {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()} == before
    assert write_report([], folder) == folder / "index.html"
    assert (folder / "index.html").read_text(encoding="utf-8") != "whole"


def test_a_scenarios_own_instants_come_first(result, shown):
    item, *others = result
    assert "instants" not in shown.pictures[0].caption
    pictures = scenario_page(replace(item, instants=(0.0, 0.2, 0.5, 1.0)), *others).pictures
    assert len(pictures) == 1 + len(shown.pictures)
    assert "The 4 instants that the source shows" in pictures[0].caption


def test_the_run_in_the_page_is_the_run(result, shown):
    header, arrays = decode(base64.b64decode(shown.play))
    item, run, verdicts = result
    assert (header["n"], header["m"], header["marks"]) == (2, 2, [])
    span = np.ptp(run.q)
    np.testing.assert_allclose(arrays["q"], run.q, atol=span / 8192.0)
    fast = replace(run, p=run.p + 1e60)  # too large for the player's numbers
    assert scenario_page(*result, figures=False).play == scenario_page(item, fast, verdicts).play == ""


def test_instants_of_source_and_witnesses_are_marked_once_each(result):
    seen = Claim("iii", "verified", witness={"time": 0.5})
    late = Claim("iv", "verified", witness={"time": 99.0})  # not in this run
    verdict = Verdict("os-1", (), (seen, late), Tolerances(), "pair")
    marked = scenario_page(replace(result[0], instants=(0.2, 0.5)), result[1], (verdict,))
    header, _ = decode(base64.b64decode(marked.play))
    assert header["marks"] == [
        {"t": 0.2, "label": "as in the source"},
        {"t": 0.5, "label": "as in the source, os-1 iii"},
    ]


def test_no_two_places_of_the_whole_catalogue_have_one_id():
    reserved = "top filter open-all summary scenarios lattices-and-equilibria linearised-stability one-start statistics"
    ids = [*reserved.split(), "fixed", "coverage", "tolerances", *map(scenario_id, scenarios())]
    for name in scenarios():
        ids += [verdict_id(name, found) for found in (*scenario(name).theorems, "source")]
    for found in theorems():
        ids += [verdict_id("fixed", found), f"by-itself-{found}"]
    assert len(set(ids)) == len(ids)


def test_json_holds_every_verdict_and_is_strict(result):
    pages = [scenario_page(*result, figures=False), fixed_page(verify("E8"))]

    def refuse(constant):
        raise AssertionError(constant)

    data = json.loads(verdicts_json(pages, seed=5, seconds=2.0), parse_constant=refuse)
    assert [v["theorem"] for v in data["verdicts"]] == ["os-1", "source", "E8"]
    assert [v["as_expected"] for v in data["verdicts"]] == [False, True, True]
    assert data["surprises"] == ["os-1 is inconclusive, expected refuted"]
    assert (data["seed"], data["complete"]) == (5, True)
    assert data["verdicts"][0]["claims"][1]["computed"] == "nan"
    assert data["verdicts"][0]["tolerances"]["quasi"] == 0.3
    assert data["verdicts"][2]["claims"][0]["computed"] == pytest.approx(2 / 3)


def test_a_verdict_without_claims_and_one_that_nothing_was_expected_of(tmp_path):
    item = a_scenario(expected={}, reports=())
    verdict = Verdict("os-1", (), (), Tolerances(), "pair")
    made = scenario_page(item, item.run(), (verdict,), figures=False)
    assert made.findings[0].as_expected is None
    assert "no claim applies" in write_report([made], tmp_path).read_text(encoding="utf-8")


def test_an_empty_report_and_an_incomplete_one(tmp_path):
    text = write_report([], tmp_path, complete=False).read_text(encoding="utf-8")
    assert "not complete" in text
    assert json.loads((tmp_path / "verdicts.json").read_text())["complete"] is False


def test_a_run_that_ended_early_is_a_surprise(result):
    item, run, verdicts = result
    made = scenario_page(item, replace(run, status="failed", message="it blew up"), verdicts, figures=False)
    assert isinstance(made, ScenarioPage)
    assert made.surprises[0] == "the run of pair failed: it blew up"


def test_an_old_report_survives_a_failed_write(tmp_path, result, monkeypatch):
    write_report([], tmp_path)
    before = (tmp_path / "index.html").read_text()
    monkeypatch.setattr("os.replace", lambda *paths: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    with pytest.raises(FileError, match="No space left on device; choose another folder"):
        write_report([scenario_page(*result, figures=False)], tmp_path)
    assert (tmp_path / "index.html").read_text() == before
    assert not list(tmp_path.glob(".*partial"))


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "—"),
        (-0.0, "0"),
        (1.0 / 3.0, "0.3333"),
        (float("inf"), "inf"),
        ([1, 2.0], "(1, 2)"),
        (np.zeros(7), "7 values"),
        ({"a": {"b": 1}, "t": 0.5}, "a: (b: 1); t: 0.5"),
    ],
)
def test_values_as_text(value, text):
    assert show(value) == text


def test_the_deciding_claim_has_the_verdict_s_status():
    claims = (Claim("a", "verified"), Claim("b", "refuted"), Claim("c", "refuted"))
    assert deciding_claim(Verdict("x", (), claims)).name == "b"
    assert deciding_claim(Verdict("x", (), ())) is None


def test_only_gains_that_act_are_listed():
    assert dict(parameters(Algorithm1()))["gains"] == "Gains(c1_alpha = 30, c2_alpha = 10.95)"
    both = dict(parameters(Algorithm2(target=StaticTarget((1.0, 2.0)))))
    assert "c1_gamma = 1.1" in both["gains"]
    assert "beta" not in both["gains"]
    assert both["target"] == "StaticTarget(q = (1, 2), p = (0, 0))"


def test_every_tolerance_has_its_meaning():
    rows = tolerance_rows(Tolerances())
    assert [name for name, _, _ in rows] == list(Tolerances.__dataclass_fields__)
    assert all(len(meaning) > 10 for _, _, meaning in rows)
