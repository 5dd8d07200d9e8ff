"""Scenarios of a few milliseconds for ensembles, in a module that worker processes can import."""

import os
import signal
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from flockana.jit import Kernel
from flockana.laws.olfati_saber import Algorithm1
from flockana.scenarios import Report, Scenario
from flockana.theorems import Claim
from tests.programs import out_of_a_kernel

LOG = "FLOCKANA_TEST_LOG"  # names a file that gets a line "pid seed" for every run that is begun
GATE = "FLOCKANA_TEST_GATE"  # names a file without which gated runs do not go on


def _odd(run, tolerances):
    """Verified on odd seeds, refuted on even ones, vacuous on multiples of five; the seed is read off the clock."""
    seed = round(float(run.t[0]))
    status = "vacuous" if seed % 5 == 0 else ("verified" if seed % 2 else "refuted")
    return Claim("odd", status, margin=seed + tolerances.quasi, error=0.5, detail="")


def trio(seed, n=3, speed=0.3, fast=False):
    if LOG in os.environ:
        with Path(os.environ[LOG]).open("a") as file:
            file.write(f"{os.getpid()} {seed}\n")
    generator = np.random.default_rng(seed)
    q, p = generator.uniform(0.0, 12.0, (n, 2)), generator.uniform(-speed, speed, (n, 2))
    span = (float(seed), seed + 0.2)
    reports = (Report("odd", "the seed is odd", _odd),)
    options = {"method": "RK4", "dt": 0.1 if fast else 0.05}
    return Scenario(
        "trio", "Three agents", "ours", Algorithm1(), q, p, span, seed, {"alpha-flocking": "refuted"}, reports, options
    )


def gated(seed):
    """As `trio`, but from 24 on not before the gate is open: who runs one of these is in mid-run for sure."""
    item = trio(seed)
    while seed >= 24 and not Path(os.environ[GATE]).exists():
        time.sleep(0.01)
    return item


def begun(log):
    """(process, seed) of every run that was begun."""
    return [tuple(map(int, line.split())) for line in log.read_text().splitlines()] if log.exists() else []


class Bursting(Algorithm1):
    """Algorithm 1 until t = 4.1, then nothing that is a number."""

    def flow(self, t, q, p):
        u, rate = super().flow(t, q, p)
        return (u, rate) if t < 4.1 else (np.full_like(u, np.nan), rate)


def faulty(seed):
    """Raises on 3, cannot be integrated on 4."""
    if seed == 3:
        raise ValueError("a bad\nseed")
    item = trio(seed)
    return replace(item, law=Bursting()) if seed == 4 else item


def deadly(seed):
    """2 ends its process."""
    if seed == 2:
        os.kill(os.getpid(), signal.SIGKILL)
    return trio(seed)


def lethal(seed):
    """Every seed ends its process."""
    os.kill(os.getpid(), signal.SIGKILL)


def not_a_scenario(seed):
    return seed


def compilations(run):
    """Kernels that this process compiled, rather than load them, since it started."""
    known = [vars(module) for name, module in sys.modules.items() if name.startswith("flockana")]
    kernels = {id(one): one for names in known for one in names.values() if isinstance(one, Kernel)}.values()
    loaded = [kernel.dispatcher for kernel in kernels if kernel._dispatcher is not None]
    assert loaded
    return sum(dispatcher.stats.cache_misses.total() for dispatcher in loaded)


def threads(run):
    return float(os.environ.get("OPENBLAS_NUM_THREADS", "nan"))


def interrupts(run):
    """Ctrl-C in the run of seed 3."""
    if run.t[0] == 3.0:
        raise KeyboardInterrupt
    return 0.0


def interrupts_a_kernel(run):
    """Ctrl-C in the run of seed 3, within a kernel."""
    if run.t[0] == 3.0:
        raise out_of_a_kernel()
    return 0.0


def slowness(run):
    """How far all speeds stay below 2: a margin of a user's own."""
    return 2.0 - np.linalg.norm(run.p, axis=2).max(axis=1)
