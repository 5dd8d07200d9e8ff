"""The force of every law that has an energy is minus the derivative of that energy, by complex steps."""

from dataclasses import replace

import numpy as np
import pytest

from flockana.laws.law import Law
from tests.properties.test_every_law import LAWS
from tests.properties.test_every_law import state as made
from tests.reference import energies as from_formulas
from tests.reference.energies import drawn, over_pairs, pulled, walled

STEP = 1e-30  # of a complex step: nothing is subtracted, so nothing is lost


def alpha(law, q):
    return law.gains.c1_alpha * over_pairs(q, lambda s2: from_formulas.psi_alpha(s2, law.alpha))


def following(law, q):
    return alpha(law, q) + pulled(q, law.gains.c1_gamma)


def dead(law, q):
    return over_pairs(q, lambda s2: from_formulas.dead_zone(s2, law.interaction))


POTENTIALS = {
    "Algorithm1": alpha,
    "Algorithm2": following,
    "Algorithm3": lambda law, q: alpha(law, q) + drawn(q, law.gains.c1_gamma) + walled(q, law),
    "PushedAlgorithm1": alpha,
    "PushedAlgorithm2": following,
    "PeerToPeer": following,
    "Composition": following,
    **dict.fromkeys(("CuckerSmale", "FiniteTimeAlignment", "SingularAlignment"), lambda law, q: 0.0 * q[0][0]),
    "FixedNetFlocking": lambda law, q: over_pairs(
        q, lambda s2: from_formulas.logarithmic(s2, law.potential, 1e9), law.edges
    ),
    "ProximityFlocking": lambda law, q: over_pairs(q, lambda s2: from_formulas.logarithmic(s2, law.potential, law.r)),
    "LinkKeeping": lambda law, q: over_pairs(q, lambda s2: from_formulas.tension(s2, law), law.links),
    "DeadZoneFlocking": dead,
    "LedDeadZoneFlocking": lambda law, q: dead(law, q) + pulled(q, law.c1),
}
NAMES = sorted(POTENTIALS)


def case(name, seed):
    """The law, with next to the printed jumps of the dead zone, and agents at rest that are not on any of its kinks."""
    law = LAWS[name][0]
    if hasattr(law, "interaction"):
        law = replace(law, interaction=replace(law.interaction, ramp=1e-12))
    if hasattr(law, "min_distance"):
        law = replace(law, min_distance=1e-6)  # a push has no energy
    return law, made(seed)[0]


def test_every_law_with_an_energy_is_here():
    q, p, *_ = made(0)
    having = {n for n, (law, _) in LAWS.items() if isinstance(law, Law) and np.isfinite(law.energy(0.0, q, p))}
    assert having == set(NAMES)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", NAMES)
def test_forces_are_complex_steps_of_the_energy(name, seed):
    law, q = case(name, seed)
    expected = np.zeros_like(q)
    for k in np.ndindex(q.shape):
        moved = q.astype(complex)
        moved[k] += 1j * STEP
        expected[k] = -np.imag(POTENTIALS[name](law, moved)) / STEP
    np.testing.assert_allclose(law.acceleration(0.0, q, 0.0 * q), expected, atol=1e-10 * (1.0 + np.abs(expected).max()))


@pytest.mark.parametrize("name", NAMES)
def test_energies_differ_as_their_formulas_do(name):
    law, places = case(name, 0)[0], [case(name, seed)[1] for seed in (0, 1)]
    q, other = (place - place.mean(axis=0) for place in places)  # where Algorithm 2 counts what is about the centre
    expected = POTENTIALS[name](law, q) - POTENTIALS[name](law, other)
    found = law.energy(0.0, q, 0.0 * q) - law.energy(0.0, other, 0.0 * other)
    assert found == pytest.approx(expected, rel=1e-10, abs=1e-9)
