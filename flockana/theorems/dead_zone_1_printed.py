"""Theorem 1 of the dead-zone paper as printed: one flock within r, an energy that falls, one velocity, no collision."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np

from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.metrics import cohesion_radius
from flockana.theorems.asymptotics import velocities_match
from flockana.theorems.dead_zone_case import PROOF, Parts, dead_zone_law, hypotheses, no_collision, parts
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge
from flockana.trajectory import Trajectory


def _at_rest(run: Trajectory, law: DeadZoneFlocking, end: Parts, tolerances: Tolerances) -> bool:
    """Whether the flock is one, with matched velocities and no force: it has ended where it is."""
    u = law.flow(float(run.t[-1]), run.q[-1], run.p[-1])[0]
    still = float(np.linalg.norm(u, axis=1).max()) <= tolerances.force * law.interaction.contact_force
    return end.count == 1 and end.mismatch <= tolerances.velocity and still


def _cohesion(
    run: Trajectory, law: DeadZoneFlocking, end: Parts, needs: list[Hypothesis], tolerances: Tolerances
) -> Claim:
    """R ≤ r in the end; a finite run refutes it where parts are certain to part, or a flock at rest is wider."""
    radius, r = cohesion_radius(run.q[-1]), law.interaction.r
    margin = -inf if end.parting else r - radius
    status = judge(margin, 0.0, needs)
    final = end.parting or _at_rest(run, law, end, tolerances)
    return Claim(
        "cohesion",
        "inconclusive" if status == "refuted" and not final else status,
        computed=radius,
        stated=f"in the end no agent is farther than r = {r:g} from the leader (read: the centre of mass)",
        margin=margin,
        error=0.0,
        witness={"components": end.count, "parting": end.parting, "time": float(run.t[-1])},
        detail=f"at t = {run.t[-1]:g} there are {end.count} component(s), R = {radius:.4g}"
        + (", and they part for ever" if end.parting else ""),
    )


def _energy(run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """The energy of neighbours only never rises between samples."""
    energy = run.metrics().literal_energy.values
    error = float(np.abs(run.energy_residual).max()) if "work" in run.extra else 1e-9 * float(np.abs(energy).max())
    rises = np.diff(energy)
    k = int(np.argmax(rises)) if rises.size else 0
    rise = float(rises[k]) if rises.size else 0.0
    unmet = any(need.status == "unmet" for need in needs)
    return Claim(
        "energy",
        "vacuous" if unmet else "refuted" if rise > error else "verified",
        computed=rise,
        stated="H, summed over neighbours, never rises",
        margin=-rise,
        error=error,
        witness={"time": float(run.t[min(k + 1, len(run.t) - 1)])},
        proof=PROOF,
        detail=f"H of neighbours rises by up to {rise:.4g} from one sample to the next",
    )


def _one_velocity(run: Trajectory, end: Parts, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """K̃ → 0: a finite run refutes it only where parts are certain to part, each at its own velocity for ever."""
    claim = velocities_match(run, tolerances, needs, name="velocity")
    if claim.status == "inconclusive" and end.parting:
        return replace(claim, status="refuted", detail=claim.detail + "; the parts keep their own velocities for ever")
    return claim


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    needs, law = hypotheses(run), dead_zone_law(run)
    if law is None:
        return needs, [Claim(name, "vacuous", detail="another law") for name in _CLAIMS]
    end = parts(run.q[-1], run.p[-1], law)
    return needs, [
        _cohesion(run, law, end, needs, tolerances),
        _energy(run, needs),
        _one_velocity(run, end, needs, tolerances),
        no_collision(run, 0.0, needs, name="collision"),
    ]


_CLAIMS = ("cohesion", "energy", "velocity", "collision")

THEOREM = Theorem(
    id="dead-zone-1-printed",
    title="Dead-zone flocking as printed: cohesion, falling energy, one velocity, no collision",
    statement=(
        "From finite initial energy, agents form cohesive flocks with no agent farther than r from its virtual leader; "
        "the energy does not rise, the flock ends in a local minimum and velocities match; no two agents collide. No "
        "leader appears in the law: its centre of mass is taken instead. Connectivity is not implied (L4), the energy "
        "of neighbours jumps (L5), velocities match within components only (L7); the last claim is true (L6)."
    ),
    source="Li, Yuan and Liu, Theorem 1 (its proof is omitted there)",
    kind="trajectory",
    check=_check,
    references=("li-dead-zone",),
)
