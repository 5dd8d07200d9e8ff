"""Tanner, Jadbabaie and Pappas (2007): a proximity net with force jumps at its range, always connected."""

import numpy as np

from flockana.measures.nets import components, links
from flockana.sources.tanner_2007.laws import ProximityFlocking
from flockana.sources.tanner_2007.theorems.common_claims import comes_to_rest, no_collision, out_of_range
from flockana.theorems.energy import balance
from flockana.theorems.hypotheses import condition, law_is
from flockana.theorems.theorem_toolkit import EPS, Checked, Hypothesis, Observed, Tolerances, run_theorem, unmet


def _connected(seen: Observed) -> Hypothesis:
    """Return the hypothesis that the net is connected at all times."""
    name, run = "the net is connected at all times", seen.run
    error_bounds = 8.0 * EPS * float(np.abs(run.q).max()) + 2.0 * seen.shape_error.max(axis=1)
    for q, t, range_error in zip(run.q, run.t, error_bounds, strict=True):
        if components(run.n, links(q, run.law.r + float(range_error))).max() > 0:
            return condition(name, False, detail=f"the net has several components at t = {t:.6g}", decided="enclosed")
    pairs = out_of_range(seen)
    start = components(run.n, links(run.q[0], run.law.r - float(error_bounds[0]))).max() == 0
    if start and pairs.hi < run.n - 1:
        text = f"the energy of the start can put {pairs.mid:.3g} pairs out of range; to part takes {run.n - 1}"
        return condition(name, True, float((run.n - 1 - pairs).mid) / (run.n - 1), text, decided="enclosed")
    detail = "connected at every sample; its energy does not guarantee more"
    return Hypothesis(name, "assumed", None, detail, on_motion=True)


@run_theorem(
    "tanner-switching",
    title="A net of proximity that stays connected flocks, though its forces jump",
    source="Tanner, Jadbabaie and Pappas 2007, on switching networks; the sufficient condition is ours",
    law=law_is("the law on a net of proximity", ProximityFlocking),
    claims=("energy", "no-collision", "velocities", "critical"),
    references=("tanner-2007",),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let agents steer by u_i = -Σ (p_i - p_j) - Σ ∇V_ij over those nearer than R, V being unbounded at contact, with
    one minimum, and constant from R on, where its gradient may jump; solutions are Filippov's. If the net is connected
    at all times, velocities become the same, no two agents collide, and the flock tends to a state in which no force
    acts. That it stays connected is certain if H(0) < (n - 1) V(R): in a disconnected net at least n - 1 pairs are
    beyond R.
    """
    if unmet(requirements := [_connected(seen)]):
        return requirements, []
    return requirements, [
        balance(seen, [], tolerances, name="energy", proof="tanner"),
        no_collision(seen, *np.triu_indices(seen.n, 1), "tanner", []),
        *comes_to_rest(seen, requirements, ("velocities", "critical")),
    ]
