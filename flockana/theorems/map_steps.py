"""Consistency of a map's run with the map, checked at some samples."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.laws.discrete import DiscreteLaw
from flockana.theorems.toolkit import FloatArray, Trajectory

SAME = 1e-8  # of the largest number: other machine code steps to 1e-13, another law does not
SLACK = 100.0  # how often what a nudge grows to a sample may be off: rounding grows alike where the map is chaotic
_NUDGE = 1e-13  # of positions: more than other machine code rounds in a step
_SPREAD = 12  # intervals that are made again


def ensure_steps_of_map(run: Trajectory) -> None:
    """Raise unless the map leads from sample to sample, by some intervals from the first to the last."""
    steps = np.maximum(np.rint(np.diff(run.t) / run.law.dt), 1.0).astype(np.int64).tolist()
    for k in sorted({int(k) for k in np.linspace(0, len(steps) - 1, min(_SPREAD, len(steps)))}):
        _ensure_next_step(run, k, steps[k])


def _ensure_next_step(run: Trajectory, k: int, steps: int) -> None:
    """Raise unless the map leads from sample k to the next, beyond what rounding may grow to over several steps."""
    for name, off, difference in _differences(run, k, steps):
        if not (off <= SAME or (steps > 1 and off <= SAME + SLACK * _growth(run, k, steps, name))):
            raise ArgumentError(
                f"{name} at t = {run.t[k + 1]:g} is off by {difference:.3g} from where {run.law.title} leads "
                f"from the sample at t = {run.t[k]:g}: expected a law that is the same function each time"
            )


def _differences(run: Trajectory, k: int, steps: int) -> Iterator[tuple[str, float, float]]:
    """Return (name, relative error, error) of each series at the sample after sample k."""
    scales = run.scales
    least = {"q": scales.length, "p": scales.speed, "u": scales.force}
    for name, values in _recompute(run, k, steps, 0.0).items():
        sample = (getattr(run, name) if name in least else run.extra[name])[k + 1]
        size = least.get(name, 0.0) + float(np.abs(values).max(initial=0.0))
        same = (sample == values) | (np.isnan(sample) & np.isnan(values))
        difference = float(np.abs(sample - values).max(where=~same, initial=0.0))
        yield name, difference / size if size else difference, difference


def _growth(run: Trajectory, k: int, steps: int, name: str) -> float:
    """Return the relative change of a series over the interval when the positions of sample k are perturbed."""
    exact, nudged = (_recompute(run, k, steps, nudge)[name] for nudge in (0.0, _NUDGE))
    size = float(np.abs(exact).max(initial=0.0))
    return float(np.abs(nudged - exact).max(initial=0.0)) / size if size else 0.0


def _recompute(run: Trajectory, k: int, steps: int, nudge: float) -> dict[str, FloatArray]:
    """Return q, p, u and the map's memory after some steps recomputed from sample k."""
    law: DiscreteLaw = run.law
    q, p, t = run.q[k] * (1.0 + nudge), run.p[k].copy(), float(run.t[k])
    memory: Any = {name: series[k].copy() for name, series in run.extra.items()}
    found = law.visit(t + law.dt * np.arange(float(steps)), q, p, memory, np.array([steps]))
    series = dict(zip("qpu", found[:3], strict=True)) | dict(found[3])
    return {name: np.asarray(values[-1], float) for name, values in series.items()}
