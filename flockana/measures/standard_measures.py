"""Measures defined for any flock: net, extent and velocities."""

from functools import partial
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.measures import metrics
from flockana.measures.measure import Flock, Measure, has_lattice, has_range
from flockana.measures.nets import components, link_lengths, links


def _mismatch(flock: Flock) -> FloatArray:
    """Return the velocity mismatch per agent, K̃ = K/n, at each instant."""
    return metrics.spreads(flock.p) / flock.p.shape[1]


def _strain(run: Any) -> float:
    d, r = run.law.lattice
    distances = link_lengths(run.q[-1], links(run.q[-1], r))
    return float(np.abs(distances - d).max()) / d if distances.size else np.nan


def _relative_residual(run: Any) -> float:
    if "work" not in run.extra:
        return np.nan
    largest = float(np.abs(run.energy()).max())
    return float(np.abs(run.energy_residual).max()) / largest if largest > 0.0 else 0.0


_share = partial(Measure, at_most_one=True)

MEASURES = (
    _share("connectivity", "C, relative connectivity", over_time=lambda flock: flock.nets[0], defined=has_range),
    _share(
        "giant_share", "C*, share of the largest component", over_time=lambda flock: flock.nets[1], defined=has_range
    ),
    Measure(
        "components",
        "components of the net",
        of_run=lambda run: int(components(run.n, links(run.q[-1], run.law.pair.range)).max()) + 1,
        defined=has_range,
    ),
    Measure(
        "normalised_deviation_energy",
        "Ẽ, normalised deviation energy",
        over_time=lambda flock: flock.nets[2] / flock.law.lattice[0] ** 2,
        defined=has_lattice,
    ),
    Measure("strain", "δ/d, largest |link − d|/d", of_run=_strain, defined=has_lattice),
    Measure("cohesion_radius", "R, cohesion radius", "length", lambda flock: metrics.cohesion_radii(flock.q)),
    Measure(
        "normalised_velocity_mismatch", "K̃, normalised velocity mismatch", "length²/time²", _mismatch, logarithmic=True
    ),
    Measure(
        "slip",
        "K̃ over the square of the law's speed scale",
        of_run=lambda run: float(_mismatch(run.end)[0]) / run.scales.energy,
    ),
    Measure("position_diameter", "greatest distance", "length", lambda flock: metrics.diameters(flock.q)),
    Measure(
        "velocity_diameter",
        "greatest difference of velocities",
        "length/time",
        lambda flock: metrics.diameters(flock.p),
        logarithmic=True,
    ),
    Measure("inertia", "J, inertia", "length²", lambda flock: metrics.spreads(flock.q)),
    Measure(
        "min_distance",
        "least distance",
        "length",
        over_time=lambda flock: metrics.min_distances(flock.q),
        of_run=lambda run: run.min_distance(),
        of_run_text="closest approach of two agents in the run, a lower bound between samples too",
    ),
    Measure(
        "end_distance",
        "least distance over d",
        of_run=lambda run: metrics.min_distance(run.q[-1]) / run.law.lattice[0],
        defined=has_lattice,
    ),
    _share("order", "polar order", over_time=lambda flock: metrics.orders(flock.p)),
    _share("coordination", "mean cosine between velocities", over_time=lambda flock: metrics.coordinations(flock.p)),
    Measure(
        "energy_residual",
        "residual of the energy balance",
        of_run=_relative_residual,
        of_run_text="largest |residual of the energy balance| over the largest |H|",
    ),
)
