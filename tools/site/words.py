"""Plain text as Markdown that shows it as it is, and tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def plain(text: str) -> str:
    r"""Text that Markdown leaves as it is.

    Examples
    --------
    >>> plain("H_λ < c*")
    'H\\_λ \\< c\\*'
    """
    for mark in ("\\", "*", "_", "<", "`", "$", "[", "]", "|", "{"):
        text = text.replace(mark, f"\\{mark}")
    return text


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A Markdown table of cells that are Markdown already."""
    lines = [header, ("---",) * len(header), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def contents(pages: Iterable[str], *, depth: int = 1) -> str:
    """A table of contents of these pages."""
    return "\n".join(["```{toctree}", f":maxdepth: {depth}", "", *pages, "```"])
