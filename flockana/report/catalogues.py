"""Catalogues as terminal tables; nothing here draws, solves or integrates."""

from __future__ import annotations

from rich.table import Column, Table
from rich.text import Text

from flockana.report.tables import column, headed_table
from flockana.scenarios import scenario, scenarios
from flockana.theorems import theorem, theorems


def scenario_table() -> Table:
    """The catalogue of scenarios: size, law and time span, title, source, theorems."""
    table = headed_table(column("scenario"), Column("what", ratio=1, overflow="fold"), show_lines=True)
    for name in scenarios():
        item = scenario(name)
        n, m = item.shape
        law = type(item.law).__name__
        left = Text.assemble((name, "bold"), f"\nn = {n}, m = {m}\n{law}\nt = {item.t_span[0]:g} to {item.t_span[1]:g}")
        right = Text.assemble((item.title, "bold"), "\n", (item.source, "bright_black"))
        table.add_row(left, right + Text(f"\ntheorems: {', '.join(item.theorems) or 'none'}"))
    return table


def theorem_table() -> Table:
    """The catalogue of theorems: id, title, what each is checked on, source."""
    name_column = Column("theorem", no_wrap=True, style="bold")
    table = headed_table(
        name_column, Column("what, and where it is printed", ratio=1, overflow="fold"), column("checked on")
    )
    kinds = {"trajectory": "a run", "configuration": "positions", "fixed": "itself"}
    for name in theorems():
        item = theorem(name)
        table.add_row(name, Text.assemble(item.title, "\n", (item.source, "bright_black")), kinds[item.kind])
    return table
