"""Su, Wang and Lin (2009): a virtual leader of varying velocity, with acceleration feedforward."""

from dataclasses import replace
from math import sqrt

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm2
from flockana.laws.terms.feedforward import TargetFeedforward
from flockana.laws.terms.navigation import Navigation
from flockana.laws.terms.pairs import PairTerm
from flockana.sources.su_2009.theorems.leader_frame import as_the_leader_sees, comes_to_rest, constant_velocity
from flockana.theorems.attraction_basin import attraction
from flockana.theorems.claims import run_theorem
from flockana.theorems.cohesion import stays_within
from flockana.theorems.collisions import below_multiple, no_collision
from flockana.theorems.energy import pairs_dissipate
from flockana.theorems.gamma_agent_checks import consistent
from flockana.theorems.meeting_energy import least_is_known, meeting
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances, unmet
from flockana.theorems.theorem_toolkit import (
    Certificate,
    Enclosure,
    Observed,
    Trajectory,
    condition,
    judged,
    law_is,
    positive,
)

PROOF = "informed-agents"
CLAIMS = ("centre", "velocities", "distance", "no-collision")
_AGREES = 1e-6  # of the way that the centre has to go, or of d: well above the default tolerance of an integrator


def convergence_rate(gains: Gains) -> float:
    """Return −max Re s of s² + c2 s + c1, the rate at which the centre of mass approaches the leader."""
    c1, c2 = float(gains.c1_gamma), float(gains.c2_gamma)
    return 0.5 * c2 - sqrt(max(0.25 * c2 * c2 - c1, 0.0))


def _is_feedforward(run: Trajectory) -> Hypothesis:
    """Return the hypothesis that the law is Algorithm 2 with feedforward (not needed at constant velocity)."""
    name, law = "the law is Algorithm 2, with the leader's acceleration fed forward to all agents", run.law
    if type(law) is Algorithm2:
        steady = constant_velocity(run)
        return Hypothesis(name, steady.status, steady.margin, f"no feedforward; {steady.name}: {steady.detail}")
    terms = [type(term) for term in law.terms]
    is_same_law = terms == [PairTerm, Navigation, TargetFeedforward] and law.unit is None
    is_feedforward = is_same_law and type(law.alpha) is AlphaInteraction
    if is_feedforward and (tells := consistent(run)).status != "met":
        return Hypothesis(name, tells.status, tells.margin, f"{tells.name}: {tells.detail}", tells.error)
    return condition(name, is_feedforward, detail=", ".join(term.__name__ for term in terms))


def centre_of(run: Trajectory) -> tuple[FloatArray, FloatArray]:
    """Return the centre of mass's path in the leader's frame, measured and in closed form, (T, 2 m) each."""
    centre = np.concatenate([run.q.mean(axis=1), run.p.mean(axis=1)], axis=1)
    c1, c2 = run.law.gains.c1_gamma[0], run.law.gains.c2_gamma[0]
    flow = np.array([[0.0, 1.0], [-c1, -c2]])
    start = centre[0].reshape(2, run.m)
    from scipy.linalg import expm

    predictions = np.array([(expm(flow * (t - run.t[0])) @ start).ravel() for t in run.t.tolist()])
    return centre, predictions


def _centre(seen: Observed, gains: Gains, needs: list[Hypothesis]) -> Claim:
    run = seen.run
    (centre, predictions), unit = centre_of(run), seen.scales.time
    units = np.repeat([1.0, unit], run.m)  # velocities as lengths
    magnitude = max(float(np.abs(centre[0] * units).max()), seen.scales.length)
    error = np.maximum(seen.centre_error, seen.drift_error * unit)[:, None]
    off = (Enclosure.around(np.abs((centre - predictions) * units), error).max(axis=1) / magnitude).clip(0.0)
    worst, rate = int(np.argmax(off.mid)), convergence_rate(gains)
    return judged("centre", _AGREES - off, needs, proof=PROOF, computed=float(off.mid[worst])).described(
        stated=f"q_c − q_r solves z'' = −c1 z − c2 z', and dies out as exp(−{rate:.4g} t)",
        witness={"time": float(run.t[worst])},
        detail=f"q_c − q_r and p_c − p_r are off the solution of z'' = −c1 z − c2 z' by {off.mid[worst]:.2g} of its "
        f"size at most; the slower root has the rate {rate:.4g}",
    )


def _shape_basin(seen: Observed, gains: Gains) -> list[Certificate]:
    """Return the certificate of a basin of the flock's shape, in a list; empty for other pair laws."""
    if type(seen.law.alpha) is not AlphaInteraction:
        return []
    q, p, *errors = seen.end
    q_off, p_off = (float(np.linalg.norm(error)) for error in errors)
    return [attraction(replace(seen.law, gains=gains), q, p, off=q_off, p_off=p_off).certificate]


@run_theorem(
    "su-varying",
    title="A virtual leader of varying velocity: the centre of mass converges if all agents know its acceleration",
    source="Su, Wang and Lin 2009, on a virtual leader with varying velocity",
    law=law_is("Algorithm 2", Algorithm2, composed=True),
    claims=CLAIMS,
    references=("su-2009", "olfati-saber-2006"),
)
def theorem(observed: Observed, tolerances: Tolerances) -> Checked:
    """All agents feel the leader with c1, c2 > 0, and know its acceleration. Then q_c − q_r and p_c − p_r decay
    exponentially, at the rate of the roots of s² + c2 s + c1. Seen from the leader the flock is one with a leader at
    rest, so that also all velocities match the leader's, every agent stays within sqrt(2 Q(0)/c1) of it, and none
    collide below c*; the positions of single agents do not converge to it. Algorithm 2 itself, without the
    acceleration, leaves a lag.
    """
    run = observed.run
    uniform_claim = condition("all agents feel the leader, with one c1 and one c2", not run.law.gains.per_agent)
    needs = [uniform_claim, _is_feedforward(run)]
    if unmet(needs):
        return needs, []
    needs = [*needs, positive(observed, c1_alpha="c1α", c2_alpha="c2α", c1_gamma="c1", c2_gamma="c2")]
    needs += [*pairs_dissipate(observed), *least_is_known(observed)]
    if unmet(needs):
        return needs, []
    observation, gains = as_the_leader_sees(observed), run.law.gains
    pairs = meeting(observation)
    energy_claim = below_multiple(observation.energy[0] - pairs.floor, pairs.c_star)
    return [*needs, energy_claim], [
        _centre(observation, gains, needs),
        comes_to_rest(observation, np.ones(run.n, dtype=bool), needs, "velocities", _shape_basin(observation, gains)),
        stays_within(observation, needs, name="distance", proof=PROOF),
        no_collision(observation, [*needs, energy_claim], tolerances, name="no-collision"),
    ]
