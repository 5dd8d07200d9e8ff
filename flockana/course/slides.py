"""Lectures as slides: one for each heading and, below it, one for each cell; exercises left out.

A slide has a fixed height, and nothing may be cut off: code and what it puts out have slides of their own, long lines
are broken, figures are no larger than the slide, and what is still taller is scrolled.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import nbformat

from flockana.course.build import companions, notebook, sources, tags
from flockana.course.delivery import deliver, notebook_bytes

_LEFT_OUT = {"exercise", "answer", "check", "install"}
_HEADING = re.compile(r"(?m)^(?=##? )")
_A_LINE = 240  # characters of a text that need no slide to themselves
_STYLE = """<style>
.reveal .slides section:not(.stack) { box-sizing: border-box; max-height: 700px; overflow: hidden auto; }
.reveal .slides pre { white-space: pre-wrap !important; overflow-wrap: anywhere; font-size: 12px !important; }
.reveal .slides .jp-OutputArea-output :is(img, svg) { max-width: 100%; max-height: 400px; }
.reveal .slides :is(.MathJax_Display, mjx-container[display="true"]) { overflow-x: auto; overflow-y: hidden; }
</style>"""


def slides(source: Path) -> Any:
    """Return a lecture's notebook marked for ``jupyter nbconvert --to slides --execute``."""
    book = notebook(source, "student")
    book.cells = [part for cell in book.cells if not _LEFT_OUT & set(tags(cell)) for part in _parts(cell)]
    book.cells[0].source += f"\n\n{_STYLE}"
    for number, (before, cell) in enumerate(zip([None, *book.cells], book.cells, strict=False)):
        cell["id"] = f"{source.stem[:3].strip('_')}-slide-{number:03d}"
        cell.metadata["slideshow"] = {"slide_type": _kind(cell, before)}
    return book


def _parts(cell: Any) -> Iterator[Any]:
    """Split a text cell at its headings; return other cells unchanged."""
    if cell.cell_type != "markdown":
        yield cell
        return
    for text in filter(str.strip, _HEADING.split(cell.source)):
        yield nbformat.v4.new_markdown_cell(text.strip())


def _kind(cell: Any, before: Any) -> str:
    if cell.cell_type != "markdown":
        leads = before.cell_type == "markdown" and not before.source.startswith("#")
        return "-" if leads and len(before.source) <= _A_LINE else "subslide"
    if cell.source.startswith("**Lectures before this one:**"):
        return "skip"
    return "slide" if cell.source.startswith("#") else "subslide"


def shown() -> list[Path]:
    """Return the lectures with slides; assignments have none."""
    return [source for source in sources() if not source.name.startswith("A")]


def write_slides(folder: Path) -> list[Path]:
    """Write all lectures as slides, with the files that they import."""
    books = {f"{source.stem}.ipynb": notebook_bytes(slides(source)) for source in shown()}
    return deliver(folder, books | companions())[: len(books)]
