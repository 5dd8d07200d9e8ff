"""Su, Wang and Lin (2009): Algorithm 2 with few informed agents and a virtual leader of constant velocity."""

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.laws.olfati_saber import Algorithm2
from flockana.sources.su_2009.theorems import leader_frame
from flockana.theorems.cohesion import stays_within
from flockana.theorems.collisions import below_multiple, distinct_pairs, no_collision, pairs_at_one_instant
from flockana.theorems.energy import never_rises
from flockana.theorems.search_objectives import pairs_apart
from flockana.theorems.theorem_toolkit import (
    Checked,
    Hypothesis,
    Observed,
    Tolerances,
    law_is,
    positive,
    run_theorem,
    unmet,
)

PROOF = "informed-agents"
CLAIMS = ("energy", "distance", "informed", "linked", "pairs", "one-instant", "no-collision")


def _lasting(run: Trajectory) -> tuple[Hypothesis, np.ndarray]:
    """Return the hypothesis that uninformed agents stay linked to informed ones, and a mask of such agents."""
    is_led = leader_frame.linked_to_informed(run) & ~leader_frame.informed(run)
    count, of = int(is_led.sum()), int((~leader_frame.informed(run)).sum())
    text = f"{count} of {of} uninformed agents, in each of {leader_frame.WINDOWS} windows of the last half of the run"
    name = "uninformed agents are joined to informed ones across each of contiguous, bounded windows, without end"
    return Hypothesis(name, "assumed" if count else "unmet", float(count), text), is_led


@run_theorem(
    "su-informed",
    title="Algorithm 2 with few informed agents: they follow, and so does who is linked to them",
    source="Su, Wang and Lin 2009, on a minority of informed agents",
    law=law_is("Algorithm 2", Algorithm2),
    claims=CLAIMS,
    leads={"pairs": pairs_apart, "one-instant": pairs_apart},
    references=("su-2009", "olfati-saber-2006"),
    corrected=("one-instant",),
)
def theorem(observed: Observed, tolerances: Tolerances) -> Checked:
    """The virtual leader keeps its velocity, a few agents feel it with c1, c2 > 0, the others do not. Let Q be the
    energy seen from the leader, c1α V + ½ c1 Σ ‖q_i − q_r‖² of the informed + ½ Σ ‖p_i − p_r‖². Then Q never rises; (i)
    every informed agent stays within sqrt(2 Q(0)/c1) of the leader; (ii) the informed take on its velocity; (iii) so
    does an uninformed agent with an infinite sequence of contiguous, nonempty, uniformly bounded intervals from t0 on,
    across each of which a joint path leads from it to an informed one; (iv) with Q(0) < (k+1) c*, at most k distinct
    pairs collide. (iv) holds at each instant, and for k = 0; over time more pairs can (erratum E13). (iii) is open
    here: links may be as weak as one likes when they come and go, and a run shows its own end only.
    """
    run = observed.run
    gains, steady_claim = positive(observed, c1_alpha="c1α", c2_alpha="c2α"), leader_frame.constant_velocity(run)
    follow = [leader_frame.some_informed(run), gains, leader_frame.constant_velocity(run, any_p_r=True)]
    needs = [*follow[:2], steady_claim]
    if unmet(follow):
        return needs, []
    seen = leader_frame.as_the_leader_sees(observed)
    rests = leader_frame.comes_to_rest(seen, leader_frame.informed(run), follow, "informed", proof="matched-velocities")
    if unmet(needs):  # a constant error of p_r moves the place that the flock follows, and not its velocity
        return needs, [rests]
    below = below_multiple(seen.energy[0], run.law.gains.c1_alpha * run.law.alpha.c_star)
    lasting, is_linked = _lasting(run)
    return [*needs, lasting, below], [
        never_rises(seen, needs, squares=True, name="energy", proof=PROOF),
        stays_within(seen, needs, name="distance", proof=PROOF),
        rests,
        leader_frame.comes_to_rest(seen, is_linked, [*needs, lasting], "linked"),
        distinct_pairs(seen, needs, tolerances, name="pairs"),
        pairs_at_one_instant(seen, needs, tolerances, name="one-instant"),
        no_collision(seen, [*needs, below], tolerances, name="no-collision"),
    ]
