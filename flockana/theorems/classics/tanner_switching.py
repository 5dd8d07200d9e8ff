"""Tanner, Jadbabaie and Pappas (2007): a net of proximity whose forces jump at its range, connected at all times."""

from __future__ import annotations

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.laws.tanner import ProximityFlocking
from flockana.measures.nets import components, links
from flockana.theorems.classics.tanner_claims import comes_to_rest, energy_falls, no_collision, out_of_range
from flockana.theorems.hypotheses import condition, law_is
from flockana.theorems.rounding import EPS
from flockana.theorems.theorem import Checked, Hypothesis, Theorem, Tolerances, unmet


def _connected(run: Trajectory) -> Hypothesis:
    """Connected for ever: certain if too few pairs can leave, not so if it is apart at a sample, else assumed."""
    name = "the net is connected at all times"
    blur = 8.0 * EPS * float(np.abs(run.q).max())
    for q, t in zip(run.q, run.t, strict=True):
        if components(run.n, links(q, run.law.r + blur)).max() > 0:
            return condition(name, False, detail=f"it is in several parts at t = {t:.6g}")
    pairs = out_of_range(run)
    start = components(run.n, links(run.q[0], run.law.r - blur)).max() == 0
    if start and pairs * (1.0 + 1e-12) < run.n - 1:
        text = f"the energy of the start can put {pairs:.3g} pairs out of range, and {run.n - 1} would be needed"
        return condition(name, True, (run.n - 1 - pairs) / (run.n - 1), text)
    return Hypothesis(name, "assumed", None, "it is at every sample; its energy does not say that it stays so")


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    needs = [_connected(run)]
    if unmet(needs):
        return needs, []
    return needs, [
        energy_falls(run, tolerances, proof="tanner"),
        no_collision(run, *np.triu_indices(run.n, 1), proof="tanner"),
        *comes_to_rest(run, tolerances, ("velocities", "critical")),
    ]


THEOREM = Theorem(
    id="tanner-switching",
    title="A net of proximity that stays connected flocks, though its forces jump",
    statement=(
        "Let agents steer by u_i = -Σ (p_i - p_j) - Σ ∇V_ij over those nearer than R, V being unbounded at contact, "
        "with one minimum, and constant from R on, where its gradient may jump; solutions are Filippov's. If the net "
        "is connected at all times, velocities become the same, no two agents collide, and the flock tends to a state "
        "in which no force acts. That it stays connected is certain if H(0) < (n - 1) V(R): a cut leaves n - 1 pairs "
        "beyond R at least."
    ),
    source="Tanner, Jadbabaie and Pappas 2007, on switching networks; the sufficient condition is ours",
    kind="trajectory",
    law=law_is("the law on a net of proximity", ProximityFlocking),
    check=_check,
    claims=("energy", "no-collision", "velocities", "critical"),
    references=("tanner-2007",),
)
