"""Pages for the lecturer: every lecture is planned, times add up, and the exam's numbers are right."""

import re

import numpy as np
import pytest

import flockana as fl
from flockana.course import build
from flockana.course import course_pages as pages

PAGES = {name.partition("/")[2]: content.decode() for name, content in build.lecturer_pages().items()}
PATH, RING = ((0, 1), (1, 2)), ((0, 1), (1, 2), (2, 3), (3, 0))
MAP = pages.course_map(build.lectures())


@pytest.mark.slow
def test_all_pages_are_delivered_with_solutions_and_to_graders_only(tmp_path):
    bank = {"exam_bank.md", "exam_bank_solutions.md", "project.md"}
    assert set(PAGES) == {"syllabus.md", "notes.md", "exam.md", "exam_solutions.md"} | bank
    build.write(tmp_path / "solutions", "solutions")
    build.write(tmp_path / "student", "student")
    assert (tmp_path / "solutions" / "lecturer" / "exam_solutions.md").is_file()
    assert not (tmp_path / "student" / "lecturer").exists()


def test_the_syllabus_teaches_every_lecture_once_in_an_order_that_the_map_allows():
    weeks = re.findall(r"(?m)^\| (\d+) \| ([^|]+) \|", PAGES["syllabus.md"])
    assert [int(number) for number, _ in weeks] == list(range(1, 15))
    taught = [name for _, what in weeks for name in re.findall(r"\b\d\d[a-z]?\b", what)]
    assert taught == [each.number for each in MAP if not each.number.startswith("A")]


@pytest.mark.parametrize("lecture", MAP, ids=lambda each: each.number)
def test_notes_plan_the_minutes_of_a_lecture(lecture):
    section = re.search(rf"(?ms)^## {lecture.number}\b.*?(?=^## |\Z)", PAGES["notes.md"])[0]
    planned = [int(minutes) for minutes in re.findall(r"(?m)^\| .* \| (\d+) \|$", section)]
    assert sum(planned) == lecture.minutes
    assert "**Outcomes.**" in section
    assert "**What students get wrong.**" in section


def test_exercises_that_the_pages_name_exist():
    posed = {
        f"{pages.number_of(source)}.{each.number}" for source in build.sources() for each in build.exercises(source)
    }
    for name, page in PAGES.items():
        assert set(re.findall(r"\b((?:\d\d[a-z]?|A\d)\.\d+)\b", page)) <= posed, name


def test_the_exam_has_60_points_and_its_parts_add_up():
    parts = re.split(r"(?m)^\*\*\d\. ", PAGES["exam.md"])[1:]
    stated = [int(re.search(r"\((\d+) points\)", part)[1]) for part in parts]
    assert sum(stated) == 60
    for part, points in zip(parts, stated, strict=True):
        given = [int(each) for each in re.findall(r"\((\d)\)(?=\n|$|\Z)", part)]
        assert not given or sum(given) == points


def test_the_bank_has_forty_questions_over_all_lectures_each_with_its_answer():
    posed, answered = (
        re.findall(r"(?m)^\*\*(\d\d[a-z]?-\d)\.\*\*", PAGES[name])
        for name in ("exam_bank.md", "exam_bank_solutions.md")
    )
    assert posed == answered
    assert len(posed) == 40
    assert {each.partition("-")[0] for each in posed} == {
        each.number for each in MAP if not each.number.startswith("A")
    }


def test_the_banks_numbers():
    """Those that a pocket calculator does not give at once, by the library or by closed forms of their own."""
    said = PAGES["exam_bank_solutions.md"]
    path, ring = (fl.laplacian(n, np.array(net)).toarray() for n, net in ((3, PATH), (4, RING)))
    assert np.allclose(np.linalg.eigvalsh(path), [0.0, 1.0, 3.0], atol=1e-12)
    assert np.linalg.eigvalsh(ring)[-1] == pytest.approx(4.0)
    for number in (
        np.pi / 8,
        np.sqrt(8 / 3),
        0.025 ** (1 / 30),
        0.05 ** (1 / 30),
        np.log(20),
        1 / np.sqrt(10),
        np.pi / 4,
    ):
        assert f"{number:.4g}" in said or f"{number:.3f}" in said
    assert 0.99**299 < 0.05 < 0.99**298
    assert len(fl.links(fl.lattice.hexagonal_patch(1, 1.0), 1.2)) == 12


def test_the_rubric_has_twenty_points():
    points = re.findall(r"(?m)^\|.*\| (\d) \|$", PAGES["project.md"])
    assert sum(map(int, points)) == 20


def test_the_exams_numbers():
    said = PAGES["exam_solutions.md"]
    star = fl.laplacian(4, np.array([(0, 1), (0, 2), (0, 3)])).toarray()
    assert np.allclose(np.linalg.eigvalsh(star), [0.0, 1.0, 1.0, 4.0], atol=1e-12)
    assert np.allclose(star @ [3, -1, -1, -1], 4.0 * np.array([3, -1, -1, -1]))
    numbers = {
        "ln": np.log(100.0),
        "delay": np.pi / 8.0,
        "shift": 6.0 / np.sqrt(4.0 * 2.0 * 8.0),
        "gain": abs((2.0 * 2j + 4.0) / ((2j) ** 2 + 2.0 * 2j + 4.0)),
        "near": 1.2 / np.sqrt(2.0),
        "low": 0.025 ** (1 / 60),
    }
    shown = ["4.605", "0.3927", "0.75", "1.414", "0.849", "0.940"]
    for value, text in zip(numbers.values(), shown, strict=True):
        assert text in said
        assert abs(value - float(text)) < 0.51 * 10.0 ** -len(text.partition(".")[2])
    assert 2.0 * (3.0 - 0.5 * 3.0) / 4.0 == 0.75
