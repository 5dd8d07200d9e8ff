"""How a law is stepped: scipy's adaptive solvers, classical RK4, the steps of a map; each yields samples as it goes.

Beside the state, ∫ dH/dt is integrated as one more variable.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from flockana.checks import FloatArray
from flockana.errors import ArgumentError
from flockana.laws.law import DiscreteLaw, Law


class Sample(NamedTuple):
    """One instant that is kept."""

    t: float
    q: FloatArray
    p: FloatArray
    u: FloatArray
    extra: dict[str, FloatArray]


@dataclass
class Tally:
    """What a run did, filled in as it goes, so that an interrupted run can tell.

    Parameters
    ----------
    evaluations, steps : int
        Counts of right-hand sides and of steps.
    status, message : str
        As in `Trajectory`.
    notes : dict
        What else an integrator has to tell, for `Trajectory.stats`.
    """

    evaluations: int = 0
    steps: int = 0
    status: str = "complete"
    message: str = "reached the end of the time span"
    notes: dict[str, Any] = field(default_factory=dict)

    def fail(self, message: str) -> None:
        """Note that the run ended early, and why.

        Parameters
        ----------
        message : str
            In words.
        """
        self.status, self.message = "failed", message


def start_sample(law: Law | DiscreteLaw, q0: FloatArray, p0: FloatArray, t0: float) -> Sample:
    """The initial state as a sample.

    Parameters
    ----------
    law : Law or DiscreteLaw
        What moves the flock.
    q0, p0 : ndarray, shape (n, m)
        Start.
    t0 : float
        Time of the start.
    """
    if isinstance(law, DiscreteLaw):
        return Sample(t0, q0, p0, np.zeros_like(q0), _copied(law.start(q0, p0)))
    extra = {"work": np.array(0.0)} if has_energy(law, t0, q0, p0) else {}
    return Sample(t0, q0, p0, law.flow(t0, q0, p0)[0], extra)


def _copied(memory: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    return {name: np.array(value) for name, value in memory.items()}


def _finite(*values: Any) -> bool:
    return all(bool(np.isfinite(value).all()) for value in values)


def has_energy(law: Law, t: float, q: FloatArray, p: FloatArray) -> bool:
    """Whether a law has an energy, so that its work can be integrated.

    Parameters
    ----------
    law : Law
        The law.
    t : float
        Time.
    q, p : ndarray, shape (n, m)
        A state.
    """
    return bool(np.isfinite(law.hamiltonian(t, q, p)))


def adaptive(
    law: Law,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    method: str,
    rtol: float,
    atol: float,
    keep: FloatArray | None,
    tally: Tally,
) -> Iterator[Sample]:
    """Step one of scipy's solvers, as `solve_ivp` does, but so that each step is kept as soon as it is made.

    Parameters
    ----------
    law : Law
        What moves the flock.
    q0, p0 : ndarray, shape (n, m)
        Start.
    t_span : (float, float)
        Start and end.
    method : str
        One of scipy's solvers.
    rtol, atol : float
        Its tolerances.
    keep : ndarray or None
        Times to keep; every step if None.
    tally : Tally
        Filled in on the way.
    """
    import scipy.integrate

    shape, size = q0.shape, q0.size
    energetic = has_energy(law, t_span[0], q0, p0)

    def rhs(t: float, y: FloatArray) -> FloatArray:
        p = y[size : 2 * size]
        u, rate = law.flow(t, y[:size].reshape(shape), p.reshape(shape))
        tally.evaluations += 1
        if method == "LSODA" and not _finite(u, rate if energetic else 0.0):  # it would try to step over it for ever
            raise FloatingPointError(f"the law's acceleration is not finite at t = {t:g}")
        return np.concatenate([p, u.ravel(), [rate] if energetic else []])

    def sample(t: float, y: FloatArray) -> Sample:
        q, p = y[:size].reshape(shape).copy(), y[size : 2 * size].reshape(shape).copy()
        extra = {"work": np.array(y[-1])} if energetic else {}
        return Sample(t, q, p, law.flow(t, q, p)[0], extra)

    y0 = np.concatenate([q0.ravel(), p0.ravel(), [0.0] if energetic else []])
    atols = np.full(y0.size, atol)
    if energetic:  # the work is measured against the energy it is the change of, not against zero at the start
        atols[-1] = max(atol, rtol * abs(law.hamiltonian(t_span[0], q0, p0)))
    wanted = 0
    if keep is None or keep[0] == t_span[0]:
        wanted = 1
        yield sample(t_span[0], y0)
    if not _finite(
        *law.flow(t_span[0], q0, p0)[: 2 if energetic else 1]
    ):  # scipy's first step would look for its length for ever
        tally.fail(f"the law's acceleration is not finite at the start, t = {t_span[0]:g}")
        return
    solver = getattr(scipy.integrate, method)(rhs, t_span[0], y0, t_span[1], rtol=rtol, atol=atols)
    while solver.status == "running":
        try:
            message = solver.step()
        except (ValueError, FloatingPointError, np.linalg.LinAlgError) as error:  # implicit solvers raise on NaN
            if isinstance(error, ArgumentError):
                raise
            message, solver.status = str(error), "failed"
        if solver.status == "failed" or not _finite(solver.y):
            tally.fail(f"{method} gave up at t = {solver.t:g}: {message or 'the state is no longer finite'}")
            return
        tally.steps += 1
        if keep is None:
            yield sample(solver.t, solver.y)
            continue
        interpolant = None
        while wanted < keep.size and keep[wanted] <= solver.t:
            interpolant = interpolant or solver.dense_output()
            yield sample(keep[wanted], solver.y if keep[wanted] == solver.t else interpolant(keep[wanted]))
            wanted += 1


def rk4(
    law: Law,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    dt: float,
    keep: FloatArray | None,
    tally: Tally,
) -> Iterator[Sample]:
    """Classical RK4 on (q, p, work); steps are shortened to land on the times to keep.

    Parameters
    ----------
    law : Law
        What moves the flock.
    q0, p0 : ndarray, shape (n, m)
        Start.
    t_span : (float, float)
        Start and end.
    dt : float
        Step.
    keep : ndarray or None
        Times to keep; every step if None.
    tally : Tally
        Filled in on the way.
    """
    energetic = has_energy(law, t_span[0], q0, p0)
    t, q, p, work = t_span[0], q0.copy(), p0.copy(), 0.0
    u, rate = law.flow(t, q, p)
    tally.evaluations += 1

    def sample() -> Sample:
        return Sample(t, q, p, u, {"work": np.array(work)} if energetic else {})

    for stop in _grid(t_span, dt) if keep is None else keep:
        while t < stop:
            remaining = stop - t
            # a step is split evenly rather than ending on a sliver, which would lose the order for nothing
            h = remaining / max(1.0, np.ceil(remaining / dt - 1e-9))
            p2 = p + 0.5 * h * u
            u2, rate2 = law.flow(t + 0.5 * h, q + 0.5 * h * p, p2)
            p3 = p + 0.5 * h * u2
            u3, rate3 = law.flow(t + 0.5 * h, q + 0.5 * h * p2, p3)
            p4 = p + h * u3
            u4, rate4 = law.flow(t + h, q + h * p3, p4)
            q = q + h / 6.0 * (p + 2.0 * (p2 + p3) + p4)
            p = p + h / 6.0 * (u + 2.0 * (u2 + u3) + u4)
            work += h / 6.0 * (rate + 2.0 * (rate2 + rate3) + rate4)
            t = stop if h == remaining else t + h
            u, rate = law.flow(t, q, p)
            tally.steps += 1
            tally.evaluations += 4
            if not _finite(q, p, u):
                tally.fail(f"RK4 left the finite numbers at t = {t:g}: reduce dt = {dt:g}")
                return
        yield sample()


def _grid(t_span: tuple[float, float], dt: float) -> Iterator[float]:
    for k in range(int(np.ceil((t_span[1] - t_span[0]) / dt - 1e-9))):
        yield t_span[0] + k * dt
    yield t_span[1]


def discrete(
    law: DiscreteLaw, q0: FloatArray, p0: FloatArray, t_span: tuple[float, float], tally: Tally
) -> Iterator[Sample]:
    """Iterate the map; sample k holds the state at t0 + k dt and the input that brought it there.

    Parameters
    ----------
    law : DiscreteLaw
        The map.
    q0, p0 : ndarray, shape (n, m)
        Start.
    t_span : (float, float)
        Start and end.
    tally : Tally
        Filled in on the way.
    """
    q, p, memory = q0, p0, law.start(q0, p0)
    yield Sample(t_span[0], q, p, np.zeros_like(q), _copied(memory))
    steps = int(np.floor((t_span[1] - t_span[0]) / law.dt + 1e-9))
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
        q, p, memory = qs[-1], ps[-1], _copied({name: values[-1] for name, values in series.items()})


def nearest(samples: Iterator[Sample], keep: FloatArray, dt: float) -> Iterator[Sample]:
    """The steps nearest to the wanted times: between its steps a map has no state.

    Parameters
    ----------
    samples : iterator of Sample
        Steps in order.
    keep : ndarray
        Rising times.
    dt : float
        Step of the map.
    """
    wanted = 0
    for sample in samples:
        while wanted < keep.size and keep[wanted] <= sample.t + 0.5 * dt:
            yield sample
            wanted += 1
            while wanted < keep.size and keep[wanted] <= sample.t + 0.5 * dt:
                wanted += 1  # two wanted times in one step are one sample
