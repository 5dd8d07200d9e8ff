"""Run the benchmarks and write their table: `python -m benchmarks [--quick] [--only STUDY]... [--out FOLDER]`.

CPU time on one core, what is compared taking turns in one process. Writes performance.json, performance.md and two
pictures; `--redraw FILE` writes page and pictures anew from such a JSON, without measuring anything.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from importlib import import_module
from pathlib import Path
from typing import Any

from benchmarks.machine import cores, facts, notice, pin

STUDIES = (
    "right_hand_side",
    "formulas",
    "pairs",
    "laws",
    "engines",
    "runs",
    "whole_steps",
    "precision",
    "before",
    "costs",
    "million",
    "threads",
    "zones",
    "noise",
    "search",
    "commands",
    "waits",
    "others",
)


def main() -> int:
    """Measure, or read what was measured, and write it."""
    options = _options()
    if options.redraw is not None:
        record = json.loads(options.redraw.read_text())
    else:
        record = _measured(options.only or STUDIES, quick=options.quick)
    if options.keep is not None:
        record = _merged(json.loads(options.keep.read_text()), record)
    from benchmarks.page import write

    for path in write(record, options.out):
        sys.stdout.write(f"{path}\n")
    return 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="smaller flocks and fewer rounds: a few minutes")
    parser.add_argument("--only", action="append", choices=STUDIES, metavar="STUDY", help=", ".join(STUDIES))
    parser.add_argument("--out", type=Path, default=Path("report/performance"), help="folder to write to")
    parser.add_argument(
        "--redraw", type=Path, metavar="FILE", help="a performance.json to write page and pictures from"
    )
    parser.add_argument("--keep", type=Path, metavar="FILE", help="a performance.json whose other studies are kept")
    return parser.parse_args()


def _merged(before: dict[str, Any], now: dict[str, Any]) -> dict[str, Any]:
    """Return the record of before, with the studies of now in place of its own."""
    studies = {row["study"] for row in now["rows"]}
    kept = [row for row in before["rows"] if row["study"] not in studies]
    return {**before, "rows": kept + now["rows"], "series": before["series"] | now["series"]}


def _measured(names: tuple[str, ...] | list[str], *, quick: bool) -> dict[str, object]:
    """Everything that the studies find, as what JSON holds."""
    available, core = cores(), pin()  # before numpy is imported, which counts the cores for its threads
    from benchmarks.rows import to_json

    rows, notices = list[dict[str, Any]](), list[str]()
    series: dict[str, Any] = {}
    for name in names:
        started = time.perf_counter()
        found = import_module(f"benchmarks.{name}").study(quick=quick)
        rows += to_json(found.rows)
        notices += found.notices
        series |= dict(found.series)
        for text in (*found.notices, f"{name}: {len(found.rows)} rows, {time.perf_counter() - started:.0f} s"):
            notice(text)
    return {
        "command": "python -m benchmarks" + (" --quick" if quick else ""),
        "machine": facts(available, core),
        "rows": rows,
        "notices": notices,
        "series": series,
    }


if __name__ == "__main__":
    sys.exit(main())
