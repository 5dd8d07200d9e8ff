"""Links that are kept for ever: below an energy level none reaches the range, so a connected net stays connected."""

from __future__ import annotations

import numpy as np

from flockana.base.vectors import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.kernels.paths import control_points
from flockana.laws.link_keeping import LinkKeeping
from flockana.measures.nets import components
from flockana.measures.path_bounds import ROUNDING
from flockana.theorems.claims import judged
from flockana.theorems.hypotheses import condition, law_is
from flockana.theorems.olfati_saber.energy import balance, never_rises
from flockana.theorems.rounding import EPS
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances

_PROOF = "links-kept"


def _joined(run: Trajectory) -> Hypothesis:
    """The hypothesis that the links join all agents."""
    ends = np.array(run.law.links, dtype=np.int32).reshape(-1, 2)
    parts = len({*components(run.n, ends).tolist()})
    return condition("the links join all agents", parts == 1, float(1 - parts), f"{parts} parts, {len(ends)} links")


def _length_bound(run: Trajectory) -> float:
    """No link is longer than this on the interpolated path: its control points are not."""
    ends = np.array(run.law.links, dtype=np.int64).reshape(-1, 2)
    t, *states, slack = run.path
    bound = 0.0
    for k in range(len(t) - 1):
        points, _, allowance = control_points(t[k + 1] - t[k], *(x[s] for s in (k, k + 1) for x in states))
        off = allowance if slack is None else allowance + slack[k]
        apart = lengths(points[ends[:, 1]] - points[ends[:, 0]]).max(axis=1)
        bound = max(bound, float((apart + 2.0 * np.max(off)).max(initial=0.0)))
    return bound


def _below(run: Trajectory, name: str, most: float, rounding: float, stated: str, needs: list[Hypothesis]) -> Claim:
    """The claim that no link is longer than `most`: by a bound of the path, refuted by a sample alone."""
    reached = max(float(run.law.lengths(q).max(initial=0.0)) for q in run.q)
    bound = max(_length_bound(run), reached)
    length = reached if most - bound <= rounding else bound
    return judged(
        name,
        (most - length) / run.law.r,
        rounding / run.law.r,
        needs,
        verifies=length == bound and len(run.t) > 1,
        computed=reached,
        stated=stated,
        proof=_PROOF,
        detail=f"the longest link is {reached:.4g} at a sample and at most {bound:.4g} between; r = {run.law.r:g}",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    law, joined = run.law, _joined(run)
    energy = float(run.energy()[0])
    rounding = ROUNDING * float(np.abs(run.q).max()) + 64.0 * EPS * law.r
    longest = law.longest(energy * (1.0 + run.n**2 * EPS))
    level = f"no link is longer than the {longest:.5g} at which it alone has H(0) = {energy:.5g}"
    return [joined], [
        never_rises(run, [], proof=_PROOF),
        balance(run, [], tolerances, proof=_PROOF),
        _below(run, "links", longest, rounding, level, []),
        _below(run, "connected", law.r, rounding, "the links, all shorter than r, join all agents always", [joined]),
    ]


THEOREM = Theorem(
    id="links-kept",
    title="A tension without bound at the range keeps the net connected",
    statement=(
        "Along u_i = -Σ_j ∇_i ψ + c Σ_j (p_j - p_i) over links, with ψ(s) = k s²/(r - s) and c >= 0, the energy "
        "H = Σ ψ + ½ Σ‖p_i‖² never rises. So no link that is shorter than r at the start is ever longer than the "
        "length at which it alone has H(0), which is below r; if the links join all agents, they do so for ever."
    ),
    source=(
        "Zavlanos, Jadbabaie and Pappas 2007, with the tension of Ji and Egerstedt 2007; the net is that of the start, "
        "without the links that both add, and the bound of each link is ours"
    ),
    kind="trajectory",
    check=_check,
    law=law_is("link-keeping", LinkKeeping),
    claims=("rate", "balance", "links", "connected"),
    references=("zavlanos-2007", "ji-egerstedt-2007"),
)
