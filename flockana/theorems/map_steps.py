"""Whether the samples of a run of a map are where the map leads: from sample to sample, it is made again."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.dynamics.simulate import AS_SIMULATED
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.discrete import DiscreteLaw, IndexArray

SAME = 1e-8  # of the largest number: other machine code steps to 1e-13, another law or an edit does not
SLACK = 100.0  # how often what a nudge grows to a sample may be off: rounding grows alike where the map is chaotic
_NUDGE = 1e-13  # of positions: more than other machine code rounds in a step
_SPREAD = 12  # intervals of a run that was not edited: enough to show a law that is another function each time
_AT_ONCE = 64  # intervals made in one go, and steps of a law that cannot leave out any


def as_simulated(run: Trajectory) -> bool:
    """Whether the samples have the digest that `simulate` noted: the run was not edited."""
    return run.remembered(AS_SIMULATED, lambda: b"") == run.samples_digest()


def ensure_steps_of_map(run: Trajectory) -> None:
    """Raise unless the map leads from every sample to the next; of a run as `simulate` returned it, from some."""
    steps = _steps_between(run)
    for name in run.law.start(run.q[0], run.p[0]):
        if name not in run.extra:
            raise ArgumentError(
                f"the run has no extra[{name!r}], which {type(run.law).__name__} remembers: expected a run as simulate "
                "returned it"
            )
    if as_simulated(run):
        for k in sorted({int(k) for k in np.linspace(0, len(steps) - 1, min(_SPREAD, len(steps)))}):
            _ensure_leads_on(run, k, steps)
        return
    for begin in range(0, len(steps), _AT_ONCE):
        block = steps[begin : begin + _AT_ONCE]
        if all(off <= SAME for _, off, _ in _differences(run, begin, block)):
            continue
        for k in range(begin, begin + len(block)):  # in so many steps the rounding of other machine code may grow
            _ensure_leads_on(run, k, steps)


def _steps_between(run: Trajectory) -> IndexArray:
    """How many steps there are from sample to sample."""
    dt = run.law.dt
    gaps = np.diff(run.t) / dt
    steps: IndexArray = np.maximum(np.rint(gaps), 1.0).astype(np.int64)
    off = ~(np.abs(gaps - steps) <= 1e-6 + 8.0 * np.spacing(np.abs(run.t).max()) / dt)
    if off.any():
        k = int(np.argmax(off))
        raise ArgumentError(
            f"t = {run.t[k]:.9g} and {run.t[k + 1]:.9g} are {gaps[k]:.9g} steps of {dt:g} apart, and between its steps "
            "a map has no state: expected a run as simulate returned it; was it edited, or is it of another law?"
        )
    return steps


def _ensure_leads_on(run: Trajectory, k: int, steps: IndexArray) -> None:
    """Raise unless the map leads from sample k to the next, beyond what rounding may grow to over several steps."""
    one = steps[k : k + 1]
    for name, off, difference in _differences(run, k, one):
        if not (off <= SAME or (one[0] > 1 and off <= SAME + SLACK * _growth(run, k, one, name))):
            raise ArgumentError(
                f"{name} at t = {run.t[k + 1]:g} is off by {difference:.3g} from where {type(run.law).__name__} leads "
                f"from the sample at t = {run.t[k]:g}: expected a run as simulate returned it; was it edited, or is it "
                "of another law?"
            )


def _differences(run: Trajectory, begin: int, steps: IndexArray) -> Iterator[tuple[str, float, float]]:
    """Of each series (name, how far the samples after sample `begin` are off over its size, and how far)."""
    made, scales = _made_again(run, begin, steps, 0.0), run.scales
    least = {"q": scales.length, "p": scales.speed, "u": scales.force}
    at = slice(begin + 1, begin + 1 + len(steps))
    for name, values in made.items():
        samples = np.asarray((getattr(run, name) if name in least else run.extra[name])[at], float)
        size = least.get(name, 0.0) + float(np.abs(values).max(initial=0.0))
        same = (samples == values) | (np.isnan(samples) & np.isnan(values))
        difference = float(np.abs(samples - values).max(where=~same, initial=0.0))
        yield name, difference / size if size else difference, difference


def _growth(run: Trajectory, k: int, steps: IndexArray, name: str) -> float:
    """What a nudge of the positions of sample k changes of a series over the interval, over its size."""
    exact, nudged = (_made_again(run, k, steps, nudge)[name] for nudge in (0.0, _NUDGE))
    size = float(np.abs(exact).max(initial=0.0))
    return float(np.abs(nudged - exact).max(initial=0.0)) / size if size else 0.0


def _made_again(run: Trajectory, k: int, steps: IndexArray, nudge: float) -> dict[str, FloatArray]:
    """q, p, u and what the map remembers after so many steps from sample k, and so many from there, and so on."""
    law: DiscreteLaw = run.law
    q, p, t, stops = run.q[k] * (1.0 + nudge), run.p[k].copy(), float(run.t[k]), np.cumsum(steps)
    memory: Any = {name: series[k].copy() for name, series in run.extra.items()}
    found = law.visit(t, q, p, memory, stops)
    if found is not None:
        return dict(zip("qpu", found[:3], strict=True)) | {
            x: np.asarray(series, float) for x, series in found[3].items()
        }
    rows, done = [], 0
    for stop in stops.tolist():
        while done < stop:
            count = min(stop - done, _AT_ONCE)
            qs, ps, us, series = law.iterate(t + done * law.dt, q, p, memory, count)
            q, p, u, done = qs[-1], ps[-1], us[-1], done + count
            memory = {name: np.array(values[-1]) for name, values in series.items()}
        rows.append({"q": q, "p": p, "u": u} | memory)
    return {name: np.stack([np.asarray(row[name], float) for row in rows]) for name in rows[0]}
