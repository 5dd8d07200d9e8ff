import re
from functools import partial

import pytest
from markupsafe import escape

from flockana.base.errors import FlockanaError, SolverError
from flockana.cli.verify import verify_command
from flockana.report import comparison, verify_catalogue
from flockana.report.figures import Picture
from flockana.report.report_writer import write_report
from flockana.report.stability import LinearisedFlocks
from flockana.report.verify_catalogue import Task
from flockana.scenarios.one_start import compare, entries
from flockana.theorems import Claim, Verdict, theorem


@pytest.fixture(scope="module")
def section():
    """Two of the laws."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(comparison, "compare", partial(compare, ["Dead zone", "Averaged headings"]))
        return comparison.comparison_section.__wrapped__()


@pytest.mark.slow
def test_a_row_for_each_law_with_its_theorem_and_verdict():
    section = comparison.comparison_section()
    assert [row.name for row in section.rows] == [entry.name for entry in entries()]
    for entry, row in zip(entries(), section.rows, strict=True):
        assert theorem(entry.theorem).kind == "trajectory"
        assert row.status == (entry.expected or row.status)
        assert row.reason or row.status == "verified"
        assert int(row.groups) >= 1


def test_it_is_part_of_the_page(section, tmp_path):
    page = write_report([], tmp_path, comparison=section).read_text(encoding="utf-8")
    assert 'id="one-start"' in page
    assert 'href="#one-start"' in page
    assert all(str(escape(row.promise)) in page for row in section.rows)
    assert len(re.findall(r'class="drawn"', page)) == len(section.pictures) == 2
    assert 'id="one-start"' not in write_report([], tmp_path).read_text(encoding="utf-8")


def test_it_is_made_among_the_tasks_of_the_catalogue_where_there_is_a_report(section, tmp_path, monkeypatch):
    made = []
    monkeypatch.setattr(verify_catalogue, "plan", lambda *given, **options: (Task("E8", fixed=True),))
    monkeypatch.setattr("flockana.report.seed_surveys.surveys", lambda *given, **options: ())
    monkeypatch.setattr("flockana.report.comparison.comparison_section", lambda seed: made.append(seed) or section)
    flocks = LinearisedFlocks((), (), ())
    monkeypatch.setattr("flockana.report.stability.linearised_flocks", lambda: made.append("flocks") or flocks)
    assert verify_command(seed=5, report=tmp_path, jobs=1) == 0
    assert made == [5, "flocks"]
    assert 'id="one-start"' in (tmp_path / "index.html").read_text(encoding="utf-8")
    assert verify_command(no_report=True, jobs=1) == verify_command(name="E8", report=tmp_path / "E8", jobs=1) == 0
    assert made == [5, "flocks"]
    assert verify_command(name="delay-margin", report=tmp_path / "margin", jobs=1) == 0
    assert made == [5, "flocks", "flocks"], "a theorem of the section has the section's pictures"


def test_linearised_flocks_of_the_tasks_are_in_the_page_and_their_failure_loses_nothing(
    section, tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr(verify_catalogue, "plan", lambda *given, **options: (Task("delay-margin", fixed=True),))
    names = [name.partition(":")[2] for name in theorem("delay-margin").expected]
    claims = tuple(Claim(name, "verified") for name in names if name)
    monkeypatch.setattr(verify_catalogue, "verify", lambda name: Verdict(name, (), claims))
    monkeypatch.setattr("flockana.report.seed_surveys.surveys", lambda *given, **options: ())
    monkeypatch.setattr("flockana.report.comparison.comparison_section", lambda seed: section)
    made = [LinearisedFlocks((Picture("Poles of 19", "<svg></svg>"),), (), ())]
    monkeypatch.setattr("flockana.report.stability.linearised_flocks", made.pop)
    assert verify_command(report=tmp_path, jobs=1) == 0
    assert "Poles of 19" in (tmp_path / "index.html").read_text(encoding="utf-8")

    def fail():
        made.append(None)
        raise SolverError("no equilibrium")

    monkeypatch.setattr("flockana.report.stability.linearised_flocks", fail)
    with pytest.raises(FlockanaError, match=r"^linearised flocks: no equilibrium$"):
        verify_command(report=tmp_path, jobs=1)
    assert made == [None]
    assert "delay-margin" in capsys.readouterr().out
    page = (tmp_path / "unfinished" / "index.html").read_text(encoding="utf-8")
    assert 'id="linearised-stability"' in page
    assert "Poles of 19" not in page
    assert "State space to download" not in page
