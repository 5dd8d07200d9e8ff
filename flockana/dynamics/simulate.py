"""Integrate a law with a solver, or make the steps of a map.

Beside the state, ∫ dH/dt is integrated as one more variable, so that every run measures its own error: the residual
of the energy balance is `Trajectory.energy_residual`.
"""

import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.integrity_seals import sealed
from flockana.base.interrupts import restore_interrupts
from flockana.base.progress import progress_bar
from flockana.base.value_checks import (
    FloatArray,
    TimeSpan,
    ensure_fits,
    ensure_positive,
    ensure_state,
    ensure_time_span,
    real_array,
)
from flockana.dynamics.driver import drive, integrator_of
from flockana.dynamics.error_tolerances import Control, ensure_atol, error_floor
from flockana.dynamics.first_evaluation import first_call
from flockana.dynamics.map_stepper import MapStepper, count_steps
from flockana.dynamics.moving_frame import Plan
from flockana.dynamics.run_samples import Sample, Samples, Start, Tally
from flockana.dynamics.stepper import Stepper
from flockana.dynamics.steps_between_samples import Between, Recorder
from flockana.dynamics.trajectory import Trajectory
from flockana.kernels.cell_grid import LARGE
from flockana.kernels.thread_counts import ensure_threads, limited_threads
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.first_order_law import VelocityLaw, ensure_any_law, first_order
from flockana.laws.law import Law
from flockana.laws.wrapper_base import needs_steps, wrappers_within
from flockana.solvers.fixed_steps import FixedStep, FixedSteps
from flockana.solvers.solver import Solver
from flockana.solvers.solver_names import solver_of


def simulate(
    law: Law | DiscreteLaw | VelocityLaw,
    q0: Any,
    p0: Any,
    t_span: TimeSpan,
    *,
    method: str | Solver = "DOP853",
    rtol: float = 1e-8,
    atol: float | tuple[float, float] | None = None,
    dt: float | None = None,
    max_step: float | None = None,
    t_eval: Any = None,
    threads: int | None = None,
    progress: bool = False,
    watch: Callable[[Sample], object] | None = None,
) -> Trajectory:
    """Integrate q' = p, p' = u(t, q, p) from (q0, p0), or q' = velocity(t, q) from q0.

    Ctrl-C ends the run early and returns what was integrated, with status ``"interrupted"``.

    Parameters
    ----------
    law : Law, VelocityLaw or DiscreteLaw
        What moves the flock. A discrete law brings its own step; method, tolerances and dt do not apply to it. A
        `SwitchedLaw` is integrated from switch to switch, except in fixed steps; a sliding mode ends the run and is
        reported.
    q0, p0 : array_like, shape (n, m)
        Initial positions and velocities; those of a `VelocityLaw`, late or sampled too, are its own, and may be None.
    t_span : (float, float)
        Start and end.
    method : str or Solver
        A solver such as ``RK4(0.01)``, or its name: DOP853, RK45, RK23, Radau, BDF, LSODA; with `dt` RK4, Heun,
        ExplicitEuler, SemiImplicitEuler, TaylorStep, Euler-Maruyama. Methods with coefficients are compiled for laws
        that are (Algorithms 1 and 2 and all sums of such terms), and stepped in Python for others; `scipy-DOP853` and
        so on are scipy's for every law. They make the same decisions with the same coefficients. A law that is wrapped
        by a delay, a clock or noise takes a method of fixed steps, with noise Heun or Euler-Maruyama; by default RK4,
        with noise Heun.
    rtol : float
        Relative tolerance of the adaptive solvers: relative to the state as seen from the mean motion of the start, so
        that neither the origin nor a common drift matters. The default keeps energy residuals well below 1e-6 of the
        energy in a run; scipy's own 1e-3 is never used.
    atol : float or (float, float), optional
        Absolute tolerance of positions, a length; velocities and energies are allowed the same share of the law's own
        speed and energy. Or a pair: of positions, a length, and of velocities, a speed. By default a hundredth of
        `rtol` times the law's own length.
    dt : float, optional
        Step of a method of fixed steps that is given by name, and of wrapped laws (required there, meaningless
        elsewhere). Of a continuous law the last step ends on time.
    max_step : float, optional
        Longest step of the adaptive solvers: what is narrower than their steps may be leapt over without a trace.
    t_eval : array_like, optional
        Rising times at which to keep the state; by default every step that the integrator takes. Bounds at all times,
        such as `Trajectory.min_distance`, rest on the steps in either case.
    threads : int, optional
        Cores for a flock of 10,000 agents or more, with the same bits for any number; by default NUMBA_NUM_THREADS, or
        all, and one in worker processes. What threads are pair forces within a range and their energies, lists of
        pairs, and of compiled methods the stages, the checks of pairs and the writing of states; alignment alone,
        links, obstacles, directed nets, maps and zone flocking run on one.
    progress : bool
        Show a progress bar on the terminal.
    watch : callable, optional
        Called with each sample that is kept, which has t, q, p and u, as it comes: to draw the run while it is made.

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
    ensure_any_law(law)
    if isinstance(law, Law) and needs_steps(law):
        law, method, dt = _in_steps(law, method, dt), "DOP853", None
    if (core := first_order(law)) is not None:
        t_span = ensure_time_span(t_span)
        q0, p0 = core.start(t_span[0], q0, p0)
    q0, p0 = ensure_state(q0, p0)
    law.check_dimension(q0.shape[1])
    law.check_start(q0, p0)
    t_span = ensure_time_span(t_span)
    kept_times = _check_t_eval(t_eval, t_span)
    threads = ensure_threads(threads) if threads is not None or len(q0) >= LARGE else 1
    with limited_threads(threads):
        start = first_call(law, t_span[0], q0, p0)
    if watch is not None and not callable(watch):
        raise ArgumentError(f"watch = {watch!r}: expected a function of a sample, or None")
    if isinstance(law, DiscreteLaw):
        if dt is not None or max_step is not None or method != "DOP853":
            raise ArgumentError("a discrete law brings its own step: expected neither dt, max_step nor method")
        name, run_options = "discrete", {"dt": _ensure_step("law.dt", law.dt, t_span)}
        _ensure_samples_fit(run_options["dt"], t_span, q0, kept_times)
        make_stepper: Callable[[], Stepper] = partial(MapStepper, law, start, t_span, kept_times)
    else:
        plan, run_options = _plan(solver_of(method, dt), law, start, t_span, kept_times, (rtol, atol, max_step))
        if isinstance(law, VelocityLaw) and getattr(plan.solver, "position_factor", None):
            raise ArgumentError(f"method = {plan.solver.name!r}: {law.title} is of first order; expected RK4 or Heun")
        name, make_stepper = plan.solver.name, partial(integrator_of, law, start, plan._replace(threads=threads))
    start_time, tally = time.perf_counter(), Tally()
    with limited_threads(threads):
        samples, between_samples = _collect(drive(make_stepper, tally), t_span, tally, progress, watch)
    counts = {"method": name, "steps": tally.steps, "evaluations": tally.evaluations}
    stats = counts | tally.notes | run_options | {"seconds": time.perf_counter() - start_time}
    if not samples:  # ended before the first time to keep
        samples = [start.sample]
        if watch is not None:
            watch(_copy(start.sample))
    t, q, p, u, extra_series = _stacked(samples)
    return sealed(Trajectory(t, q, p, u, law, extra_series, tally.status, tally.message, stats, between_samples))


def _in_steps(law: Law, method: str | Solver, dt: Any) -> FixedSteps:
    """Return a law that needs fixed steps (delay, clock or noise) as a map."""
    if isinstance(method, str) and dt is None:
        raise ArgumentError(f"dt = None: {law.title} is run in fixed steps, expected one such as dt=0.01")
    if method == "DOP853":
        method = "Heun" if any(item.noisy for item in wrappers_within(law)) else "RK4"
    solver = solver_of(method, dt)
    if not isinstance(solver, FixedStep):
        raise ArgumentError(f"method = {method!r}: {law.title} is run in fixed steps, such as Heun(0.01)")
    return FixedSteps(law, solver)


def _plan(
    solver: Solver,
    law: Law | VelocityLaw,
    start: Start,
    t_span: tuple[float, float],
    keep: FloatArray | None,
    tolerances: tuple[Any, Any, Any],
) -> tuple[Plan, dict[str, Any]]:
    """Return the plan of a run of a continuous law, and the options listed in its statistics."""
    rtol, atol, max_step = tolerances
    if solver.dt is not None:
        if max_step is not None:
            raise ArgumentError(f"max_step = {max_step!r}: {solver.name} takes steps of dt; make dt shorter")
        dt = _ensure_step("dt", solver.dt, t_span)
        _ensure_samples_fit(dt, t_span, start.q, keep)
        stops = np.union1d(list(_stops(t_span, dt, keep)), _beside_switches(law, t_span))
        return Plan(solver, stops, stops if keep is None else keep), {"dt": dt}
    run_options: dict[str, Any] = {"rtol": ensure_positive("rtol", rtol), "atol": ensure_atol("atol", atol)}
    floor = error_floor(law.scales, start, t_span[1] - t_span[0], **run_options)
    longest = np.inf if max_step is None else _ensure_step("max_step", max_step, t_span)
    control = Control(run_options["rtol"], floor, longest)
    run_options |= {"floors": list(floor)} if max_step is None else {"floors": list(floor), "max_step": longest}
    return Plan(solver, np.append(_beside_switches(law, t_span), t_span[1]), keep, control), run_options


def _beside_switches(law: Law | VelocityLaw, t_span: tuple[float, float]) -> FloatArray:
    """Return the times at which the law switches, each with a floating-point time just after it."""
    times = law.switches(*t_span)
    doubled_times = np.stack([times, times + 4.0 * np.spacing(np.abs(times))], axis=1).ravel()
    return doubled_times[(doubled_times > t_span[0]) & (doubled_times < t_span[1])]


def _stacked(kept: list[Samples]) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, dict[str, FloatArray]]:
    """Return the stacked arrays (t, q, p, u, extra) of a run, without two copies of the samples in memory."""
    first_block, end = kept[0], sum(len(samples.t) for samples in kept)
    t, (q, p, u) = np.empty(end), (np.empty((end, *first_block.q.shape[1:])) for _ in range(3))
    extra_series = {key: np.empty((end, *values.shape[1:])) for key, values in first_block.extra.items()}
    while kept:
        samples = kept.pop()
        start = end - len(samples.t)
        t[start:end], q[start:end], p[start:end], u[start:end] = samples.t, samples.q, samples.p, samples.u
        for key, series in extra_series.items():
            series[start:end] = samples.extra[key]
        end = start
    return t, q, p, u, extra_series


def _ensure_step(name: str, dt: Any, t_span: tuple[float, float]) -> float:
    step, largest_time = ensure_positive(name, dt), max(abs(t) for t in t_span)
    if largest_time + 0.5 * step == largest_time:
        raise ArgumentError(f"{name} = {step:g}: too small to change t = {largest_time:g}; start the clock near t = 0")
    return step


def _ensure_samples_fit(dt: float, t_span: tuple[float, float], q0: FloatArray, keep: FloatArray | None) -> None:
    """Raise if a run that keeps all its steps would not fit into memory."""
    if keep is None:
        samples = count_steps(*t_span, dt) + 1
        ensure_fits(f"a sample at each step of {dt:g}", (samples, 3, *q0.shape), "take longer steps, or give t_eval")


def _stops(t_span: tuple[float, float], dt: float, keep: FloatArray | None) -> Iterator[float]:
    """Yield times at which steps of at most dt end."""
    # The way to a time to keep is split evenly: a last step that is a sliver would lose the order for nothing.
    if keep is None:
        yield from (t_span[0] + k * dt for k in range(count_steps(*t_span, dt)))
        yield t_span[1]
        return
    t = t_span[0]
    for stop in keep.tolist():
        yield from np.linspace(t, stop, max(1, count_steps(t, stop, dt)) + 1)[1:].tolist()
        t = stop


def _check_t_eval(t_eval: Any, t_span: tuple[float, float]) -> FloatArray | None:
    if t_eval is None:
        return None
    try:
        times = np.atleast_1d(real_array(t_eval))
    except (TypeError, ValueError, OverflowError):
        times = np.array([np.nan])
    is_valid = times.ndim == 1 and times.size > 0 and np.isfinite(times).all() and (np.diff(times) > 0.0).all()
    if not is_valid or times[0] < t_span[0] or times[-1] > t_span[1]:
        raise ArgumentError(f"t_eval = {t_eval!r}: expected rising times within t_span = {t_span}")
    return times


def _copy(single: Samples) -> Sample:
    """Return a copy of a single sample for the user's `watch`, which may change it without harm to the run."""
    q, p, u = (values[0].copy() for values in single[1:4])
    return Sample(float(single.t[0]), q, p, u, {name: np.array(values[0]) for name, values in single.extra.items()})


def _collect(
    samples: Iterator[Samples],
    t_span: tuple[float, float],
    tally: Tally,
    progress: bool,
    watch: Callable[[Sample], object] | None,
) -> tuple[list[Samples], Between | None]:
    """Collect samples and steps from the integrator; on Ctrl-C keep the collected part."""
    blocks, recorder, t_reached = list[Samples](), Recorder(), t_span[0]
    with progress_bar(t_span[1] - t_span[0], enabled=progress, counted=False, steady=True) as advance:
        try:
            with restore_interrupts():
                for sample_block in samples if watch is None else _one_by_one(samples):
                    recorder.add(sample_block)  # first: `watch` may end the run here
                    if sample_block.wanted:
                        blocks.append(sample_block)
                        if watch is not None:
                            watch(_copy(sample_block))
                    if progress:
                        t_reached = max(t_reached, float(sample_block.t[-1]))
                        advance(t_reached - t_span[0], f"t = {t_reached:.4g}")
        except KeyboardInterrupt:
            end_text = (
                f"the last sample is at t = {blocks[-1].t[-1]:g}" if blocks else "no sample was reached but the start"
            )
            tally.status, tally.message = "interrupted", f"interrupted: {end_text}"
    return blocks, recorder.between()


def _one_by_one(samples: Iterator[Samples]) -> Iterator[Samples]:
    """Yield samples one at a time for the user's `watch`, and steps as they come."""
    for some in samples:
        yield from (some.at(slice(k, k + 1)) for k in range(len(some.t))) if some.wanted else (some,)
