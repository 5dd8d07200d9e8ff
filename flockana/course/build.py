"""Lectures as notebooks: for students without our solutions, for lecturers with them, and the files that go with them.

A lecture is a text in jupytext's percent format whose cells are tagged: ``exercise`` poses, ``answer`` is what the
student fills in, ``solution`` is our answer, and ``check`` grades it by one call of `grade`. ``facts`` asserts what the
text says about the output above it; it is kept beside the solutions, where CI runs it.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jupytext
import nbformat

from flockana.base.checks import ensure_choice
from flockana.base.errors import ArgumentError
from flockana.course.delivery import deliver, notebook_bytes
from flockana.course.grading import form_of
from flockana.course.pages import course_map, header, map_page, notation_page, number_of, references

_PACKAGE = Path(__file__).resolve().parent
_CHECKOUT = _PACKAGE.parent.parent
_KERNEL = {"name": "python3", "language": "python", "display_name": "Python 3"}
_LEFT_OUT = {"student": {"solution", "facts"}, "self-study": {"solution", "facts"}, "solutions": {"answer"}}
_POSED = re.compile(r"\*\*(\d+)\.\*\* (★{1,3}) \((\d+) points?, (\w+)\)")
KINDS = ("derivation", "design", "counterexample", "program", "experiment", "reading", "words")
VERSIONS = tuple(_LEFT_OUT)
_INSTALL = """# Where flockana is missing, as on Colab, this cell installs it; elsewhere it does nothing.
import importlib.util

missing = importlib.util.find_spec("flockana") is None
if missing:
    %pip install --quiet "flockana[course]\""""
_COMPANIONS = """

    from pathlib import Path

    from flockana.course.build import copy_companions

    copy_companions(Path())"""


@dataclass(frozen=True)
class Exercise:
    """One exercise of a lecture."""

    name: str  # the variable that takes the answer
    number: int  # number, level, points: its place in the lecture, stars from 1 to 3, and what it counts
    level: int
    points: int
    # what it takes to answer: paper, a choice, a search, code, a computation of one's own, an output, sentences
    kind: str
    form: str  # what is asked for, as `answered` takes it


def lectures() -> Path:
    """The folder that holds the sources: in the package where it is installed, in the checkout where it is not."""
    shipped = _PACKAGE / "lectures"
    return shipped if shipped.is_dir() else _CHECKOUT / "notebooks"


def sources() -> list[Path]:
    """The lectures, in the order in which they are taught."""
    files = {number_of(path): path for path in lectures().glob("*.py")}
    return [files[lecture.number] for lecture in course_map(lectures())]


def tags(cell: Any) -> list[str]:
    """The tags of a cell."""
    return list(cell.metadata.get("tags", ()))


def notebook(source: Path, version: str) -> Any:
    """The notebook of a lecture: for the student, for study alone (with checks), or with solutions."""
    ensure_choice("version", version, VERSIONS)
    book = jupytext.read(source)
    book.metadata = nbformat.from_dict({"kernelspec": _KERNEL})
    book.cells = [cell for cell in book.cells if not _LEFT_OUT[version] & set(tags(cell))]
    entry = next(each for each in course_map(source.parent) if each.number == number_of(source))
    book.cells.insert(1, nbformat.v4.new_markdown_cell(header(entry, source.parent)))
    book.cells.insert(2, _install(source))
    book.cells.append(nbformat.v4.new_markdown_cell(references(entry)))
    for number, cell in enumerate(book.cells):
        cell["id"] = f"{entry.number}-{number:03d}"  # the same at every build
        if "check" in tags(cell) and version == "student":
            cell.source = form_check(cell.source)
        elif {"solution", "check", "facts"} & set(tags(cell)):
            cell.metadata["jupyter"] = {"source_hidden": True}
    return book


def _install(source: Path) -> Any:
    """A cell that installs flockana where it is missing, as on Colab, with what this lecture imports from beside it."""
    lines = _INSTALL + (_COMPANIONS if needs_companions(source) else "")
    return nbformat.v4.new_code_cell(lines, metadata={"tags": ["install"], "jupyter": {"source_hidden": True}})


def needs_companions(source: Path) -> bool:
    """Whether a lecture imports from folders beside it."""
    return any(f"from {name}." in source.read_text(encoding="utf-8") for name in ("own_law", "proofs"))


def exercises(source: Path) -> Iterator[Exercise]:
    """The exercises of a lecture, in order."""
    posed = [cell for cell in jupytext.read(source).cells if {"exercise", "check"} & set(tags(cell))]
    for text, check in zip(posed[::2], posed[1::2], strict=True):
        number, stars, points, kind = _head(text.source, source)
        name, form = asked(check.source)
        yield Exercise(name, number, stars, points, kind, form)


def _head(text: str, source: Path) -> tuple[int, int, int, str]:
    found = _POSED.search(text)
    if found is None or found[4] not in KINDS:
        raise ArgumentError(
            f"{source.name}: an exercise begins {text[:60]!r}; expected '**1.** ★★ (2 points, kind) ...', "
            f"kind one of {', '.join(KINDS)}"
        )
    return int(found[1]), len(found[2]), int(found[3]), found[4]


def asked(check: str) -> tuple[str, str]:
    """The variable that a check looks at, and the form of its answer.

    Examples
    --------
    >>> asked('grade(jump, 1.0, hint="one-sided limits")')
    ('jump', 'number')
    """
    *before, last = ast.parse(check).body
    match last:
        case ast.Expr(ast.Call(func=ast.Name("grade"), args=[ast.Name(name), right], keywords=options)) if not before:
            given = {option.arg: option.value for option in options}
        case _:
            raise ArgumentError(f"a check reads {check!r}: expected one call grade(name, right, ...)")
    try:
        return name, str(ast.literal_eval(given["form"])) if "form" in given else form_of(ast.literal_eval(right))
    except ValueError as error:
        raise ArgumentError(f"the check of {name} computes what is right: give a constant, or form=") from error


def form_check(check: str) -> str:
    """What a student's copy has in the place of a check: a look at the form of the answer.

    Examples
    --------
    >>> print(form_check('grade(jump, 1.0, hint="one-sided limits")'))
    from flockana.course import answered
    <BLANKLINE>
    answered(jump, "number")
    """
    name, form = asked(check)
    return f'from flockana.course import answered\n\nanswered({name}, "{form}")'


def write(folder: Path, version: str = "student") -> list[Path]:
    """Write a version of all lectures, and what they import or show, so that they run there."""
    books = {f"{source.stem}.ipynb": notebook_bytes(notebook(source, version)) for source in sources()}
    pages = {"map.md": map_page(lectures()).encode(), "notation.md": notation_page(lectures()).encode()}
    return deliver(folder, books | pages | companions())[: len(books)]


def companions() -> dict[str, bytes]:
    """What lectures import, by name: the law of lecture 11, and the files of `proofs` that its proof needs."""
    law, shipped = lectures() / "own_law", lectures() / "proofs"
    proofs = shipped if shipped.is_dir() else _CHECKOUT / "proofs"
    found = {path: f"own_law/{path.relative_to(law).as_posix()}" for path in sorted(law.rglob("*")) if path.is_file()}
    found |= {proofs / name: f"proofs/{name}" for name in ("__init__.py", "proof.py")}
    return {name: path.read_bytes() for path, name in found.items() if "__pycache__" not in path.parts}


def copy_companions(folder: Path) -> None:
    """Write `companions` into the folder in which a notebook runs."""
    deliver(folder, companions())
