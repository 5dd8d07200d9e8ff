"""Time and peak memory against n, each n in a process of its own, whose memory nothing else has touched."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from benchmarks.flocks import Flock, lattice
from benchmarks.rows import Asked, Found, Row
from flockana.dynamics.simulate import simulate
from flockana.environment.targets import StaticTarget
from flockana.laws.olfati_saber import Algorithm2

STUDY = "Cost against n"
SIZES = (100, 300, 1000, 3000, 10_000, 30_000, 100_000, 300_000, 1_000_000)
WORK = {"flow": "evaluation", "step": "step of RK4", "adaptive": "short run of DOP853"}
DT, RTOL = 0.005, 1e-6
_STEPS = 3
_GIGABYTE = 1000.0  # MB


def study(*, quick: bool) -> Found:
    """A flow evaluation, a step of RK4 and a short adaptive run of a lattice, from 10² to 10⁶ agents."""
    series = [_measured(n) for n in (SIZES[:-2] if quick else SIZES)]
    rows = []
    for point in series:
        asked = Asked("<=", _GIGABYTE, "value") if point["n"] == 1_000_000 else None
        for key, name in WORK.items():
            rows.append(Row(STUDY, f"{name}: time", point["n"], 1e3 * point[key], "ms"))
            rows.append(Row(STUDY, f"{name}: peak memory", point["n"], point[f"{key}_memory"], "MB", asked=asked))
    return Found(rows, (), {"cost": series})


def _measured(n: int) -> dict[str, Any]:
    """What a process of its own finds for n."""
    command = [sys.executable, "-m", "benchmarks.costs", str(n)]
    point: dict[str, Any] = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    return point


def _measure(n: int) -> dict[str, float]:
    """CPU seconds and the growth of the peak of resident memory, in MB, of an evaluation and of a step."""
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))

    def flow(flock: Flock, times: int) -> None:
        for _ in range(times):
            law.flow(0.0, *flock)

    def steps(flock: Flock, times: int) -> None:
        end = times * DT
        simulate(law, flock[0], flock[1], (0.0, end), method="RK4", dt=DT, t_eval=[end])

    def adaptive(flock: Flock, times: int) -> None:
        for _ in range(times):
            simulate(law, flock[0], flock[1], (0.0, DT), rtol=RTOL, t_eval=[DT])

    works = {"flow": flow, "step": steps, "adaptive": adaptive}
    for work in works.values():
        work(lattice(100), 1)
    flock, found = lattice(n), dict[str, float](n=n)
    for name, work in works.items():
        before = _memory(peak=False)
        work(flock, 1)
        found[f"{name}_memory"] = _memory(peak=True) - before
        number = max(1 if name == "adaptive" else _STEPS, min(2000, 200_000 // n))
        started = time.process_time()
        work(flock, number)
        found[name] = (time.process_time() - started) / number
    return found


def _memory(*, peak: bool) -> float:
    """Resident memory in MB, now, which begins a new peak, or at its peak since; the peak so far where none begins."""
    status = Path("/proc/self/status")
    if not status.exists():
        import resource

        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3)
    if not peak:
        Path("/proc/self/clear_refs").write_text("5")
    lines = dict(line.split(":", 1) for line in status.read_text().splitlines())
    return float(lines["VmHWM" if peak else "VmRSS"].split()[0]) * 1.024e-3


if __name__ == "__main__":
    sys.stdout.write(json.dumps(_measure(int(sys.argv[1]))))
