"""Rigorous enclosure of a run, step by step: `enclose`."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations
from math import inf, isfinite, sqrt
from typing import Any

import numpy as np
from flint import arb, ctx

from flockana.base.errors import ArgumentError
from flockana.base.integrity_seals import sealed
from flockana.base.interrupts import restore_interrupts
from flockana.base.progress import progress_bar
from flockana.base.value_checks import (
    TimeSpan,
    ensure_count,
    ensure_nonnegative,
    ensure_positive,
    ensure_state,
    ensure_time_span,
)
from flockana.certified.flow_in_balls import Flow, ensure_enclosable, flow_of
from flockana.certified.lohner import StateSet, Step, crossing_step, size, taylor_step, variation_order
from flockana.certified.pair_laws_in_series import Piece
from flockana.certified.structural_energy import BITS
from flockana.certified.tube import Tube

_SHORTEST = 1e-7  # of the law's own time: nearer to a switch, it is crossed
_LONGEST = 0.1  # of the law's own time: the longest step that crosses a switch
_TRIES = 40  # of ever shorter steps
_SHRINK, _GROW = 0.5, 4.0
_PART = 1e-4  # of its own width, which a step may add to a wide set
_FAR = 1e3  # times what a step may add: one that adds more is taken again, shorter
_BLUR = 1e-4  # by which a step may let the set grow


def enclose(
    law: Any,
    q0: Any,
    p0: Any,
    t_span: TimeSpan,
    *,
    radius: float | tuple[float, float] = 0.0,
    order: int = 16,
    remainder: float = 1e-16,
    widest: float = 0.1,
    steps: int = 20_000,
    progress: bool = False,
) -> Tube:
    """Enclose every solution from a start, or from a box of starts, rigorously: Lohner's method in ball arithmetic.

    Where the pair law of every pair is analytic, a step is one of a Taylor polynomial, with its remainder bounded over
    all states that the step may meet; at h r_α and r_α, and at h d_β and d_β of an obstacle, where the law is only C¹,
    short steps of second order; the surface of a sphere is no such place. A parameter of the law is the decimal that it
    prints as, a coordinate or a time is its binary value.

    The set grows at each crossing by about the third power of its duration: a pair that grazes a switching distance, or
    a wide set, is what the tube may break at. It then ends early, and says why. Three agents in the plane cost about
    15 ms a step, 240 steps from a start out of range until they lie in a certified basin; seven cost 50 to 150 ms,
    some 600 steps, the set growing from rounding to 1e-6 on the way. Steps become shorter as agents become faster.

    Parameters
    ----------
    law : Algorithm1, Algorithm2 or Algorithm3
        Under the latter two the γ-agent is a `StaticTarget` or a `LinearTarget`; each obstacle is a `Sphere`.
    q0, p0 : array_like, shape (n, m)
        Initial positions and velocities, exact.
    radius : float or (float, float)
        Of the box of starts: of each coordinate of q0, and of p0 (by default the same number).
    order : int
        Of the Taylor polynomials, 4 to 40.
    remainder : float
        What a step may add to the set, in units of d, and of d times the law's fastest rate.
    widest : float
        Half-width of the set, in units of d, at which the tube counts as broken.
    steps : int
        At most so many.

    Returns
    -------
    Tube
        With status "complete", "broken" or "interrupted"; what it holds is proved in any case.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> tube = enclose(Algorithm1(), [[0.0], [7.5]], [[0.0], [0.0]], (0.0, 0.125))
    >>> tube.status, bool(tube.distances_during(0)[0] < 7.6), float(tube.radii[-1].max()) < 1e-12
    ('complete', True, True)
    """
    ensure_enclosable(law)
    q0, p0 = ensure_state(q0, p0)
    law.check_dimension(q0.shape[1])
    law.check_start(q0, p0)
    span = ensure_time_span(t_span)
    radii = radius if isinstance(radius, tuple) else (radius, radius)
    if len(radii) != 2:
        raise ArgumentError(f"radius = {radius!r}: expected one, or one of positions and one of velocities")
    limits = {"remainder": ensure_positive("remainder", remainder), "widest": ensure_positive("widest", widest)}
    around = tuple(ensure_nonnegative("radius", r) for r in radii)
    if isinstance(order, bool) or not isinstance(order, int) or not 4 <= order <= 40:
        raise ArgumentError(f"order = {order!r}: expected a whole number from 4 to 40")
    steps, start_time = ensure_count("steps", steps), time.perf_counter()
    with ctx.workprec(BITS):
        marcher = _March(flow_of(law, *q0.shape), law.alpha.d, order, **limits)
        widths = [arb(r) for r in around for _ in range(q0.size)]
        start = StateSet.box([arb(float(x)) for x in (*q0.ravel(), *p0.ravel())], widths)
        times, sets, taken_steps, status, message = _collected(marcher, start, span, steps, progress)
    stats = {"order": order, **limits, "radius": around, "steps": len(taken_steps)}
    stats["seconds"] = time.perf_counter() - start_time
    return sealed(Tube(law, q0, p0, times, sets, taken_steps, status, message, stats))


def _collected(
    march: _March, start: StateSet, span: tuple[float, float], most: int, progress: bool
) -> tuple[tuple[float, ...], tuple[StateSet, ...], tuple[Step, ...], str, str]:
    """Return times, state sets and steps until the run ends or a proof fails, with status and message."""
    times, sets, taken_steps = [span[0]], [start], list[Step]()
    status, message = "broken", f"it took {most} steps, as many as it may"
    with progress_bar(span[1] - span[0], enabled=progress, counted=False, steady=True) as advance:
        try:
            with restore_interrupts():
                for t, step in march.steps(start, span):
                    if isinstance(step, str):
                        message = step
                        break
                    times.append(t)
                    sets.append(step.after)
                    taken_steps.append(step)
                    advance(t - span[0], f"t = {t:.4g}, {len(taken_steps)} steps")
                    if t == span[1]:
                        status, message = "complete", ""
                    if len(taken_steps) == most:
                        break
        except KeyboardInterrupt:
            status, message = "interrupted", f"interrupted: it ends at t = {times[-1]:g}"
    return tuple(times), tuple(sets), tuple(taken_steps), status, message


@dataclass(frozen=True)
class _March:
    """Step-by-step rigorous integrator of `enclose`: right-hand side, length scale, and error limits."""

    flow: Flow
    length: float
    order: int
    remainder: float
    widest: float

    def steps(self, start: StateSet, span: tuple[float, float]) -> Iterator[tuple[float, Step | str]]:
        """Yield the end time and enclosure of each proved step, or a message where a proof fails."""
        flow, t, current_set, target_step = self.flow, span[0], start, 0.1 / self.flow.pace
        while t < span[1]:
            end, step, is_crossing = self._step(t, current_set, min(target_step, span[1] - t), span[1])
            if step is None:
                yield t, f"no step of any length could be enclosed at t = {t:.6g}, where {_where(flow, current_set)}"
                return
            if not self._width(step) <= self.widest * self.length:
                place_text = _where(flow, current_set)
                yield t, f"the set is wider than {2.0 * self.widest:g} d at t = {end:.6g}, where {place_text}"
                return
            if not is_crossing:
                growth = _factor(step.blur / _BLUR, variation_order(self.order))
                target_step = (end - t) * max(min(_factor(self._excess(step), self.order), growth, _GROW), 0.3)
            t, current_set = end, step.after
            yield t, step

    def _step(self, t: float, current: StateSet, most: float, last: float) -> tuple[float, Step | None, bool]:
        """Return the end time of the next step, its enclosure (or None), and whether it may cross a switch."""
        flow, shortest, end = self.flow, _SHORTEST / self.flow.pace, t
        step: Step | None = None
        duration, is_crossing = _proposed(flow, current, most)
        for _ in range(_TRIES):
            if not is_crossing and duration < shortest:
                duration, is_crossing = shortest, True
            end = min(t + duration, last)
            if end <= t:
                break
            h = arb(end) - arb(t)
            if is_crossing:
                step = crossing_step(flow, arb(t), h, current)
            else:
                step = taylor_step(flow, arb(t), h, current, self.order)
            if step is not None and (is_crossing or (step.blur < _BLUR**0.5 and self._excess(step) < _FAR)):
                break
            duration *= _SHRINK
        return end, step, is_crossing

    def _width(self, step: Step) -> float:
        """Return the largest half-width of the enclosed state set after a step."""
        return size(self.flow, [arb(x.rad()) for x in step.after.hull])

    def _excess(self, step: Step) -> float:
        """Return the ratio of a step's Taylor remainder to the allowed remainder."""
        return step.added / max(self.remainder * self.length, _PART * self._width(step))


def _factor(excess: float, order: int) -> float:
    """Return the factor by which to scale the next step, from the excess and order of the error."""
    return float(0.9 * excess ** (-1.0 / order)) if excess > 0.0 else inf


def _proposed(flow: Flow, current: StateSet, longest: float) -> tuple[float, bool]:
    """Return a proposed length of the next time step, and whether the step may cross a switching distance."""
    state = np.array([[float(x.mid()), float(x.rad())] for x in current.hull])
    (q, p), radii = state[:, 0].reshape(2, flow.n, flow.m), state[:, 1].reshape(2, -1)
    wide, velocity_width = (2.0 * sqrt(flow.m) * float(half_vector.max()) for half_vector in radii)
    h, crossing = longest, 0.0
    for gap, speed in _gaps(flow, q, p):
        fastest = abs(speed) + velocity_width
        if abs(gap) <= 1.5 * wide + 2.0 * _SHORTEST * fastest / flow.pace:
            crossing = max(crossing, (wide + abs(gap)) / max(fastest, 1e-3 * wide * flow.pace, 1e-300))
        elif gap * speed < 0.0:
            h = min(h, 0.8 * (abs(gap) - wide) / abs(speed))
        elif speed != 0.0:
            h = min(h, max(6.0 * (abs(gap) - wide) / abs(speed), 2.0 * _SHORTEST / flow.pace))
    if crossing == 0.0:
        return h, False
    return float(min(max(1.5 * crossing, _SHORTEST / flow.pace), _LONGEST / flow.pace, longest)), True


def _gaps(flow: Flow, q: Any, p: Any) -> Iterator[tuple[float, float]]:
    """Yield how far each pair's distance is from a switch of its law, with its rate; likewise for agents."""
    switches = flow.pair.switches
    for i, j in combinations(range(flow.n), 2):
        displacement, relative = q[j] - q[i], p[j] - p[i]
        distance = float(np.linalg.norm(displacement))
        speed = float(displacement @ relative) / distance if distance > 0.0 else float(np.linalg.norm(relative))
        yield from ((distance - switch, speed) for switch in switches)
    for term in flow.terms:
        for x, v in zip(q, p, strict=True):
            yield from term.switches(x, v)


def _where(flow: Flow, current: StateSet) -> str:
    """Return a phrase on the width of a state set and the pairs near a switching distance, for messages."""
    names = [f"agents {i} and {j}" for i, j in combinations(range(flow.n), 2)]
    names += [f"agent {i} and an obstacle" for _ in flow.terms for i in range(flow.n)]
    switch_names = [name for name, piece in zip(names, flow.pieces(current.hull), strict=True) if piece is Piece.SWITCH]
    width = max(float(x.rad()) for x in current.hull)
    if not isfinite(width):
        return "nothing is known of it any more"
    suspects_text = f", and {', '.join(switch_names[:3])} may be about a switching distance" if switch_names else ""
    return f"its half-width is {width:.2g}{suspects_text}"
