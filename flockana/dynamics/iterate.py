"""The steps of a map."""

from collections.abc import Callable, Iterator

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray
from flockana.dynamics.pace import Pace
from flockana.dynamics.sample import Samples, Tally, copied, finite
from flockana.laws.discrete import DiscreteLaw, IndexArray, States
from flockana.laws.law import Arrays

_NUMBERS = 6_000_000  # kept of the steps made at once, at most
_BEGIN = 16  # steps made at once at first


def count_steps(start: float, stop: float, dt: float, rounded: Callable[[float], float] = np.ceil) -> int:
    """Return the number of steps of dt between two times, whatever the rounding of the times."""
    slack = 4.0 * float(np.spacing(max(abs(start), abs(stop), stop - start)))
    return int(rounded((stop - start + (slack if rounded is np.floor else -slack)) / dt))


def discrete(
    law: DiscreteLaw, q0: FloatArray, p0: FloatArray, t_span: tuple[float, float], keep: FloatArray | None, tally: Tally
) -> Iterator[Samples]:
    """Iterate the map; sample k holds the state at t0 + k dt and the input that brought it there."""
    # Samples come as many at once as steps are made at once: one by one they would cost more than a compiled step. Of
    # times to keep the nearest steps are given, each once: between its steps a map has no state.
    q, p, memory, t0, dt = q0, p0, law.start(q0, p0), t_span[0], law.dt
    steps, wanted = count_steps(*t_span, dt, np.floor), wanted_steps(law, t_span, keep)
    if wanted is None or 0 in wanted:
        extra = {name: values[None] for name, values in copied(memory).items() if name not in law.private}
        yield Samples(np.array([t0]), q[None], p[None], np.zeros((1, *q.shape)), extra)
    pace, first, last = Pace(min(_BEGIN, 20_000 // q0.size), min(law.steps_at_once, _NUMBERS // (3 * q0.size))), 0, 0
    while last < steps:
        first, last = last, min(last + pace.steps, steps)
        own = np.arange(first + 1, last + 1)
        if wanted is not None:
            own = wanted[slice(*np.searchsorted(wanted, [first + 1, last + 1]))]
        times = t0 + np.arange(float(first), float(last)) * dt  # so a step hangs on its own time, and on no block's
        with pace:
            made, rows, states = _chunk(law, times, q, p, memory, own - first)
        qs, ps, us, series = states
        good = made.size
        if not finite(qs, ps):
            good = int(np.argmin(np.isfinite(qs).all(axis=(1, 2)) & np.isfinite(ps).all(axis=(1, 2))))
        kept = rows[rows < good]
        if kept.size:
            # of all steps a view, of some a copy: the others are let go
            at = slice(0, good) if kept.size == made.size else kept
            some = {name: values[at] for name, values in series.items() if name not in law.private}
            t = np.minimum(t0 + (made[at] + first) * dt, t_span[1])  # which the last step may pass by its rounding
            yield Samples(t, qs[at], ps[at], us[at], some)
        done = int(made[good - 1]) if good else 0
        tally.steps, tally.evaluations = tally.steps + done, tally.evaluations + done
        if good < made.size:
            tally.fail(f"the map left the finite numbers at t = {t0 + (first + good + 1) * dt:g}")
            return
        # a copy: a law may change its memory in place
        q, p, memory = qs[-1], ps[-1], copied({name: values[-1] for name, values in series.items()})


def wanted_steps(law: DiscreteLaw, t_span: tuple[float, float], keep: FloatArray | None) -> IndexArray | None:
    """Return indices of the steps nearest to the times to keep, each once; None to keep all."""
    return None if keep is None else _nearest(t_span[0], law.dt, count_steps(*t_span, law.dt, np.floor), keep)


def _chunk(
    law: DiscreteLaw, times: FloatArray, q: FloatArray, p: FloatArray, memory: Arrays, own: IndexArray
) -> tuple[IndexArray, IndexArray, States]:
    """Return (indices of steps, positions of the wanted ones among them, states after them).

    They are its own and the last; all where the map has left the finite numbers: which step was the first?
    """
    steps = len(times)
    few = own if own.size and own[-1] == steps else np.append(own, steps)
    states = law.visit(times, q, p, copied(memory), few)
    if few.size == steps or finite(*states[:2]):
        return few, np.arange(own.size), states
    return np.arange(1, steps + 1), own - 1, law.visit(times, q, p, memory, np.arange(1, steps + 1))


def _nearest(t0: float, dt: float, steps: int, keep: FloatArray) -> IndexArray:
    """Return indices of the steps nearest to the times to keep, each once; the earlier of two as near."""
    k = np.maximum(np.ceil((keep - t0) / dt - 0.5), 0.0).astype(np.int64)

    def before(steps: IndexArray) -> npt.NDArray[np.bool_]:
        return np.asarray(t0 + steps * dt + 0.5 * dt < keep)

    while (late := before(k)).any():  # a quotient may round to the step beside
        k += late
    while (early := (k > 0) & ~before(k - 1)).any():
        k -= early
    return np.unique(k[k <= steps])
