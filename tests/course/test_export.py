import re

import pytest

from flockana.course import build, export

SOURCES = build.sources()


def code(book):
    return [cell for cell in book.cells if cell.cell_type == "code"]


@pytest.mark.slow
@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_otter_gives_all_points_to_the_hidden_test(source):
    book, asked = export.master(source, "otter"), list(build.exercises(source))
    assert "%pip" not in "".join(cell.source for cell in book.cells)  # a grader has what it needs
    raw = [cell.source for cell in book.cells if cell.cell_type == "raw"]
    assert raw[0].startswith("# ASSIGNMENT CONFIG")
    heads = [text for text in raw if text.startswith("# BEGIN QUESTION")]
    assert [re.search(r"name: (\w+)\npoints: (\d+)", text).groups() for text in heads] == [
        (each.name, str(each.points)) for each in asked
    ]
    assert ["manual: true" in text for text in heads] == [each.form == "text" for each in asked]
    graded = [each for each in asked if each.form != "text"]
    hidden = [cell.source for cell in code(book) if "hidden: true" in cell.source]
    seen = [cell.source for cell in code(book) if "hidden: false" in cell.source]
    assert len(hidden) == len(seen) == len(graded)
    for each, test, look in zip(graded, hidden, seen, strict=True):
        assert f"points: {each.points}\n" in test
        assert "assert grade(" in test.replace("\n    ", "")
        assert "points: 0\n" in look
        assert "assert grade(" not in look
    for mark in ("QUESTION", "SOLUTION", "TESTS"):
        assert raw.count(f"# END {mark}") == sum(text.startswith(f"# BEGIN {mark}") for text in raw)


@pytest.mark.slow
@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_nbgrader_marks_every_answer_and_test(source):
    book, asked = export.master(source, "nbgrader"), list(build.exercises(source))
    marked = [cell for cell in book.cells if "nbgrader" in cell.metadata]
    names = [cell.metadata["nbgrader"]["grade_id"] for cell in marked]
    assert len(names) == len(set(names))
    graded = [cell for cell in marked if cell.metadata["nbgrader"]["grade"]]
    assert [cell.metadata["nbgrader"]["points"] for cell in graded] == [each.points for each in asked]
    for each, cell in zip(asked, graded, strict=True):
        by_hand = each.form == "text"
        assert cell.cell_type == cell.metadata["nbgrader"]["cell_type"] == ("markdown" if by_hand else "code")
        assert cell.metadata["nbgrader"]["solution"] is by_hand
        assert ("### BEGIN HIDDEN TESTS" in cell.source) is not by_hand
        assert ("### BEGIN SOLUTION" in cell.source) is by_hand
        left = re.sub(r"### BEGIN (.*?)\n.*### END \1", "", cell.source, flags=re.DOTALL)
        assert "grade(" not in left
        assert "Rubric" not in left
    unmarked = "\n".join(cell.source for cell in code(book) if "nbgrader" not in cell.metadata)
    assert "grade(" not in unmarked  # what both programs would leave in the student's copy
