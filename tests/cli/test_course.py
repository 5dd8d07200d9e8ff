import json
import sys

import pytest

COMMAND = ("course",)


@pytest.fixture(autouse=True)
def few(monkeypatch):
    """Five lectures: tests/course builds each of them."""
    pytest.importorskip("jupytext")
    from flockana.course import build, slides

    chosen = [one for one in build.sources() if one.stem[:2] in ("01", "02", "03", "11", "A1")]
    assert len(chosen) == 5
    for module in (build, slides):
        monkeypatch.setattr(module, "sources", lambda: chosen)


@pytest.mark.slow
def test_notebooks_are_written_for_students_and_with_solutions(call, tmp_path):
    for arguments, has, lacks in (
        (("new",), "answered(jump", "grade(jump"),
        (("solved", "--solutions"), "grade(jump", "jump = ..."),
        (("alone", "--self-study"), "grade(jump", 'fl.verify(\\"E10\\")'),
        (("hers", "--student", "Emmy Noether"), '"student": "Emmy Noether"', "$c^* = 1000$"),
    ):
        code, said, _ = call(*arguments)
        assert code == 0
        assert f"notebook: {arguments[0]}/01_pair_potentials.ipynb" in said
        assert f"{arguments[0]}/01_pair_potentials.ipynb" in json.loads(call(*arguments, "--json")[1])["notebooks"]
        text = (tmp_path / arguments[0] / "01_pair_potentials.ipynb").read_text()
        assert has in text
        assert lacks not in text
        assert (tmp_path / arguments[0] / "own_law" / "law.py").is_file()


def test_two_versions_at_once_are_refused(call, tmp_path):
    code, _, complaint = call("new", "--solutions", "--self-study")
    assert code == 2
    assert "expected one of them" in complaint
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize("options", [("--student", " "), ("--student", "Ada", "--slides")], ids=" ".join)
def test_a_student_without_a_name_or_exercises_is_refused(refused, options):
    refused("expected a name, and exercises to number; slides have none", "new", *options)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("options", "book"),
    [
        ((), "01_pair_potentials.ipynb"),
        (("--slides",), "01_pair_potentials.ipynb"),
        (("--grader", "otter"), "01_pair_potentials.ipynb"),
        (("--grader", "nbgrader"), "source/01_pair_potentials/01_pair_potentials.ipynb"),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, tuple) else "",
)
def test_answers_are_not_replaced(call, refused, tmp_path, options, book):
    first = call("own", *options)
    assert call("own", *options) == first  # what is the same is no obstacle
    answered, lost = tmp_path / "own" / book, tmp_path / "own" / book.replace("01_pair_potentials", "02_algorithm_1")
    text = answered.read_text().replace("import", "# my answer")
    answered.write_text(text)
    lost.unlink()
    refused(
        f"own/{book} exists with other content: nothing is written, so that no answers are lost; "
        "choose another folder, or move it away",
        "own",
        *options,
    )
    assert answered.read_text() == text
    assert not lost.exists()


def test_without_the_extra_the_remedy_is_said(call, monkeypatch):
    monkeypatch.setitem(sys.modules, "jupytext", None)
    monkeypatch.delitem(sys.modules, "flockana.course.build", raising=False)
    code, _, complaint = call("new")
    assert code == 2
    assert "pip install 'flockana[course]'" in complaint
    assert complaint.count("\n") == 1
