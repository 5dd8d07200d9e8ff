"""The steps of a map."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.sample import Sample, Tally, copied
from flockana.laws.discrete import DiscreteLaw


def count_steps(start: float, stop: float, dt: float, rounded: Callable[[float], float] = np.ceil) -> int:
    """How many steps of dt it takes between two times; the times' own rounding makes none more or less.

    Examples
    --------
    >>> count_steps(0.0, 0.3, 0.1), count_steps(1e6, 1e6 + 0.3, 0.1), count_steps(0.0, 0.31, 0.1)
    (3, 3, 4)
    """
    slack = 4.0 * float(np.spacing(max(abs(start), abs(stop), stop - start)))
    return int(rounded((stop - start + (slack if rounded is np.floor else -slack)) / dt))


def discrete(
    law: DiscreteLaw, q0: FloatArray, p0: FloatArray, t_span: tuple[float, float], tally: Tally
) -> Iterator[Sample]:
    """Iterate the map; sample k holds the state at t0 + k dt and the input that brought it there."""
    q, p, memory = q0, p0, law.start(q0, p0)
    yield Sample(t_span[0], q, p, np.zeros_like(q), copied(memory))
    steps = count_steps(*t_span, law.dt, np.floor)
    for first in range(0, steps, law.steps_at_once):
        some = min(law.steps_at_once, steps - first)
        qs, ps, us, series = law.iterate(t_span[0] + first * law.dt, q, p, memory, some)
        known = np.logical_and(np.isfinite(qs).all(axis=(1, 2)), np.isfinite(ps).all(axis=(1, 2)))
        for k in range(some):
            t = t_span[0] + (first + k + 1) * law.dt
            tally.steps += 1
            tally.evaluations += 1
            if not known[k]:
                tally.fail(f"the map left the finite numbers at t = {t:g}")
                return
            yield Sample(t, qs[k], ps[k], us[k], {name: values[k] for name, values in series.items()})
        # a copy: a law may change its memory in place
        q, p, memory = qs[-1], ps[-1], copied({name: values[-1] for name, values in series.items()})


def nearest(samples: Iterator[Sample], keep: FloatArray, dt: float) -> Iterator[Sample]:
    """The steps nearest to the wanted times: between its steps a map has no state."""
    wanted = 0
    for sample in samples:
        while wanted < keep.size and keep[wanted] <= sample.t + 0.5 * dt:
            yield sample
            wanted += 1
            while wanted < keep.size and keep[wanted] <= sample.t + 0.5 * dt:
                wanted += 1  # two wanted times in one step are one sample
