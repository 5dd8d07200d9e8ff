import importlib
import inspect
import json
import pkgutil
import re
from pathlib import Path
from xml.etree import ElementTree

import nbformat
import pytest

import flockana
from flockana import plots, scenario, symbolic
from flockana.course import build
from flockana.report.flock_stills import stills
from flockana.scenarios import scenarios as scenario_names
from flockana.theorems.catalogue import catalogue
from tools.site import lectures, links, mathematics, reference, runs, scenarios, slides, theorems, verdicts
from tools.site.formulas import DERIVATIONS

INNER = {"pair_derivation", "energy_balance"}  # of a formula that a user writes; a part of several
NO_PLOTS = {"save"}  # writes a plot to a file
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
    theorems.write(tmp_path / "theorems", verdicts.Verdicts(), images=False, report=False)
    for item in catalogue().values():
        text = (tmp_path / "theorems" / f"{item.id}.md").read_text(encoding="utf-8")
        assert theorems.plain(item.statement) in text
        assert theorems.plain(item.source) in text
        assert text.count("```bibtex") == len(item.references) > 0
        assert all(f"`{claim}`" in text for claim in item.claims)
        assert all(f"(../scenarios/{name}.md)" in text for name in scenarios.checked_on(item.id))
        assert f"({item.id}.md)" in (tmp_path / "theorems" / "index.md").read_text(encoding="utf-8")


def test_lectures_and_theorems_lead_to_each_other(proved):
    led = 0
    for source in build.sources():
        text = "\n".join(cell.source for cell in lectures.lecture(source).cells if cell.cell_type == "markdown")
        for name in set(re.findall(r"\(\.\./theorems/([\w-]+)\.md(?:#proof)?\)", text)):
            page = theorems.page(catalogue()[name], verdicts.Verdicts(), images=False, report=False)
            assert f"](../lectures/{source.stem}.ipynb)" in page
            assert "\n## Proof\n" in page
            led += 1
    assert led >= 25
    stated = theorems.page(catalogue()["os-3"], verdicts.Verdicts(), images=False, report=False)
    assert "[Lecture 03, 3.2](../lectures/03_algorithm_2.ipynb)" in stated


def test_every_scenario_has_a_page_that_leads_to_its_theorems(tmp_path):
    scenarios.write(tmp_path / "scenarios", tmp_path / "extra", verdicts.Verdicts(), images=False, report=False)
    tried = (tmp_path / "scenarios" / "without-installing.md").read_text(encoding="utf-8")
    assert [line.partition("](")[2] for line in tried.splitlines() if line.startswith("## ")] == [
        f"{name}.md)" for name in scenarios.TWELVE
    ]
    assert tried.count("](../theorems/") == sum(len(scenario(name).theorems) for name in scenarios.TWELVE)
    for name in scenario_names():
        text = (tmp_path / "scenarios" / f"{name}.md").read_text(encoding="utf-8")
        assert all(f"(../theorems/{theorem}.md)" in text for theorem in scenario(name).theorems)


MEASURED = {
    "flockana": "0.1",
    "written": "today",
    "verdicts": [
        {
            "theorem": "os-3",
            "status": "refuted",
            "rigour": "interval",
            "subject": "collapse",
            "hypotheses": [{"name": "c1γ > 0", "status": "met"}],
            "claims": [{"name": "i", "status": "refuted", "stated": "as *said*", "about": "limit"}],
        },
        {
            "theorem": "os-3",
            "status": "vacuous",
            "rigour": "numeric",
            "subject": "hexagon",
            "hypotheses": [{"name": "c1γ > 0", "status": "unmet"}],
            "claims": [{"name": "i", "status": "vacuous"}],
        },
        {"theorem": "E1", "status": "refuted", "rigour": "symbolic", "subject": ""},
    ],
}


@pytest.fixture
def found(tmp_path):
    (tmp_path / "verdicts.json").write_text(json.dumps(MEASURED), encoding="utf-8")
    return verdicts.measured(tmp_path / "verdicts.json")


def test_a_page_shows_hypotheses_claims_steps_pictures_and_verdicts(proved, found):
    text = theorems.page(catalogue()["os-3"], found, images=True, report=True)
    assert "| c1γ > 0 | met: 1, unmet: 1 |" in text
    assert "| `i` | as \\*said\\* | refuted: 1, vacuous: 1 |" in text
    assert "Limits as t → ∞: `i`." in text
    assert "1. x\\_1 \\< 2 (holds)\n\n   $$\n   x_1 < 2\n   $$" in text
    assert "2. and so on (**does not hold**)" in text
    row = next(line for line in text.splitlines() if "scenarios/collapse.md" in line)
    assert row.startswith("| ![collapse, at the end](../scenarios/images/collapse-end.svg){.thumbnail} |")
    shown = '<a href="../../report/index.html#scenario-collapse--os-3">refuted (interval)</a>'
    assert row.endswith(f"| {scenario('collapse').expected['os-3']} | {shown} |")


def test_a_scenario_s_page_plays_the_run_and_shows_what_was_found(found, monkeypatch):
    told = {"stills": [["t = 0", "<svg/>"]], "play": "<p>", "facts": [["agents", "150"]]}
    monkeypatch.setattr(scenarios, "ran", lambda name: told)
    text = scenarios.page(scenario("collapse"), found, images=True, report=False)
    assert 'src="../../runs/collapse.html"' in text
    assert "![collapse at t = 0](images/collapse-0.svg){.still}" in text
    assert "| [os-3](../theorems/os-3.md) |" in text
    assert "| refuted (interval) |" in text
    assert "| agents | 150 |" in text


def test_a_still_of_its_own_file_has_its_colours_and_is_whole():
    run = scenario("head-on").run()
    ((label, svg),) = runs.STILL.findall(stills(run, [run.t[0]]))
    root = ElementTree.fromstring(runs.image(svg))
    assert root.tag == "{http://www.w3.org/2000/svg}svg"
    style = root.find("{http://www.w3.org/2000/svg}style").text
    used = {name for each in root.iter() for name in each.get("class", "").split()}
    assert used
    assert all(f".{name} " in style or f".{name}{{" in style for name in used if name != "even")
    assert "var(" not in style
    assert label == "t = 0"


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
    assert {name for name in plots.__all__ if f"plots.{name}(" not in code} == NO_PLOTS


def test_formulas_are_those_of_the_library(monkeypatch):
    few = {"Energies": (*DERIVATIONS["Energy along the flow"][:3], *DERIVATIONS["Obstacles and Theorem 6"][-2:])}
    monkeypatch.setattr(mathematics, "DERIVATIONS", few)
    text = mathematics.page()
    assert r"\|z\|_\sigma = \frac{\sqrt{\epsilon z^{2} + 1} - 1}{\epsilon}" in text
    assert "| $V$ | collective potential" in text  # notation
    assert text.count("As computed: every residual, computed, is 0.") == 3
    for false in ("e1_identity", "algorithm3_energy.e2_identity"):  # printed energies that are none
        assert "is **not** 0" in text.split(f"### `{false}`")[1].split("###")[0]


def test_every_derivation_of_the_library_is_on_the_mathematics_page():
    told = {name.split("(")[0].split(".")[-1] for group in DERIVATIONS.values() for name, _ in group}
    for info in pkgutil.iter_modules(symbolic.__path__):
        module = importlib.import_module(f"flockana.symbolic.{info.name}")
        for name, item in vars(module).items():
            own = inspect.isfunction(item) and item.__module__ == module.__name__ and not name.startswith("_")
            if own and item.__annotations__.get("return") in ("Derivation", "EnergyIdentity"):
                assert name in told | INNER, name


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


def test_slides_show_what_the_page_of_their_lecture_put_out(tmp_path):
    """Each code cell of the slides is one of the page's, with its output: nothing is executed twice."""
    for source in slides.shown():
        book = lectures.lecture(source)
        for number, cell in enumerate(book.cells):
            if cell.cell_type == "code":
                cell["outputs"] = [nbformat.v4.new_output("stream", text=f"output of cell {number}")]
        nbformat.write(book, tmp_path / f"{source.stem}.ipynb")
        texts = {cell.source: cell.outputs[0].text for cell in book.cells if cell.cell_type == "code"}
        code = [cell for cell in slides.with_outputs(source, tmp_path).cells if cell.cell_type == "code"]
        assert len(code) > 1
        assert [cell.outputs[0].text for cell in code] == [texts[cell.source] for cell in code]
