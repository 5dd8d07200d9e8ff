"""What a person waits for: CPU times over those of the start of Python with numpy and scipy, in turns."""

from __future__ import annotations

import os
import subprocess
import sys
from statistics import median

from benchmarks.machine import all_cores
from benchmarks.rows import Asked, Found, Row

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
_FLOWS = "60 gradient flows of 10 to 40 agents take more than half of it, and loading the library a quarter"
_RUNS = "eight runs with their verdicts, in workers each of which loads the library, too"
_ENCLOSED = "verdicts are two thirds of it: eigenvalues of 300 coordinates, and enclosures between samples"
ASKED = {
    "flockana scenarios": Asked("<=", 1.2),
    "flockana verify E3": Asked("<=", 3.0, why=_FLOWS),
    "flockana ensemble phase --seeds 8": Asked("<=", 9.0, why=_RUNS),
    "flockana stability hexagonal-patch:3 --delay": Asked("<=", 3.0),
    "150 agents: all verdicts": Asked("<=", 5.0, why=_ENCLOSED),
}
_START = ("-c", "import numpy, scipy.integrate")


def study(*, quick: bool) -> Found:
    """CPU time of each wait, workers included, over that of the start of Python, run just before it."""
    rows = []
    for name, arguments in WAITS.items():
        _taken(arguments)  # compiles and caches what the others load
        pairs = [(_taken(_START), _taken(arguments)) for _ in range(1 if quick else 3)]
        ratio = median(wait / start for start, wait in pairs)
        rows.append(Row(STUDY, name, None, median(wait for _, wait in pairs), "s", START, ratio, ASKED.get(name)))
    return Found(rows)


def _taken(arguments: tuple[str, ...]) -> float:
    environment, before = dict(os.environ), os.times()
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # else Python compiles the package anew in each process
    with all_cores():
        subprocess.run([sys.executable, *arguments], capture_output=True, check=True, env=environment)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system
