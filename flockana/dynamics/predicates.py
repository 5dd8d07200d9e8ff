"""Predicates of Olfati-Saber's paper for groups in a run: cohesive, quasi-flock, flock, dynamic flock.

A run is known at its samples; between them only distances are bounded (`Trajectory.closest_approach`). Links may come
and go between samples, so predicates about nets speak of the sampled times.
"""

from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import ensure_nonnegative, ensure_positive
from flockana.dynamics.trajectory import Trajectory

Ended = TypeVar("Ended", bound=Any)  # a run, or a tube, with its status
BoolArray = npt.NDArray[np.bool_]


def ensure_run(trajectory: Any, name: str = "trajectory") -> Trajectory:
    """Return `trajectory` if it is a run; raise `ArgumentError` otherwise."""
    if not isinstance(trajectory, Trajectory):
        raise ArgumentError(f"{name} = {format_value(trajectory)}: expected a run, as simulate(...) gives it")
    return trajectory


def ensure_uninterrupted(run: Ended) -> Ended:
    """Return the run; raise KeyboardInterrupt if Ctrl-C ended the run early.

    Parameters
    ----------
    run : Trajectory or Tube
        As `simulate` or `enclose` gives it, with status "interrupted" or another.

    Examples
    --------
    >>> import flockana as fl
    >>> ensure_uninterrupted(fl.simulate(fl.Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 0.1))).status
    'complete'
    """
    if run.status == "interrupted":
        raise KeyboardInterrupt
    return run


def is_flock(trajectory: Trajectory) -> BoolArray:
    """Return a mask of the samples at which the net G(q) is connected, shape (T,)."""
    result: BoolArray = ensure_run(trajectory).metrics().connectivity.values == 1.0
    return result


def is_quasi_flock(trajectory: Trajectory, *, share: float = 0.5) -> BoolArray:
    """Return a mask of the samples at which a giant component holds more than `share` of the agents, shape (T,).

    Parameters
    ----------
    share : float
        What counts as giant; the source gives no number.

    Raises
    ------
    ArgumentError
        If it is no share from 0 to below 1.
    """
    if (giant_share := ensure_nonnegative("share", share)) >= 1.0:
        raise ArgumentError(f"share = {giant_share:g}: expected a share from 0 to below 1, such as 0.5")
    result: BoolArray = ensure_run(trajectory).metrics().giant_share.values > giant_share
    return result


def is_cohesive(trajectory: Trajectory, radius: float) -> bool:
    """Whether all agents stay within `radius` of the centre of mass at all samples.

    Parameters
    ----------
    radius : float
        In the unit of q.
    """
    return bool(ensure_run(trajectory).metrics().cohesion_radius.max() <= ensure_positive("radius", radius))


def is_dynamic_flock(trajectory: Trajectory) -> bool:
    """Whether the net is connected at every sample of the run (cut one with `Trajectory.window`)."""
    return bool(is_flock(trajectory).all())
