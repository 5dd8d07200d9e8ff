"""Cohesion near a γ-agent: a pulled agent stays near it in every composition with nonrising energy."""

import numpy as np

from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm2
from flockana.laws.terms.navigation import Navigation
from flockana.theorems.bounds_between_samples import polygons, radius_over
from flockana.theorems.claims import judged, run_theorem
from flockana.theorems.energy import nothing_adds_energy
from flockana.theorems.meeting_energy import least_is_known, meeting
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances, unmet
from flockana.theorems.theorem_toolkit import (
    Enclosure,
    FloatArray,
    Observed,
    Trajectory,
    condition,
    law_is,
    lengths,
    stacked,
)


def gains_of(run: Trajectory | Observed) -> FloatArray:
    """Return the position gain c1γ of each agent, shape (n,)."""
    return np.broadcast_to(np.asarray(run.law.gains.c1_gamma, dtype=np.float64), (run.n,))


def bound(energy: Enclosure, gain: float, unit: float | None) -> Enclosure:
    """Return the largest distance from the centre of its pull that a potential energy allows an agent."""
    height = energy.clip(0.0) / gain
    return (2.0 * height + (0.0 if unit is None else (height / unit).square())).sqrt()


def farthest(seen: Observed, place: FloatArray) -> Enclosure:
    """Return an enclosure of the largest distance of each agent from a point over a run, shape (n,)."""
    run = seen.run
    error = seen.shape_error + seen.centre_error[:, None]
    sample_distances = Enclosure.around(lengths(run.q - place), error).max(axis=0)
    maximum = sample_distances.hi.copy()
    point = np.zeros(3)  # paths have three components in every dimension
    point[: run.m] = place
    error_sum = float(error.max()) + (float(seen.between_error.max()) if len(seen.t) > 1 else 0.0)
    for _, points, allowance in polygons(run):
        maximum = np.maximum(maximum, lengths(points - point).max(axis=1) + allowance + error_sum)
    return Enclosure(sample_distances.lo, sample_distances.mid, maximum)


def stays_within(seen: Observed, needs: list[Hypothesis], *, name: str = "bound", proof: str | None = None) -> Claim:
    """Return the claim that each pulled agent stays within the distance allowed by the initial energy."""
    law, gains = seen.law, gains_of(seen)
    unit, pulled_agents = law.term(Navigation).unit, np.flatnonzero(gains > 0.0)
    energy = seen.energy[0] - (0.0 if law.alpha is None else meeting(seen).floor)
    distance_bounds = stacked([bound(energy, gain, unit) for gain in gains[pulled_agents]])
    if law.moving:
        distance = seen.distances_from_centre.max(axis=0)[pulled_agents]
        distance = Enclosure(distance.lo, distance.mid, np.maximum(distance.hi, radius_over(seen).hi.max()))
    else:
        distance = farthest(seen, law.target.position(float(seen.t[0])))[pulled_agents]
    margin = distance_bounds - distance
    worst, centre_text = margin.worst_index, "the centre of mass" if law.moving else "the γ-agent"
    agent = int(pulled_agents[worst])
    return judged(name, margin, needs, proof=proof, computed=float(distance.mid[worst])).described(
        stated=f"agent {agent} stays within {distance_bounds.mid[worst]:.5g} of {centre_text}",
        witness={"agent": agent},
        detail=f"of {pulled_agents.size} agents with c1γ > 0 the one nearest to its bound, agent {agent}, goes "
        f"{distance.mid[worst]:.4g} from {centre_text}, and H(0) allows {distance_bounds.mid[worst]:.4g}",
    )


@run_theorem(
    "cohesion",
    title="Agents that a γ-agent pulls stay near it",
    source="ours, on Olfati-Saber 2006, Theorem 3(i)",
    law=law_is("Algorithm 2 or 3", Algorithm2, Algorithm3, composed=True),
    claims=("bound",),
    references=("olfati-saber-2006", "flockana"),
    author="flockana",
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Where no term adds energy, the potential of each agent's own pull is at most H(0) minus the least energy of all
    pairs: with a linear pull ‖q_i − q_r‖ <= sqrt(2 H(0)/c1γ_i) of a γ-agent at rest, or of the centre of mass where one
    gain pulls all and the energy is that of the shape; with a bounded pull of length ℓ sqrt(2 H(0)/c1γ_i + (H(0)/(c1γ_i
    ℓ))²).
    """
    pulls = seen.law.target is not None and bool(np.max(gains_of(seen)) > 0.0)
    if unmet(needs := [condition("c1γ > 0 of an agent", pulls, detail="" if pulls else "the γ-agent pulls nobody")]):
        return needs, []
    needs += nothing_adds_energy(seen) + ([] if seen.law.alpha is None else least_is_known(seen))
    return needs, [stays_within(seen, needs)]
