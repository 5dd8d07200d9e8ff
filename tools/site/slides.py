"""The lectures' slides, beside their pages: with what the pages' own execution put out, so that nothing runs twice."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nbformat

from flockana.course.slides import shown, slides


def with_outputs(source: Path, executed: Path | None) -> Any:
    """The slides of a lecture with the outputs that the same cells have in ``executed``, a folder; without it, none."""
    book = slides(source)
    if executed is None:
        return book
    page = nbformat.read(executed / f"{source.stem}.ipynb", as_version=4)
    done = {cell.source: cell for cell in page.cells if cell.cell_type == "code"}
    for cell in book.cells:
        if cell.cell_type == "code":
            found = done[cell.source]
            cell["outputs"], cell["execution_count"] = found.outputs, found.execution_count
    return book


def write(folder: Path, executed: Path | None) -> None:
    """Write the slides of all lectures; their pages load reveal.js and MathJax from the net.

    Parameters
    ----------
    folder : Path
        Of the site.
    executed : Path, optional
        Where the build left the executed lectures; for a draft None.
    """
    from nbconvert import SlidesExporter

    folder.mkdir(parents=True, exist_ok=True)
    exporter = SlidesExporter()
    for source in shown():
        page, _ = exporter.from_notebook_node(with_outputs(source, executed))
        (folder / f"{source.stem}.html").write_text(page, encoding="utf-8")
