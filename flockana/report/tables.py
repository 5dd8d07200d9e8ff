"""The two kinds of tables on the terminal: rows under headings, and facts with their names."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal

from rich import box
from rich.table import Column, Table
from rich.text import Text


def headed_table(*columns: Column | str, **options: Any) -> Table:
    """A table with a line under its headings.

    Examples
    --------
    >>> headed_table(column("mode"), column("frequency", right=True)).columns[1].justify
    'right'
    """
    return Table(*columns, box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1), **options)


def column(heading: str, *, right: bool = False, width: int | None = None, wraps: bool = False) -> Column:
    """A column that does not wrap unless told to; one with a width keeps it on a narrow terminal: others give way."""
    overflow: Literal["fold", "ellipsis"] = "fold" if wraps else "ellipsis"
    justify: Literal["left", "right"] = "right" if right else "left"
    return Column(heading, justify=justify, no_wrap=not wraps, min_width=width, overflow=overflow)


def fact_table(facts: Iterable[tuple[str, str]]) -> Table:
    """A row per fact: its name, and its value in words.

    Examples
    --------
    >>> fact_table([("links", "12"), ("graph", "planar")]).row_count
    2
    """
    columns = Column(no_wrap=True, style="bright_black"), Column()
    table = Table(*columns, box=box.SIMPLE, show_header=False, pad_edge=False, padding=(0, 1))
    for name, value in facts:
        table.add_row(name, Text(value))
    return table
