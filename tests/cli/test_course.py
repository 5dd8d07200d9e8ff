"""`flockana course`."""

from __future__ import annotations

import sys

COMMAND = ("course",)


def test_notebooks_are_written_for_students_and_with_solutions(call, tmp_path):
    for arguments, has, lacks in (
        (("new",), "answered(jump", "grade(jump"),
        (("solved", "--solutions"), "grade(jump", "jump = ..."),
        (("alone", "--self-study"), "grade(jump", 'fl.verify(\\"E10\\")'),
    ):
        code, said, _ = call(*arguments)
        assert code == 0
        assert f"notebook: {arguments[0]}/01_pair_potentials.ipynb" in said
        text = (tmp_path / arguments[0] / "01_pair_potentials.ipynb").read_text()
        assert has in text
        assert lacks not in text
        assert (tmp_path / arguments[0] / "own_law" / "law.py").is_file()


def test_two_versions_at_once_are_refused(call, tmp_path):
    code, _, complaint = call("new", "--solutions", "--self-study")
    assert code == 2
    assert "expected one of them" in complaint
    assert not (tmp_path / "new").exists()


def test_slides(call, tmp_path):
    code, said, _ = call("shown", "--slides")
    assert code == 0
    assert "notebook: shown/03_algorithm_2.ipynb" in said
    assert "A1_four_cases" not in said
    text = (tmp_path / "shown" / "03_algorithm_2.ipynb").read_text()
    assert '"slide_type": "slide"' in text
    assert "Exercises" not in text


def test_masters_for_a_grader(call, tmp_path):
    code, said, _ = call("masters", "--grader", "nbgrader")
    assert code == 0
    assert "notebook: masters/source/11_your_own_law/11_your_own_law.ipynb" in said
    assert (tmp_path / "masters" / "source" / "11_your_own_law" / "own_law" / "law.py").is_file()
    assert (tmp_path / "masters" / "nbgrader_config.py").is_file()


def test_without_the_extra_the_remedy_is_said(call, monkeypatch):
    monkeypatch.setitem(sys.modules, "jupytext", None)
    monkeypatch.delitem(sys.modules, "flockana.course.build", raising=False)
    code, _, complaint = call("new")
    assert code == 2
    assert "pip install 'flockana[course]'" in complaint
    assert complaint.count("\n") == 1
