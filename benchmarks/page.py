"""The page of a record: what was measured where, the tables, and the two pictures."""

from __future__ import annotations

import json
from collections.abc import Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

from benchmarks.pictures import draw
from benchmarks.rows import Row, from_json, missed, table

_SHORT = 10  # ratios on the first screen
_HEAD = """# Performance

Written by `{command}`; no number in its tables is typed by hand. Times are CPU times on one core, medians over
rounds in which all that is compared takes turns; a ratio is the median of the ratios of the rounds. Unless a row says
"faster", a ratio is our time over that of what stands beside it. Flocks live in the plane, d = 7 and r = 8.4: a
triangular lattice disturbed by 3 % of d (6 neighbours), the same with its agents in no order, and a uniform gas (12
neighbours on average). Times per pair count the pairs in range once each. The C loop (`benchmarks/pair_loop.c`) keeps a
flat half list with a skin of 1, compiled by the machine's own compiler with -O3 -march=native -ffast-math.
"""


def write(record: Mapping[str, Any], folder: Path) -> list[Path]:
    """Write performance.json, performance.md and the pictures that there are series for; returns the paths."""
    folder.mkdir(parents=True, exist_ok=True)
    raw, page = folder / "performance.json", folder / "performance.md"
    pictures = draw(record["series"], folder)
    raw.write_text(json.dumps(record, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    page.write_text(text(record, [path.name for path in pictures]), encoding="utf-8")
    return [raw, page, *pictures]


def in_short(rows: list[Row]) -> str:
    """Return the ratio of the last row of each study that has one, ten at most."""
    last: dict[str, Row] = {}
    for row in rows:
        if row.ratio is not None:
            last[row.study] = row
    return table(list(last.values())[:_SHORT])


def text(record: Mapping[str, Any], pictures: list[str]) -> str:
    """The page in Markdown.

    Parameters
    ----------
    record : mapping
        As `python -m benchmarks` writes it to performance.json.
    pictures : list of str
        File names beside the page.
    """
    machine = "".join(f"| {name} | {value} |\n" for name, value in record["machine"].items())
    parts = [
        _HEAD.format(command=record["command"]),
        _folded("The machine", f"| machine | |\n|---|---|\n{machine}"),
    ]
    parts += [f"![{name.removesuffix('.png')}]({name})\n" for name in pictures]
    rows = from_json(record["rows"])
    parts.insert(1, f"## In short\n\n{in_short(rows)}")
    for study, own in groupby(rows, key=lambda row: row.study):
        parts.append(_folded(study, table(list(own))))
    if short := missed(rows):
        parts.append(_folded(f"Asked for and not reached: {len(short.splitlines())}", short))
    if record["notices"]:
        parts.append(_folded("Left out", "".join(f"- {line}\n" for line in record["notices"])))
    return "\n".join(parts)


def _folded(title: str, text: str) -> str:
    """Return Markdown that opens at a click."""
    return f"<details><summary>{title}</summary>\n\n{text}\n</details>\n"
