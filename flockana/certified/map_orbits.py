"""Enclosed orbits of maps in ball arithmetic (Arb): exact steps of a scheme from an exact start.

A map of a flock may be chaotic, so that the order of a sum decides where its floating-point orbit is after some hundred
steps. Here each step is made with balls, of the numbers that the law and the start hold in binary, at a precision that
is doubled until every ball is thin at the last step, or until the budget is spent. Where a ball lies across the end of
a piece of the pair law, it is evaluated on both pieces, as the law is continuous there.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import sqrt
from typing import Any

import numpy as np
from flint import arb, ctx, fmpq

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.certified.balls import minus, norm2
from flockana.certified.flow_in_balls import Flow, Pieces, ensure_enclosable, flow_of
from flockana.certified.pair_laws_in_series import Piece
from flockana.solvers.fixed_steps import FixedSteps

BUDGET = 200_000  # pairs evaluated at 128 bits, in all: some ten seconds
_FIRST_BITS = 128
_THIN = 1e-10  # of the law's length and speed: a ball that is wider is no knowledge
_ROUND = 2.0**-52


@dataclass(frozen=True)
class BallOrbit:
    """Enclosed states at some steps: midpoints and half widths of q and p, shape (S, n, m)."""

    q: FloatArray
    p: FloatArray
    q_off: FloatArray
    p_off: FloatArray
    known: int  # rows, from the first on; the others are NaN
    spent: float  # share of the budget
    bits: int


def has_ball_orbit(law: Any) -> bool:
    """Return whether a map is an explicit one-step method of a law with a right-hand side in balls."""
    if type(law) is not FixedSteps:
        return False
    try:
        ensure_enclosable(law.law)
    except ArgumentError:
        return False
    return True


def enclose_orbit(
    law: Any, t0: float, q0: FloatArray, p0: FloatArray, wanted: Sequence[int], *, budget: float = BUDGET
) -> BallOrbit:
    """Enclose the exact orbit of a numerical integration scheme at selected steps, in ball arithmetic.

    The law's parameters, unlike those of a tube, are their binary values; `budget` counts pairs, at 128 bits.
    """
    bits, left = _FIRST_BITS, float(budget)
    best_orbit: BallOrbit | None = None
    while best_orbit is None or (best_orbit.known < len(wanted) and left > 0.0):
        with ctx.workprec(bits):
            best_orbit, left = _pass(law, t0, (q0, p0), wanted, left)
        bits *= 2
    return best_orbit


def _pass(
    law: Any, t0: float, start: tuple[FloatArray, FloatArray], wanted: Sequence[int], left: float
) -> tuple[BallOrbit, float]:
    """Return the orbit in balls until one is too wide or the budget ends, and the budget left."""
    n, m = start[0].shape
    flow, begin = flow_of(law.law, n, m, number=_binary), left + 0.0
    h, half_dimension, t, evaluations = arb(law.dt), n * m, arb(t0), len(law.solver.b)
    widest = np.repeat([law.scales.length, law.scales.speed], half_dimension) * _THIN
    state = [arb(float(x)) for x in np.concatenate([item.ravel() for item in start])]
    rows = np.full((len(wanted), 2, 2, n, m), np.nan)
    finished_rows, k, cost = 0, 0, max(ctx.prec / _FIRST_BITS, 1.0) ** 1.2
    while True:
        midpoint, radii = (np.array([float(ball_part(x)) for x in state]) for ball_part in (arb.mid, arb.rad))
        if not (radii <= widest).all():
            break
        if k == wanted[finished_rows]:
            rows[finished_rows] = np.stack([midpoint, radii + _ROUND * np.abs(midpoint)]).reshape(2, 2, n, m)
            finished_rows += 1
            if finished_rows == len(wanted):
                break
        state, near_count = _step(flow, law, t + k * h, h, state)
        left -= cost * (near_count + evaluations)
        if left <= 0.0:
            break
        k += 1
    parts = (rows[:, 0, 0], rows[:, 0, 1], rows[:, 1, 0], rows[:, 1, 1])
    return BallOrbit(*parts, finished_rows, 1.0 - max(left, 0.0) / begin, ctx.prec), left


def _step(flow: Flow, law: Any, t: arb, h: arb, state: Sequence[arb]) -> tuple[list[arb], int]:
    """Return the state after one step of the integration method, and the number of pairs evaluated."""
    half, slopes, count, solver = flow.n * flow.m, list[list[arb]](), 0, law.solver
    for row, s in zip(solver.a, (sum(row) for row in solver.a), strict=True):
        moved_state = _moved(state, h, row, slopes)
        pieces, near_count = _pieces(flow, moved_state, law.law.alpha.r)
        slopes.append([*moved_state[half:], *flow.input(t + h * arb(s), moved_state, pieces)])
        count += near_count
    next_state = _moved(state, h, solver.b, slopes)
    if solver.position_factor:
        input_scale = arb(solver.position_factor) * h * h
        next_state[:half] = [x + input_scale * a for x, a in zip(next_state[:half], slopes[0][half:], strict=True)]
    return next_state, count


def _moved(state: Sequence[arb], h: arb, weights: Sequence[float], slopes: list[list[arb]]) -> list[arb]:
    """Return the intermediate state y + h Σ_j w_j K_j of a Runge-Kutta stage."""
    slopes_used = [(h * arb(w), slope) for w, slope in zip(weights, slopes, strict=False) if w]
    return [sum((w * slope[k] for w, slope in slopes_used), x) for k, x in enumerate(state)]


def _pieces(flow: Flow, state: Sequence[arb], r: float) -> tuple[Pieces, int]:
    """Return the smooth piece of every pair and agent, and the number of pairs that may be in range."""
    positions = state[: flow.n * flow.m]
    x = np.array([float(y.mid()) for y in positions]).reshape(flow.n, flow.m)
    position_radius = max(float(y.rad()) for y in positions)
    reach = r * (1.0 + 1e-9) + 2.0 * sqrt(flow.m) * (position_radius + 4.0 * _ROUND * float(np.abs(x).max()))
    distances = np.linalg.norm(x[:, None] - x, axis=2)
    q, near_count, pieces = flow.split(state)[0], 0, []
    for i, j in combinations(range(flow.n), 2):
        is_far = distances[i, j] > reach
        near_count += not is_far
        pieces.append(Piece.OUT if is_far else flow.pair.piece(norm2(minus(q[i], q[j]))))
    return (*pieces, *(term.piece(y) for term in flow.terms for y in q)), near_count


def _binary(x: Any) -> fmpq:
    """Return a number as the exact rational of its binary form."""
    fraction = Fraction(float(x))
    return fmpq(fraction.numerator, fraction.denominator)
