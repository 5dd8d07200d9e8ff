"""The course from its py:percent sources: student and solution notebooks, and the cells that each of them keeps.

`python tools/course.py [FOLDER]` writes `FOLDER/student` and `FOLDER/solutions` (by default `course/`). A source tags
its cells: ``exercise`` poses, ``answer`` is what the student fills in, ``solution`` is our answer, ``check`` grades it.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import jupytext
import nbformat

ROOT = Path(__file__).resolve().parent.parent
NOTEBOOKS = ROOT / "notebooks"
KERNEL = {"name": "python3", "language": "python", "display_name": "Python 3"}
LEFT_OUT = {"student": "solution", "solutions": "answer"}


def tags(cell: Any) -> list[str]:
    """The tags of a cell."""
    return list(cell.metadata.get("tags", ()))


def notebook(source: Path, version: str) -> Any:
    """The notebook of a source: without our solutions for the student, without the blanks for the lecturer.

    Solutions and checks are folded, and unfold with a click.
    """
    book = jupytext.read(source)
    book.metadata = nbformat.from_dict({"kernelspec": KERNEL})
    book.cells = [cell for cell in book.cells if LEFT_OUT[version] not in tags(cell)]
    for number, cell in enumerate(book.cells):
        cell["id"] = f"{source.stem[:2]}-{number:03d}"  # the same at every build
        if {"solution", "check"} & set(tags(cell)):
            cell.metadata["jupyter"] = {"source_hidden": True}
    return book


def sources() -> list[Path]:
    """The lectures, in order."""
    return sorted(path for path in NOTEBOOKS.glob("*.py") if re.match(r"\d\d_", path.name))


def main(arguments: list[str]) -> int:
    """Write both versions of every lecture."""
    folder = Path(arguments[0]) if arguments else ROOT / "course"
    for version in LEFT_OUT:
        (folder / version).mkdir(parents=True, exist_ok=True)
        for source in sources():
            target = folder / version / f"{source.stem}.ipynb"
            nbformat.write(notebook(source, version), target)
            sys.stdout.write(f"{target}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
