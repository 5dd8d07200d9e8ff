"""The nonlinear flock with delayed interactions, integrated with the past that it hears."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.checks import (
    FloatArray,
    ensure_count,
    ensure_fits,
    ensure_known,
    ensure_positive,
    ensure_state,
    ensure_time_span,
)
from flockana.base.errors import ArgumentError
from flockana.base.vectors import lengths
from flockana.dynamics.encounters import Encounters, State
from flockana.dynamics.iterate import count_steps
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.laws.terms.pairs import PairTerm
from flockana.stability.blocks import ensure_pairs_and_pull
from flockana.stability.delay import DELAYED


@dataclass(frozen=True)
class DelayedRun:
    """A run whose interactions are delayed.

    Parameters
    ----------
    t : ndarray, shape (T,)
        Times, one step apart.
    q, p : ndarray, shape (T, n, m)
    delay : float
        τ.
    """

    t: FloatArray
    q: FloatArray
    p: FloatArray
    delay: float


def simulate_delayed(
    law: Algorithm1 | Algorithm2, q0: Any, p0: Any, t_span: Any, *, delay: float, steps: int = 20, delayed: str = "all"
) -> DelayedRun:
    """Integrate the nonlinear flock with delayed interactions: RK4, `steps` steps per delay.

    Before the start the flock moved with its initial velocities. Each agent acts on a state of the flock and the
    γ-agent that is τ old, its own included (``"all"``); in the terms between agents alone, where its own state is as
    old as theirs (``"pairs"``); or on what is τ old of other agents and its own state at once (``"neighbours"``: then
    action is no longer reaction, and the centre of mass is pushed). Steps divide the delay, so that kinks of the
    solution fall on steps; halfway between, the past is a Hermite cubic: the order is four.

    Parameters
    ----------
    q0, p0 : array_like, shape (n, m)
        State at the start.
    t_span : (float, float)
        Start and end; the last step may go beyond the end.
    delay : float
        τ > 0.
    steps : int
        Steps per delay.
    delayed : {"all", "pairs", "neighbours"}
        As in `delay_system`.

    Raises
    ------
    ArgumentError
        On bad arguments; on the way, if a step leaps over an encounter (`flockana.dynamics.encounters`): steps divide
        the delay, so that one cannot be made shorter, and the error names how many it takes.

    Examples
    --------
    A lone agent sees the target where it was: at first it falls with constant acceleration.

    >>> from flockana.environment.targets import StaticTarget
    >>> from flockana.interactions import Gains
    >>> law = Algorithm2(gains=Gains(c1_gamma=2.0, c2_gamma=0.0), target=StaticTarget((0.0,)))
    >>> run = simulate_delayed(law, [[1.0]], [[0.0]], (0.0, 0.5), delay=0.5)
    >>> round(float(run.q[-1, 0, 0]), 12)
    0.75
    """
    ensure_pairs_and_pull(law)
    ensure_known("set of delayed terms", delayed, DELAYED)
    q, p = ensure_state(q0, p0)
    law.check_dimension(q.shape[1])
    law.check_start(q, p)
    t0, t1 = ensure_time_span(t_span)
    delay, steps = ensure_positive("delay", delay), ensure_count("steps", steps)
    h = delay / steps
    total = count_steps(t0, t1, h)
    samples = (steps + 1 + total, 3, *q.shape)
    ensure_fits(f"the run in steps of {h:g}, {steps} a delay,", samples, "take a longer delay or fewer steps")
    past = np.arange(-steps, 1)[:, None, None] * h
    qs, ps, us = (np.empty((steps + 1 + total, *q.shape)) for _ in range(3))
    qs[: steps + 1], ps[: steps + 1], us[:steps] = q + past * p, p, 0.0
    encounters = Encounters.of(law, len(q))

    def check_step(k: int, arriving: FloatArray) -> None:
        """Raise if the flock leaps over an encounter between two steps, whether it is heard of already or not."""
        before, after = State(qs[k], ps[k], us[k]), State(qs[k + 1], ps[k + 1], arriving)
        share = encounters.share(h, before, after)
        if share < 1.0:
            raise ArgumentError(
                f"steps = {steps} per delay: agents come into range and out again, or go too far there, within the "
                f"step from t = {t0 + (k - steps) * h:.6g}; expected steps >= {int(np.ceil(steps / share))}"
            )

    def push(t: float, q: FloatArray, p: FloatArray, q_old: FloatArray, p_old: FloatArray) -> FloatArray:
        if delayed == "all":
            return law.flow(t - delay, q_old, p_old)[0]
        heard = np.zeros_like(q)
        for term in law.terms:
            if not isinstance(term, PairTerm):
                term.act(t, q, p, heard)
            elif delayed == "pairs":
                term.act(t, q_old, p_old, heard)
            else:
                heard += _heard_of_others(term, q, p, q_old, p_old)
        return heard

    for k in range(steps):
        check_step(k, us[0])  # the flock moved freely before the start
    us[steps] = push(t0, q, p, qs[0], ps[0])
    for k in range(steps, steps + total):
        t, old = t0 + (k - steps) * h, k - steps
        q, p = qs[k], ps[k]
        q_mid = 0.5 * (qs[old] + qs[old + 1]) + h / 8.0 * (ps[old] - ps[old + 1])
        arriving = us[old + 1] if old + 1 != steps else 0.0  # the acceleration jumps at the start
        p_mid = 0.5 * (ps[old] + ps[old + 1]) + h / 8.0 * (us[old] - arriving)
        k1 = us[k]
        k2 = push(t + h / 2, q + h / 2 * p, p + h / 2 * k1, q_mid, p_mid)
        k3 = push(t + h / 2, q + h / 2 * (p + h / 2 * k1), p + h / 2 * k2, q_mid, p_mid)
        k4 = push(t + h, q + h * (p + h / 2 * k2), p + h * k3, qs[old + 1], ps[old + 1])
        qs[k + 1] = q + h * p + h * h / 6 * (k1 + k2 + k3)
        ps[k + 1] = p + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        us[k + 1] = push(t + h, qs[k + 1], ps[k + 1], qs[old + 1], ps[old + 1])
        check_step(k, us[k + 1])
    return DelayedRun(t0 + h * np.arange(total + 1.0), qs[steps:], ps[steps:], delay)


def _heard_of_others(term: PairTerm, q: FloatArray, p: FloatArray, q_old: FloatArray, p_old: FloatArray) -> FloatArray:
    """What a pair term makes of an agent's own state now and of the others' as they were, shape (n, m)."""
    n, u = len(q), np.zeros_like(q)
    apart = lengths(q_old[None, :, :] - q[:, None, :]) < term.pair.range
    i, j = np.nonzero(apart & ~np.eye(n, dtype=bool))
    weight, adjacency, _ = term.pair.kernels.terms(np.vstack([q, q_old]), i, n + j, term.pair.par)
    force = term.stiffness * weight[:, None] * (q_old[j] - q[i]) + term.damping * adjacency[:, None] * (p_old[j] - p[i])
    np.add.at(u, i, force)
    return u
