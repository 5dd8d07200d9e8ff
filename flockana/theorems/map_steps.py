"""Runs of maps: consistency with the map at some samples, and the known length of their orbits.

Where a scheme steps a law that is known in balls, its exact orbit is enclosed (`flockana.certified.map_orbits`), and
judged instead of the run's own numbers. Elsewhere two orbits from starts nudged to both sides are an estimate of its
error: nothing is known after they part.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.discrete import DiscreteLaw
from flockana.theorems.second_runs import DOUBT, Errors, Pair, doubt_about, unbounded_errors

SAME = 1e-8  # of the largest number: other machine code steps to 1e-13, another law does not
SLACK = 100.0  # how often what a nudge grows to a sample may be off: rounding grows alike where the map is chaotic
_NUDGE = 1e-13  # of a state: a thousand times what a step rounds
_PARTED = 1e-6  # of the law's length and speed, at which two orbits have parted
_SPREAD = 12  # intervals that are made again


def ensure_steps_of_map(run: Trajectory) -> None:
    """Raise unless the map reproduces selected sample intervals, from the first to the last."""
    steps = np.maximum(np.rint(np.diff(run.t) / run.law.dt), 1.0).astype(np.int64).tolist()
    for k in sorted({int(k) for k in np.linspace(0, len(steps) - 1, min(_SPREAD, len(steps)))}):
        _ensure_next_step(run, k, steps[k])


def _ensure_next_step(run: Trajectory, k: int, steps: int) -> None:
    """Raise unless the map leads from sample k to the next, within rounding grown over several steps."""
    for name, deviation, difference in _differences(run, k, steps):
        if not (deviation <= SAME or (steps > 1 and deviation <= SAME + SLACK * _growth(run, k, steps, name))):
            raise ArgumentError(
                f"{name} at t = {run.t[k + 1]:g} is off by {difference:.3g} from where {type(run.law).__name__} leads "
                f"from the sample at t = {run.t[k]:g}: expected a law that is the same function each time"
            )


def _differences(run: Trajectory, k: int, steps: int) -> Iterator[tuple[str, float, float]]:
    """Yield name, relative and absolute difference of each recomputed series, at the sample after k."""
    scales = run.scales
    floors = {"q": scales.length, "p": scales.speed, "u": scales.force}
    for name, values in _recompute(run, k, steps, 0.0).items():
        sample = (getattr(run, name) if name in floors else run.extra[name])[k + 1]
        magnitude = floors.get(name, 0.0) + float(np.abs(values).max(initial=0.0))
        is_same = (sample == values) | (np.isnan(sample) & np.isnan(values))
        difference = float(np.abs(sample - values).max(where=~is_same, initial=0.0))
        yield name, difference / magnitude if magnitude else difference, difference


def _growth(run: Trajectory, k: int, steps: int, name: str) -> float:
    """Return the relative change of a series over the interval when the positions of sample k are perturbed."""
    exact, nudged_result = (_recompute(run, k, steps, nudge)[name] for nudge in (0.0, _NUDGE))
    magnitude = float(np.abs(exact).max(initial=0.0))
    return float(np.abs(nudged_result - exact).max(initial=0.0)) / magnitude if magnitude else 0.0


def paired_orbit(run: Trajectory) -> Pair:
    """Return a map's run with errors, from its orbit in balls or from perturbed starts."""
    from flockana.certified.map_orbits import enclose_orbit, has_ball_orbit

    if doubt := doubt_about(run):
        return Pair(run, run, unbounded_errors(run), doubt)
    steps = np.rint((run.t - run.t[0]) / run.law.dt).astype(np.int64)
    memory, missing = dict(run.law.start(run.q[0], run.p[0])), set(run.law.private)
    if missing & memory.keys():
        return Pair(run, run, unbounded_errors(run), f"a run does not hold the map's {', '.join(sorted(missing))}")
    pairs = [_nudged_orbits(run, steps, memory)]
    if has_ball_orbit(run.law):
        balls = enclose_orbit(run.law, float(run.t[0]), run.q[0], run.p[0], steps.tolist())
        is_known = np.arange(len(steps)) < balls.known
        q, p = (np.where(is_known[:, None, None], x, y) for x, y in ((balls.q, run.q), (balls.p, run.p)))
        off = [np.where(is_known[:, None], lengths(x), np.inf) for x in (balls.q_off, balls.p_off)]
        best_run = replace(run, q=q, p=p)
        beside = replace(run, q=np.nextafter(q, np.inf), p=np.nextafter(p, np.inf))
        pairs.append(Pair(best_run, beside, _known_errors(run.t, off[0], off[1]), enclosed=balls.known == len(steps)))
    return max(pairs, key=lambda each: (int(np.isfinite(each.errors.shape).all(axis=1).sum()), each.enclosed))


def _nudged_orbits(run: Trajectory, steps: Any, memory: Any) -> Pair:
    """Return a map's run with two orbits from perturbed starts; unknown after the orbits separate."""
    begins = all(np.array_equal(memory[name], run.extra[name][0]) for name in memory)
    rng, scales, orbits = np.random.default_rng(0), run.scales, []
    signs = [rng.choice([-1.0, 1.0], size=run.q[0].shape) for _ in range(2)]
    with np.errstate(all="ignore"):
        for way in (1.0, -1.0):
            q = run.q[0] + way * _NUDGE * max(float(np.abs(run.q[0]).max()), scales.length) * signs[0]
            p = run.p[0] + way * _NUDGE * max(float(np.abs(run.p[0]).max()), scales.speed) * signs[1]
            previous_memory = run.law.start(q, p) if begins else {key: run.extra[key][0].copy() for key in memory}
            states = _visited(
                run.law, float(run.t[0]) + run.law.dt * np.arange(float(steps[-1])), q, p, previous_memory, steps[1:]
            )
            extra_series = {key: np.concatenate([run.extra[key][:1], states[3][key]]) for key in run.extra}
            qs, ps, us = (np.concatenate([getattr(run, x)[:1], y]) for x, y in zip("qpu", states[:3], strict=True))
            orbits.append(replace(run, q=qs, p=ps, u=us, extra=extra_series))
        q, p = (
            DOUBT * np.max([lengths(getattr(each, name) - getattr(run, name)) for each in orbits], axis=0)
            for name in "qp"
        )
    return Pair(run, orbits[0], _known_errors(run.t, q, p, scales.length, scales.speed))


def _visited(law: DiscreteLaw, times: FloatArray, q: FloatArray, p: FloatArray, memory: Any, wanted: Any) -> Any:
    """Return a map's states after selected numbers of steps, computed in blocks."""
    blocks: list[Any] = []
    for first in range(0, len(times), law.steps_at_once):
        rows = wanted[(wanted > first) & (wanted <= first + law.steps_at_once)] - first
        count = min(law.steps_at_once, len(times) - first)
        *samples, next_memory = law.visit(times[first : first + count], q, p, memory, np.union1d(rows, [count]))
        q, p, memory = samples[0][-1], samples[1][-1], {name: each[-1].copy() for name, each in next_memory.items()}
        blocks.append(
            [*(each[: len(rows)] for each in samples), {name: each[: len(rows)] for name, each in next_memory.items()}]
        )
    joined_parts = [np.concatenate([block[k] for block in blocks]) for k in range(3)]
    return (*joined_parts, {name: np.concatenate([block[3][name] for block in blocks]) for name in memory})


def _known_errors(t: FloatArray, q: FloatArray, p: FloatArray, length: float = 1.0, speed: float = 1.0) -> Errors:
    """Return half widths of a map's run, infinite from the first separation of perturbed orbits on."""
    is_close = ((q <= _PARTED * length) & (p <= _PARTED * speed)).all(axis=1)
    unknown = ~np.logical_and.accumulate(is_close)
    q, p = (np.where(unknown[:, None], np.inf, x) for x in (q, p))
    q_c, p_c = q.max(axis=1), p.max(axis=1)
    return Errors(t, q + q_c[:, None], p + p_c[:, None], q_c, p_c)


def _recompute(run: Trajectory, k: int, steps: int, nudge: float) -> dict[str, FloatArray]:
    """Return q, p, u and the map's memory after some steps recomputed from sample k."""
    memory = {name: series[k].copy() for name, series in run.extra.items()}
    start = run.q[k] * (1.0 + nudge), run.p[k].copy()
    times = float(run.t[k]) + run.law.dt * np.arange(float(steps))
    samples = run.law.visit(times, *start, memory, np.array([steps]))
    series = dict(zip("qpu", samples[:3], strict=True)) | dict(samples[3])
    return {name: np.asarray(values[-1], float) for name, values in series.items()}
