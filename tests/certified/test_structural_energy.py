"""The structural energy in balls against the law's own energy, seen from the centre."""

import numpy as np
import pytest
from flint import arb

import flockana as fl
from flockana.certified.structural_energy import structural_energy

Q = np.array([[0.0, 0.0], [6.5, 0.5], [2.0, 7.5], [9.0, 6.0]])
P = np.array([[1.0, 0.0], [0.5, -1.0], [0.0, 2.0], [-0.5, 0.5]])


@pytest.mark.parametrize(
    "law", [fl.Algorithm1(), fl.Algorithm2(target=fl.StaticTarget(Q.mean(axis=0).tolist()))], ids=["1", "2"]
)
def test_it_is_the_energy_of_the_law_seen_from_the_centre(law):
    found = structural_energy(law, *([[arb(x) for x in row] for row in state.tolist()] for state in (Q, P)))
    assert float(found.mid()) == pytest.approx(law.energy(0.0, Q, P - P.mean(axis=0)), rel=1e-13)
    assert float(found.rad()) < 1e-20
