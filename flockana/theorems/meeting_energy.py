"""Energy needed for two agents to meet: c1α ψ_α(0) for Olfati-Saber's pair law."""

from typing import NamedTuple

import numpy as np

from flockana.interactions import PairInteraction
from flockana.theorems.theorem_toolkit import EPS, Enclosure, Hypothesis, Observed, Trajectory


class PairEnergies(NamedTuple):
    """Potential energies of a law's pairs of agents, gain included."""

    # By how much a coincident pair has more than the least that a pair has; infinite of a singular potential
    c_star: float
    floor: float  # The least potential energy of all pairs together: their number times that of one


def meeting(run: Trajectory | Observed) -> PairEnergies:
    """Return the pair energies of a run's law, which has an α-interaction, for the run's number of agents."""
    pair, gain = run.law.alpha, run.law.gains.c1_alpha
    if gain == 0.0:
        return PairEnergies(0.0, 0.0)
    (energy_floor, _), (top, maximum) = _potential_bounds(pair)
    if maximum == -np.inf:
        return PairEnergies(0.0, -np.inf)  # a pair that meets has less energy than any bound
    return PairEnergies(gain * (top - energy_floor), gain * energy_floor * (run.n * (run.n - 1) // 2))


def _potential_bounds(pair: PairInteraction) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return bounds of the least potential and of the potential at contact; values if unproved."""
    energy_floor, contact = pair.facts.least, pair.facts.contact
    if np.isfinite(energy_floor[0]) and contact[0] > -np.inf:
        return energy_floor, contact
    with np.errstate(all="ignore"):
        ends = pair.energy(np.array([0.0, pair.length]))
    top = contact[0] if contact[0] > -np.inf or contact[1] == -np.inf else float(np.nan_to_num(ends[0], nan=-np.inf))
    floor = energy_floor[0] if np.isfinite(energy_floor[0]) else float(min(pair.far_potential, np.nanmin(ends)))
    return (floor, floor), (top, max(top, contact[1] if np.isfinite(contact[1]) else top))


def above_least(run: Trajectory | Observed, energy: Enclosure) -> Enclosure:
    """Return an energy minus the least possible total potential of all pairs."""
    floor = meeting(run).floor
    return energy if floor == 0.0 else (energy - floor).widened(4.0 * EPS * abs(floor))


def least_is_known(run: Trajectory | Observed) -> list[Hypothesis]:
    """Return the hypothesis that no pair potential is below the least known value; empty if proved."""
    facts = run.law.alpha.facts
    if np.isfinite(facts.least[0]) and facts.contact[0] > -np.inf:
        return []
    detail = f"{type(run.law.alpha).__name__}: no lower bound is proved; values at contact, length, range"
    return [Hypothesis("no pair has less potential energy than the least seen", "assumed", detail=detail)]
