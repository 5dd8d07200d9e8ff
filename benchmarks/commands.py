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
_STARTS = "Python, numpy and what reads the command line take most of it before anything is listed."
_COLD = "Some 160 kernels and 110 functions of numba's own are compiled once, an eighth of a second each."
_LOADED = "A second of it is Python's start and the loading of compiled kernels."
_COLLAPSE = " The run is integrated twice, and 23 gradient flows tell at what ratio hexagons of three sizes collapse."
_VERIFY = "Near half of it are surveys of some 3 000 seeds, most of that in compiled steps."
_SEEDS = "They are 8 million steps of 50 agents, near two millionths of a second each, and 400 verdicts."
_MAIN = (sys.executable, "-c", "from flockana.cli.main import main; main()")


def study(*, quick: bool) -> Found:
    """CPU time, and for the long jobs the wall clock, on all cores; they are left out where it is to be short."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        cold, report = Path(folder) / "numba", Path(folder) / "report"
        _taken(["theorems"], None)  # bytecode is there, as on every machine but a new one
        rows.append(_row("scenarios", ["scenarios"], _asked(0.5, _STARTS), rounds=3))
        first = ["verify", "hexagon", "--no-report"]
        rows.append(_row("verify hexagon, without report, cold", first, _asked(12.0, _COLD), rounds=1, cache=cold))
        for name, why in (("hexagon", _LOADED), ("collapse", _LOADED + _COLLAPSE)):
            what = f"verify {name}, without report, warm"
            rows.append(_row(what, ["verify", name, "--no-report"], _asked(3.0, why), rounds=2 if quick else 5))
        if not quick:
            for _ in range(2):  # the first compiles what has changed since kernels were last used
                cpu, wall = _taken(["verify", "--output", str(report)], None)
            rows.append(Row(STUDY, "flockana verify, warm: CPU", None, cpu, "s"))
            rows.append(Row(STUDY, "flockana verify, warm: clock", None, wall, "s", asked=_asked(60.0, _VERIFY)))
            _, wall = _taken(["verify", "dead-zone", "--no-report", "--seeds", "400"], None)
            many = "flockana verify dead-zone, 400 seeds, without report, warm: clock"
            rows.append(Row(STUDY, many, None, wall, "s", asked=_asked(10.0, _SEEDS)))
    return Found(rows)


def _asked(most: float, why: str) -> Asked:
    return Asked("<=", most, "value", why)


def _row(name: str, arguments: list[str], asked: Asked, *, rounds: int, cache: Path | None = None) -> Row:
    """The least CPU time of a few."""
    taken = [_taken(arguments, cache)[0] for _ in range(rounds)]
    return Row(STUDY, f"flockana {name}: CPU", None, min(taken), "s", asked=asked)


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
