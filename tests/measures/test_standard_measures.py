"""The measures of any flock, of one whose numbers are known by hand."""

from math import hypot, isnan, sqrt

import numpy as np
import pytest

from flockana import Algorithm1, simulate
from flockana.measures.measure import measures

# d = 7 and r = 8.4: agent 0 has links of 7.7 and 7, agent 3 has none; the centre is at (7, 0) and moves with (2, 0)
Q = [[0.0, 0.0], [7.7, 0.0], [0.0, 7.0], [20.3, -7.0]]
P = [[2.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, -1.0]]
AT_THE_START = {
    "connectivity": 2.0 / 3.0,
    "giant_share": 3.0 / 4.0,
    "normalised_deviation_energy": 2.0 * 0.7**2 / (4.0 + 1.0) / 49.0,  # two links, four ordered pairs
    "cohesion_radius": hypot(13.3, 7.0),
    "normalised_velocity_mismatch": 0.5 * (1.0 + 1.0) / 4.0,
    "position_diameter": hypot(20.3, 14.0),
    "velocity_diameter": 2.0,
    "inertia": 0.5 * (7.0**2 + 0.7**2 + 2.0 * 7.0**2 + 13.3**2 + 7.0**2),
    "min_distance": 7.0,
    "order": (2.0 + 2.0 * 2.0 / sqrt(5.0)) / 4.0,
}


@pytest.fixture(scope="module")
def run():
    return simulate(Algorithm1(), Q, P, (0.0, 1e-6))


@pytest.mark.parametrize("name", AT_THE_START)
def test_values_over_time(run, name):
    assert run.metric(name)[0] == pytest.approx(AT_THE_START[name], rel=1e-12)


def test_values_of_a_run(run):
    found = {name: measure.number(run) for name, measure in measures().items()}
    assert found["components"] == 2.0
    assert found["strain"] == pytest.approx(0.1, rel=1e-4)
    assert found["end_distance"] == pytest.approx(1.0, rel=1e-4)
    assert found["slip"] * run.scales.energy == pytest.approx(0.25, rel=1e-4)
    balance, energy = np.abs(run.energy_residual).max(), np.abs(run.energy()).max()
    assert found["energy_residual"] * energy == pytest.approx(balance, rel=1e-12, abs=0.0)


def test_a_flock_without_links_has_no_strain():
    run = simulate(Algorithm1(), [[0.0], [30.0]], [[0.0]] * 2, (0.0, 1.0))
    assert isnan(measures()["strain"].number(run))


def test_nothing_is_missing_from_an_energy_that_is_zero():
    """One agent at rest, with no energy at all: the balance closes, and is not divided by nothing."""
    run = simulate(Algorithm1(), [[0.0, 0.0]], [[0.0, 0.0]], (0.0, 1.0))
    assert np.abs(run.energy()).max() == 0.0
    assert measures()["energy_residual"].number(run) == 0.0
