"""What energy it takes that two agents meet: c1α ψ_α(0) under the paper's pair law, where no pair has less than 0."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.interactions import AlphaInteraction
from flockana.theorems.theorem import Hypothesis

_GRID = 4001  # distances at which a potential without a known minimum is looked at


class Meeting(NamedTuple):
    """Energies of a law's pairs, gain included.

    Attributes
    ----------
    c_star : float
        By how much a coincident pair has more than the least that a pair has; infinite of a singular potential.
    floor : float
        The least potential energy of all pairs together: their number times that of one.
    """

    c_star: float
    floor: float


def meeting(run: Trajectory) -> Meeting:
    """Those of a run's law, which has an α-interaction, and its number of agents.

    Examples
    --------
    >>> from flockana import Algorithm1, simulate
    >>> run = simulate(Algorithm1(), [[0.0], [7.0]], [[0.0], [0.0]], (0.0, 1.0))
    >>> meeting(run).c_star == 30.0 * run.law.alpha.c_star, meeting(run).floor
    (True, 0.0)
    """
    pair, gain = run.law.alpha, run.law.gains.c1_alpha
    if isinstance(pair, AlphaInteraction):
        return Meeting(gain * pair.c_star, 0.0)
    reach = pair.range if np.isfinite(pair.range) else 100.0 * pair.length
    with np.errstate(all="ignore"):
        values = pair.energy_at(np.append(np.linspace(0.0, reach, _GRID), pair.length))
    least = float(min(pair.far_potential, np.nanmin(values)))
    top = float(values[0]) if np.isfinite(values[0]) else np.inf
    return Meeting(gain * (top - least), gain * least * (run.n * (run.n - 1) // 2))


def least_is_known(run: Trajectory) -> list[Hypothesis]:
    """The hypothesis that no pair has less energy than was seen at some distances: assumed; none of the paper's law."""
    if isinstance(run.law.alpha, AlphaInteraction):
        return []
    detail = f"seen at {_GRID} distances up to the range"
    return [Hypothesis("no pair has less potential energy than the least seen", "assumed", detail=detail)]
