"""The balance of energy of every run of the catalogue closes to ten times its tolerance."""

import numpy as np
import pytest

from flockana import DiscreteLaw, scenario, scenarios

MOST = 10.0  # times rtol, of the largest energy of the run


def conserving(name):
    item = scenario(name)
    return not isinstance(item.law, DiscreteLaw) and np.isfinite(item.law.hamiltonian(0.0, item.q0, item.p0))


NAMES = [name for name in scenarios() if conserving(name)]


def test_most_of_the_catalogue_has_an_energy():
    assert len(NAMES) > 40


@pytest.mark.parametrize("name", NAMES)
def test_the_balance_closes(name):
    run = scenario(name).run()
    energy = np.abs(run.energy()).max()
    assert energy > 0.0
    assert np.abs(run.energy_residual).max() <= MOST * run.stats["rtol"] * energy
