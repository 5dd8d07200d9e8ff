"""What the two forms of the dead-zone theorem share: its hypotheses, and how a flock that has come apart goes on."""

from __future__ import annotations

from dataclasses import dataclass
from math import floor, inf

import numpy as np

from flockana.checks import FloatArray
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.laws.law import DiscreteLaw
from flockana.laws.semi_implicit import SemiImplicitEuler
from flockana.metrics import min_distance
from flockana.nets import components, links
from flockana.theorems.theorem import Claim, Hypothesis, judge
from flockana.trajectory import Trajectory

PROOF = "dead-zone"


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
        Whether there are several and it is certain that each goes its own way: under the flow from here no two of them
        ever meet again, and every two have different mean velocities, so that they end arbitrarily far apart.
    """

    count: int
    mismatch: float
    parting: bool


def parts(q: FloatArray, p: FloatArray, law: DeadZoneFlocking) -> Parts:
    """Components of the net at r, and whether they are certain to part for ever.

    While no two components meet, each has a centre of constant velocity and an energy H̄ of its own that does not rise.
    No pair's potential is negative, so at most M = ⌊H̄/ψ̄(r)⌋ of its pairs are ever out of range. If M < n − 1 it stays
    connected, for a cut leaves at least n − 1 pairs out of range; then the steps in the net from one agent to all
    others are at most n − 1 + M in number, as each step beyond the first leaves a pair out of range. So nobody gets
    farther from the centre than B = r (n − 1 + M)/n. Two components never meet if their centres, at constant
    velocities, never come closer than r + B + B'. Where M ≥ n − 1 nothing is known.

    Parameters
    ----------
    q, p : ndarray, shape (n, m)
        Positions and velocities.
    law : DeadZoneFlocking
        The law.

    Examples
    --------
    >>> law, apart = DeadZoneFlocking(), np.array([[0.0], [16.0]])
    >>> parts(apart, np.array([[-1.0], [1.0]]), law)
    Parts(count=2, mismatch=0.0, parting=True)
    >>> parts(apart, np.array([[1.0], [-1.0]]), law).parting
    False
    """
    label = components(len(q), links(q, law.interaction.r))
    groups = [np.flatnonzero(label == k) for k in range(int(label.max()) + 1)]
    centre = np.array([q[g].mean(axis=0) for g in groups])
    velocity = np.array([p[g].mean(axis=0) for g in groups])
    mismatch = max(0.5 * float(np.sum((p[g] - v) ** 2)) / len(g) for g, v in zip(groups, velocity, strict=True))
    radius = np.array([_stray(q[g], p[g], law) for g in groups])
    a, b = np.triu_indices(len(groups), 1)
    x, v = centre[b] - centre[a], velocity[b] - velocity[a]
    speed2 = np.sum(v**2, axis=1)
    turn = np.maximum(0.0, -np.sum(x * v, axis=1)) / np.where(speed2 > 0.0, speed2, 1.0)  # when they are closest
    nearest = np.linalg.norm(x + turn[:, None] * v, axis=1)
    away = (speed2 > 0.0) & (nearest > law.interaction.r + radius[a] + radius[b])
    return Parts(len(groups), mismatch, bool(a.size and away.all()))


def _stray(q: FloatArray, p: FloatArray, law: DeadZoneFlocking) -> float:
    """B: a bound, for ever, of how far an agent of a component gets from its centre; inf if it might break up."""
    n, far = len(q), law.interaction.far_potential
    if n == 1:
        return 0.0
    share = law.hamiltonian(0.0, q, p) / far if far > 0.0 else inf
    return law.interaction.r * (n - 1 + floor(share)) / n if share < n - 1 else inf


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
        proof=PROOF,
        detail=f"no two agents come closer than {least:.4g} {where}; the bound is {bound:.3g}",
    )
