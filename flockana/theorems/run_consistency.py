"""Consistency of a run's samples with its law, checked before a theorem is judged.

That a run is whole its seal says. What no seal can say is that the law is the same function now as it was then.
"""

import numpy as np

from flockana.base.errors import ArgumentError, FlockanaError
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.first_order_law import VelocityLaw
from flockana.laws.jump_laws import SwitchedLaw
from flockana.theorems.map_steps import ensure_steps_of_map

SAME_INPUT = 1e-8  # of the largest input: other machine code evaluates a law to 1e-13, another law does not


def ensure_fits(run: Trajectory) -> None:
    """Raise unless recomputed inputs, or some recomputed steps of a map, agree with the run's samples."""
    run.cached("fits", lambda: _ensure_fits(run))


def _ensure_fits(run: Trajectory) -> bool:
    if run.law.is_map:
        ensure_steps_of_map(run)
        return True
    if isinstance(run.law, VelocityLaw):
        _ensure_velocities(run, run.law)
        return True
    difference = np.abs(run.u - run._flows[0]).max(axis=(1, 2))
    if run.status == "failed":  # where agents met the law has no input
        difference[~np.isfinite(run._flows[0]).all(axis=(1, 2))] = 0.0
    if isinstance(run.law, SwitchedLaw):
        law, tiny_distance = run.law, 1e-9 * run.scales.length  # at a jump of the force the input has two values
        difference[[bool((law.margins(law.pieces(q), q).inside < tiny_distance).any()) for q in run.q]] = 0.0
    input_tolerance = SAME_INPUT * max(float(np.abs(run.u).max()), run.scales.force)
    for k in np.flatnonzero(~(difference <= input_tolerance)).tolist():
        if difference[k] <= input_tolerance + _rounded_input(run, k):
            continue
        raise ArgumentError(
            f"u at t = {run.t[k]:g} is off by {difference[k]:.3g} from the input of {run.law.title} at that "
            "state: expected a run as simulate returned it; was it edited, or is it of another law?"
        )
    return True


def _ensure_velocities(run: Trajectory, law: VelocityLaw) -> None:
    """Raise unless the velocities of a run are those of its law of first order."""
    difference = np.abs([law.velocity(t, q) - p for t, q, p in zip(run.t, run.q, run.p, strict=True)]).max(axis=(1, 2))
    k = int(difference.argmax())
    if difference[k] > SAME_INPUT * max(float(np.abs(run.p).max()), run.scales.speed):
        raise ArgumentError(
            f"p at t = {run.t[k]:g} is off by {difference[k]:.3g} from the velocity of {law.title} there: expected a "
            "run as simulate returned it; was it edited, or is it of another law?"
        )


def _rounded_input(run: Trajectory, k: int) -> float:
    """Return the contribution to a force that rounding of a sample can explain."""
    if run.law.compiled(run.m) is None:
        return 0.0
    try:
        slopes = run.law.derivatives(run.t[k], run.q[k], run.p[k])
    except FlockanaError:  # where the law has no input, no run can be
        return 0.0
    forces = zip(slopes, (run.q[k], run.p[k]), strict=True)
    return float(sum(abs(slope) @ np.spacing(np.abs(x).ravel()) for slope, x in forces).max())
