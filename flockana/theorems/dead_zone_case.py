"""What the two forms of the dead-zone theorem share: its hypotheses, and how a flock that has come apart goes on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flockana.checks import FloatArray
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.laws.law import DiscreteLaw
from flockana.laws.semi_implicit import SemiImplicitEuler
from flockana.metrics import min_distance
from flockana.nets import components, links
from flockana.theorems.theorem import Claim, Hypothesis, judge
from flockana.trajectory import Trajectory


def dead_zone_law(run: Trajectory) -> DeadZoneFlocking | None:
    """The dead-zone law of a run, of its semi-implicit Euler steps too; None under another law.

    Parameters
    ----------
    run : Trajectory
        The run.
    """
    law = run.law.law if isinstance(run.law, SemiImplicitEuler) else run.law
    return law if isinstance(law, DeadZoneFlocking) else None


def hypotheses(run: Trajectory) -> list[Hypothesis]:
    """The law, and distinct positions at the start.

    Parameters
    ----------
    run : Trajectory
        The run.
    """
    law = dead_zone_law(run)
    applies = Hypothesis("the dead-zone law is applied", "met" if law else "unmet", detail=type(run.law).__name__)
    least = min_distance(run.q[0])
    distinct = Hypothesis("agents start at distinct places", "met" if least > 0.0 else "unmet", least)
    return [applies, distinct]


@dataclass(frozen=True)
class Parts:
    """The components of a flock at one instant.

    Parameters
    ----------
    count : int
        How many.
    mismatch : float
        Largest ½ Σ‖p_i − p̄‖² over n_c of a component c with n_c agents.
    parting : bool
        Whether there are several and every two of them move apart, each as a whole at its own velocity: then they never
        meet again.
    """

    count: int
    mismatch: float
    parting: bool


def parts(q: FloatArray, p: FloatArray, r: float) -> Parts:
    """Components of the net at r, and whether they part for ever.

    Parting is judged from the bounding balls: centres that recede, and a gap between the balls that exceeds r.

    Parameters
    ----------
    q, p : ndarray, shape (n, m)
        Positions and velocities.
    r : float
        Interaction range.

    Examples
    --------
    >>> parts(np.array([[0.0], [9.0]]), np.array([[-1.0], [1.0]]), 2.0)
    Parts(count=2, mismatch=0.0, parting=True)
    """
    label = components(len(q), links(q, r))
    groups = [np.flatnonzero(label == k) for k in range(int(label.max()) + 1)]
    centre = np.array([q[g].mean(axis=0) for g in groups])
    velocity = np.array([p[g].mean(axis=0) for g in groups])
    mismatch = max(0.5 * float(np.sum((p[g] - v) ** 2)) / len(g) for g, v in zip(groups, velocity, strict=True))
    a, b = np.triu_indices(len(groups), 1)
    receding = np.sum((centre[b] - centre[a]) * (velocity[b] - velocity[a]), axis=1)
    return Parts(len(groups), mismatch, bool(a.size and (receding > 0.0).all()))


def no_collision(run: Trajectory, bound: float, needs: list[Hypothesis], *, name: str) -> Claim:
    """No two agents come closer than a bound: between the samples too, except for a map, which has nothing there.

    Parameters
    ----------
    run : Trajectory
        The run.
    bound : float
        The bound, at least 0.
    needs : list of Hypothesis
        Hypotheses of the claim.
    name : str
        Name of the claim.
    """
    if isinstance(run.law, DiscreteLaw) or len(run.t) == 1:
        series = np.array([min_distance(q) for q in run.q])
        k = int(np.argmin(series))
        least, upper, where, time = float(series[k]), float(series[k]), "at the samples", float(run.t[k])
    else:
        closest = run.closest_approach()
        least, upper, where, time = closest.lower, closest.distance, "ever", closest.time
    status = judge(least - bound, 0.0, needs)
    if status == "refuted" and upper > bound:  # the lower bound is weak where samples are sparse
        status = "inconclusive"
    return Claim(
        name,
        status,
        computed=least,
        stated=f"every distance > {bound:.4g}",
        margin=least - bound,
        error=0.0,
        witness={"time": time},
        detail=f"no two agents come closer than {least:.4g} {where}; the bound is {bound:.3g}",
    )
