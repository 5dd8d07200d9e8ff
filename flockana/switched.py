"""Integrate a law with jumps from switch to switch: scipy's solvers on one smooth piece at a time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from flockana.checks import FloatArray
from flockana.integrators import Sample, Tally, has_energy
from flockana.laws.switched import Pieces, SwitchedLaw

LOOKS = 4  # at how many times within a step a pair is looked for that has left its piece (and may be back)
_HALVINGS = 60  # of a step, until the switch is bracketed to rounding


def located(
    law: SwitchedLaw,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    method: str,
    rtol: float,
    atol: float,
    keep: FloatArray | None,
    tally: Tally,
) -> Iterator[Sample]:
    """Step a solver with every pair held in its piece; at the first pair that leaves, stop there and start anew.

    A pair that leaves and comes back between two looks of one step is missed. A pair held at a surface ends the run:
    its switches would become ever more frequent. `tally.notes` gets the number of switches.

    Parameters
    ----------
    law : SwitchedLaw
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
        Times to keep; every step and every switch if None.
    tally : Tally
        Filled in on the way.
    """
    import scipy.integrate

    shape, size = q0.shape, q0.size
    pieces = law.pieces(q0)
    energetic = has_energy(law, t_span[0], q0, p0)

    def split(y: FloatArray) -> tuple[FloatArray, FloatArray]:
        return y[:size].reshape(shape), y[size : 2 * size].reshape(shape)

    def sample(t: float, y: FloatArray) -> Sample:
        q, p = (x.copy() for x in split(y))
        return Sample(t, q, p, law.piece_flow(pieces, t, q, p)[0], {"work": np.array(y[-1])} if energetic else {})

    def solver_from(t: float, y: FloatArray, held: Pieces) -> Any:
        def rhs(s: float, x: FloatArray) -> FloatArray:
            tally.evaluations += 1
            u, rate = law.piece_flow(held, s, *split(x))
            return np.concatenate([x[size : 2 * size], u.ravel(), [rate] if energetic else []])

        return getattr(scipy.integrate, method)(rhs, t, y, t_span[1], rtol=rtol, atol=atols)

    y = np.concatenate([q0.ravel(), p0.ravel(), [0.0] if energetic else []])
    atols = np.full(y.size, atol)
    if energetic:  # as in `adaptive`
        atols[-1] = max(atol, rtol * abs(law.hamiltonian(t_span[0], q0, p0)))
    t, wanted, switches = t_span[0], 0, 0
    tally.notes["switches"] = switches
    if keep is None or keep[0] == t:
        wanted = 1
        yield sample(t, y)
    solver = solver_from(t, y, pieces)
    while t < t_span[1]:
        message = solver.step()
        if solver.status == "failed" or not np.isfinite(solver.y).all():
            tally.fail(f"{method} gave up at t = {solver.t:g}: {message or 'the state is no longer finite'}")
            return
        tally.steps += 1
        course = solver.dense_output()
        end = _first_switch(law, pieces, course, t, solver.t, split)
        t, y = (solver.t, solver.y) if end is None else (end, course(end))
        if keep is None:
            yield sample(t, y)
        while keep is not None and wanted < keep.size and keep[wanted] <= t:
            yield sample(keep[wanted], course(keep[wanted]))
            wanted += 1
        if end is None:
            continue
        switches += 1
        tally.notes["switches"] = switches
        before, (q, p) = pieces, split(y)
        pieces = law.crossed(before, law.margins(before, q))
        if reason := law.sliding(before, pieces, t, q, p):
            tally.notes["sliding"] = reason
            tally.fail(f"sliding at t = {t:.6g}: {reason}")
            return
        solver = solver_from(t, y, pieces)


def _first_switch(law: SwitchedLaw, pieces: Pieces, course: Any, start: float, end: float, split: Any) -> float | None:
    """The first time at which a pair is beyond its piece, by looks and halving; None if there is none."""

    def beyond(t: float) -> bool:
        return bool((law.margins(pieces, split(course(t))[0]).inside < 0.0).any())

    low = start
    for t in np.linspace(start, end, LOOKS + 1)[1:].tolist():
        if beyond(t):
            high = t
            for _ in range(_HALVINGS):
                middle = 0.5 * (low + high)
                if not low < middle < high:
                    break
                low, high = (low, middle) if beyond(middle) else (middle, high)
            return float(high)
        low = t
    return None
