"""Integrate a law with jumps from switch to switch: scipy's solvers on one smooth piece at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from flockana.base.checks import FloatArray
from flockana.dynamics.integrators import Floor, Sample, Tally, counted, stepper
from flockana.dynamics.stepping import Flow
from flockana.laws.switched import Pieces, SwitchedLaw

Way = Callable[[float], FloatArray]

_HALVINGS = 60  # of a step, until the switch is bracketed to rounding
_DEGREE = 12  # of a step's interpolant, at most: LSODA's; DOP853 has 7
_NODES = chebyshev.chebpts1(2 * _DEGREE + 1)  # so many that a squared distance is its own interpolant
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_NODES, 2 * _DEGREE))


def adaptive_with_switches(
    law: SwitchedLaw,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    method: str,
    rtol: float,
    floor: Floor,
    keep: FloatArray | None,
    tally: Tally,
) -> Iterator[Sample]:
    """Step a solver with every pair held in its piece; at the first pair that leaves, stop there and start anew.

    None is missed that the step's interpolant makes, however short the visit (`turns`). A pair held at a surface ends
    the run: its switches would become ever more frequent. `tally.notes` gets the number of switches.
    """
    pieces = law.pieces(q0)
    solver = stepper(law, _held(law, pieces), q0, p0, t_span, method, rtol, floor, tally)
    frame = solver.frame
    t, wanted, switches = t_span[0], 0, 0
    beside: Sample | None = None
    tally.notes["switches"] = switches

    def sample(t: float, y: FloatArray) -> Sample:
        q, p = frame.state(t, y)
        work = {"work": np.array(y[-1])} if frame.energetic else {}
        return Sample(t, q, p, law.piece_flow(pieces, t, q, p)[0], work)

    if keep is None or keep[0] == t:
        wanted = 1
        yield sample(t, solver.now.y)._replace(q=q0, p=p0)  # not a rounding beside it, as in the frame
    while t < t_span[1]:
        if not solver.step(()):
            tally.fail(solver.message)
            return
        tally.steps += 1
        course, start = solver.course(), t

        def way(s: float, course: Any = course) -> FloatArray:
            return frame.state(s, course(s))[0]

        end = _first_switch(law, pieces, way, start, solver.now.t)
        t, y = (solver.now.t, solver.now.y) if end is None else (end, course(end))
        coming = keep[wanted] if keep is not None and wanted < keep.size else t
        if beside is not None and beside.t < min(coming, t):
            yield beside
        beside = None
        while keep is not None and wanted < keep.size and keep[wanted] < t:
            yield sample(keep[wanted], course(keep[wanted]))
            wanted += 1
        asked = keep is None or (wanted < keep.size and keep[wanted] == t)
        wanted += int(asked)
        yield sample(t, y)._replace(wanted=asked)
        if end is None:
            continue
        switches += 1
        tally.notes["switches"] = switches
        before, (q, p) = pieces, frame.state(t, y)
        pieces = law.crossed(before, law.margins(before, q))
        if reason := law.sliding(before, pieces, t, q, p):
            tally.notes["sliding"] = reason
            tally.fail(f"sliding at t = {t:.6g}: {reason}")
            return
        solver.begin(counted(_held(law, pieces), tally, method), t, y)
        beside = _beside(sample(t, y))


def _beside(switch: Sample) -> Sample:
    """The path goes on from a switch with the other side's input: a knot next to it, apart in any unit of time."""
    gap = 4.0 * float(np.spacing(abs(switch.t)))
    return switch._replace(t=switch.t + gap, q=switch.q + gap * switch.p, wanted=False)


def _held(law: SwitchedLaw, pieces: Pieces) -> Flow:
    """The flow with every pair held in its piece."""
    return lambda t, q, p: law.piece_flow(pieces, t, q, p)


def _first_switch(law: SwitchedLaw, pieces: Pieces, way: Way, start: float, end: float) -> float | None:
    """The first time at which a pair is beyond its piece; None if there is none.

    Between two turns every distance that could reach an edge is monotone: no pair can have left and be back.
    """

    def beyond(t: float) -> bool:
        return bool((law.margins(pieces, way(t)).inside < 0.0).any())

    low = start
    for t in [*turns(law, pieces, way, start, end), end]:
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


def turns(law: SwitchedLaw, pieces: Pieces, way: Way, start: float, end: float) -> list[float]:
    """When, within a step, the distance of a pair that could leave its piece stops growing or shrinking, rising.

    The interpolant of every solver is a polynomial, and so are the squares of distances: their turns are roots. Only
    pairs are asked whose two agents' ways, each bounded by the coefficients of its series, could reach an edge.
    """
    times = 0.5 * (start + end) + 0.5 * (end - start) * _NODES
    places = np.stack([way(t) for t in times.tolist()])  # (nodes, n, m)
    series = np.tensordot(_TO_SERIES, places, axes=1)
    reach = np.sum(np.linalg.norm(series[1:], axis=2), axis=0)  # an agent's way from its mean place, series[0]
    rows, columns = np.triu_indices(len(reach), 1)
    near = law.margins(pieces, series[0]).inside <= (reach[rows] + reach[columns]) * (1.0 + 1e-9)
    found: set[float] = set()
    for i, j in zip(rows[near].tolist(), columns[near].tolist(), strict=True):
        squared = _TO_SERIES @ np.sum((places[:, j] - places[:, i]) ** 2, axis=1)
        roots = chebyshev.chebroots(chebyshev.chebder(chebyshev.chebtrim(squared, 1e-15 * abs(squared).max())))
        real = roots.real[np.abs(roots.imag) < 1e-6]
        found.update((0.5 * (start + end) + 0.5 * (end - start) * real[np.abs(real) < 1.0]).tolist())
    return sorted(t for t in found if start < t < end)
