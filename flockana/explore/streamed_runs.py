"""Runs streamed during computation: first frames at once, an error if the run would take too long."""

import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.dynamics.run_samples import Sample
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.explore.page_starts import Start
from flockana.player.scene import kept, scene

AGENTS = 3000  # more of them no page draws smoothly
_FIRST, _SLOWER = 0.03, 2.5  # seconds until the first frames are sent; factor between sendings
_FRAMES, _SAMPLES = 24, 200  # of a run under way; of the whole, at least
_NUMBERS = 120_000  # places and velocities of the whole, at most
_TRIED, _FAR = 2.0, 4.0  # seconds after which the end is foretold; multiples of the limit at which it is not awaited


class TooLargeError(ArgumentError):
    """Run that would take too long for a page; the message states its cost."""


def ensure_small(parts: Start) -> None:
    """Raise if a flock has more agents than the explorer's page can show."""
    n, m = parts.q0.shape
    if n > AGENTS:
        megabytes = 8e-6 * 2 * n * m * _FRAMES
        raise TooLargeError(
            f"{n} agents, {megabytes:.3g} MB for every {_FRAMES} frames: expected at most {AGENTS} in a page; "
            "take fewer, or run the lines of Python below"
        )


def watched(parts: Start, show: Callable[[bytes], None], *, limit: float, cancelled: Callable[[], bool]) -> Trajectory:
    """Simulate a case and return its run, sending frames to the page while it is computed."""
    samples: list[Sample] = []
    span = parts.t_span[1] - parts.t_span[0]
    started, due, pause = time.perf_counter(), 0.0, _FIRST
    failure: TooLargeError | None = None

    def watch(sample: Sample) -> None:
        nonlocal started, due, pause, failure
        if cancelled():
            raise KeyboardInterrupt
        samples.append(sample)
        current_time = time.perf_counter()
        if len(samples) <= 2:  # until here the law was compiled, or loaded
            started, due = current_time, current_time + pause
            return
        progress_made, seconds_gone = sample.t - samples[1].t, current_time - started
        whole = seconds_gone * span / progress_made if progress_made > 0.0 else float("inf")
        if seconds_gone > limit or (seconds_gone > _TRIED and _FAR * limit < whole < float("inf")):
            failure = TooLargeError(
                f"this run takes about {whole / 60.0:.2g} minutes here ({len(parts.q0)} agents, {span:.4g} time units, "
                f"{progress_made:.3g} of them took {seconds_gone:.2g} s): expected at most {limit:g} s; "
                "shorten it, take fewer agents or softer gains, or run the lines of Python below"
            )
            raise KeyboardInterrupt
        if current_time >= due:
            show(scene(_thin(samples, parts.law)))
            pause *= _SLOWER
            due = time.perf_counter() + pause

    run = simulate(parts.law, parts.q0, parts.p0, parts.t_span, **parts.options, watch=watch)
    if failure is not None:
        raise failure
    if run.status == "interrupted":
        raise KeyboardInterrupt
    if len(run.t) > _SAMPLES and pause == _FIRST:  # nothing was shown yet, and the whole takes longer
        show(scene(_thin(samples, parts.law)))
    return shown(run, show)


def _thin(samples: list[Sample], law: Any) -> Trajectory:
    """Return an unfinished run as a `Trajectory`, with some of its samples left out."""
    shown_samples = [samples[k] for k in kept(len(samples), _FRAMES)]
    t, q, p, u = (np.array([getattr(sample, name) for sample in shown_samples]) for name in "tqpu")
    extra_series = {key: np.array([sample.extra[key] for sample in shown_samples]) for key in shown_samples[0].extra}
    return Trajectory(t, q, p, u, law, extra_series, "interrupted", "under way")


def shown(run: Trajectory, show: Callable[[bytes], None]) -> Trajectory:
    """Send a run to the explorer's page, thinned if it is long, and return it unchanged."""
    most = kept(len(run.t), max(_SAMPLES, _NUMBERS // (2 * run.n * run.m)))
    extra_series = {name: series[most] for name, series in run.extra.items()}
    some = replace(run, t=run.t[most], q=run.q[most], p=run.p[most], u=run.u[most], extra=extra_series, between=None)
    show(scene(some, values=_NUMBERS))
    return run
