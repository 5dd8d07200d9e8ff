"""The lectures, from their sources, with solutions folded away, for myst-nb to execute."""

from __future__ import annotations

import re
import shutil
from pathlib import Path
from typing import Any

import jupytext
import nbformat

from flockana.course import build, slides
from flockana.course.course_pages import entry_of, fold_depth, number_of, number_statements
from flockana.theorems.catalogue import catalogue
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
    number_statements(
        book.cells, entry_of(source), "[`{0}`](../theorems/{0}.md), [proof](../theorems/{0}.md#proof)".format
    )
    fold_depth(book.cells, entry_of(source))
    links = " · ".join(f"[{name}](../theorems/{name}.md)" for name in catalogue_entries(source))
    book.cells += [nbformat.v4.new_markdown_cell(f"## In the library\n\n{links}")] if links else []
    for number, cell in enumerate(book.cells):
        cell["id"] = f"{source.stem[:2]}-{number:03d}"
        tags = list(cell.metadata.get("tags", ()))
        if "jupyter" in cell.metadata:
            cell.metadata["tags"] = [*tags, "hide-cell"]
        if "solution" in tags and cell.cell_type == "markdown":
            cell.source = f"````{{admonition}} Solution\n:class: dropdown\n\n{cell.source}\n````"
        elif "solution" in tags or "check" in tags:
            cell.metadata["tags"] = [*tags, "hide-cell"]
        elif "predict" in tags:
            cell.metadata["tags"] = [*tags, "hide-input"]
    return book


def catalogue_entries(source: Path) -> list[str]:
    """The entries of the catalogue that a lecture states, or asks about a run."""
    found = re.findall(r'(?:verify|theorem|falsify)\(\s*"([\w-]+)"', source.read_text(encoding="utf-8"))
    return [name for name in dict.fromkeys([*entry_of(source).theorems.values(), *found]) if name in catalogue()]


def back_links(name: str) -> str:
    """Links to the lectures in which an entry of the catalogue is stated, with its numbers, or asked."""
    parts = []
    for source in (each for each in build.sources() if name in catalogue_entries(each)):
        entry = entry_of(source)
        places = [place for place, of in entry.theorems.items() if of == name]
        parts.append(f"[{', '.join(['Lecture ' + entry.number, *places])}](../lectures/{source.stem}.ipynb)")
    return " · ".join(parts) or "No lecture speaks of it."


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
