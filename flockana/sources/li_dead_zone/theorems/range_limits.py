"""Decision whether two agents of a run come into range, also between samples."""

from dataclasses import dataclass

import numpy as np

from flockana.kernels.range_crossings import follow_pairs, follow_steps
from flockana.theorems.theorem_toolkit import EPS, Observed, Trajectory

_NEXT = 1.5  # steps: samples of a map that are farther apart have states between them that were not kept


@dataclass(frozen=True)
class RangeEntry:
    """First pair that comes into range, and whether others may."""

    pair: tuple[int, int] | None
    time: float | None
    unsure: bool


def thinned(run: Trajectory) -> bool:
    """Return whether a map made steps between the stored samples."""
    return run.law.is_map and bool((np.diff(run.t) > _NEXT * run.law.dt).any())


def first_entry(seen: Observed, r: float) -> RangeEntry:
    """Return the first pair that comes into range in a run."""
    run = seen.run
    if seen.doubt or len(run.t) == 1:  # nothing was seen to happen
        return RangeEntry(None, None, True)
    pairs = run.n * (run.n - 1) // 2
    was_outside, is_doubtful = np.zeros(pairs, dtype=np.bool_), np.zeros(pairs, dtype=np.bool_)
    noise = 16.0 * EPS * (float(np.abs(run.q).max()) + r)
    if run.law.is_map:
        for k, q in enumerate(run.q):
            pair = follow_steps(q, r, noise, was_outside, is_doubtful)
            if pair[0] >= 0:
                return RangeEntry(pair, float(run.t[k]), True)
        return RangeEntry(None, None, thinned(run) or bool(is_doubtful.any()))
    t, q, p, u, slack = run.path  # its own steps too: an input that jumps at a switch has its other value beside it
    noise += 2.0 * float(slack.max()) if slack is not None else 0.0
    noise_levels = (noise, 2.0 * float(seen.between_error.max()), 2.0 * float(seen.between_speed_error.max()))
    for k in range(len(t) - 1):
        start, end = (q[k], p[k], u[k]), (q[k + 1], p[k + 1], u[k + 1])
        pair = follow_pairs(float(t[k + 1] - t[k]), start, end, r, noise_levels, was_outside, is_doubtful)
        if pair[0] >= 0:
            return RangeEntry(pair, float(t[k + 1]), True)
    return RangeEntry(None, None, bool(is_doubtful.any()))
