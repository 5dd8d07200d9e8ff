"""What the site promises of its pages: nothing public is missing, and no link leads nowhere."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import flockana
from flockana import plots
from flockana.scenarios import scenario
from flockana.theorems.catalogue import catalogue
from tools.site import cache, links, mathematics, reference, theorems

DOCS = Path(__file__).resolve().parent.parent.parent / "docs"


@pytest.fixture
def proved(monkeypatch):
    """One step that holds and one that does not, so that no proof need run."""
    steps = [
        {"text": "x_1 < 2", "holds": True, "latex": "x_1\n< 2", "evidence": ""},
        {"text": "and so on", "holds": False, "latex": "", "evidence": ""},
    ]
    found = {"status": "failed", "objections": ["does not hold: and so on"], "steps": steps}
    monkeypatch.setattr(theorems, "outcome", lambda name: found)


def test_every_theorem_and_erratum_has_a_page_with_what_it_says(proved, tmp_path):
    theorems.write(tmp_path, {}, images=False)
    for item in catalogue().values():
        text = (tmp_path / f"{item.id}.md").read_text(encoding="utf-8")
        assert theorems.plain(item.statement) in text
        assert theorems.plain(item.source) in text
        assert text.count("```bibtex") == len(item.references) > 0
        assert f"({item.id}.md)" in (tmp_path / "index.md").read_text(encoding="utf-8")


def test_a_page_shows_steps_expected_and_measured(proved):
    item = catalogue()["os-3"]
    text = theorems.page(item, {("os-3", "collapse"): "refuted (interval)"}, image="![alt](x.png)")
    assert "1. x\\_1 \\< 2 (holds)\n\n   $$\n   x_1 < 2\n   $$" in text
    assert "2. and so on (**does not hold**)" in text
    row = next(line for line in text.splitlines() if "`collapse`" in line)
    assert row.endswith(f"| {scenario('collapse').expected['os-3']} | refuted (interval) |")
    assert "![alt](x.png)" in text


def test_measured_verdicts_come_from_a_report(tmp_path):
    verdicts = [
        {"theorem": "E1", "status": "refuted", "rigour": "symbolic", "subject": ""},
        {"theorem": "os-1", "status": "vacuous", "rigour": "numeric", "subject": "hexagon"},
    ]
    (tmp_path / "verdicts.json").write_text(json.dumps({"verdicts": verdicts}))
    found = theorems.measured(tmp_path / "verdicts.json")
    assert found == {("E1", ""): "refuted (symbolic)", ("os-1", "hexagon"): "vacuous (numeric)"}


def test_every_public_name_is_in_the_reference():
    printed = {entry for entries in reference.pages().values() for entry in entries}
    for name in flockana.__all__:
        item = getattr(flockana, name)
        module = getattr(item, "__name__", "")
        assert ("flockana", name) in printed or module in reference.pages() or name == "__version__", name
    for name in plots.__all__:
        assert ("flockana.plots", name) in printed


def test_every_plot_is_in_the_gallery():
    code = "".join(
        block
        for path in sorted((DOCS / "gallery").glob("*.md"))
        for block in re.findall(r"```\{code-cell\} python\n(.*?)```", path.read_text(encoding="utf-8"), re.DOTALL)
    )
    assert [name for name in plots.__all__ if f"plots.{name}(" not in code] == []


def test_formulas_are_those_of_the_library(monkeypatch):
    monkeypatch.setattr(mathematics, "DERIVATIONS", mathematics.DERIVATIONS[2:3])
    text = mathematics.page()
    assert r"\|z\|_\sigma = \frac{\sqrt{\epsilon z^{2} + 1} - 1}{\epsilon}" in text
    assert "the residual, computed, is 0" in text


def test_dead_links_are_found_and_good_ones_are_not(tmp_path):
    (tmp_path / "sub").mkdir()
    (tmp_path / "a.html").write_text(
        '<p id="here"><a href="#here">.</a><a href="sub/b.html#there">.</a><a href="https://example.org/x">.</a>'
        '<a href="sub/">.</a><img src="none.png"><a href="sub/b.html#nowhere">.</a><a href="#lost">.</a>'
    )
    (tmp_path / "sub" / "b.html").write_text('<p id="there"><a href="../a.html?x=1#here">.</a>')
    (tmp_path / "sub" / "index.html").write_text("")
    assert list(links.dead(tmp_path)) == [
        "a.html: none.png is no file",
        "a.html: sub/b.html#nowhere names no element",
        "a.html: #lost names no element",
    ]


def test_what_is_kept_is_made_again_when_its_code_changes(tmp_path, monkeypatch):
    monkeypatch.setattr(cache, "CACHE", tmp_path)
    made = iter((1, 2, 3))
    monkeypatch.setattr(cache, "digest", lambda folders: "a" * 16)
    assert [cache.kept("k", "n", ("x",), lambda: next(made)) for _ in range(2)] == [1, 1]
    monkeypatch.setattr(cache, "digest", lambda folders: "b" * 16)
    assert cache.kept("k", "n", ("x",), lambda: next(made)) == 2
    assert len(list((tmp_path / "k").iterdir())) == 1
