"""Checks of every step: no encounter is leapt over, no pole is crossed, the energy is balanced.

One source for every integrator, compiled with the law or not. A step that does not stand is made again, and shorter.
"""

from typing import Any, NamedTuple

import numpy as np

from flockana.jit import inlined
from flockana.kernels.adaptive_steps import GROWTH, spacing
from flockana.kernels.encounter_checks import Ends
from flockana.kernels.step_shares import POLE

ROUNDINGS = 64.0  # of the time: a step of so few is not made again
HALVINGS, FALLS = 4, 0.04  # a residual that so many halvings leave above so much is not the integrator's to mend
HELPS = 0.25  # of the residual, a halving: across a kink of the force it leaves an eighth, of a wrong rate one half
PATIENCE = 4  # steps in a row that halving did not mend, after which none is halved any more
LARGEST, IN_VAIN, HALVED, TRIED = range(4)  # of a ledger: largest |H|, steps that halving did not mend; of this step


class Rules(NamedTuple):
    """Settings of the step checks."""

    paths: Any  # whether there are encounters, poles or obstacles
    energetic: Any  # whether energies are looked at
    balance: Any  # share of the energy, and energy, that the balance of a step may be off by
    fixed: Any  # whether the method's steps are of fixed length


class Judged(NamedTuple):
    """Data for checking integration steps: encounters, settings, and the record of energy balances."""

    around: Any  # `flockana.kernels.encounter_checks.Around`
    rules: Any
    ledger: Any  # of the balance
    share: Any  # `flockana.kernels.step_shares.share_of_step`


def empty_ledger() -> Any:
    """Return the empty record of energy-balance checks for a run that has not begun."""
    return np.zeros(TRIED + 64)


@inlined
def balanced(first, last, work, balance, ledger):
    """Return the accepted fraction of a step by the balance of energy and work; update the ledger.

    A residual that does not fall when the step is halved is not the integrator's: the law's rate is not that of its
    energy, or all is rounding. Then steps stand as they are.
    """
    if np.isfinite(first) and not np.isfinite(last):  # the step ends where the potential is infinite
        return POLE
    residual, largest = abs(last - first - work), max(max(ledger[LARGEST], abs(first)), abs(last))
    worst, halved = 0.0, np.int64(ledger[HALVED])
    for k in range(halved + 1 - HALVINGS):
        worst = max(worst, ledger[TRIED + k])
    is_unbalanced = residual > max(balance[0] * largest, balance[1])
    if is_unbalanced and TRIED + halved < ledger.size and (halved < HALVINGS or residual <= FALLS * worst):
        ledger[TRIED + halved] = residual
        ledger[HALVED] = halved + 1
        return 0.5
    if halved:
        ledger[IN_VAIN] = 0.0 if residual <= ledger[TRIED] * HELPS**halved else ledger[IN_VAIN] + 1.0
    ledger[LARGEST], ledger[HALVED] = largest, 0.0
    return 1.0


@inlined
def ends_of(block, k, n, m):
    """Return the states at both ends of step k of a block."""
    y0, f0, y1, f1, dimension = block.y[k], block.f[k], block.y[k + 1], block.f[k + 1], n * m
    return Ends(
        block.t[k + 1] - block.t[k],
        y0[:dimension].reshape(n, m),
        y0[dimension : 2 * dimension].reshape(n, m),
        f0[dimension : 2 * dimension].reshape(n, m),
        y1[:dimension].reshape(n, m),
        y1[dimension : 2 * dimension].reshape(n, m),
        f1[dimension : 2 * dimension].reshape(n, m),
    )


@inlined
def checked(block, k, judged, view, kept, near):
    """Return (length to repeat a step with, 0 if accepted; whether a pole or lack of room ends the run)."""
    encounter_data, rules, ledger, share_allowed = judged
    t, end_time, share = block.t[k], block.t[k + 1], 1.0
    h = end_time - t
    if rules.paths:
        step_ends = ends_of(block, k, encounter_data.radii.shape[0], view[1].size)
        share = share_allowed(t, step_ends, encounter_data, view, kept, near)
    if share == 1.0 and rules.energetic and ledger[IN_VAIN] < PATIENCE:
        work_integral = block.y[k + 1, -1] - block.y[k, -1]
        share = balanced(block.energy[k], block.energy[k + 1], work_integral, rules.balance, ledger)
    is_singular, share = share < 0.0, abs(share)
    shorter_step, shortest = share * h, ROUNDINGS * spacing(max(abs(t), abs(end_time)))
    if rules.fixed:  # down to what no shorter step ends before: half of one rounding may round up to the whole
        shorter_step, shortest = max(shorter_step, h / GROWTH), 0.0
    if share == 1.0 or shorter_step <= shortest or not t < t + shorter_step < end_time:
        return 0.0, is_singular
    return shorter_step, False
