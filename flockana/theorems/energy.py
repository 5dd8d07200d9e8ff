"""The energy identities that the theorems rest on, checked along a run."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from flockana.environment.obstacles import Sphere, Wall
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.simulate import simulate
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge
from flockana.trajectory import Trajectory

_TIGHTER, _SHRINKS = 1e-3, 0.1  # a tolerance so much tighter must shrink a residual so much, if it is the integrator's
_FINEST = 1e-13  # relative tolerance: next to rounding


def proved(run: Trajectory, proof: str = "energy-identities") -> str | None:
    """The id of the proof of this law's energy identity, which knows walls, spheres and gains common to all agents.

    Parameters
    ----------
    run : Trajectory
        A run of Algorithm 1, 2 or 3.
    proof : str
        The id.
    """
    known = all(type(obstacle) in (Sphere, Wall) for obstacle in getattr(run.law, "obstacles", ()))
    return proof if known and not run.law.gains.per_agent else None


def _unbalanced(run: Trajectory) -> float:
    """Largest residual of the energy balance over the largest |H|."""
    return float(np.abs(run.energy_residual).max()) / (float(np.abs(run.energy()).max()) or 1.0)


def _shrinks(run: Trajectory, share: float) -> bool:
    """Whether the run comes out so again, and better by tighter integration; a wrong identity does not care."""
    if "rtol" not in run.stats:
        return False
    span, again = (float(run.t[0]), float(run.t[-1])), []
    for factor in (1.0, _TIGHTER):
        rtol, atol = max(factor * run.stats["rtol"], _FINEST), run.stats["atol"]
        atol = None if atol is None else factor * atol
        again.append(simulate(run.law, run.q[0], run.p[0], span, method=run.stats["method"], rtol=rtol, atol=atol))
    same, better = (_unbalanced(one) if one.status == "complete" else float("nan") for one in again)
    return same >= _SHRINKS * share >= better


def balance(run: Trajectory, needs: Iterable[Hypothesis], tolerances: Tolerances, *, proof: str | None = None) -> Claim:
    """H(t) − H(0) agrees with the integral of the closed-form rate: the identity, and the integration, are right.

    A residual that shrinks when the run is integrated more tightly is the integrator's, and refutes nothing.

    Parameters
    ----------
    run : Trajectory
        A run of a law with an energy.
    needs : iterable of Hypothesis
        Hypotheses of the claim.
    tolerances : Tolerances
        `energy` is used.
    proof : str, optional
        Id of the proof of the identity.
    """
    energy, residual = run.energy(), run.energy_residual
    worst, share, rounding = int(np.argmax(np.abs(residual))), _unbalanced(run), 1e-14
    margin = tolerances.energy - share
    status = judge(margin, rounding, needs)
    if status == "refuted" and _shrinks(run, share):
        status = "inconclusive"
    course = "falls" if energy[-1] <= energy[0] else "rises"
    return Claim(
        "balance",
        status,
        computed=share,
        stated=f"H(t) - H(0) = integral of dH/dt, to {tolerances.energy:g} of the largest |H|",
        margin=margin,
        error=rounding,
        witness={"time": float(run.t[worst]), "residual": float(residual[worst])},
        proof=proof,
        detail=f"H {course} from {energy[0]:.6g} to {energy[-1]:.6g}; the balance is off by {share:.2g} of it at most",
    )


def never_rises(run: Trajectory, needs: Iterable[Hypothesis], *, since: int = 0, proof: str | None = None) -> Claim:
    """dH/dt ≤ 0 at every sample from one on, by the closed form.

    The terms of Algorithms 1 and 2 have one sign each, which rounding cannot change; those of Algorithm 3 that are
    differences (⟨p_i, p̂_ik − p_i⟩, ⟨p_i, p_i − p_r⟩) are allowed their rounding.

    Parameters
    ----------
    run : Trajectory
        A run of a law with an energy.
    needs : iterable of Hypothesis
        Hypotheses of the claim.
    since : int
        Index of the first sample that counts.
    proof : str, optional
        Id of the proof of the sign.
    """
    rate, error = run.energy_rate()[since:], np.zeros(len(run.t) - since)
    if isinstance(run.law, Algorithm3):
        gains, speed2 = run.law.gains, np.sum(run.p[since:] ** 2, axis=(1, 2))
        told = np.array([float(np.abs(run.law.target.state(t)[1]).sum()) for t in run.t[since:]])
        drag = np.max(gains.c2_gamma) * (speed2 + told * np.sqrt(run.n * speed2))
        error = 1e-14 * (gains.c2_beta * len(run.law.obstacles) * speed2 + drag)
    worst = int(np.argmax(rate - error))
    highest = float(rate[worst])
    falls = "verified" if rate.max() <= 0.0 else "refuted" if highest > error[worst] else "inconclusive"
    return Claim(
        "rate",
        "vacuous" if any(need.status == "unmet" for need in needs) else falls,  # type: ignore[arg-type]
        computed=highest,
        stated="dH/dt <= 0" if since == 0 else f"dH/dt <= 0 for t >= {run.t[since]:.6g}",
        margin=-highest,
        error=float(error[worst]),
        witness={"time": float(run.t[since + worst])},
        proof=proof,
        detail=f"the closed-form rate is at most {highest:.3g} from t = {run.t[since]:.4g} on",
    )


def stays_outside(run: Trajectory) -> Hypothesis:
    """No agent enters an obstacle, between samples either: inside a sphere ⟨p_i, p̂_ik − p_i⟩ may be positive.

    Parameters
    ----------
    run : Trajectory
        A run of Algorithm 3.
    """
    name = "no agent enters an obstacle"
    least = run.clearance()
    if not run.law.obstacles:
        return Hypothesis(name, "met", detail="there is none")
    where = f"(agent {least.agent} at obstacles[{least.obstacle}], t = {least.time:.4g})"
    return Hypothesis(
        name, "met" if least.lower > 0.0 else "unmet", least.lower, f"clearance at least {least.lower:.4g} {where}"
    )


def at_rest(run: Trajectory) -> Hypothesis:
    """Only a γ-agent at rest, in place and as told, does no work on the flock of Algorithm 3.

    Parameters
    ----------
    run : Trajectory
        A run of a law with a γ-agent.
    """
    target = run.law.target
    start = target.position(float(run.t[0]))
    off = (max(np.abs(target.position(t) - start).max(), np.abs(target.state(t)[1]).max()) for t in run.t)
    furthest = float(max(off))
    detail = "" if furthest == 0.0 else "it moves, or says so: it does work on the flock, of either sign"
    return Hypothesis("the γ-agent is at rest, p_r = 0", "met" if furthest == 0.0 else "unmet", detail=detail)


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    applies = type(run.law) in (Algorithm1, Algorithm2, Algorithm3)
    law = Hypothesis("Algorithm 1, 2 or 3 is applied", "met" if applies else "unmet", detail=type(run.law).__name__)
    if not applies:
        return [law], [Claim(name, "vacuous", detail="no energy is known for this law") for name in ("rate", "balance")]
    needs = [law, at_rest(run), stays_outside(run)] if isinstance(run.law, Algorithm3) else [law]
    if type(run.law) is Algorithm2 and run.law.gains.per_agent:  # no moving frame: a moving γ-agent does work
        needs.append(at_rest(run))
    proof = proved(run)
    return needs, [never_rises(run, needs, proof=proof), balance(run, [law], tolerances, proof=proof)]


THEOREM = Theorem(
    id="energy",
    title="Energy identities of Algorithms 1, 2 and 3",
    statement=(
        "dH/dt = -c2α pᵀL̂p under Algorithm 1, dH_λ/dt = -c2γ‖v‖² - c2α vᵀL̂v in the moving frame under Algorithm 2, "
        "and the form of Theorem 6, with the work of a moving γ-agent, under Algorithm 3: the closed form agrees with "
        "the energy of the integrated run. It is never positive under Algorithms 1 and 2, nor under Algorithm 3 with "
        "a γ-agent at rest and all agents outside the obstacles."
    ),
    source="Olfati-Saber 2006, proofs of Theorems 1, 3 and 6",
    kind="trajectory",
    check=_check,
)
