"""Energy identities of Algorithms 1 to 3, the basis of the theorems, checked along a run."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from flockana.environment.capsule import Capsule
from flockana.environment.obstacles import Sphere, Wall
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.composition import Composition
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.laws.sum_of_terms import SumOfTerms
from flockana.theorems.claims import run_theorem
from flockana.theorems.gamma_agent_checks import declared_rate_is_true, target_rests
from flockana.theorems.hypotheses import condition, law_is, smooth_pair, weight_nonnegative
from flockana.theorems.theorem import Checked, Claim, Hypothesis, HypothesisStatus, Needs, Tolerances
from flockana.theorems.theorem_toolkit import (
    EPS,
    Enclosure,
    FloatArray,
    Observed,
    Trajectory,
    judged,
    lengths,
    undecided,
)


def proved(run: Any, proof: str = "energy-identities") -> str | None:
    """Return the id of the proof of this law's energy identity, for walls, spheres and common gains; else None."""
    is_known = all(type(obstacle) in (Sphere, Wall) for obstacle in run.law.obstacles)
    return proof if is_known and not run.law.gains.per_agent and type(run.law) is not Composition else None


def balance(
    seen: Observed, needs: Needs, tolerances: Tolerances, *, name: str = "balance", proof: str | None = None
) -> Claim:
    """Return the claim that H(t) − H(0) agrees with the integral of the closed-form rate."""
    energy, largest = seen.energy.mid, float(np.abs(seen.energy.mid).max())
    off = abs(seen.residual)
    worst = int(np.argmax(off.mid))
    residual, unit = float(seen.residual.mid[worst]), largest or 1.0
    course = "falls" if energy[-1] <= energy[0] else "rises"
    return judged(name, tolerances.energy - off / unit, needs, proof=proof, computed=abs(residual) / unit).described(
        stated=f"H(t) - H(0) = integral of dH/dt, to {tolerances.energy:g} of the largest |H|",
        witness={"time": float(seen.t[worst]), "residual": residual},
        detail=f"H {course} from {energy[0]:.6g} to {energy[-1]:.6g}; the balance is off by "
        f"{abs(residual) / unit:.2g} of the largest |H| at most",
    )


def cancelling(run: Trajectory) -> FloatArray:
    """Return the magnitude of the terms of dH/dt that are differences and may cancel, at each sample."""
    # They are c2β ΣΣ b ⟨p_i, p̂_ik − p_i⟩, of β-agents no faster than their agent, c2γ Σ⟨p_i, p_i − p_r⟩, and the work
    # of a γ-agent that moves, or whose acceleration is fed forward. The others, −c2α pᵀL̂p, −c2γ‖v‖² and those of drag,
    # are sums of squares.
    law, q, p = run.law, run.q, run.p
    if law.moving or (law.target is None and not law.obstacles):
        return np.zeros(len(p))
    speed = lengths(p)
    magnitude: FloatArray = law.gains.c2_beta * 2.0 * len(law.obstacles) * np.sum(speed**2, axis=1)
    if law.target is not None:
        any_p_r = [(*law.target.state(t), law.target.rate(t)) for t in run.t.tolist()]
        q_r, p_r, rate = (np.array(item)[:, None] for item in zip(*any_p_r, strict=True))
        magnitude += np.max(law.gains.c2_gamma) * np.sum(speed * (speed + lengths(p_r)), axis=1)
        magnitude += np.max(law.gains.c1_gamma) * np.sum(lengths(rate) * lengths(q - q_r), axis=1)
    return magnitude


def _damps_only(run: Trajectory) -> bool:
    """Return whether dH/dt is a sum of squares outside of obstacles, with a resting or absent γ-agent."""
    # ⟨p_i, p̂_ik − p_i⟩ = μ‖P p_i‖² − ‖p_i‖² ≤ 0, with the projection P and μ ≤ 1.
    target, is_known = run.law.target, all(type(obstacle) in (Sphere, Wall, Capsule) for obstacle in run.law.obstacles)
    return is_known and (
        target is None or not any(np.any(target.state(t)[1]) or np.any(target.rate(t)) for t in run.t.tolist())
    )


def falling_share(
    seen: Observed,
    rate: Callable[[Trajectory], FloatArray],
    cancels: Callable[[Trajectory], FloatArray],
    *,
    one_sign: bool = False,
) -> Enclosure:
    """Return −dH/dt over the magnitude of its terms, from 1 (all terms fall) to −1, at each sample."""
    # Terms of one sign in exact arithmetic cancel in their computation alone, whatever the error of the state.

    def share(run: Trajectory) -> FloatArray:
        falls = -rate(run)
        magnitude = np.abs(falls) + 2.0 * cancels(run)
        return np.divide(falls, magnitude, out=np.ones_like(falls), where=magnitude > 0.0)

    rounding = (seen.n**2 + 64) * EPS
    if not cancels(seen.run).any():  # a sum of terms of one sign keeps it in floating point
        return Enclosure.around(share(seen.run), 0.0)
    return Enclosure.around(share(seen.run), rounding) if one_sign else seen.series(share, floor=rounding)


def never_rises(
    seen: Observed,
    needs: Needs,
    *,
    since: int = 0,
    rate: Callable[[Trajectory], FloatArray] = Trajectory.energy_rate,
    cancels: Callable[[Trajectory], FloatArray] = cancelling,
    squares: bool = False,
    formula: bool = True,
    name: str = "rate",
    proof: str | None = None,
) -> Claim:
    """Return the claim that dH/dt ≤ 0 from `since` on, by its size relative to its terms at the samples."""
    # Samples refute it; a proof, or a formula of one sign, verifies it: nothing bounds what lies between. A sum
    # of terms of one sign keeps it in floating point, so that Algorithms 1 and 2 have the margin 1 at every
    # state. Where terms may cancel, the claim is judged as long as the agents' motion is above its error.
    cancels = (lambda run: np.zeros(len(run.t))) if squares else cancels
    one_sign = cancels is cancelling and _damps_only(seen.run)
    share = falling_share(seen, rate, cancels, one_sign=one_sign)
    stop, end_text = len(seen.t), ""
    if cancels(seen.run).any() and not one_sign:
        speeds = Enclosure.around(lengths(seen.run.p), seen.speed_error + seen.drift_error[:, None])
        stop = seen.known_samples((speeds.max(axis=1).lo > 0.0) | (share.lo >= 0.0) | (np.arange(stop) < since))
        end_text = "" if stop == len(seen.t) else f"; known {seen.until(stop)}"
    if stop <= since:
        return undecided(name, "the motion is not known well enough to determine the sign of dH/dt", needs, proof=proof)
    share = share[since:stop]
    worst, highest = share.worst_index, float(rate(seen.run)[since:stop].max())
    claim = judged(name, share, needs, proof=proof)
    is_signed = formula and (one_sign or not cancels(seen.run).any())  # by a formula of squares
    if claim.status == "verified" and claim.rigour == "numeric" and not is_signed:
        end_text += "; between samples nothing bounds it, and no formula decides its sign"
        claim = replace(claim, status="inconclusive")
    return claim.described(
        computed=highest,
        stated="dH/dt <= 0" if since == 0 else f"dH/dt <= 0 for {seen.t[since]:.6g} <= t <= {seen.t[-1]:.6g}",
        witness={"time": float(seen.t[since + worst])},
        detail=f"the closed-form rate is at most {highest:.3g} from t = {seen.t[since]:.4g} on; its size is at least "
        f"{share.mid.min():.2g} times the sum of its terms' sizes{end_text}",
    )


def stays_outside(run: Observed) -> Hypothesis:
    """Return the hypothesis that no agent enters an obstacle, where the obstacle term may add energy."""
    name, room = "no agent enters an obstacle", run.run.clearance()
    if not run.law.obstacles:
        return Hypothesis(name, "met", detail="there is none")
    off = float((run.shape_error.max(axis=1) + run.centre_error).max(initial=0.0))
    rounding = 64.0 * EPS * float(np.abs(run.run.q).max()) + off
    where = f"(agent {room.agent} at obstacles[{room.obstacle}], t = {room.time:.4g})"
    if room.lower > rounding:
        return Hypothesis(name, "met", room.lower, f"clearance at least {room.lower:.4g} {where}", decided="enclosed")
    status: HypothesisStatus = "unmet" if room.reached < -rounding else "assumed"
    text = f"clearance {room.reached:.4g} {where}, and {room.lower:.4g} at least"
    return Hypothesis(name, status, room.lower if status == "assumed" else room.reached, text, decided="enclosed")


def smooth_where_needed(run: Observed) -> list[Hypothesis]:
    """Return the hypothesis that the pair law is C¹; empty if proved."""
    return [requirement for requirement in [smooth_pair(run)] if requirement.status != "met"]


def pairs_dissipate(run: Observed) -> list[Hypothesis]:
    """Return the unproved hypotheses under which pairs add no energy: a C¹ potential, no negative adjacency."""
    return [requirement for requirement in (smooth_pair(run), weight_nonnegative(run)) if requirement.status != "met"]


def nothing_adds_energy(run: Observed) -> list[Hypothesis]:
    """Return the hypotheses under which no term of the law adds energy, in the energy's own frame."""
    law, needs = run.law, pairs_dissipate(run)
    if law.target is not None and not law.moving:
        needs.append(target_rests(run.run, any_p_r=False))  # outside of the moving frame a moving γ-agent does work
    if type(law) is Algorithm3 or law.obstacles:
        needs.append(stays_outside(run))
    if type(law) is Composition and law.thrust > 0.0:
        needs.append(condition("no thrust: α <= 0", False, -law.thrust, f"α = {law.thrust:g}"))
    return needs


def declared(run: Observed) -> list[Hypothesis]:
    """Return the energy balance's hypotheses: that the γ-agent's declared velocity is true, or none."""
    return [declared_rate_is_true(run.run)] if run.law.target is not None and not run.law.moving else []


def is_own(law: Any) -> bool:
    """Return whether a law is a user's sum of terms, other than Algorithms 1 to 3 and compositions."""
    return isinstance(law, SumOfTerms) and not isinstance(law, Algorithm1 | Algorithm2 | Algorithm3 | Composition)


def _law(seen: Observed) -> Hypothesis:
    """Return the hypothesis that the law is a sum of terms with known energy and rate."""
    if not is_own(seen.law):
        return law_is("Algorithm 1, 2 or 3", Algorithm1, Algorithm2, Algorithm3, composed=True)(seen)
    terms = ", ".join(type(term).__name__ for term in seen.law.terms)
    return condition("the law is a sum of terms", True, detail=f"{seen.law.title}: {terms}")


def _rates(run: Trajectory) -> FloatArray:
    """Return each term's part of dH/dt at each sample, shape (T, terms)."""
    rows = zip(run.t.tolist(), run.q, run.p, strict=True)
    return np.array([[term.act(t, q, p, np.zeros_like(q)) for term in run.law.terms] for t, q, p in rows])


def _own_terms(seen: Observed, tolerances: Tolerances) -> Checked:
    """Return hypotheses and claims about a user's law: no term adds energy, and the energy balances."""
    rates = _rates(seen.run)
    maximum, largest = float(rates.max(initial=0.0)), float(np.abs(rates).max(initial=0.0))
    status: HypothesisStatus = "unmet" if maximum > (seen.n**2 + 64) * EPS * largest else "assumed"
    name = "no term adds energy"
    falls = Hypothesis(name, status, -maximum, f"at the samples a term adds {max(maximum, 0.0):.3g} per time at most")
    claims = [balance(seen, smooth_where_needed(seen), tolerances)]
    if status != "unmet":
        claims.insert(0, never_rises(seen, [falls], cancels=lambda run: np.abs(_rates(run)).sum(axis=1), formula=False))
    return [falls], [replace(claim, by="flockana") for claim in claims]


@run_theorem(
    "energy",
    title="Energy identities of Algorithms 1, 2 and 3",
    source="Olfati-Saber 2006, proofs of Theorems 1, 3 and 6",
    law=_law,
    claims=("rate", "balance"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """dH/dt = -c2α pᵀL̂p under Algorithm 1, dH_λ/dt = -c2γ‖v‖² - c2α vᵀL̂v in the moving frame under Algorithm 2, and
    the form of Theorem 6, with the work of a moving γ-agent, under Algorithm 3: the closed form agrees with the energy
    of the integrated run. It is never positive under Algorithms 1 and 2, nor under Algorithm 3 with a γ-agent at rest
    and all agents outside the obstacles. The same holds for every composition of their terms, with a consensus over
    another net, a feedforward acceleration and drag; a thrust adds energy. For a sum of your own terms, the rates that
    they return are compared with the energy of the run.
    """
    if is_own(seen.law):
        return _own_terms(seen, tolerances)
    needs, rates, proof = nothing_adds_energy(seen), declared(seen), proved(seen)
    balance_claim = balance(seen, [*smooth_where_needed(seen), *rates], tolerances, proof=proof)
    return [*needs, *rates], [never_rises(seen, needs, proof=proof), balance_claim]


STEPS = {
    "energy": ("where no term adds energy, H rises in a step by no more than the scheme's own defect", lambda seen: 0)
}
