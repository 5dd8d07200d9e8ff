"""Run in the frame of its virtual leader: informed agents, lasting links, decaying velocities."""

from collections.abc import Iterable
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from flockana.dynamics.steps_between_samples import Between
from flockana.environment.targets import StaticTarget
from flockana.laws.olfati_saber import Algorithm2
from flockana.measures.nets import components, links
from flockana.theorems.limit_certificates import Certificate, decays_to_zero
from flockana.theorems.rounding_bounds import EPS
from flockana.theorems.theorem_toolkit import (
    Claim,
    FloatArray,
    Hypothesis,
    Needs,
    Observed,
    Trajectory,
    condition,
    lengths,
)

WINDOWS = 4  # of equal length, of the last half of a run: in each of them an agent must be linked to the informed


def gains_of(run: Trajectory) -> tuple[FloatArray, FloatArray]:
    """Return the gains c1γ and c2γ of each agent, two arrays of shape (n,)."""
    gains = run.law.gains
    pull, match = (np.broadcast_to(np.asarray(x, dtype=np.float64), (run.n,)) for x in (gains.c1_gamma, gains.c2_gamma))
    return pull, match


def informed(run: Trajectory) -> np.ndarray:
    """Return a mask (n,) of the agents that feel the leader."""
    return gains_of(run)[0] > 0.0


def some_informed(run: Trajectory) -> Hypothesis:
    """Return the hypothesis that informed agents share c1, c2 > 0, and the other agents have none."""
    pull, match = gains_of(run)
    who = pull > 0.0
    is_uniform = np.array_equal(who, match > 0.0) and np.unique(pull[who]).size == np.unique(match[who]).size == 1
    name = "some agents are informed, with c1 > 0 and c2 > 0, the same for all of them"
    return condition(name, is_uniform, detail=f"{int(who.sum())} of {run.n} agents are informed")


def constant_velocity(run: Trajectory, *, any_p_r: bool = False) -> Hypothesis:
    """Return the hypothesis that the leader's velocity is constant and equals p_r (or differs by a constant)."""
    # p_r = dq_r/dt + e acts on agents of one c1 and one c2 as the true velocity of a leader at q_r + (c2/c1) e does.
    target = run.law.target
    name = "the leader's velocity is constant" + (", and so is p_r" if any_p_r else "")
    if target.constant_velocity and target.consistent is not None:
        is_told = any_p_r or target.consistent
        detail = type(target).__name__ if is_told else "the leader reports another velocity than it has"
        return condition(name, is_told, detail=detail)
    feedforward = np.array([[target.state(float(t))[1], target.rate(float(t))] for t in run.path.t])
    spread = float(np.abs(feedforward - (feedforward[0] if any_p_r else feedforward[0, 1])).max())
    if target.constant_velocity is False or spread > 64.0 * EPS * float(np.abs(feedforward).max()):
        return Hypothesis(name, "unmet", -spread, f"it changes by {spread:.3g}, or differs from the reported one")
    return Hypothesis(name, "assumed", detail="constant at all steps of the run")


def as_the_leader_sees(seen: Observed) -> Observed:
    """Return a run in the frame of its leader, where the γ-agent of Algorithm 2 is at rest; cached."""
    # Of a leader that accelerates, this is so where all agents are told: the acceleration of the frame takes theirs
    # away.
    return seen.cached("leader's frame", lambda: seen.transformed(_seen))


def _seen(run: Trajectory) -> Trajectory:
    law, (pull, velocity_gain) = run.law, gains_of(run)
    gains = replace(law.gains, c1_gamma=tuple(pull.tolist()), c2_gamma=tuple(velocity_gain.tolist()))
    resting_law = Algorithm2(law.alpha, gains, StaticTarget((0.0,) * run.m))
    feedforward = bool(getattr(law, "feedforward", False))
    between_samples = run.between
    if between_samples is not None:
        between_samples = Between(**_shifted(law.target, between_samples, feedforward), slack=between_samples.slack)
    return replace(run, **_shifted(law.target, run, feedforward), law=resting_law, extra={}, between=between_samples)


def _shifted(target: Any, course: Any, feedforward: bool) -> dict[str, Any]:
    """Return the times, positions, velocities and inputs of samples or steps relative to the leader."""
    states = [(target.position(float(t)), target.rate(float(t))) for t in course.t]
    shape = (len(course.t), course.q.shape[2])
    position, speed = (np.array([state[k] for state in states]).reshape(shape) for k in (0, 1))
    push = np.array([target.harmonic.acceleration(float(t)) if feedforward else np.zeros(shape[1]) for t in course.t])
    shifted_state = {"q": course.q - position[:, None], "p": course.p - speed[:, None]}
    return {"t": course.t, **shifted_state, "u": course.u - push.reshape(shape)[:, None]}


def linked_to_informed(run: Trajectory) -> np.ndarray:
    """Return a mask (n,) of agents linked to an informed one in each window of the last half of a run."""
    # A link counts in a window if it is there at one of its samples; the chain may be made of links of different times.
    is_linked, start = np.ones(run.n, dtype=bool), 0.5 * (run.t[0] + run.t[-1])
    is_informed, edges = informed(run), np.linspace(start, run.t[-1], WINDOWS + 1)
    for low, high in pairwise(edges):
        nets = [links(q, run.law.alpha.range) for q in run.q[(run.t >= low) & (run.t <= high)]]
        label = components(run.n, np.concatenate(nets)) if nets else np.arange(run.n)
        is_linked &= np.isin(label, label[is_informed])
    return is_linked


def comes_to_rest(
    seen: Observed,
    who: np.ndarray,
    needs: Needs,
    name: str,
    certificates: Iterable[Certificate] = (),
    *,
    proof: str | None = None,
) -> Claim:
    """Return the claim that the velocities of given agents decay to 0 in the leader's frame."""
    speeds, count = lengths(seen.run.p[:, who]).max(axis=1, initial=0.0), int(np.count_nonzero(who))
    quantity_text = f"the largest of {count} differences from the leader's velocity"
    claim_details: dict[str, Any] = {
        "series": speeds,
        "what": quantity_text,
        "of": "the largest difference",
        "stated": "p_i - dq_r/dt -> 0",
    }
    claim = decays_to_zero(seen, name, needs, certificates, proof=proof, **claim_details)
    return claim.described(witness={"time": float(seen.t[-1]), "agents": count})
