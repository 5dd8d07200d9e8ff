"""The steps of a map."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray
from flockana.dynamics.sample import Samples, Tally, copied
from flockana.laws.discrete import DiscreteLaw

IndexArray = npt.NDArray[np.int64]
_NUMBERS = 6_000_000  # kept of the steps made at once, at most


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
    law: DiscreteLaw,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    keep: FloatArray | None,
    tally: Tally,
) -> Iterator[Samples]:
    """Iterate the map; sample k holds the state at t0 + k dt and the input that brought it there.

    Samples come as many at once as steps are made at once: one by one they would cost more than a compiled step. Of
    times to keep the nearest steps are given, each once: between its steps a map has no state.
    """
    q, p, memory, t0, dt = q0, p0, law.start(q0, p0), t_span[0], law.dt
    steps = count_steps(*t_span, dt, np.floor)
    if keep is None or _nearest(np.array([t0]), keep, dt).size:
        extra = {name: values[None] for name, values in copied(memory).items()}
        yield Samples(np.array([t0]), q[None], p[None], np.zeros((1, *q.shape)), extra)
    at_once = max(1, min(law.steps_at_once, _NUMBERS // (3 * q0.size)))
    for first in range(0, steps, at_once):
        some = min(at_once, steps - first)
        qs, ps, us, series = law.iterate(t0 + first * dt, q, p, memory, some)
        known = np.isfinite(qs).all(axis=(1, 2)) & np.isfinite(ps).all(axis=(1, 2))
        good = some if known.all() else int(np.argmin(known))
        times = t0 + np.arange(first, first + good + 1) * dt  # with the step before: what is nearest to it is done
        wanted = np.arange(1, good + 1) if keep is None else _nearest(times, keep, dt)
        wanted = wanted[wanted > 0]
        if wanted.size:
            # of all steps a view, of some a copy: the others are let go
            at = slice(0, good) if wanted.size == good else wanted - 1
            yield Samples(times[wanted], qs[at], ps[at], us[at], {name: values[at] for name, values in series.items()})
        tally.steps, tally.evaluations = tally.steps + good, tally.evaluations + good
        if good < some:
            tally.fail(f"the map left the finite numbers at t = {t0 + (first + good + 1) * dt:g}")
            return
        # a copy: a law may change its memory in place
        q, p, memory = qs[-1], ps[-1], copied({name: values[-1] for name, values in series.items()})


def _nearest(times: npt.NDArray[np.floating], keep: FloatArray, dt: float) -> IndexArray:
    """Which steps are nearest to a time to keep, each once; of two as near the earlier."""
    nearest = np.searchsorted(times + 0.5 * dt, keep)
    return np.unique(nearest[nearest < times.size])
