"""The page of a record: what was measured where, the tables, and the two pictures."""

from __future__ import annotations

import json
from collections.abc import Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

from benchmarks.pictures import draw
from benchmarks.rows import Row, from_json, missed, number, table

_RUN = "lattice: an evaluation in a run of RK4, with its share of lists, energies and steps"
_FASTER, _TIMES = "{}\u00a0×\u00a0faster", "{}\u00a0×\u00a0the\u00a0time"  # on one line each
# of the first screen: study, name, agents, beginning of the baseline; what is said of them
HEADLINES = {
    ("Right-hand side against numpy", "times faster than numpy", 1000, "a numpy loop"): (
        "accelerations of 1,000 agents", _FASTER, "a numpy loop over the agents"),
    ("A law from its formula", "times the hand-written law's", 10_000, ""): (
        "a law typed as a formula, 10,000 agents", _TIMES, "the same law written by hand"),
    ("Time per pair", "lattice: one evaluation", 10_000, "C, list rebuilt"): (
        "accelerations of 10,000 agents", _TIMES, "C that finds all pairs anew"),
    ("Time per pair", "lattice: an evaluation over a kept list", 10_000, ""): (
        "the same over a kept list of pairs", _TIMES, "C that keeps its list"),
    ("Time per pair", _RUN, 10_000, ""): (
        "whole steps of RK4, 10,000 agents", _TIMES, "C for the accelerations alone"),
    ("Against molecular dynamics engines", "gas", 100_000, "LAMMPS"): (
        "accelerations of 100,000 agents", _TIMES, "LAMMPS's Lennard-Jones"),
    ("Work and precision, Fig. 10", "DOP853 at equal error: times faster, median of 9", 150, ""): (
        "Fig. 10 by DOP853 at equal error", _FASTER, "scipy's solve_ivp"),
    ("Whole runs", "all distances between samples, bounded", 150, ""): (
        "bounds between all samples", _TIMES, "that run"),
    ("What a person waits for", "flockana verify hexagon, with report", None, ""): (
        "`flockana verify hexagon`, report", _TIMES, "Python's start with scipy"),
    ("What a person waits for", "150 agents: all verdicts", None, ""): (
        "150 agents and every verdict", _TIMES, "Python's start with scipy"),
}  # fmt: skip
_HEAD = "# Performance\n\nMeasured by `{command}`; what stands behind each number is folded below.\n"
_HOW = """Times are CPU times on one core (many cores: clock times), medians over interleaved
rounds; a ratio is the median of the ratios of the rounds. Unless a row says "faster", a ratio is our time
over that of what stands beside it. Flocks live in the plane, d = 7 and r = 8.4: a triangular lattice disturbed by 3 %
of d (6 neighbours), the same with its agents in no order, and a uniform gas (12 neighbours on average). Times per pair
count the pairs in range once each. The C loop (`benchmarks/pair_loop.c`) keeps a flat half list with a skin of 1,
compiled by the machine's own compiler with -O3 -march=native -ffast-math.
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
    """Return the table of the first screen; of rows that were not measured nothing is said."""
    lines = []
    for (study, name, n, baseline), (what, phrase, against) in HEADLINES.items():
        for row in rows:
            if (row.study, row.name, row.n) == (study, name, n) and row.baseline.startswith(baseline):
                lines.append(f"| {what} | {phrase.format(number(row.ratio))} | {against} |\n")
    return "| what | takes | against |\n|---|---|---|\n" + "".join(lines)


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
    rows = from_json(record["rows"])
    parts = [_HEAD.format(command=record["command"]), in_short(rows)]
    if pictures:
        shown = " | ".join(f"![{name.removesuffix('.png')}]({name})" for name in pictures)
        parts.append(f"| {shown} |\n|{'---|' * len(pictures)}\n")
    parts += [_folded("How it is measured", _HOW), _folded("The machine", f"| machine | |\n|---|---|\n{machine}")]
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
