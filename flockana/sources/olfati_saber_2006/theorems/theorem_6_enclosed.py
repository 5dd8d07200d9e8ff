"""Theorem 6 of Olfati-Saber (2006), decided by a tube: the energy's rate and its balance among spheres."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flint import arb, ctx

from flockana.certified.energies_in_balls import powers_during, total_energy, work
from flockana.certified.flow_in_balls import Flow, flow_of
from flockana.certified.pair_laws_in_series import Piece
from flockana.certified.structural_energy import BITS
from flockana.certified.tube import Tube, up
from flockana.theorems.energy import proved
from flockana.theorems.hypotheses import common_gains
from flockana.theorems.theorem_toolkit import Checked, Claim, FloatArray, Hypothesis, Tolerances, condition, undecided
from flockana.theorems.tube_claims import certain, decided

if TYPE_CHECKING:
    from flockana.certified.tube import BasinLike


def _declared_velocity(tube: Tube) -> FloatArray:
    """Return the γ-agent's velocity p_r, which is constant on a straight path."""
    terms = tube.law.target.harmonic.terms
    return terms[1] + terms[4]


def _slow_enough(tube: Tube, flow: Flow) -> tuple[Hypothesis, int]:
    """Return condition (76), and the first step from which it certainly holds to the end."""
    name = "(n/2)⟨p_c, p_d⟩ <= T from some t0 to the end (76)"
    pull, half, m = flow.terms[0], tube.n * tube.m, tube.m
    slack = []
    for step in tube.taken:
        p = step.during[half:]
        pulls = [pull.power(p[i : i + m], p[i : i + m], Piece.CORE) for i in range(0, half, m)]
        slack.append(-sum(pulls, arb(0)))
    if not _declared_velocity(tube).any() or all(x >= 0 for x in slack):
        return certain(name, True, detail="at all times of the tube"), 0
    last_doubtful = max(k for k, x in enumerate(slack) if not x >= 0)
    since = last_doubtful + 1
    if since < len(slack) and tube.t[-1] - tube.t[since] >= tube.law.scales.time:
        return certain(name, True, detail=f"certainly from t0 = {tube.t[since]:.6g} to the end of the tube"), since
    if any(x < 0 and tube.t[-1] - tube.t[k + 1] <= tube.law.scales.time for k, x in enumerate(slack)):
        return certain(name, False, detail=f"certainly broken about t = {tube.t[last_doubtful]:.6g}, near the end"), 0
    return Hypothesis(name, "assumed", detail="the tube is too wide or too short to decide"), 0


def _stays_outside(tube: Tube) -> Hypothesis:
    """Return the hypothesis that no agent enters an obstacle, between the steps too."""
    name = "no agent enters an obstacle"
    if not tube.law.obstacles:
        return Hypothesis(name, "met", detail="there is none")
    clearance = tube.min_clearance()
    where = f"(agent {clearance.agent} at obstacles[{clearance.obstacle}], about t = {clearance.time:.4g})"
    if clearance.lower > 0.0:
        return certain(name, True, clearance.lower, f"clearance at least {clearance.lower:.6g} {where}, proved")
    is_inside = any(x < 0 for k in range(len(tube.taken)) for row in tube.clearances_during(k) for x in row)
    text = "certainly inside" if is_inside else "the tube is too wide to tell"
    return Hypothesis(name, "unmet" if is_inside else "assumed", clearance.lower, f"{text} {where}", decided="enclosed")


def _never_rises(tube: Tube, flow: Flow, since: int, needs: list[Hypothesis]) -> Claim:
    """Return the claim that the rate dH/dt of the energy is never positive from a given step on."""
    # With p_r = 0 and all agents outside, every term is minus a sum of squares: the margin is 1, at rest too.
    squares = not _declared_velocity(tube).any() and needs[-1].status == "met"
    margin, highest, time_of_highest = arb(1), arb(float("-inf")), tube.t[since]
    for k in range(since, len(tube.taken)):
        parts = powers_during(tube, flow, k)
        total, magnitude = sum(parts, arb(0)), sum((abs(x) for x in parts), arb(0))
        if total.upper() > highest:
            highest, time_of_highest = total.upper(), tube.t[k]
        if not squares:
            share = -total / magnitude if magnitude > 0 else arb(0, 1)
            margin = share if share.lower() < margin.lower() else margin
    return decided("rate", margin, needs, proof=proved(tube, "theorem6")).described(
        computed=up(highest),
        stated="dH/dt <= 0" if since == 0 else f"dH/dt <= 0 for t >= {tube.t[since]:.6g}",
        witness={"time": time_of_highest},
        detail=f"dH/dt is at most {up(highest):.3g} at all times from t = {tube.t[since]:g} to {tube.t[-1]:g}",
    )


def _balance(tube: Tube, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """Return the claim that H(t) − H(0) is the integral of the closed-form rate."""
    first, last = total_energy(tube.law, *tube.state(0)), total_energy(tube.law, *tube.state(-1))
    largest = abs(first).max(abs(last))
    share = abs(last - first - work(tube)) / largest if largest > 0 else arb(0)
    return decided("balance", arb(tolerances.energy) - share, needs, proof=proved(tube, "theorem6")).described(
        computed=up(share.upper()),
        stated=f"H(t) - H(0) = integral of dH/dt, to {tolerances.energy:g} of the largest |H|",
        detail=f"H goes from {float(first):.6g} to {float(last):.6g}; the balance is off by {up(share.upper()):.2g} of "
        "the largest |H| at most",
    )


def os_6(tube: Tube, basin: BasinLike | None, tolerances: Tolerances) -> Checked:
    """Check Theorem 6 of Olfati-Saber (2006) for all starts enclosed by a tube, over the time of the tube."""
    with ctx.workprec(BITS):
        flow = flow_of(tube.law, tube.n, tube.m)
        slow_claim, first_index = _slow_enough(tube, flow)
        is_moving = bool(tube.law.target.harmonic.terms[1].any())
        detail = "it moves" if is_moving else f"q_r is fixed, p_r = {_declared_velocity(tube).tolist()}"
        rest_claim = condition("the γ-agent is static", not is_moving, detail=detail)
        needs = [common_gains(tube), rest_claim, slow_claim, _stays_outside(tube)]
        if tube.status != "complete":
            reason, stated_text = f"the tube ends early: {tube.message}", "over the whole time span"
            return needs, [undecided(name, reason, needs, stated=stated_text) for name in ("rate", "balance")]
        return needs, [_never_rises(tube, flow, first_index, needs), _balance(tube, [rest_claim, needs[0]], tolerances)]
