"""Orbits of maps in balls: enclosures of every state that the map, exactly computed, leads to.

The steps of a solver on Algorithms 1 to 3 are sums and products of what `flockana.certified.flow` has in balls. Where a
map is chaotic balls grow; then the orbit is run again with twice the precision, until the balls at all samples are
narrow or a budget is spent.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from flint import arb, ctx

from flockana.base.errors import ArgumentError
from flockana.certified.balls import exact
from flockana.certified.flow import Flow, ensure_enclosable, flow_of
from flockana.dynamics.map_errors import MapErrors, nudged_errors
from flockana.dynamics.trajectory import Trajectory
from flockana.solvers.fixed_steps import FixedSteps

BUDGET = 100_000  # pairs times stages of all steps of one orbit, a few seconds; and of its precision
PRECISIONS = (128, 256, 512, 1024, 2048)  # bits
_NARROW = 1e-15  # of the law's length: the widest ball that does


def map_errors(run: Trajectory, *, budget: int = BUDGET) -> MapErrors:
    """Return the errors of a map's run: enclosures by an orbit in balls where there is one, else estimates.

    Parameters
    ----------
    budget : int
        Pairs times stages times steps that an orbit in balls may take.

    Examples
    --------
    >>> from flockana.dynamics.simulate import simulate
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> from flockana.solvers.taylor_step import TaylorStep
    >>> run = simulate(TaylorStep(Algorithm1(), 0.01), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    >>> errors = map_errors(run)
    >>> errors.known_until, errors.enclosed, bool(0.0 < errors.q.max() < 1e-13)
    (1.0, True, True)
    """
    steps = np.rint((run.t - run.t[0]) / run.law.dt).astype(np.int64)
    if not _has_balls(run.law) or run.n**2 * int(steps[-1]) * len(run.law.solver.b) > budget:
        return nudged_errors(run)
    errors = None
    for precision in PRECISIONS:
        before, ctx.prec = ctx.prec, precision
        try:
            errors, widest = _orbit_errors(run, flow_of(run.law.law, run.n, run.m), steps)
        finally:
            ctx.prec = before
        if widest <= _NARROW * run.scales.length:
            break
    assert errors is not None
    return errors


def _has_balls(law: Any) -> bool:
    """Return whether a map is a solver's on a law that is known in balls."""
    if type(law) is not FixedSteps:
        return False
    try:
        ensure_enclosable(law.law)
    except ArgumentError:
        return False
    return True


def _orbit_errors(run: Trajectory, flow: Flow, steps: Any) -> tuple[MapErrors, float]:
    """Return half widths of the samples about the orbit, and the radius of the widest ball."""
    state = [arb(x) for x in (*run.q[0].ravel().tolist(), *run.p[0].ravel().tolist())]
    wanted = {step: row for row, step in enumerate(steps.tolist())}
    widths, widest = np.full((len(steps), len(state)), np.inf), 0.0
    for k in range(int(steps[-1]) + 1):
        if (row := wanted.get(k)) is not None:
            sample = [*run.q[row].ravel().tolist(), *run.p[row].ravel().tolist()]
            widths[row] = [float(abs(x - y).upper()) for x, y in zip(state, sample, strict=True)]
            widest = max(widest, *(float(x.rad()) for x in state))
            if not widest < run.scales.length:
                break
        state = step_in_balls(run.law, flow, arb(exact(run.t[0])) + k * arb(exact(run.law.dt)), state)
    half = np.nextafter(widths, np.inf).reshape(len(steps), 2, run.n, run.m)
    q, p = (np.linalg.norm(half[:, part], axis=2) * (1.0 + 1e-15) for part in (0, 1))
    reason = "by rounding the run has left the orbit that the map exactly has, or its balls grow too wide"
    return MapErrors.of(run, q, p, enclosed=True, reason=reason), widest


def step_in_balls(law: FixedSteps, flow: Flow, t: arb, state: Sequence[arb]) -> list[arb]:
    """Return the state after one step of a map from every state in a box, at a ball of times."""
    h, half, factor = arb(exact(law.dt)), flow.n * flow.m, law.solver.position_factor
    q, p = list(state[:half]), list(state[half:])
    speeds, inputs = [p], [flow.input(t, state, flow.pieces(state))]
    for row in law.solver.a[1:]:
        at = [*_moved(q, h, row, speeds), *_moved(p, h, row, inputs)]
        speeds.append(at[half:])
        inputs.append(flow.input(t + h * arb(sum(row)), at, flow.pieces(at)))
    after = _moved(p, h, law.solver.b, inputs)
    if factor is None:
        return [*_moved(q, h, law.solver.b, speeds), *after]
    return [*(x + h * v + arb(factor) * h * h * u for x, v, u in zip(q, p, inputs[0], strict=True)), *after]


def _moved(x: Sequence[arb], h: arb, weights: Sequence[float], rates: Sequence[Sequence[arb]]) -> list[arb]:
    """x + h Σ weights_j rates_j."""
    known = [(arb(weight), rate) for weight, rate in zip(weights, rates, strict=True) if weight]
    return [y + h * sum((weight * rate[k] for weight, rate in known), arb(0)) for k, y in enumerate(x)]
