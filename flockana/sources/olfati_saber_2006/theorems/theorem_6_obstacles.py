"""Theorem 6 of Olfati-Saber (2006): under Algorithm 3 with a static γ-agent the energy stops rising."""

from math import comb

import numpy as np

from flockana.laws.algorithm3 import Algorithm3
from flockana.theorems.bounds_between_samples import polygons
from flockana.theorems.energy import balance, never_rises, proved, stays_outside
from flockana.theorems.gamma_agent_checks import declared_rate_is_true, target_rests
from flockana.theorems.hypotheses import common_gains
from flockana.theorems.theorem import Checked, Hypothesis, Tolerances
from flockana.theorems.theorem_toolkit import EPS, FloatArray, Observed, Trajectory, law_is, lengths, run_theorem
from flockana.theorems.tube_claims import enclosed_by

_EIGHT = np.array([[comb(4, i) * comb(4, j) / comb(8, i + j) for j in range(5)] for i in range(5)])[::-1]
_DIAGONALS = [np.add.outer(np.arange(4, -1, -1), np.arange(5)) == k for k in range(9)]


def condition_76(run: Trajectory) -> FloatArray:
    """Return T(t) − (n/2) ⟨p_c(t), p_r(t)⟩ at each sample; condition (76) asks for >= 0."""
    any_p_r = np.array([run.law.target.state(t)[1] for t in run.t])
    kinetic = 0.5 * np.sum(run.p**2, axis=(1, 2))
    return kinetic - 0.5 * np.einsum("tim,tm->t", run.p, any_p_r)


def _least_slack(seen: Observed) -> FloatArray:
    """Return a lower bound of T − (n/2) ⟨p_c, p_r⟩ over each interval between samples, of a constant p_r."""
    # On a step velocities are polynomials of degree four, so that this is one of degree eight: no value of it is below
    # the least of its Bernstein coefficients.
    p_r, slacks = seen.law.target.state(float(seen.t[0]))[1], []
    for h, points, _ in polygons(seen.run):
        legs = 5.0 / h * np.diff(points, axis=1)[:, :, : seen.m]
        squares = 0.5 * np.einsum("nim,njm->ij", legs, legs) - 0.25 * np.add.outer(*[(legs @ p_r).sum(axis=0)] * 2)
        error = float(seen.between_speed_error.max() + seen.drift_error.max())
        error_bound = error * float(lengths(legs - 0.5 * p_r).max(axis=1).sum()) + 0.5 * seen.n * error**2
        slacks.append(min(np.sum(_EIGHT * squares[::-1], where=_DIAGONALS[k]) for k in range(9)) - error_bound)
    bounds = np.array(slacks)
    if seen.run.path.slack is not None:  # of steps that were not kept the velocities are not known
        bounds[seen.run.path.slack.max(axis=1) > 0.0] = -np.inf
    return seen.run.over_intervals(np.minimum, bounds)


def _condition(seen: Observed) -> tuple[Hypothesis, int]:
    """Return condition (76), and the first sample from which it holds to the end."""
    # It must hold for the law's time scale at least: one instant at the end is no "from some t0 on". Where rounding
    # decides, or what lies between two samples, it is assumed to hold.
    run, slack, name = seen.run, condition_76(seen.run), "(n/2)⟨p_c, p_d⟩ <= T from some t0 to the end (76)"
    any_p_r = np.array([np.linalg.norm(run.law.target.state(float(t))[1]) for t in run.t])
    if not any_p_r.any() and run.law.target.constant_velocity:
        return Hypothesis(name, "met", float(slack.min()), "p_d = 0: T >= 0 at all times"), 0
    terms = 0.5 * np.sum(run.p**2, axis=(1, 2)) + 0.5 * any_p_r * lengths(run.p).sum(axis=1)
    error = seen.series(condition_76).half_width
    rounding = np.where(any_p_r > 0.0, (run.n + 8) * EPS * terms + error, 0.0)
    broken = np.flatnonzero(slack < -rounding)
    since = 0 if broken.size == 0 else int(broken[-1]) + 1
    if since >= len(run.t) or run.t[-1] - run.t[since] < run.scales.time:
        worst = float(slack[min(since, len(run.t)) - 1])
        detail = f"it fails until t = {run.t[broken[-1]] if broken.size else run.t[0]:.4g}, by {-worst:.3g}"
        return Hypothesis(name, "unmet", worst, detail, decided="enclosed", on_motion=True), len(run.t) - 1
    between = _least_slack(seen)
    doubtful_samples = np.flatnonzero(between[since:] < 0.0)
    later_index = since if not doubtful_samples.size else since + int(doubtful_samples[-1]) + 1
    is_certain = bool(run.t[-1] - run.t[later_index] >= run.scales.time and (slack >= rounding)[later_index:].all())
    since = later_index if is_certain else since
    share = 100.0 * broken.size / len(run.t)
    history_text = f"broken at {share:.2g} % of the samples before t0" if broken.size else "never broken"
    least_slack = float(between[since:].min() if is_certain else slack[since:].min())
    detail = f"t0 = {run.t[since]:.6g}, {history_text}; to the end of this run, " + (
        "between samples too" if is_certain else "seen"
    )
    return Hypothesis(name, "met" if is_certain else "assumed", least_slack, detail, decided="enclosed"), since


def start_of_condition(seen: Observed) -> int:
    """Return the first sample from which condition (76) holds to the end, at most the second-last sample."""
    return min(_condition(seen)[1], len(seen.t) - 2)


STEPS = {
    "os-6": (
        "where its hypotheses hold of the law's flow, H rises in a step by no more than the scheme's own defect",
        start_of_condition,
    )
}


@run_theorem(
    "os-6",
    title="Algorithm 3: the energy never rises once the flock's mean velocity allows",
    source="Olfati-Saber 2006, Theorem 6",
    law=law_is("Algorithm 3", Algorithm3, one_gain=True),
    enclosed=enclosed_by("os_6", f"{__package__}.theorem_6_enclosed"),
    claims=("rate", "balance"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """With one c1γ and c2γ for all agents, a static γ-agent, (q_r, p_r) = (q_d, p_d), and (n/2)⟨p_c, p_d⟩ <= T for t >=
    t0: dH/dt = -c2α pᵀL̂p + c2β ΣΣ b_ik ⟨p_i, p̂_ik - p_i⟩ - 2 c2γ (T - (n/2)⟨p_c, p_d⟩) <= 0 for t >= t0, where H
    counts every pair once (erratum E2). The source omits that the agents must be outside the obstacles: inside a sphere
    the second term can be positive. The condition is bounded between samples, up to the end of the run only.
    """
    run = seen.run
    speed_claim, first_index = _condition(seen)
    requirements = [common_gains(seen), target_rests(run, any_p_r=True), speed_claim, stays_outside(seen)]
    rate, proof = declared_rate_is_true(run), proved(seen, "theorem6")
    balance_claim = balance(seen, [*requirements, rate], tolerances, proof=proof)
    return [*requirements, rate], [never_rises(seen, requirements, since=first_index, proof=proof), balance_claim]
