"""Boxes of gains: stable, unstable with a witness, undecided; and every sampled choice agrees."""

from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, gain_box
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


def test_a_pressed_flock_has_a_witness():
    """Pressed to 0.93 of d: the pairs' push buckles it unless the γ-agent's pull is strong."""
    found = gain_box(LAW, 0.93 * HEXAGON, 0.5)
    assert found.status == "refuted"
    c1, c2, pull, drag = found.witness
    k = c1 * LAW.alpha.hessian(0.93 * HEXAGON).toarray() + pull * np.eye(14)
    d = c2 * LAW.alpha.laplacian(0.93 * HEXAGON).toarray() + drag * np.eye(14)
    assert np.linalg.eigvals(np.block([[0 * k, np.eye(14)], [-k, -d]])).real.max() > 0.0


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
