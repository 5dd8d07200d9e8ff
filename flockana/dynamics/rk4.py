"""Classical Runge-Kutta of order 4 with a longest step."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.compiled import engine_of, stepped
from flockana.dynamics.encounters import Encounters, State, at_a_pole
from flockana.dynamics.iterate import count_steps
from flockana.dynamics.sample import Sample, Samples, Tally, finite, has_energy
from flockana.kernels.advance import GROWTH
from flockana.laws.law import Law


def rk4(
    law: Law,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    dt: float,
    keep: FloatArray | None,
    tally: Tally,
) -> Iterator[Sample | Samples]:
    """Classical RK4 on (q, p, work); steps are shortened to land on the times to keep, and to meet every encounter.

    A step that would leap over an encounter is made again, and shorter: dt is the longest step, and what a step does
    not see is not an error of its order. `tally.notes` gets how many were.
    """
    engine = engine_of(law, q0, p0, t_span[0], "RK4")
    if engine is not None:
        stops = np.array([t for t, _ in _stops(t_span, dt, keep)])
        marked = stops if keep is None else keep
        yield from stepped(engine, q0, p0, stops, np.empty(0), marked, tally, lambda _, t: _left(t, dt))
        return
    energetic, encounters = has_energy(law, t_span[0], q0, p0), Encounters.of(law, len(q0))
    t, state, work = t_span[0], State(q0.copy(), p0.copy(), np.empty(0)), 0.0
    u, rate = law.flow(t, q0, p0)
    state = state._replace(u=u)
    tally.evaluations += 1
    tally.notes["redone"], taken = 0, np.inf
    for stop, wanted in _stops(t_span, dt, keep):
        while t < stop:
            remaining = stop - t
            h = remaining if remaining <= GROWTH * taken else GROWTH * taken
            while True:
                later, more, rate_there = _rk4_step(law, t, state, rate, h)
                tally.evaluations += 4
                share = encounters.share(h, state, later) if encounters.any and finite(*later) else 1.0
                singular, share = share < 0.0, abs(share)
                if share == 1.0 or t + share * h == t:
                    break
                h *= max(share, 1.0 / GROWTH)  # what a step that is far too long foresees is no measure of the next
                tally.notes["redone"] += 1
            if singular:
                tally.fail(at_a_pole(t))
                return
            if not finite(*later):
                tally.fail(_left(t + h, dt))
                return
            t, taken = (stop, np.inf) if h == remaining else (t + h, h)
            state, rate, work = later, rate_there, work + more
            tally.steps += 1
            if t < stop:
                yield Sample(t, *state, {}, wanted=False)
        yield Sample(t, *state, {"work": np.array(work)} if energetic else {}, wanted=wanted)


def _left(t: float, dt: float) -> str:
    return f"RK4 left the finite numbers at t = {t:g}: reduce dt = {dt:g}"


def _rk4_step(law: Law, t: float, state: State, rate: float, h: float) -> tuple[State, float, float]:
    """(the state after a step, the work done on the way, dH/dt at the end)."""
    q, p, u = state
    p2 = p + 0.5 * h * u
    u2, rate2 = law.flow(t + 0.5 * h, q + 0.5 * h * p, p2)
    p3 = p + 0.5 * h * u2
    u3, rate3 = law.flow(t + 0.5 * h, q + 0.5 * h * p2, p3)
    p4 = p + h * u3
    u4, rate4 = law.flow(t + h, q + h * p3, p4)
    q = q + h / 6.0 * (p + 2.0 * (p2 + p3) + p4)
    p = p + h / 6.0 * (u + 2.0 * (u2 + u3) + u4)
    work = h / 6.0 * (rate + 2.0 * (rate2 + rate3) + rate4)
    u, rate = law.flow(t + h, q, p)
    return State(q, p, u), work, rate


def _stops(t_span: tuple[float, float], dt: float, keep: FloatArray | None) -> Iterator[tuple[float, bool]]:
    """Where steps of at most dt end, and whether a sample is wanted there.

    The way to a time to keep is split evenly: a last step that is a sliver would lose the order for nothing.
    """
    if keep is None:
        yield from ((t_span[0] + k * dt, True) for k in range(count_steps(*t_span, dt)))
        yield t_span[1], True
        return
    t = t_span[0]
    for stop in keep.tolist():
        yield from ((one, False) for one in np.linspace(t, stop, max(1, count_steps(t, stop, dt)) + 1)[1:-1].tolist())
        yield stop, True
        t = stop
