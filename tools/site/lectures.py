"""The lectures, from their sources, with solutions folded away, for myst-nb to execute."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import jupytext
import nbformat

from flockana.course import build, slides
from flockana.course.pages import number_of
from tools.site.cache import ROOT
from tools.site.words import contents

SOURCES = ROOT / "notebooks"


def lecture(source: Path) -> Any:
    """The notebook of a lecture: without blanks to fill in, solutions and checks hidden until a click."""
    book = jupytext.read(source)
    book.metadata = nbformat.from_dict(
        {"kernelspec": {"name": "python3", "language": "python", "display_name": "Python"}}
    )
    book.cells = [cell for cell in book.cells if "answer" not in cell.metadata.get("tags", ())]
    for number, cell in enumerate(book.cells):
        cell["id"] = f"{source.stem[:2]}-{number:03d}"
        tags = list(cell.metadata.get("tags", ()))
        if "solution" in tags and cell.cell_type == "markdown":
            cell.source = f"````{{admonition}} Solution\n:class: dropdown\n\n{cell.source}\n````"
        elif "solution" in tags or "check" in tags:
            cell.metadata["tags"] = [*tags, "hide-cell"]
    return book


def write(folder: Path) -> None:
    """Write all that there are, what they import, and their index."""
    folder.mkdir(parents=True, exist_ok=True)
    sources = build.sources()
    for source in sources:
        nbformat.write(lecture(source), folder / f"{source.stem}.ipynb")
    for helper in (path for path in SOURCES.iterdir() if path not in sources and path.name != "__pycache__"):
        if helper.is_dir():
            shutil.copytree(
                helper, folder / helper.name, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__")
            )
        else:
            shutil.copy(helper, folder)
    opening = (
        "# Lectures\n\nEach was executed when this page was built. Solutions unfold with a click; `make course` writes "
        "notebooks for students, without them."
    )
    shown = " · ".join(f'<a href="../../slides/{each.stem}.html">{number_of(each)}</a>' for each in slides.shown())
    text = f"{opening}\n\n{contents(source.stem for source in sources)}\n\nAs slides: {shown}\n"
    (folder / "index.md").write_text(text, encoding="utf-8")
