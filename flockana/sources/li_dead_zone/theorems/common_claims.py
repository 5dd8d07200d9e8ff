"""Dead-zone law of a run, with hypotheses and claims shared by both forms of the theorem."""

from math import inf
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.measures.metrics import min_distance
from flockana.solvers.semi_implicit_euler import SemiImplicitEuler
from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.li_dead_zone.theorems.net_components import Components, components_of
from flockana.theorems.collisions import least_distance
from flockana.theorems.limit_certificates import Certificate, decays_to_zero
from flockana.theorems.theorem_toolkit import (
    EPS,
    Claim,
    Enclosure,
    Hypothesis,
    Needs,
    Observed,
    Trajectory,
    condition,
    judged,
)

PROOF = "dead-zone"
_BOUND = 1e-9  # relative rounding of the explicit bound: that of H̄(0)/2k_r in an exponent


def dead_zone_law(run: Trajectory | Observed) -> DeadZoneFlocking | None:
    """Return the dead-zone law of a run or of its semi-implicit Euler map; None for other laws."""
    law: Any = run.law.law if type(getattr(run.law, "solver", None)) is SemiImplicitEuler else run.law
    exact = type(law) is DeadZoneFlocking and type(law.interaction) is DeadZoneInteraction
    return law if exact else None


def applied(seen: Observed) -> Hypothesis:
    """Return the hypothesis that the dead-zone law is applied."""
    return condition("the dead-zone law is applied", dead_zone_law(seen) is not None, detail=seen.law.title)


def hypotheses(seen: Observed) -> list[Hypothesis]:
    """Return the hypothesis of distinct positions at the start."""
    distance = min_distance(seen.run.q[0])
    return [condition("agents start at distinct places", distance > 0.0, distance)]


def final_components(seen: Observed, law: DeadZoneFlocking) -> Components:
    """Return the components of the net at the end of a run, with certificates, cached with the run."""
    dt = seen.law.dt if seen.is_map else None
    q, p, q_error, p_error = seen.end
    late_run = seen.window(seen.t[-1] - seen.scales.time, seen.t[-1])

    def energy_off(agents: npt.NDArray[np.intp]) -> float:
        def energies(run: Trajectory) -> list[float]:
            return [law.hamiltonian(0.0, q[agents], p[agents]) for q, p in zip(run.q, run.p, strict=True)]

        return float(late_run.series(energies, floor=0.0 if seen.is_map else seen.floors.work).half_width[-1])

    def compute() -> Components:
        position_error, p_off = float(np.linalg.norm(q_error)), float(np.linalg.norm(p_error))
        return components_of(q, p, law, dt, off=position_error, p_off=p_off, energy_off=energy_off)

    return seen.cached("dead-zone components", compute)


def settling(end: Components) -> Certificate:
    """Return a certificate that the velocities of each component agree in the limit and no components meet."""
    return min((*(c.settles for c in end.members), end.apart), key=lambda each: each.margin - each.error)


def velocities_match(seen: Observed, end: Components, needs: Needs, *, name: str) -> Claim:
    """Return the claim K̃ → 0, certain if a single component settles, refuted if components separate."""
    what: dict[str, Any] = {"what": "K̃", "of": "K̃", "start": "K̃ at the start", "stated": "K̃ -> 0: all velocities match"}
    certificates = [settling(end)] if end.count == 1 else []
    return decays_to_zero(seen, name, needs, certificates, series=seen.mismatch.mid, escape=end.separation, **what)


def distance_bound(seen: Observed, law: DeadZoneFlocking) -> Enclosure:
    """Return the guaranteed lower bound of all distances, from the saturated energy of the first sample."""

    def distance(energy: npt.NDArray[np.float64]) -> float:
        return law.interaction.least_distance(float(energy)) if np.isfinite(energy) else 0.0

    bound = seen.energy[0].clip(0.0).falling(distance)
    return bound.widened(_BOUND * bound.hi).clip(0.0)


def no_collision(seen: Observed, law: DeadZoneFlocking, bound: Enclosure, needs: Needs, *, name: str) -> Claim:
    """Return the claim that no two agents come closer than a bound: between samples too, except for a map."""
    # The margin is ln(ρ/bound), as a bound may be exponentially small; ρ over d₁ where the bound is exactly 0.
    unit = law.scales.length
    if seen.is_map:
        series = seen.run.metric("min_distance")
        distance, time = Enclosure.of(series.min()), float(seen.t[int(np.argmin(series))])
    else:
        distance, time = least_distance(seen), seen.run.closest_approach().time
    time_text = "at the samples" if seen.is_map else "ever"
    distance = distance.widened(4.0 * EPS * float(np.abs(seen.run.q).max())).clip(0.0)
    if seen.n == 1:
        margin = Enclosure.of(1.0)  # a single agent has no distances
    elif bound.hi > 0.0:
        margin = (distance / bound).log()
    else:
        margin = distance / unit if distance.lo > 0.0 else Enclosure(-inf, distance.mid / unit, inf)
    text = f"no two agents come closer than {distance.lo:.4g} {time_text}; the bound is {bound.mid:.3g}"
    return judged(name, margin, needs, proof=None if seen.is_map else PROOF).described(
        computed=float(distance.lo), stated=f"every distance > {bound.mid:.4g}", witness={"time": time}, detail=text
    )
