"""Lectures as slides: the title with the aims, and for each figure its section's heading, one sentence and the figure.

Code runs and is not shown. A slide has a fixed height: figures are no larger, and what is still taller is scrolled.
"""

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from nbformat.v4 import new_markdown_cell

from flockana.course.build import companions, notebook, sources, tags
from flockana.course.file_delivery import deliver, notebook_bytes

_LEFT_OUT = {"exercise", "answer", "check", "install", "predict"}
_SENTENCE = r"(?s:.+?[.?])(?=\s+[A-Z*$#]|\s*\Z)"
_PART = re.compile(
    rf"(?m)^# (?P<title>.+)$|^\*\*Aims\.\*\* (?P<aims>{_SENTENCE})|^## (?P<head>.+)$"
    rf"|^\*\*Figure \w+\.\d+\.\*\* (?P<said>(?s:.+?)(?=\n\n|\Z))"
)
_STYLE = """<style>
.reveal .slides section:not(.stack) { box-sizing: border-box; max-height: 700px; overflow: hidden auto; }
.reveal .slides :is(.jp-CodeCell .jp-InputArea, .jp-InputPrompt, .jp-OutputPrompt) { display: none !important; }
.reveal .slides .jp-OutputArea-output :is(img, svg) { max-width: 100%; max-height: 480px; }
.reveal .slides :is(.MathJax_Display, mjx-container[display="true"]) { overflow-x: auto; overflow-y: hidden; }
</style>"""


def slides(source: Path) -> Any:
    """Return a lecture's notebook marked for ``jupyter nbconvert --to slides --execute``."""
    book = notebook(source, "student")
    book.cells = list(_slides([cell for cell in book.cells if not _LEFT_OUT & set(tags(cell))]))
    for number, cell in enumerate(book.cells):
        cell["id"] = f"{source.stem[:3].strip('_')}-slide-{number:03d}"
    return book


def _slides(cells: list[Any]) -> Iterator[Any]:
    """Yield the slides of a lecture: title with aims, one for each figure, and hidden code cells."""
    title = head = ""
    code: list[Any] = []
    for cell in cells:
        if cell.cell_type == "code":
            yield from (_marked(item, "skip") for item in code)
            code = [cell]
            continue
        for part in _PART.finditer(cell.source):
            title, head = part["title"] or title, part["head"] or head
            if part["aims"]:
                yield _marked(new_markdown_cell(f"# {title}\n\n{part['aims']}\n\n{_STYLE}"), "slide")
            if part["said"]:
                sentence = re.match(_SENTENCE, part["said"])
                yield _marked(new_markdown_cell(f"## {head}\n\n{sentence[0] if sentence else part['said']}"), "slide")
                yield from (_marked(item, "-") for item in code)
                code = []
    yield from (_marked(item, "skip") for item in code)


def _marked(cell: Any, kind: str) -> Any:
    cell.metadata.pop("jupyter", None)  # a figure is shown, wherever its text is folded
    cell.metadata["slideshow"] = {"slide_type": kind}
    return cell


def shown() -> list[Path]:
    """Return the source files of the lectures that have slides; assignments have none."""
    return [notebook_path for notebook_path in sources() if not notebook_path.name.startswith("A")]


def write_slides(folder: Path) -> list[Path]:
    """Write all lectures as slides, with the files that they import."""
    books = {f"{notebook_path.stem}.ipynb": notebook_bytes(slides(notebook_path)) for notebook_path in shown()}
    return deliver(folder, books | companions())[: len(books)]
