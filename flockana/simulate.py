"""Integrate a law: scipy's adaptive solvers, a fixed-step RK4 for large flocks, or the steps of a discrete law.

Beside the state, ∫ dH/dt is integrated as one more variable, so that every run measures its own error: the residual
of the energy balance is `Trajectory.energy_residual`.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from flockana.checks import FloatArray, ensure_positive, ensure_state, ensure_time_span
from flockana.errors import ArgumentError, UnknownNameError
from flockana.laws.law import DiscreteLaw, Law, ensure_law
from flockana.trajectory import Trajectory

ADAPTIVE = ("DOP853", "RK45", "RK23", "Radau", "BDF", "LSODA")
METHODS = (*ADAPTIVE, "RK4")
_REFRESH = 0.1  # seconds between updates of the progress bar


class Sample(NamedTuple):
    """One instant that is kept."""

    t: float
    q: FloatArray
    p: FloatArray
    u: FloatArray
    extra: dict[str, FloatArray]


@dataclass
class _Tally:
    """What a run did, filled in as it goes, so that an interrupted run can tell."""

    evaluations: int = 0
    steps: int = 0
    status: str = "complete"
    message: str = "reached the end of the time span"

    def fail(self, message: str) -> None:
        self.status, self.message = "failed", message


def simulate(
    law: Law | DiscreteLaw,
    q0: Any,
    p0: Any,
    t_span: Any,
    *,
    method: str = "DOP853",
    rtol: float = 1e-8,
    atol: float = 1e-10,
    dt: float | None = None,
    t_eval: Any = None,
    progress: bool = False,
) -> Trajectory:
    """Integrate q' = p, p' = u(t, q, p) from (q0, p0).

    Ctrl-C ends the run early and returns what was integrated, with status ``"interrupted"``.

    Parameters
    ----------
    law : Law or DiscreteLaw
        What moves the flock. A discrete law brings its own step; method, tolerances and dt do not apply to it.
    q0, p0 : array_like, shape (n, m)
        Initial positions and velocities.
    t_span : (float, float)
        Start and end.
    method : str
        One of scipy's solvers (DOP853, RK45, RK23, Radau, BDF, LSODA), or RK4 with a fixed step.
    rtol, atol : float
        Tolerances of the adaptive solvers, relative and in the state's own units. The default is tight enough that
        energy residuals stay about 1e-6 of the energy turned over in a run; scipy's own 1e-3 is never used.
    dt : float, optional
        Step of RK4 (required there, meaningless elsewhere). The last step is shortened to end on time.
    t_eval : array_like, optional
        Rising times at which to keep the state; by default every step that the integrator takes.
    progress : bool
        Show a progress bar on the terminal.

    Returns
    -------
    Trajectory

    Raises
    ------
    ArgumentError
        On bad input, before anything is integrated.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    >>> run.status, bool(abs(run.energy_residual).max() < 1e-6)
    ('complete', True)
    """
    ensure_law(law)
    q0, p0 = ensure_state(q0, p0)
    law.check_dimension(q0.shape[1])
    law.check_start(q0, p0)
    t_span = ensure_time_span(t_span)
    keep = _check_t_eval(t_eval, t_span)
    tally = _Tally()
    if isinstance(law, DiscreteLaw):
        if dt is not None or method != "DOP853":
            raise ArgumentError("a discrete law brings its own step: expected neither dt nor method")
        samples, name = _discrete(law, q0, p0, t_span, tally), "discrete"
        step = _ensure_step("law.dt", law.dt, t_span)
        keep_samples = samples if keep is None else _nearest(samples, keep, step)
    else:
        _check_method(method, dt)
        name = method
        if method == "RK4":
            keep_samples = _rk4(law, q0, p0, t_span, _ensure_step("dt", dt, t_span), keep, tally)
        else:
            tolerances = ensure_positive("rtol", rtol), ensure_positive("atol", atol)
            keep_samples = _adaptive(law, q0, p0, t_span, method, *tolerances, keep, tally)
    started = time.perf_counter()
    kept = _collect(keep_samples, t_span, tally, progress)
    if not kept:  # ended before the first time to keep: the start at least is known
        kept = [_start(law, q0, p0, t_span[0])]
    extra = {key: np.stack([s.extra[key] for s in kept]) for key in kept[0].extra}
    stats: dict[str, Any] = {"method": name, "steps": tally.steps, "evaluations": tally.evaluations}
    if name == "RK4" or isinstance(law, DiscreteLaw):
        stats["dt"] = law.dt if isinstance(law, DiscreteLaw) else dt
    else:
        stats |= {"rtol": rtol, "atol": atol}
    stats["seconds"] = time.perf_counter() - started
    q, p, u = (np.stack([getattr(s, name) for s in kept]) for name in ("q", "p", "u"))
    return Trajectory(np.array([s.t for s in kept]), q, p, u, law, extra, tally.status, tally.message, stats)


def _ensure_step(name: str, dt: Any, t_span: tuple[float, float]) -> float:
    step, far = ensure_positive(name, dt), max(abs(t) for t in t_span)
    if far + 0.5 * step == far:
        raise ArgumentError(f"{name} = {step:g}: too small to change t = {far:g}; start the clock near t = 0")
    return step


def _start(law: Law | DiscreteLaw, q0: FloatArray, p0: FloatArray, t0: float) -> Sample:
    """The initial state as a sample."""
    if isinstance(law, DiscreteLaw):
        return Sample(t0, q0, p0, np.zeros_like(q0), _copied(law.start(q0, p0)))
    extra = {"work": np.array(0.0)} if _has_energy(law, t0, q0, p0) else {}
    return Sample(t0, q0, p0, law.flow(t0, q0, p0)[0], extra)


def _copied(memory: Mapping[str, FloatArray]) -> dict[str, FloatArray]:
    return {name: np.array(value) for name, value in memory.items()}


def _finite(*values: Any) -> bool:
    return all(bool(np.isfinite(value).all()) for value in values)


def _check_method(method: str, dt: float | None) -> None:
    if method not in METHODS:
        raise UnknownNameError("method", method, METHODS)
    if method == "RK4" and dt is None:
        raise ArgumentError("dt = None: method RK4 needs a fixed step, such as dt=0.005")
    if method != "RK4" and dt is not None:
        raise ArgumentError(f"dt = {dt!r}: {method} chooses its own steps; give t_eval to choose output times")


def _check_t_eval(t_eval: Any, t_span: tuple[float, float]) -> FloatArray | None:
    if t_eval is None:
        return None
    try:
        times = np.atleast_1d(np.asarray(t_eval, dtype=np.float64))
    except (TypeError, ValueError, OverflowError):
        times = np.array([np.nan])
    good = times.ndim == 1 and times.size > 0 and np.isfinite(times).all() and (np.diff(times) > 0.0).all()
    if not good or times[0] < t_span[0] or times[-1] > t_span[1]:
        raise ArgumentError(f"t_eval = {t_eval!r}: expected rising times within t_span = {t_span}")
    return times


def _collect(samples: Iterator[Sample], t_span: tuple[float, float], tally: _Tally, progress: bool) -> list[Sample]:
    """Drain the integrator; on Ctrl-C keep what there is."""
    kept: list[Sample] = []
    with _progress_bar(t_span, enabled=progress) as advance:
        try:
            for sample in samples:
                kept.append(sample)
                advance(sample.t)
        except KeyboardInterrupt:
            until = f"the last sample is at t = {kept[-1].t:g}" if kept else "no sample was reached but the start"
            tally.status, tally.message = "interrupted", f"interrupted: {until}"
    return kept


class _progress_bar:  # noqa: N801  # reads as the context manager it is
    """A rich progress bar over simulated time, or nothing."""

    def __init__(self, t_span: tuple[float, float], *, enabled: bool) -> None:
        self.t_span, self.enabled, self.shown = t_span, enabled, 0.0

    def __enter__(self) -> Callable[[float], None]:
        if not self.enabled:
            return lambda t: None
        from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

        columns = (TextColumn("t = {task.fields[now]:.4g}"), BarColumn(), TimeRemainingColumn())
        self.bar = Progress(*columns, transient=True)
        t0, t1 = self.t_span
        task = self.bar.add_task("", total=t1 - t0, now=t0)
        self.bar.start()

        def advance(t: float) -> None:
            if time.perf_counter() - self.shown > _REFRESH:
                self.bar.update(task, completed=t - t0, now=t)
                self.shown = time.perf_counter()

        return advance

    def __exit__(self, *exc: object) -> None:
        if self.enabled:
            self.bar.stop()


def _has_energy(law: Law, t: float, q: FloatArray, p: FloatArray) -> bool:
    return bool(np.isfinite(law.hamiltonian(t, q, p)))


def _adaptive(
    law: Law,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    method: str,
    rtol: float,
    atol: float,
    keep: FloatArray | None,
    tally: _Tally,
) -> Iterator[Sample]:
    """Step one of scipy's solvers, as `solve_ivp` does, but so that each step is kept as soon as it is made."""
    import scipy.integrate

    shape, size = q0.shape, q0.size
    energetic = _has_energy(law, t_span[0], q0, p0)

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


def _rk4(
    law: Law,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    dt: float,
    keep: FloatArray | None,
    tally: _Tally,
) -> Iterator[Sample]:
    """Classical RK4 on (q, p, work); steps are shortened to land on the times to keep."""
    energetic = _has_energy(law, t_span[0], q0, p0)
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


def _discrete(
    law: DiscreteLaw, q0: FloatArray, p0: FloatArray, t_span: tuple[float, float], tally: _Tally
) -> Iterator[Sample]:
    """Iterate the map; sample k holds the state at t0 + k dt and the input that brought it there."""
    t, q, p, memory = t_span[0], q0, p0, law.start(q0, p0)
    yield Sample(t, q, p, np.zeros_like(q), _copied(memory))
    steps = int(np.floor((t_span[1] - t_span[0]) / law.dt + 1e-9))
    for k in range(1, steps + 1):
        q, p, u, memory = law.step(t, q, p, memory)
        t = t_span[0] + k * law.dt
        tally.steps += 1
        tally.evaluations += 1
        if not _finite(q, p):
            tally.fail(f"the map left the finite numbers at t = {t:g}")
            return
        yield Sample(t, q, p, u, _copied(memory))


def _nearest(samples: Iterator[Sample], keep: FloatArray, dt: float) -> Iterator[Sample]:
    """The steps nearest to the wanted times: between its steps a map has no state."""
    wanted = 0
    for sample in samples:
        while wanted < keep.size and keep[wanted] <= sample.t + 0.5 * dt:
            yield sample
            wanted += 1
            while wanted < keep.size and keep[wanted] <= sample.t + 0.5 * dt:
                wanted += 1  # two wanted times in one step are one sample
