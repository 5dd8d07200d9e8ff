"""What the command line takes, in whole processes with all that they start: the main job, and the first verdict."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.machine import all_cores
from benchmarks.rows import Asked, Found, Row

STUDY = "Command line"
_MAIN = (sys.executable, "-c", "from flockana.cli.main import main; main()")


def study(*, quick: bool) -> Found:
    """CPU time, and for the long jobs the wall clock, on all cores; they are left out where it is to be short."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        cold, report = Path(folder) / "numba", Path(folder) / "report"
        _taken(["theorems"], None)  # bytecode is there, as on every machine but a new one
        rows.append(_row("scenarios", ["scenarios"], 0.5, rounds=3))
        first = ["verify", "hexagon", "--no-report"]
        rows.append(_row("verify hexagon, without report, cold", first, 12.0, rounds=1, cache=cold))
        for name in ("hexagon", "collapse"):
            what = f"verify {name}, without report, warm"
            rows.append(_row(what, ["verify", name, "--no-report"], 3.0, rounds=2 if quick else 5))
        if not quick:
            for _ in range(2):  # the first compiles what has changed since kernels were last used
                cpu, wall = _taken(["verify", "--report", str(report)], None)
            rows.append(Row(STUDY, "flockana verify, warm: CPU", None, cpu, "s"))
            rows.append(Row(STUDY, "flockana verify, warm: clock", None, wall, "s", asked=Asked("<=", 60.0, "value")))
            _, wall = _taken(["verify", "dead-zone", "--no-report", "--seeds", "400"], None)
            many = "flockana verify dead-zone, 400 seeds, without report, warm: clock"
            rows.append(Row(STUDY, many, None, wall, "s", asked=Asked("<=", 10.0, "value")))
    return Found(rows)


def _row(name: str, arguments: list[str], most: float, *, rounds: int, cache: Path | None = None) -> Row:
    """The least CPU time of a few."""
    taken = [_taken(arguments, cache)[0] for _ in range(rounds)]
    return Row(STUDY, f"flockana {name}: CPU", None, min(taken), "s", asked=Asked("<=", most, "value"))


def _taken(arguments: list[str], cache: Path | None) -> tuple[float, float]:
    """(CPU seconds of the process and its children, seconds on the clock); statuses 0 and 3 are ends of a whole run."""
    environment = os.environ | ({} if cache is None else {"NUMBA_CACHE_DIR": str(cache)})
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # else Python compiles the package anew in each process
    before, started = os.times(), time.perf_counter()
    with all_cores():
        done = subprocess.run([*_MAIN, *arguments], env=environment, capture_output=True, text=True, check=False)
    wall, after = time.perf_counter() - started, os.times()
    if done.returncode not in (0, 3):
        raise RuntimeError(f"flockana {' '.join(arguments)} ended with {done.returncode}: {done.stderr.strip()[-300:]}")
    return after.children_user + after.children_system - before.children_user - before.children_system, wall
