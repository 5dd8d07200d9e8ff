"""Boxes of gains: stable, unstable with a witness, undecided; and every sampled choice agrees."""

from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, find_equilibrium, gain_box
from flockana.base.errors import ArgumentError
from flockana.lattice import hexagonal_patch

LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))
HEXAGON = hexagonal_patch(1, 7.0)


@pytest.mark.parametrize("spread", [0.1, 0.6, 0.9])
def test_a_lattice_is_stable_for_all_gains_and_so_is_every_choice(spread):
    assert gain_box(LAW, HEXAGON, spread).status == "verified"
    rng = np.random.default_rng(0)
    hessian, laplacian = LAW.alpha.hessian(HEXAGON).toarray(), LAW.alpha.laplacian(HEXAGON).toarray()
    for _ in range(20):
        own = rng.uniform(1.0 - spread, 1.0 + spread, (4, 14))
        k = LAW.gains.c1_alpha * own[0, 0] * hessian + np.diag(LAW.gains.c1_gamma * np.repeat(own[1, :7], 2))
        d = LAW.gains.c2_alpha * own[2, 0] * laplacian + np.diag(LAW.gains.c2_gamma * np.repeat(own[3, :7], 2))
        assert np.linalg.eigvals(np.block([[0 * k, np.eye(14)], [-k, -d]])).real.max() < 0.0


def test_the_rotation_of_a_frozen_configuration_refutes_nothing():
    """S7: with other gains the flock rests elsewhere, and there its rotation is neutral; pressed to 0.93 it relaxes."""
    rest = find_equilibrium(LAW, HEXAGON).q
    assert gain_box(LAW, rest, 0.1).status == "inconclusive"
    assert gain_box(LAW, 0.93 * HEXAGON, 0.5).status == "inconclusive"


def test_an_equilibrium_is_stable_with_its_own_gains_but_for_its_rotation():
    rest = find_equilibrium(LAW, HEXAGON).q
    assert gain_box(LAW, rest, 0.0).status == "verified"
    line = Algorithm2(target=StaticTarget((0.0,)))
    assert gain_box(line, find_equilibrium(line, [[-3.5], [3.5]]).q, 0.0).status == "verified"


def test_without_any_pull_nothing_is_certain():
    assert gain_box(replace(LAW, gains=Gains(c1_gamma=0.0)), HEXAGON, 0.1).status == "inconclusive"


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: gain_box(Algorithm1(), HEXAGON, 0.1), "expected Algorithm2"),
        (lambda: gain_box(LAW, hexagonal_patch(2, 7.0), 0.1), "q has 19 agents: expected at most 7"),
        (lambda: gain_box(LAW, HEXAGON, 1.0), "spread = 1: expected a share below 1"),
        (lambda: gain_box(LAW, HEXAGON, -0.1), "spread = -0.1"),
    ],
)
def test_bad_input(call, message):
    with pytest.raises(ArgumentError, match=message):
        call()
