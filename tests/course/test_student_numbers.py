"""Students' own numbers: what varies stands in the lecture, and each solution passes the grader with its numbers."""

import ast

import numpy as np
import pytest

import flockana as fl
from flockana.course import build, grade
from flockana.course.course_pages import number_of
from flockana.course.student_numbers import draw_column, variants

SOURCES = {number_of(source): source for source in build.sources()}
TABLE = variants(build.lectures())
CASES = [pytest.param(number, name, id=f"{number}-{name}") for number in TABLE for name in TABLE[number]]


def students(number, name):
    """A name for each column."""
    columns, found = len(TABLE[number][name][0]), {}
    for k in range(500):
        found.setdefault(draw_column(f"student {k}", f"{number}.{name}", columns), f"student {k}")
    assert sorted(found) == list(range(columns))
    return [found[column] for column in range(columns)]


def names(part, context):
    return {node.id for node in ast.walk(part) if isinstance(node, ast.Name) and isinstance(node.ctx, context)}


def bound(part):
    """Names that a statement defines."""
    found = names(part, ast.Store) | {getattr(part, "name", "")}
    return found | {each.asname or each.name for each in getattr(part, "names", ()) if isinstance(each, ast.alias)}


def namespace(book, place):
    """What the solution in a cell needs of the code before it."""
    skipped, parts = {"install", "check", "facts"}, []
    for cell in book.cells[: place + 1]:
        if cell.cell_type == "code" and not skipped & set(build.tags(cell)):
            parts += ast.parse(cell.source).body
    wanted, kept = names(ast.parse(book.cells[place].source), ast.Load), []
    for part in reversed(parts[: len(parts) - len(ast.parse(book.cells[place].source).body)]):
        if bound(part) & wanted:
            kept.insert(0, part)
            wanted |= names(part, ast.Load)
    known = {"grade": grade, "np": np, "fl": fl}
    exec(compile(ast.Module(kept, []), "before", "exec"), known)
    return known


def cells_of(book, name):
    """The places of an exercise's question, solution and check."""
    tags = [set(build.tags(cell)) for cell in book.cells]
    check = next(k for k, t in enumerate(tags) if "check" in t and build.asked(book.cells[k].source)[0] == name)
    return [max(k for k in range(check) if tag in tags[k]) for tag in ("exercise", "solution")] + [check]


@pytest.mark.slow
@pytest.mark.parametrize(("number", "name"), CASES)
def test_a_solution_with_own_numbers_passes_its_own_grader_and_no_other(number, name):
    source, rows = SOURCES[number], TABLE[number][name]
    plain = build.notebook(source, "solutions")
    places = cells_of(plain, name)
    said = [plain.cells[place].source for place in places]
    assert all(any(row[0] in text for text in said) for row in rows)
    assert any(row[0] in said[0] for row in rows)
    assert {len(row) for row in rows} == {len(rows[0])}
    books = [build.notebook(source, "solutions", student=each) for each in students(number, name)]
    known, answers, checks = namespace(plain, places[1]), [], []
    for column, book in enumerate(books):
        posed, solution, check = (book.cells[place].source for place in places)
        assert all(row[column] in posed + solution + check for row in rows)
        own = dict(known)
        exec(solution, own)
        answers, checks = [*answers, own[name]], [*checks, check]
    passed = [[eval(check, known | {name: each}).status == "right" for each in answers] for check in checks]
    assert passed == np.eye(len(books), dtype=bool).tolist()


@pytest.mark.slow
def test_numbers_vary_in_every_lecture_and_nothing_else():
    assert list(TABLE) == list(SOURCES)
    for number, source in SOURCES.items():
        plain, ada, again = (build.notebook(source, "solutions", student=each) for each in ("", "Ada", " ADA "))
        assert ada.metadata["student"] == "Ada"
        assert ada.cells == again.cells
        places = {place for name in TABLE[number] for place in cells_of(plain, name)}
        assert {k for k, pair in enumerate(zip(plain.cells, ada.cells, strict=True)) if pair[0] != pair[1]} <= places
    drawn = [
        [
            draw_column(who, f"{number}.{name}", len(TABLE[number][name][0]))
            for number in TABLE
            for name in TABLE[number]
        ]
        for who in ("Ada", "Emmy Noether")
    ]
    assert sum(a != b for a, b in zip(*drawn, strict=True)) > len(CASES) // 2
