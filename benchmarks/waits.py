"""What a person waits for, as ratios to the start of Python with numpy and scipy, in turns in one process."""

from __future__ import annotations

import subprocess
import sys
import time
from statistics import median

from benchmarks.machine import all_cores
from benchmarks.rows import Found, Row

STUDY = "What a person waits for"
START = "python -c 'import numpy, scipy.integrate'"
_VERDICTS = "import flockana as fl; i = fl.scenario('paper-flocking'); r = i.run(); "
WAITS = {
    "flockana --help": ("-m", "flockana.cli", "--help"),
    "flockana scenarios": ("-m", "flockana.cli", "scenarios"),
    "flockana lattice square:4x5": ("-m", "flockana.cli", "lattice", "square:4x5"),
    "flockana verify E3": ("-m", "flockana.cli", "verify", "E3", "--no-report"),
    "flockana verify hexagon, with report": ("-m", "flockana.cli", "verify", "hexagon", "--output", "report/waits"),
    "flockana ensemble phase --seeds 8": ("-m", "flockana.cli", "ensemble", "phase", "--seeds", "8"),
    "flockana stability hexagonal-patch:3 --delay": ("-m", "flockana.cli", "stability", "hexagonal-patch:3", "--delay"),
    "150 agents: first verdict": ("-c", _VERDICTS + "fl.verify('energy', r)"),
    "150 agents: all verdicts": ("-c", _VERDICTS + "i.verify(r)"),
}
_START = ("-c", "import numpy, scipy.integrate")


def study(*, quick: bool) -> Found:
    """Clock time of each wait over that of the start of Python, run just before it."""
    rows = []
    for name, arguments in WAITS.items():
        _taken(arguments)  # compiles and caches what the others load
        pairs = [(_taken(_START), _taken(arguments)) for _ in range(1 if quick else 3)]
        ratio = median(wait / start for start, wait in pairs)
        rows.append(Row(STUDY, name, None, median(wait for _, wait in pairs), "s", START, ratio))
    return Found(rows)


def _taken(arguments: tuple[str, ...]) -> float:
    started = time.perf_counter()
    with all_cores():
        subprocess.run([sys.executable, *arguments], capture_output=True, check=True)  # no wait for a refusal
    return time.perf_counter() - started
