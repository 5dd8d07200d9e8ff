"""Building of lectures as notebooks, for students and with solutions, with the files that they need.

A lecture is a text in jupytext's percent format whose cells are tagged: ``exercise`` poses, ``answer`` is what the
student fills in, ``solution`` is our answer, and ``check`` grades it by one call of `grade`. Answers in sentences have
no check, and their solutions end with a rubric. ``predict`` asks for a guess by one `Prediction`; no later cell needs
it. ``facts`` asserts what the text says about the output above it; it is kept beside the solutions, where CI runs it.
"""

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jupytext
import nbformat

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_choice
from flockana.course import course_pages
from flockana.course.file_delivery import deliver, notebook_bytes
from flockana.course.grading import form_of
from flockana.course.student_numbers import give_own_numbers, variants

_PACKAGE = Path(__file__).resolve().parent
_CHECKOUT = _PACKAGE.parent.parent
_KERNEL = {"name": "python3", "language": "python", "display_name": "Python 3"}
_LEFT_OUT = {"student": {"solution", "facts"}, "self-study": {"solution", "facts"}, "solutions": {"answer"}}
_POSED = re.compile(r"\*\*(\d+)\.\*\* (★{1,3}) \((\d+) points?, (\w+)\)")
WRITTEN = ("proof", "project", "words")  # kinds whose answers are sentences, in a Markdown cell, read by a person
KINDS = ("derivation", "design", "counterexample", "program", "experiment", "player", "reading", *WRITTEN)
VERSIONS = tuple(_LEFT_OUT)
_INSTALL = """# Where flockana is missing, as on Colab, this cell installs it; elsewhere it does nothing.
import importlib.util

address = {address!r}
missing = importlib.util.find_spec("flockana") is None
if missing and not address:
    raise RuntimeError("flockana is missing: put the address of the course's checkout between the quotes above")
if missing:
    %pip install --quiet "flockana[course] @ {{address}}\""""
_COMPANIONS = """

    from pathlib import Path

    from flockana.course.build import copy_companions

    copy_companions(Path())"""


@dataclass(frozen=True)
class Exercise:
    """One exercise of a lecture."""

    name: str  # the variable that takes the answer, or text_ and the number where the answer is written
    number: int  # number, level, points: its place in the lecture, stars from 1 to 3, and what it counts
    level: int
    points: int
    kind: str  # what it takes to answer, one of KINDS
    form: str  # what is asked for, as `answered` takes it, or "text"


def lectures() -> Path:
    """Return the folder of lecture sources, in the installed package or in the checkout."""
    shipped_folder = _PACKAGE / "lectures"
    return shipped_folder if shipped_folder.is_dir() else _CHECKOUT / "notebooks"


def sources() -> list[Path]:
    """Return the source files of the lectures, in teaching order."""
    files = {course_pages.number_of(path): path for path in lectures().glob("*.py")}
    return [files[lecture.number] for lecture in course_pages.course_map(lectures())]


def tags(cell: Any) -> list[str]:
    """Return the tags of a notebook's cell."""
    return list(cell.metadata.get("tags", ()))


def notebook(source: Path, version: str, *, address: str = "", student: str = "") -> Any:
    """Return the notebook of a lecture: for the student, for self-study (with checks), or with solutions.

    `address` is where its first cell installs flockana from if it is missing, such as ``git+https://host/flockana``.
    With a `student`, whose name is in the notebook's metadata, exercises have this student's own numbers.
    """
    ensure_choice("version", version, VERSIONS)
    book = jupytext.read(source)
    if version == "solutions" and not any("solution" in tags(cell) for cell in book.cells):
        raise ArgumentError(
            f"{source.name} has no solutions: an installed flockana ships none; use a checkout of its code"
        )
    book.metadata = nbformat.from_dict({"kernelspec": _KERNEL} | ({"student": student} if student else {}))
    if student:
        give_own_numbers(
            book.cells, course_pages.number_of(source), variants(source.parent)[course_pages.number_of(source)], student
        )
    book.cells = [cell for cell in book.cells if not _LEFT_OUT[version] & set(tags(cell))]
    entry = course_pages.entry_of(source)
    course_pages.number_statements(book.cells, entry)
    course_pages.fold_depth(book.cells, entry)
    book.cells.insert(1, nbformat.v4.new_markdown_cell(course_pages.header(entry, source.parent)))
    lines = _INSTALL.format(address=address) + (_COMPANIONS if needs_companions(source) else "")  # as on Colab
    hidden_metadata = {"tags": ["install"], "jupyter": {"source_hidden": True}}
    book.cells.insert(2, nbformat.v4.new_code_cell(lines, metadata=hidden_metadata))
    book.cells.append(nbformat.v4.new_markdown_cell(course_pages.references(entry)))
    for number, cell in enumerate(book.cells):
        cell["id"] = f"{entry.number}-{number:03d}"  # the same at every build
        if "check" in tags(cell) and version == "student":
            cell.source = form_check(cell.source)
        elif {"solution", "check", "facts"} & set(tags(cell)):
            cell.metadata["jupyter"] = {"source_hidden": True}
    return book


def needs_companions(source: Path) -> bool:
    """Return whether a lecture imports from folders beside it."""
    return any(f"from {name}." in source.read_text(encoding="utf-8") for name in ("own_law", "proofs"))


def exercises(source: Path) -> Iterator[Exercise]:
    """Return the exercises of a lecture, in order."""
    parts: list[dict[str, str]] = []
    for cell in jupytext.read(source).cells:
        for tag in {"exercise", "check"} & set(tags(cell)):
            parts += [{}] * (tag == "exercise")
            parts[-1] = parts[-1] | {tag: cell.source}
    for part in parts:
        match = _POSED.search(part["exercise"])
        if match is None or match[4] not in KINDS:
            raise ArgumentError(
                f"{source.name}: an exercise begins {part['exercise'][:60]!r}; expected '**1.** ★★ (2 points, kind) "
                f"...', kind one of {', '.join(KINDS)}"
            )
        number, stars, points, kind = int(match[1]), len(match[2]), int(match[3]), match[4]
        if ("check" in part) is (kind in WRITTEN):
            raise ArgumentError(
                f"{source.name}: exercise {number} is of kind {kind}; expected a check unless it is one of "
                f"{', '.join(WRITTEN)}, which a person reads"
            )
        name, form = asked(part["check"]) if "check" in part else (f"text_{number}", "text")
        yield Exercise(name, number, stars, points, kind, form)


def asked(check: str) -> tuple[str, str]:
    """Return the variable that an exercise's check grades, and the expected form of the answer."""
    *before, last_statement = ast.parse(check).body
    match last_statement:
        case ast.Expr(ast.Call(func=ast.Name("grade"), args=[ast.Name(name), right], keywords=options)) if not before:
            texts = {option.arg: option.value for option in options}
        case _:
            raise ArgumentError(f"a check reads {check!r}: expected one call grade(name, right, ...)")
    try:
        return name, str(ast.literal_eval(texts["form"])) if "form" in texts else form_of(ast.literal_eval(right))
    except ValueError as error:
        raise ArgumentError(f"the check of {name} computes what is right: give a constant, or form=") from error


def form_check(check: str) -> str:
    """Return the check in a student's copy, which tests the form of the answer only."""
    name, form = asked(check)
    return f'from flockana.course import answered\n\nanswered({name}, "{form}")'


def write(folder: Path, version: str = "student", *, address: str = "", student: str = "") -> list[Path]:
    """Write one version of all lectures with all imported files; with solutions, also the lecturer's pages."""
    notebooks = {source.stem: notebook(source, version, address=address, student=student) for source in sources()}
    books = {f"{name}.ipynb": notebook_bytes(book) for name, book in notebooks.items()}
    files = {
        "map.md": course_pages.map_page(lectures()).encode(),
        "notation.md": course_pages.notation_page(lectures()).encode(),
    }
    if version == "solutions":
        files |= lecturer_pages()
    return deliver(folder, books | files | companions())[: len(books)]


def lecturer_pages() -> dict[str, bytes]:
    """Return the pages for the lecturer by name: plan, notes, exam with solutions."""
    return {f"lecturer/{path.name}": path.read_bytes() for path in sorted((lectures() / "lecturer").glob("*.md"))}


def companions() -> dict[str, bytes]:
    """Return the files that lectures import, by name."""
    law, shipped_folder = lectures() / "own_law", lectures() / "proofs"
    proofs = shipped_folder if shipped_folder.is_dir() else _CHECKOUT / "proofs"
    paths = {path: f"own_law/{path.relative_to(law).as_posix()}" for path in sorted(law.rglob("*")) if path.is_file()}
    paths |= {proofs / name: f"proofs/{name}" for name in ("__init__.py", "proof.py")}
    return {name: path.read_bytes() for path, name in paths.items() if "__pycache__" not in path.parts}


def copy_companions(folder: Path) -> None:
    """Write the `companions` files into the folder of a notebook."""
    deliver(folder, companions())
