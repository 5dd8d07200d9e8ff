"""Su, Wang and Lin (2009): a virtual leader of varying velocity, whose acceleration all agents are told."""

from __future__ import annotations

from math import sqrt

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm2
from flockana.laws.terms.navigation import Navigation
from flockana.laws.terms.pairs import PairTerm
from flockana.laws.terms.told import ToldAcceleration
from flockana.theorems.claims import judged
from flockana.theorems.classics.leader_frame import as_the_leader_sees, comes_to_rest, constant_velocity
from flockana.theorems.composed.cohesion import stays_within
from flockana.theorems.hypotheses import condition, law_is_or_composed, positive
from flockana.theorems.meeting import least_is_known, meeting
from flockana.theorems.olfati_saber.collisions import below_multiple, no_collision
from flockana.theorems.olfati_saber.energy import pairs_dissipate
from flockana.theorems.rounding import EPS, energy_error
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, unmet

PROOF = "informed-agents"
CLAIMS = ("centre", "velocities", "distance", "no-collision")
_AGREES = 1e-6  # of the way that the centre has to go, or of d: well above the default tolerance of an integrator


def convergence_rate(gains: Gains) -> float:
    """−max Re s of s² + c2 s + c1: how fast the centre of mass comes to the leader.

    Examples
    --------
    >>> convergence_rate(Gains(c1_gamma=1.0, c2_gamma=2.0)), convergence_rate(Gains(c1_gamma=4.0, c2_gamma=5.0))
    (1.0, 1.0)
    """
    c1, c2 = float(gains.c1_gamma), float(gains.c2_gamma)
    return 0.5 * c2 - sqrt(max(0.25 * c2 * c2 - c1, 0.0))


def _only_told(run: Trajectory) -> Hypothesis:
    """That the law is Algorithm 2 and the leader's acceleration, told to all; or needs none, at constant velocity."""
    name, law = "the law is Algorithm 2, and all agents are told the leader's acceleration", run.law
    if type(law) is Algorithm2:
        steady = constant_velocity(run)
        return Hypothesis(name, steady.status, steady.margin, f"it is not told; {steady.name}: {steady.detail}")
    terms = [type(term) for term in law.terms]
    alike = terms == [PairTerm, Navigation, ToldAcceleration] and law.unit is None
    known = alike and type(law.alpha) is AlphaInteraction
    return condition(name, known, detail=", ".join(term.__name__ for term in terms))


def _all_alike(run: Trajectory) -> Hypothesis:
    return condition("all agents feel the leader, with one c1 and one c2", not run.law.gains.per_agent)


def centre_of(run: Trajectory) -> tuple[FloatArray, FloatArray]:
    """q_c − q_r and p_c − p_r of a run in its leader's frame, as they are and as the closed form says, (T, 2 m)."""
    found = np.concatenate([run.q.mean(axis=1), run.p.mean(axis=1)], axis=1)
    c1, c2 = run.law.gains.c1_gamma[0], run.law.gains.c2_gamma[0]
    flow = np.array([[0.0, 1.0], [-c1, -c2]])
    start = found[0].reshape(2, run.m)
    from scipy.linalg import expm

    said = np.array([(expm(flow * (t - run.t[0])) @ start).ravel() for t in run.t.tolist()])
    return found, said


def _centre(run: Trajectory, gains: Gains, needs: list[Hypothesis]) -> Claim:
    found, said = centre_of(run)
    units = np.repeat([1.0, run.scales.time], run.m)  # velocities as lengths
    size = max(float(np.abs(found[0] * units).max()), run.scales.length)
    off = np.abs((found - said) * units).max(axis=1) / size
    worst, rate = int(np.argmax(off)), convergence_rate(gains)
    rounding = (run.n + 64) * EPS * (float(np.abs(run.q).max()) + float(np.abs(run.p).max()) * run.scales.time) / size
    return judged(
        "centre",
        _AGREES - float(off[worst]),
        rounding,
        needs,
        computed=float(off[worst]),
        stated=f"q_c − q_r solves z'' = −c1 z − c2 z', and dies out as exp(−{rate:.4g} t)",
        witness={"time": float(run.t[worst])},
        proof=PROOF,
        detail=f"q_c − q_r and p_c − p_r are off the solution of z'' = −c1 z − c2 z' by {off[worst]:.2g} of its size "
        f"at most; the slower root has the rate {rate:.4g}",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    needs = [_all_alike(run), _only_told(run)]
    if unmet(needs):
        return needs, []
    needs = [*needs, positive(run, c1_alpha="c1α", c2_alpha="c2α", c1_gamma="c1", c2_gamma="c2")]
    needs += [*pairs_dissipate(run), *least_is_known(run)]
    if unmet(needs):
        return needs, []
    seen = as_the_leader_sees(run)
    energy = float(seen.energy()[0])
    error = float(energy_error(seen.law, seen.q[:1], seen.p[:1], seen.energy()[:1])[0])
    pairs = meeting(seen)
    below = below_multiple(energy - pairs.floor, error, pairs.c_star)
    return [*needs, below], [
        _centre(seen, run.law.gains, needs),
        comes_to_rest(seen, np.ones(run.n, dtype=bool), needs, tolerances, "velocities"),
        stays_within(seen, needs, name="distance", proof=PROOF),
        no_collision(seen, [*needs, below], tolerances, name="no-collision"),
    ]


THEOREM = Theorem(
    id="su-varying",
    title="A virtual leader of varying velocity: the centre of mass converges, if all are told its acceleration",
    statement=(
        "All agents feel the leader with c1, c2 > 0, and are told its acceleration. Then q_c − q_r and p_c − p_r die "
        "out exponentially, at the rate of the roots of s² + c2 s + c1. Seen from the leader the flock is one with a "
        "leader at rest, so that also all velocities match the leader's, every agent stays within sqrt(2 Q(0)/c1) of "
        "it, and none collide below c*; the positions of single agents do not converge to it. Algorithm 2 as it "
        "stands, which is not told, leaves a lag."
    ),
    source="Su, Wang and Lin 2009, on a virtual leader with varying velocity",
    kind="trajectory",
    law=law_is_or_composed("Algorithm 2", Algorithm2),
    check=_check,
    claims=CLAIMS,
    references=("su-2009", "olfati-saber-2006"),
)
