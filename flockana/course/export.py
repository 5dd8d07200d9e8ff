"""Lectures as assignments for otter-grader and nbgrader: points, hidden tests, and answers that a person reads.

Both programs make the student's copy themselves, and take solutions and hidden tests out of it; what is left looks at
the form of an answer only. Neither is needed for writing what they start from.
"""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from nbformat.v4 import new_code_cell, new_markdown_cell, new_raw_cell

from flockana.base.value_checks import ensure_choice
from flockana.course import build
from flockana.course.course_pages import number_of
from flockana.course.file_delivery import deliver, notebook_bytes

_IMPORTS = "from flockana.course import answered, grade, is_own, shows\n\n"
_NBGRADER_CONFIG = """c = get_config()
c.ClearSolutions.code_stub = {"python": "# your code here"}
c.ClearSolutions.text_stub = "*Your answer:*"
"""
GRADERS = ("otter", "nbgrader")


def master(source: Path, grader: str, *, student: str = "") -> Any:
    """Return the notebook that a grader starts from, with solutions and all tests; for lecturers."""
    ensure_choice("grader", grader, GRADERS)
    exercise_cells: Callable[..., Iterator[Any]] = _otter if grader == "otter" else _nbgrader
    book, questions = build.notebook(source, "solutions", student=student), iter(build.exercises(source))
    cells: list[Any] = [new_raw_cell(_assignment(source))] if grader == "otter" else []
    parts: dict[str, Any] = {}
    for cell in book.cells:
        kind = next((tag for tag in ("exercise", "solution", "check") if tag in build.tags(cell)), "")
        if kind:
            parts[kind] = cell
        elif not {"facts", "install"} & set(build.tags(cell)):
            cells.append(cell)
        if kind == "check" or (kind == "solution" and cell.cell_type == "markdown"):
            check = cell.source if kind == "check" else ""
            cells += exercise_cells(next(questions), parts["exercise"], parts["solution"].source, check)
    for number, cell in enumerate(cells):
        cell["id"] = f"{number_of(source)}-{number:03d}"
    book.cells = cells
    return book


def write_for(folder: Path, grader: str, *, student: str = "") -> list[Path]:
    """Write all lectures for a grader: masters for ``otter assign``, or nbgrader's folder ``source``."""
    books: dict[str, bytes] = {}
    other_files: dict[str, bytes] = {}
    for notebook_path in build.sources():
        home = f"source/{notebook_path.stem}/" if grader == "nbgrader" else ""
        books[f"{home}{notebook_path.stem}.ipynb"] = notebook_bytes(master(notebook_path, grader, student=student))
        if build.needs_companions(notebook_path):
            other_files |= {f"{home}{name}": content for name, content in build.companions().items()}
    if grader == "nbgrader":
        other_files["nbgrader_config.py"] = _NBGRADER_CONFIG.encode()
    return deliver(folder, books | other_files | build.lecturer_pages())[: len(books)]


def _tests(check: str, exercise: build.Exercise) -> tuple[str, str]:
    """Return the visible and the hidden test of an exercise."""
    visible_tests = f'{_IMPORTS}assert answered({exercise.name}, "{exercise.form}").status == "handed in"'
    return visible_tests, f'assert {check.rstrip()}.status == "right"'


def _assignment(source: Path) -> str:
    listing = "".join(f"\n  - {name}" for name in build.companions() if name.endswith(".py"))
    return "# ASSIGNMENT CONFIG\ninit_cell: true\nexport_cell: true" + f"\nfiles:{listing}" * build.needs_companions(
        source
    )


def _otter(exercise: build.Exercise, text: Any, solution: str, check: str) -> Iterator[Any]:
    """Export for Otter: raw cells delimit a question, and the hidden test carries its points."""
    is_graded_by_hand = not check
    head = f"# BEGIN QUESTION\nname: {exercise.name}\npoints: {exercise.points}"
    yield new_raw_cell(head + "\nmanual: true" * is_graded_by_hand)
    yield new_markdown_cell(text.source)
    yield new_raw_cell("# BEGIN SOLUTION")
    if is_graded_by_hand:
        yield new_markdown_cell(solution)
    else:
        prompt = f'""" # BEGIN PROMPT\n{exercise.name} = ...\n"""; # END PROMPT'
        yield new_code_cell(f"{prompt}\n# BEGIN SOLUTION NO PROMPT\n{solution.rstrip()}\n# END SOLUTION")
    yield new_raw_cell("# END SOLUTION")
    if not is_graded_by_hand:
        visible_tests, hidden_tests = _tests(check, exercise)
        yield new_raw_cell("# BEGIN TESTS")
        yield new_code_cell(_scored(0, hidden=False) + visible_tests)
        yield new_code_cell(_scored(exercise.points, hidden=True) + _IMPORTS + hidden_tests)
        yield new_raw_cell("# END TESTS")
    yield new_raw_cell("# END QUESTION")


def _scored(points: int, *, hidden: bool) -> str:
    return f'""" # BEGIN TEST CONFIG\npoints: {points}\nhidden: {str(hidden).lower()}\n""" # END TEST CONFIG\n'


def _nbgrader(exercise: build.Exercise, text: Any, solution: str, check: str) -> Iterator[Any]:
    """Export for nbgrader: cell metadata, and solutions between ``### BEGIN`` and ``### END``."""
    yield new_markdown_cell(text.source)
    if not check:
        solution_cell = new_markdown_cell(f"### BEGIN SOLUTION\n{solution.rstrip()}\n### END SOLUTION")
        yield _marked(solution_cell, exercise, grade=True, solution=True)
    else:
        answer = new_code_cell(f"{exercise.name} = ...\n### BEGIN SOLUTION\n{solution.rstrip()}\n### END SOLUTION")
        yield _marked(answer, exercise, grade=False, solution=True)
        visible_tests, hidden_tests = _tests(check, exercise)
        tests = new_code_cell(f"{visible_tests}\n### BEGIN HIDDEN TESTS\n{hidden_tests}\n### END HIDDEN TESTS")
        yield _marked(tests, exercise, grade=True, solution=False)


def _marked(cell: Any, exercise: build.Exercise, *, grade: bool, solution: bool) -> Any:
    marks = {"schema_version": 3, "cell_type": cell.cell_type, "task": False, "grade": grade, "solution": solution}
    marks |= {"locked": not solution, "grade_id": f"{exercise.name}-{'answer' if solution else 'tests'}"}
    cell.metadata["nbgrader"] = marks | ({"points": exercise.points} if grade else {})
    return cell
