"""Theorem 6 of Olfati-Saber (2006): under Algorithm 3 with a static γ-agent the energy stops rising."""

from __future__ import annotations

import numpy as np

from flockana.checks import FloatArray
from flockana.laws.algorithm3 import Algorithm3
from flockana.theorems.energy import balance, never_rises, proved, stays_outside
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances
from flockana.trajectory import Trajectory


def _static(run: Trajectory) -> Hypothesis:
    """q_r and p_r are constant over the run; p_r = p_d need not be 0, as printed."""
    states = [run.law.target.state(t) for t in run.t]
    q_r, p_r = (np.array([state[part] for state in states]) for part in (0, 1))
    moved = float(max(np.abs(q_r - q_r[0]).max(), np.abs(p_r - p_r[0]).max()))
    speed = float(np.linalg.norm(p_r[0]))
    held = f"q_r is fixed, p_d = {p_r[0].tolist()}" + (" though q_r does not move, as printed" if speed > 0.0 else "")
    detail = held if moved == 0.0 else "the γ-agent moves, which is outside the theorem"
    return Hypothesis("the γ-agent is static", "met" if moved == 0.0 else "unmet", -moved, detail)


def condition_76(run: Trajectory) -> FloatArray:
    """T(t) − (n/2) ⟨p_c(t), p_r(t)⟩ at each sample, shape (T,): condition (76) holds where it is not negative.

    Parameters
    ----------
    run : Trajectory
        A run of Algorithm 3.
    """
    told = np.array([run.law.target.state(t)[1] for t in run.t])
    kinetic = 0.5 * np.sum(run.p**2, axis=(1, 2))
    slack: FloatArray = kinetic - 0.5 * np.einsum("tim,tm->t", run.p, told)
    return slack


def _condition(run: Trajectory) -> tuple[Hypothesis, int]:
    """(76), and the first sample from which it holds to the end; the last one if it never does."""
    slack = condition_76(run)
    broken = np.flatnonzero(slack < 0.0)
    since = 0 if broken.size == 0 else int(broken[-1]) + 1
    name = "(n/2)⟨p_c, p_d⟩ <= T from some t0 on (76)"
    if since >= len(run.t):
        detail = f"it is broken at the end, t = {run.t[-1]:.4g}, by {-slack[-1]:.3g}"
        return Hypothesis(name, "unmet", float(slack[-1]), detail), len(run.t) - 1
    share = 100.0 * broken.size / len(run.t)
    before = f"broken at {share:.2g} % of the samples before" if broken.size else "never broken"
    detail = f"t0 = {run.t[since]:.6g}, {before}; seen at samples, to the end of this run"
    return Hypothesis(name, "met", float(slack[since:].min()), detail), since


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    applies = type(run.law) is Algorithm3
    law = Hypothesis("Algorithm 3 is applied", "met" if applies else "unmet", detail=type(run.law).__name__)
    if not applies:
        return [law], [Claim(name, "vacuous", detail="another law") for name in ("rate", "balance")]
    static, (condition, since), outside = _static(run), _condition(run), stays_outside(run)
    needs = [law, static, condition, outside]
    proof = proved(run, "theorem6")
    return needs, [never_rises(run, needs, since=since, proof=proof), balance(run, needs, tolerances, proof=proof)]


THEOREM = Theorem(
    id="os-6",
    title="Algorithm 3: the energy never rises once the flock's mean velocity allows",
    statement=(
        "With a static γ-agent, (q_r, p_r) = (q_d, p_d), and (n/2)⟨p_c, p_d⟩ <= T for t >= t0: dH/dt = -c2α pᵀL̂p + "
        "c2β ΣΣ b_ik ⟨p_i, p̂_ik - p_i⟩ - 2 c2γ (T - (n/2)⟨p_c, p_d⟩) <= 0 for t >= t0, where H counts every pair once "
        "(erratum E2). The source leaves unsaid that the agents must be outside the obstacles: inside a sphere the "
        "second term can be positive. The condition is found at the samples, and holds to the end of the run only."
    ),
    source="Olfati-Saber 2006, Theorem 6",
    kind="trajectory",
    check=_check,
)
