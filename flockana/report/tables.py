"""Terminal tables: headed tables and tables of facts, as blocks on narrow terminals."""

import re
from collections.abc import Iterable
from copy import copy
from typing import Any, Literal

from rich import box
from rich.console import Console, ConsoleOptions, RenderableType, RenderResult
from rich.measure import Measurement
from rich.padding import Padding
from rich.table import Column, Table
from rich.text import Text

_LEAST = 16  # letters in a line of a column that wraps; fewer are not readable
_WIDE = 10_000  # no table is wider
_PIECE = re.compile(r"[^\s\-/]*[-/]|[^\s\-/]+")  # a word may be broken after a hyphen, and nowhere else


class FoldingTable(Table):
    """Terminal table without truncation: long words break at hyphens, too wide tables become blocks.

    Rich itself would cut numbers and names, or leave whole columns out.
    """

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the table, or its rows as blocks."""
        full_width = Measurement.get(console, options.update(max_width=_WIDE), self).maximum
        rows = [[_text(console, cell) for cell in row] for row in zip(*(c.cells for c in self.columns), strict=True)]
        column_heads = [_text(console, column.header) for column in self.columns]
        spare_width, rooms = options.max_width - full_width, {}
        for k, column in enumerate(self.columns):
            if spare_width >= 0 or column.no_wrap:
                continue
            cells = [column_heads[k], *(row[k] for row in rows)]
            widest = max(max((line.cell_len for line in cell.split()), default=0) for cell in cells)
            widest = min(max(widest, column.min_width or 0), column.max_width or _WIDE)
            narrowest = max(min(widest, _LEAST), *map(_longest_piece, cells))
            rooms[k] = max(narrowest, widest + spare_width)
            spare_width += widest - rooms[k]
        if spare_width < 0 and full_width > options.max_width:
            yield from self._blocks(column_heads, rows)
            return
        broken_table = copy(self)
        broken_table.columns, broken_table.rows = [column.copy() for column in self.columns], []
        for row, old_row in zip(rows, self.rows, strict=True):
            cells = [_broken(cell, rooms[k]) if k in rooms else cell for k, cell in enumerate(row)]
            broken_table.add_row(*cells, style=old_row.style, end_section=old_row.end_section)
        yield from super(FoldingTable, broken_table).__rich_console__(console, options)

    def _blocks(self, heads: list[Text], rows: list[list[Text]]) -> Iterable[RenderableType]:
        """Yield each row as a block: its name, with its values below."""
        yield Text()
        for name, *values in rows:
            name_shown = name.copy()
            name_shown.overflow, name_shown.no_wrap = "fold", False
            yield name_shown
            for head, value in zip(heads[1:], values, strict=True):
                if value.plain.strip():
                    before = Text(f"{head.plain}: " if self.show_header and head.plain else "", style="bright_black")
                    line = Text.assemble(before, value, overflow="fold")
                    yield Padding(line, (0, 0, 0, _indent(name) + 2), expand=False)
        yield Text()


def _text(console: Console, cell: RenderableType) -> Text:
    return cell if isinstance(cell, Text) else console.render_str(str(cell), highlight=False)


def _indent(text: Text) -> int:
    """Return the number of leading blanks of a text."""
    return len(text.plain) - len(text.plain.lstrip(" "))


def _hanging_indent(text: Text) -> int:
    """Return the number of blanks before each continuation line of a wrapped text."""
    return _indent(text) + 2 if _indent(text) else 0


def _longest_piece(text: Text) -> int:
    """Return the width of the longest unbreakable piece of a text, with the hanging indentation."""
    return max((len(piece) + _hanging_indent(text) for piece in _PIECE.findall(text.plain)), default=0)


def _broken(text: Text, room: int) -> Text:
    """Return the text with line breaks after hyphens in words longer than a line."""
    break_points = []
    for word in re.finditer(r"\S+", text.plain):
        if len(word[0]) + _indent(text) <= room:
            continue
        begin, indent = word.start(), _indent(text)
        for piece in _PIECE.finditer(text.plain, word.start(), word.end()):
            if piece.end() - begin + indent > room and piece.start() > begin:
                break_points.append(piece.start())
                begin, indent = piece.start(), _hanging_indent(text)
    lines = text.divide(break_points)
    return Text("\n" + " " * _hanging_indent(text)).join(lines) if break_points else text


def headed_table(*columns: Column | str, **options: Any) -> Table:
    """Return a table with a line under its headings."""
    return FoldingTable(*columns, box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1), **options)


def column(heading: str, *, right: bool = False, width: int | None = None, wraps: bool = False) -> Column:
    """Return a table column that does not wrap by default, with an optional least width."""
    justify: Literal["left", "right"] = "right" if right else "left"
    return Column(heading, justify=justify, no_wrap=not wraps, min_width=width, overflow="fold")


def fact_table(facts: Iterable[tuple[str, str]]) -> Table:
    """Return a table of facts: name and value."""
    columns = Column(no_wrap=True, style="bright_black"), Column(overflow="fold")
    table = FoldingTable(*columns, box=box.SIMPLE, show_header=False, pad_edge=False, padding=(0, 1))
    for name, value in facts:
        table.add_row(name, Text(value))
    return table
