"""The course: answers are graded, and the two versions of a lecture keep the cells that they should."""

from __future__ import annotations

import numpy as np
import pytest

from flockana.course import grade
from tools import course


@pytest.mark.parametrize(
    ("answer", "right", "status"),
    [
        (..., 1.0, "not answered"),
        (1.0 + 1e-9, 1.0, "right"),
        (1.001, 1.0, "not yet"),
        ([1.0, 2.0], np.array([1.0, 2.0]), "right"),
        ([1.0], [1.0, 1.0], "not yet"),
        (1, True, "not yet"),
        (True, True, "right"),
        ("refuted", "refuted", "right"),
        ("one", 1.0, "not yet"),
        (None, 1.0, "not yet"),
        (3, lambda n: n % 2 == 1, "right"),
        ("x", lambda n: n % 2 == 1, "not yet"),
    ],
)
def test_grades(answer, right, status):
    assert grade(answer, right).status == status


def test_tolerance_is_relative_to_the_largest_component():
    assert grade([1e6, 1e-3], [1e6, 0.0], rtol=1e-6).status == "right"
    assert grade([1e6, 2.0], [1e6, 0.0], rtol=1e-6).status == "not yet"


@pytest.mark.parametrize("source", course.sources(), ids=lambda path: path.stem)
def test_versions_of_a_lecture(source):
    student, solutions = (course.notebook(source, version) for version in ("student", "solutions"))
    kept = [{tag for cell in book.cells for tag in course.tags(cell)} for book in (student, solutions)]
    assert {"answer", "check", "exercise"} <= kept[0]
    assert "solution" not in kept[0]
    assert {"solution", "check", "exercise"} <= kept[1]
    assert "answer" not in kept[1]
    answers = [cell.source for cell in student.cells if "answer" in course.tags(cell)]
    checks = [cell for cell in solutions.cells if "check" in course.tags(cell)]
    assert 3 <= len(checks) <= 5
    assert len(answers) == len(checks)
    assert all("= ..." in text for text in answers)
    assert all(cell.metadata["jupyter"]["source_hidden"] for cell in checks)


def test_both_versions_are_written(tmp_path):
    assert course.main([str(tmp_path)]) == 0
    names = {path.stem for path in course.sources()}
    for version in ("student", "solutions"):
        assert {path.stem for path in (tmp_path / version).glob("*.ipynb")} == names
