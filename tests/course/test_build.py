import ast
import json
import re
import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest

import flockana as fl
from flockana import lattice
from flockana.base.errors import ArgumentError
from flockana.course import build, grade, is_own, shows
from flockana.course.course_pages import number_of
from tests.course.answers import ANSWERS, connectivity
from tests.refused import refused

SOURCES = build.sources()


def of(book, tag):
    return [cell.source for cell in book.cells if tag in build.tags(cell)]


def check_of(source, name):
    checks = of(build.notebook(source, "solutions"), "check")
    return next(text for text in checks if build.asked(text)[0] == name)


CASES = [
    pytest.param(source, name, id=f"{number_of(source)}-{name}")
    for source in SOURCES
    for name in ANSWERS[number_of(source)]
]


@pytest.mark.slow
@pytest.mark.parametrize(("source", "name"), CASES)
def test_a_check_takes_right_answers_and_refuses_wrong_ones(source, name):
    answers = ANSWERS[number_of(source)][name]
    wrong, right = answers() if callable(answers) else answers
    code = check_of(source, name)
    tree = ast.parse(code)
    expression = compile(ast.Expression(tree.body.pop().value), code, "eval")
    assert not tree.body  # it stands alone: one call, on constants

    def graded(answer):
        known = {"grade": grade, "is_own": is_own, "shows": shows, "np": np, "fl": fl, "lattice": lattice}
        return eval(expression, known | {name: answer})

    refused = {repr(answer): graded(answer) for answer in wrong}
    assert sum("asked for" not in each.hint for each in refused.values()) >= 3  # of the form that is asked for
    assert len(right) >= 2
    assert {answer for answer, each in refused.items() if each.status != "not yet"} == set()
    assert {repr(answer): graded(answer).status for answer in right} == {repr(answer): "right" for answer in right}
    assert graded(...).status == "not answered"


@pytest.mark.slow
@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_versions_of_a_lecture(source):
    books = {version: build.notebook(source, version) for version in build.VERSIONS}
    exercises = list(build.exercises(source))
    checked = [each for each in exercises if each.kind not in build.WRITTEN]
    assert [each.number for each in exercises] == list(range(1, len(exercises) + 1))
    assert len(exercises) >= 5
    assert all(each.points == each.level for each in exercises)
    assert max(each.level for each in exercises) > 1
    assert {each.name for each in checked} == set(ANSWERS[number_of(source)])
    for version, book in books.items():
        assert len(of(book, "check")) == len(checked)
        assert len(of(book, "exercise")) == len(exercises)
        assert len(of(book, "answer")) == (0 if version == "solutions" else len(exercises))
        assert len(of(book, "solution")) == (len(exercises) if version == "solutions" else 0)
    assert all("= ..." in text or "*Your answer:*" in text for text in of(books["student"], "answer"))


def test_every_lecture_asks_for_a_proof_for_parts_and_for_the_player():
    table = {number_of(source): list(build.exercises(source)) for source in SOURCES}
    lectures = [number for number in table if not number.startswith("A")]
    assert lectures == ["00", "00a", *(f"{k:02d}" for k in range(1, len(lectures) - 1))]
    for source in SOURCES[: len(lectures)]:
        number, kinds = number_of(source), [each.kind for each in table[number_of(source)]]
        assert len(kinds) >= 6, number
        assert kinds.count("reading") <= 1, number
        assert {"proof", "player"} <= set(kinds), number
        posed = of(build.notebook(source, "student"), "exercise")
        assert any("(a)" in text and "(b)" in text for text in posed), number
    asked = [each.kind for posed in table.values() for each in posed]
    assert asked.count("project") >= len(lectures) // 3
    assert asked.count("counterexample") >= 5
    assert asked.count("derivation") >= 20
    assert asked.count("design") >= 8
    assert set(asked) == set(build.KINDS)


@pytest.mark.slow
@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_an_answer_takes_no_name_that_the_lecture_uses(source):
    """Run All, with answers still missing, must not break a later cell."""
    names = {each.name for each in build.exercises(source)}
    code = "\n".join(
        c.source for c in build.notebook(source, "student").cells if c.cell_type == "code" and not build.tags(c)
    )
    used = {node.id for node in ast.walk(ast.parse(code)) if isinstance(node, ast.Name)}
    assert not names & used


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_captions_count_the_figures(source):
    """A figure that the text speaks of has a number: that of the lecture, and its place."""
    text = source.read_text(encoding="utf-8")
    number = re.sub(r"^0(?=\d)", "", number_of(source))
    found = re.findall(r"\*\*Figure (\w+)\.(\d+)\.\*\*", text)
    assert found == [(number, str(k + 1)) for k in range(len(found))]
    assert len(found) >= (0 if number.startswith("A") else 2)


def test_a_figure_that_is_named_exists():
    texts = [source.read_text(encoding="utf-8") for source in SOURCES]
    drawn = {found for text in texts for found in re.findall(r"\*\*Figure (\w+\.\d+)\.\*\*", text)}
    notes = build.lecturer_pages()["lecturer/notes.md"].decode()
    named = {found for text in [*texts, notes] for found in re.findall(r"Figure (\w+\.\d+)", text)}
    assert len(drawn) > 60
    assert named == drawn


@pytest.mark.parametrize("source", SOURCES[1:-2], ids=lambda path: path.stem)
def test_a_theorem_that_a_lecture_teaches_is_stated_and_proved_in_it(source):
    text, number = source.read_text(encoding="utf-8"), number_of(source)
    stated = re.findall(r"^# > \*\*(?:Theorem|Lemma|Corrected|Proposition)", text, re.MULTILINE)
    assert len(stated) >= {"00a": 2, "07": 2, "08": 2, "09": 3, "11": 3, "12": 3, "14": 2}.get(number, 1)
    assert "*Proof" in text


def test_the_start_that_breaks_theorem_1_is_as_unconnected_as_lecture_00_says():
    """At t = 0 already; the instant that a verdict names is the worst, later."""
    posed = of(build.notebook(SOURCES[0], "student"), "exercise")[1]
    case = fl.scenario("paper-fragmentation")
    reached = connectivity()(case.q0, case.law.alpha.r)
    assert reached < 1.0
    assert f"$C = (n - \\text{{number of components}})/(n-1)$ is {reached:.2f} there" in " ".join(posed.split())


def test_lecture_09_calls_proved_what_is_proved_and_nothing_else():
    source = next(path for path in SOURCES if number_of(path) == "09")
    text = " ".join(cell.source for cell in build.notebook(source, "student").cells if cell.cell_type == "markdown")
    assert "Then $\\bar H$ is continuous" in text
    assert "Both are proved." in text
    assert "velocities match *within* components is seen in this run and not proved" in " ".join(text.split())
    run = fl.simulate(fl.DeadZoneFlocking(), [[0.0, 0.0], [5.0, 0.0]], np.zeros((2, 2)), (0.0, 0.5))
    claims = fl.verify("dead-zone-1-corrected", run).claims
    proved = {claim.name for claim in claims if claim.proof is not None}
    assert proved == {"rate", "distance"}  # the other two: measured


@pytest.mark.parametrize("source", SOURCES[-2:], ids=lambda path: path.stem)
def test_an_assignment_states_the_points_that_its_questions_give(source):
    """In all, and part by part: a part begins at its heading; what comes before counts with the first."""
    text, points = source.read_text(encoding="utf-8"), [each.points for each in build.exercises(source)]
    assert re.search(r"^# (\d+) points, those of the questions", text, re.MULTILINE)[1] == str(sum(points))
    parts = [int(found) for found in re.findall(r"^# \| .* \| (\d+) \|$", text, re.MULTILINE)]
    posed = of(build.notebook(source, "solutions"), "exercise")
    starts = [k for k, cell in enumerate(posed) if cell.startswith("## ")]
    found = [sum(points[a:b]) for a, b in zip(starts, [*starts[1:], len(points)], strict=True)]
    found[0] += sum(points[: starts[0]])
    assert parts == found


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_what_a_person_reads_has_a_rubric_with_as_many_parts_as_points(source):
    asked, solutions = list(build.exercises(source)), of(build.notebook(source, "solutions"), "solution")
    assert len(asked) == len(solutions)
    for each, solution in zip(asked, solutions, strict=True):
        rubric = solution.partition("**Rubric, a point each:**")[2]
        assert (each.kind in build.WRITTEN) == (each.form == "text") == bool(rubric)
        if rubric:
            assert rubric.rstrip().endswith(".")
            assert rubric.count(";") + 1 == each.points, each


@pytest.mark.parametrize("head", ["**1.** ★ (1 point) How", "**1.** ★ (1 point, riddle) How", "1. How"])
def test_an_exercise_without_points_or_kind_is_refused(tmp_path, head):
    source = tmp_path / "00_x.py"
    posed = f'# %% [markdown] tags=["exercise"]\n# {head}\n\n# %% tags=["check"]\ngrade(x, 1)\n'
    source.write_text(posed, encoding="utf-8")
    with pytest.raises(ArgumentError, match=r"2 points, kind.*derivation, design"):
        list(build.exercises(source))


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_a_lecture_says_what_it_needs_aims_at_and_rests_on(source):
    texts = [cell.source for cell in build.notebook(source, "student").cells if cell.cell_type == "markdown"]
    assert "**Aims.**" in texts[0]
    assert re.search(r"\*\*Lectures before this one:\*\* .*\*\*Time:\*\* \d+ minutes", texts[1])
    assert "| $q_i$, $p_i$, $u_i$ |" in texts[1]
    summed_up = "## How it is marked" if number_of(source).startswith("A") else "## Summary"
    assert sum(summed_up in text for text in texts) == 1
    assert not [text for text in texts if re.search(r"[.;,] - [A-Z]", text)]  # an item of a list that has lost its line
    assert "\n> >" not in "".join(texts)  # a "greater than" that begins a line of a quotation
    quoted = [line for text in texts for line in text.splitlines() if line.startswith("> ")]
    assert all(
        line.count("$$") in (0, 2) for line in quoted
    )  # "> " on a second line would be read as part of the formula
    assert "## References\n\n- " in texts[-1]
    assert "## Further reading\n\n- " in texts[-1]


@pytest.mark.slow
@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_a_students_copy_holds_neither_answers_nor_hints(source):
    text = json.dumps(build.notebook(source, "student"))
    assert "grade(" not in text
    for check in of(build.notebook(source, "solutions"), "check"):
        hint = next(each.value.value for each in ast.parse(check).body[-1].value.keywords if each.arg == "hint")
        assert hint not in text


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_a_number_that_is_not_exact_says_to_what_precision(source):
    """The tolerance is the one that the question states."""
    words = {2: "two significant", 3: "three significant", 4: "four significant"}
    solved = build.notebook(source, "solutions")
    posed = [cell.source for cell in solved.cells if {"exercise", "check"} & set(build.tags(cell))]
    for text, check in pairwise(posed):
        if "grade(" not in check:
            continue
        options = {each.arg: each.value for each in ast.parse(check).body[-1].value.keywords}
        right = ast.parse(check).body[-1].value.args[1]
        said = " ".join(text.split()).lower()
        if "digits" in options:
            assert words[options["digits"].value] in said
        elif "within" in options:
            assert "to within" in said
        elif isinstance(right, ast.Constant | ast.UnaryOp) and build.asked(check)[1] == "number":
            assert "exactly" in said or "whole number" in said or "nearest integer" in said


@pytest.mark.slow
@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_a_notebook_installs_flockana_where_it_is_missing_and_only_there(source, monkeypatch):
    address = "git+https://example.org/flockana"
    book = build.notebook(source, "student", address=address)
    (cell,) = of(book, "install")
    assert book.cells[2].source == cell  # before anything is imported
    installed = []
    plain = cell.replace('%pip install --quiet "flockana[course] @ {address}"', "installed.append(address)")
    assert plain != cell
    exec(plain.partition("    from pathlib")[0], {"installed": installed})
    assert installed == []
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    exec(plain.partition("    from pathlib")[0], {"installed": installed})
    assert installed == [address]
    assert ("copy_companions" in cell) == (number_of(source) == "11")
    (open_,) = of(build.notebook(source, "student"), "install")
    bare = open_.replace("%pip", "#").replace("if missing:\n", "if missing:\n    pass\n")
    with pytest.raises(RuntimeError, match="put the address"):
        exec(bare.partition("    from pathlib")[0], {})


@pytest.mark.slow
def test_everything_that_a_lecture_needs_is_written_beside_it(tmp_path):
    """Lecture 11 imports its own law, whose proof imports `proofs`: neither is in the package."""
    written = build.write(tmp_path)
    assert [path.stem for path in written] == [path.stem for path in SOURCES]
    code = "import own_law.theorem, own_law.proof; print(all(step.holds for step in own_law.proof.PROOF.steps()))"
    found = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "True"


test_a_check_that_cannot_be_exported_is_refused = refused(
    ("x = 1", "expected one call grade"),
    ("grade(x, right(), hint='')", "give a constant, or form="),
    ("import math\ngrade(x, 2)", "expected one call grade"),
    make=build.asked,
)
