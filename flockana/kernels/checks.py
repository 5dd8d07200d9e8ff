"""Checks of every step: no encounter is leapt over, no pole is crossed, the energy is balanced.

One source for every integrator, compiled with the law or not. A step that does not stand is made again, and shorter.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from flockana.jit import njit
from flockana.kernels.encounters import Ends, band, common_way, farthest_ways, share_of_listed, steepest
from flockana.kernels.march import GROWTH, spacing
from flockana.kernels.neighbours import _FORWARD, _MARGIN, _fill_cells, _pad, _sort_into_cells
from flockana.kernels.paths import bernstein
from flockana.kernels.poles import crossing_listed
from flockana.kernels.runge_kutta import frame_at
from flockana.kernels.verlet import SKIN, covers

ROUNDINGS = 64.0  # of the time: a step of so few is not made again
HALVINGS, FALLS = 4, 0.04  # a residual that so many halvings leave above so much is not the integrator's to mend
HELPS = 0.25  # of the residual, a halving: across a kink of the force it leaves an eighth, of a wrong rate one half
PATIENCE = 4  # steps in a row that halving did not mend, after which none is halved any more
LARGEST, IN_VAIN, HALVED, TRIED = range(4)  # of a ledger: largest |H|, steps that halving did not mend; of this step
_BLOCK = 2**16  # pairs looked at together where a list of all would not fit into memory
_POLE = -0.5  # a step that crossed a pole is halved; the sign says why


class Rules(NamedTuple):
    """Settings of the step checks."""

    bodies: Any  # whether there are obstacles that no step leaps over
    pairs: Any  # whether there are encounters or poles of pairs
    energetic: Any  # whether energies are looked at
    balance: Any  # share of the energy, and energy, that the balance of a step may be off by
    fixed: Any  # whether the method's steps are of fixed length
    listed: Any  # how pairs are listed: `flockana.kernels.verlet.listed_anew`


class Judged(NamedTuple):
    """Data that steps are checked against."""

    around: Any  # `flockana.kernels.encounters.Around`
    rules: Any
    ledger: Any  # of the balance
    share: Any  # `share_of_step`


def empty_ledger() -> Any:
    """Return the ledger of a run that has not begun."""
    return np.zeros(TRIED + 64)


@njit(cache=True, error_model="numpy", nogil=True)
def _at_rest(t, h, points, view):
    """Return the same paths in the frame in which the obstacles are at rest."""
    seen, m = points.copy(), view[1].size
    frame = np.empty((2, m))
    for k in range(6):
        frame_at(t + 0.2 * k * h, view, frame)
        for i in range(len(points)):
            for c in range(m):
                seen[i, k, c] += frame[0, c]
    return seen


@njit(cache=True, error_model="numpy", nogil=True)
def _share_of(ends, seen, around, first, second, share):
    """Return the share of a step that some pairs allow, if less than `share`; negative if one crosses a pole."""
    common, ways, between = seen
    beside = steepest(common[1]), ways[0] + ways[1]
    poles = around.poles[: 0 if around.few else around.poles.size]
    if poles.size and crossing_listed(ends, beside, poles, around.toward, first, second):
        return _POLE
    if not around.radii.size:
        return share
    return share_of_listed(ends, common[0], between, around, first, second, share)


@njit(cache=True, error_model="numpy", nogil=True)
def _share_of_crowd(ends, seen, around, share):
    """Return `_share_of` over all close pairs, found block by block without a list."""
    q0, within = ends.q0, seen[2][1]
    (n, m), size, row = q0.shape, 1, 0
    while size < 4 * n:
        size *= 2
    parts = _sort_into_cells(_pad(q0), within * _MARGIN, size)
    first, second = np.empty(max(_BLOCK, n), np.uint32), np.empty(max(_BLOCK, n), np.uint32)
    forward = _FORWARD[: (1, 4, 13)[m - 1]]
    while row < n:
        row, count = _fill_cells(parts, forward, within * within, row, first, second)
        share = _share_of(ends, seen, around, first[:count], second[:count], share)
        if share < 0.0:
            return share
    return share


@njit(cache=True, error_model="numpy", nogil=True)
def share_of_step(t, ends, around, rules, view, kept, near):
    """Return (accepted fraction of a step, list of pairs); the fraction is negative if a pair crosses a pole.

    The list `kept` is the integrator's, `near` that of these checks, which is made anew where neither holds all pairs
    that may meet.
    """
    share, few = 1.0, around.poles.size and around.few
    if rules.bodies:
        points, _, allowance = bernstein(*ends)
        seen = _at_rest(t, ends.h, points, view)
        share = around.guard(seen, allowance, around.numbers, around.starts, around.shell[0], around.shell[1], share)
    if not rules.pairs or len(ends.q0) == 1:
        return share, near
    common = common_way(ends)
    ways = farthest_ways(ends, common)
    between = band(common, ways, around.edges, around.far)
    if few:
        beside = steepest(common[1]), ways[0] + ways[1]
        if crossing_listed(ends, beside, around.poles, around.toward, around.first, around.second):
            return _POLE, near
        if not around.radii.size:
            return share, near
    held = kept
    if not covers(kept, ends.q0, between[1]):
        if not covers(near, ends.q0, between[1]):
            near = rules.listed(ends.q0, (1.0 + SKIN) * between[1], near)
        held = near
    whole = common, ways, between
    if held.count < 0:
        return _share_of_crowd(ends, whole, around, share), near
    return _share_of(ends, whole, around, held.first[: held.count], held.second[: held.count], share), near


@njit(cache=True, error_model="numpy", nogil=True)
def balanced(first, last, work, balance, ledger):
    """Return the fraction of a step that the balance of energies and work accepts; update the ledger.

    A residual that does not fall when the step is halved is not the integrator's: the law's rate is not that of its
    energy, or all is rounding. Then steps stand as they are.
    """
    if np.isfinite(first) and not np.isfinite(last):  # the step ends where the potential is infinite
        return _POLE
    residual, largest = abs(last - first - work), max(ledger[LARGEST], abs(first), abs(last))
    worst, halved = 0.0, np.int64(ledger[HALVED])
    for k in range(halved + 1 - HALVINGS):
        worst = max(worst, ledger[TRIED + k])
    off = residual > max(balance[0] * largest, balance[1])
    if off and TRIED + halved < ledger.size and (halved < HALVINGS or residual <= FALLS * worst):
        ledger[TRIED + halved] = residual
        ledger[HALVED] = halved + 1
        return 0.5
    if halved:
        ledger[IN_VAIN] = 0.0 if residual <= ledger[TRIED] * HELPS**halved else ledger[IN_VAIN] + 1.0
    ledger[LARGEST], ledger[HALVED] = largest, 0.0
    return 1.0


@njit(cache=True, error_model="numpy", nogil=True)
def ends_of(block, k, n, m):
    """Both ends of step k of a block."""
    y0, f0, y1, f1, size = block.y[k], block.f[k], block.y[k + 1], block.f[k + 1], n * m
    return Ends(
        block.t[k + 1] - block.t[k],
        y0[:size].reshape(n, m),
        y0[size : 2 * size].reshape(n, m),
        f0[size : 2 * size].reshape(n, m),
        y1[:size].reshape(n, m),
        y1[size : 2 * size].reshape(n, m),
        f1[size : 2 * size].reshape(n, m),
    )


@njit(cache=True, error_model="numpy", nogil=True)
def checked(block, k, judged, view, kept, near):
    """Return (length to repeat step k with, 0 if it is accepted; whether the run ends at a pole; the checks' list)."""
    around, rules, ledger, share_allowed = judged
    t, at, share = block.t[k], block.t[k + 1], 1.0
    h = at - t
    if rules.bodies or rules.pairs:
        ends = ends_of(block, k, around.radii.shape[0], view[1].size)
        share, near = share_allowed(t, ends, around, rules, view, kept, near)
    if share == 1.0 and rules.energetic and ledger[IN_VAIN] < PATIENCE:
        work = block.y[k + 1, -1] - block.y[k, -1]
        share = balanced(block.energy[k], block.energy[k + 1], work, rules.balance, ledger)
    singular, share = share < 0.0, abs(share)
    shorter, least = share * h, ROUNDINGS * spacing(max(abs(t), abs(at)))
    if rules.fixed:  # down to what no shorter step ends before: half of one rounding may round up to the whole
        shorter, least = max(shorter, h / GROWTH), 0.0
    if share == 1.0 or shorter <= least or not t < t + shorter < at:
        return 0.0, singular, near
    return shorter, False, near
