"""What an ensemble keeps of a run in numbers: measures of its end, its closest approach, its energy balance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import nan

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.measures import metrics as measure
from flockana.measures.nets import components, link_lengths, links


@dataclass(frozen=True)
class Measure:
    """One number of a run.

    Parameters
    ----------
    text : str
        What it is.
    unit : str
        Its unit.
    value : callable
        ``value(trajectory) -> float``; NaN where it makes no sense for the law.
    """

    text: str
    unit: str
    value: Callable[[Trajectory], float]


def _in_range(value: Callable[[Trajectory, float], float]) -> Callable[[Trajectory], float]:
    """Of laws with an interaction range r; NaN of others."""

    def of_run(run: Trajectory) -> float:
        pair = run.law.pair
        return nan if pair is None else float(value(run, pair.range))

    return of_run


def _of_net(value: Callable[[Trajectory, float, float], float]) -> Callable[[Trajectory], float]:
    """Of laws with a lattice scale d and an interaction range r; NaN of others."""

    def of_run(run: Trajectory) -> float:
        return nan if run.law.lattice is None else float(value(run, *run.law.lattice))

    return of_run


def _strain(run: Trajectory, d: float, r: float) -> float:
    lengths = link_lengths(run.q[-1], links(run.q[-1], r))
    return float(np.abs(lengths - d).max()) / d if lengths.size else nan


def _energy_residual(run: Trajectory) -> float:
    if "work" not in run.extra:
        return nan
    largest = float(np.abs(run.energy()).max())
    return float(np.abs(run.energy_residual).max()) / largest if largest > 0.0 else 0.0


_MEASURES = {
    "components": Measure(
        "components of the net at the end",
        "1",
        _in_range(lambda run, r: int(components(run.n, links(run.q[-1], r)).max()) + 1),
    ),
    "giant_share": Measure(
        "C* at the end, share of agents in the largest component",
        "1",
        _in_range(lambda run, r: measure.giant_share(run.q[-1], r)),
    ),
    "strain": Measure("terminal δ/d, largest |link − d|/d at the end", "1", _of_net(_strain)),
    "deviation_energy": Measure(
        "Ẽ = E/d² at the end", "1", _of_net(lambda run, d, r: measure.deviation_energy(run.q[-1], d, r) / d**2)
    ),
    "velocity_mismatch": Measure(
        "K̃ = K/n at the end", "length²/time²", lambda run: measure.velocity_mismatch(run.p[-1]) / run.n
    ),
    "slip": Measure(
        "K̃ at the end over the square of the law's speed scale",
        "1",
        lambda run: measure.velocity_mismatch(run.p[-1]) / run.n / run.scales.energy,
    ),
    "cohesion_radius": Measure(
        "R at the end, largest distance from the centre of mass",
        "length",
        lambda run: measure.cohesion_radius(run.q[-1]),
    ),
    "order": Measure("polar order at the end", "1", lambda run: measure.order(run.p[-1])),
    "end_distance": Measure(
        "least distance at the end, in units of d",
        "1",
        _of_net(lambda run, d, r: measure.min_distance(run.q[-1]) / d),
    ),
    "min_distance": Measure(
        "closest approach of two agents in the run, a lower bound between samples too",
        "length",
        lambda run: run.min_distance(),
    ),
    "energy_residual": Measure("largest |residual of the energy balance| over the largest |H|", "1", _energy_residual),
}

METRICS = tuple(_MEASURES)


def measure_named(name: str) -> Measure:
    """The measure of that name.

    Examples
    --------
    >>> measure_named("strain").text
    'terminal δ/d, largest |link − d|/d at the end'
    """
    return _MEASURES[name]
