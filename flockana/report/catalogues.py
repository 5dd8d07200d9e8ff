"""Catalogues as terminal tables and plain data; nothing here draws, solves or integrates."""

from collections.abc import Iterable, Sequence
from typing import Any

from rich.table import Column, Table
from rich.text import Text

from flockana.base.errors import ArgumentError
from flockana.base.user_cache import kept_data
from flockana.report.tables import column, headed_table

_KINDS = {"trajectory": "a run", "configuration": "positions", "fixed": "itself"}


def scenario_entries() -> list[dict[str, Any]]:
    """Return the catalogue of scenarios as plain data."""
    entries: list[dict[str, Any]] = kept_data("scenarios", _scenario_entries)
    return entries


def _scenario_entries() -> list[dict[str, Any]]:
    from flockana.scenarios import scenario, scenarios

    items = map(scenario, scenarios())
    return [
        {
            "name": item.name,
            "title": item.title,
            "source": _first(item.references),
            "printed": item.source,
            "law": type(item.law).__name__,
            "n": item.shape[0],
            "m": item.shape[1],
            "t_span": [float(t) for t in item.t_span],
            "theorems": list(item.theorems),
            "statuses": sorted({status for key, status in item.expected.items() if ":" not in key}),
        }
        for item in items
    ]


def theorem_entries() -> list[dict[str, Any]]:
    """Return the catalogue of theorems as plain data, with expected statuses."""
    entries: list[dict[str, Any]] = kept_data("theorems", _theorem_entries)
    return entries


def _theorem_entries() -> list[dict[str, Any]]:
    from flockana.scenarios import scenario, scenarios
    from flockana.theorems import theorem, theorems

    expected: dict[str, set[str]] = {name: set() for name in theorems()}
    for item in map(scenario, scenarios()):
        for key, status in item.expected.items():
            if key in expected:
                expected[key].add(status)
    entries = []
    for name, element in ((name, theorem(name)) for name in theorems()):
        statuses = expected[name] | {status for key, status in element.expected.items() if key == name}
        entry = {"name": name, "title": element.title, "source": _first(element.references), "printed": element.source}
        entries.append(entry | {"checked on": _KINDS[element.kind], "statuses": sorted(statuses)})
    return entries


def _first(references: Sequence[str]) -> str:
    """Return the readable name of the first source that is not flockana itself."""
    from flockana.report.value_texts import source_name

    return next((source_name(key) for key in references if key != "flockana"), "flockana")


def select(
    entries: Iterable[dict[str, Any]], words: Sequence[str] = (), *, source: str = "", status: str = ""
) -> list[dict[str, Any]]:
    """Return the catalogue entries that contain all given words, of one source, with one expected status."""
    every = list(entries)
    sources = sorted({entry["source"] for entry in every})
    if source and not any(source.casefold() in source_name.casefold() for source_name in sources):
        raise ArgumentError(f"--source {source}: expected part of {', '.join(sources)}")

    def fits(entry: dict[str, Any]) -> bool:
        text = " ".join(map(str, entry.values())).casefold()
        match = all(word.casefold() in text for word in words)
        return match and source.casefold() in entry["source"].casefold() and (not status or status in entry["statuses"])

    return [entry for entry in every if fits(entry)]


def short_list(entries: Sequence[dict[str, Any]]) -> str:
    """Return catalogue entries as text, one line per entry, grouped by source."""
    width, lines = max((len(entry["name"]) for entry in entries), default=0), []
    for source_name in dict.fromkeys(entry["source"] for entry in entries):
        entries_of_source = (entry for entry in entries if entry["source"] == source_name)
        lines += [source_name, *(f"  {entry['name']:{width}}  {entry['title']}" for entry in entries_of_source)]
    return "\n".join(lines)


def scenario_table(names: Iterable[str]) -> Table:
    """Return scenarios with size, law and time span, title, source, theorems."""
    from flockana.scenarios import scenario

    table = headed_table(column("scenario"), Column("what", ratio=1, overflow="fold"), show_lines=True)
    for name in names:
        item = scenario(name)
        n, m = item.shape
        law = type(item.law).__name__
        left = Text.assemble((name, "bold"), f"\nn = {n}, m = {m}\n{law}\nt = {item.t_span[0]:g} to {item.t_span[1]:g}")
        right = Text.assemble((item.title, "bold"), "\n", (item.source, "bright_black"))
        table.add_row(left, right + Text(f"\ntheorems: {', '.join(item.theorems) or 'none'}"))
    return table


def theorem_table(names: Iterable[str]) -> Table:
    """Return theorems with title, checked runs, and source."""
    from flockana.theorems import theorem

    text_column = Column("what, and where it is printed", ratio=1, overflow="fold")
    table = headed_table(Column("theorem", no_wrap=True, style="bold"), text_column, column("checked on"))
    for name in names:
        item = theorem(name)
        table.add_row(name, Text.assemble(item.title, "\n", (item.source, "bright_black")), _KINDS[item.kind])
    return table
