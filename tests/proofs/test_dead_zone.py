"""The proof about dead-zone flocking: another factor, damping or primitive makes a step fail."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

import sympy as sp

from flockana.interactions.dead_zone import DeadZoneInteraction
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.symbolic.dead_zone import K_2
from proofs import dead_zone

HARD = DeadZoneInteraction(ramp=0.0)


def failing():
    return [step.text for step in dead_zone.PROOF.steps() if step.holds is not True]


def test_the_collision_bound_needs_its_factor():
    assert dead_zone.no_collision("H/2k_r").holds is True
    assert dead_zone.no_collision("H/k_r, weaker", factor=1).holds is True
    assert dead_zone.no_collision("H/3k_r, stronger", factor=3).holds is False


def test_the_energy_rate_needs_its_damping():
    assert dead_zone.pair_rate(2) == 0
    assert dead_zone.pair_rate(2, damping=2 * K_2) != 0
    assert dead_zone.pair_rate(2, damping=sp.S.Zero) != 0


@pytest.mark.parametrize("name", ["repulsive_primitive", "attractive_primitive"])
def test_another_primitive_is_told(monkeypatch, name):
    right = getattr(dead_zone, name)
    monkeypatch.setattr(dead_zone, name, lambda *args, **kwargs: 2 * right(*args, **kwargs))
    broken = failing()
    assert sum("its closed form has that derivative" in text for text in broken) == 2


def test_a_bounded_force_is_told(monkeypatch):
    monkeypatch.setattr(dead_zone, "repulsion", lambda *args: -sp.Symbol("k_r", nonnegative=True))
    assert any("L3" in text for text in failing())


def test_the_constants_are_those_of_the_default_law():
    values = {symbol.name: float(sp.Rational(value)) for symbol, value in dead_zone._DEFAULTS.items()}
    assert values == {
        "d_1": HARD.d1, "d_2": HARD.d2, "r": HARD.r, "r_d": HARD.r_d, "k_r": HARD.k_r, "k_delta": HARD.k_delta,
        "eta": HARD.eta, "k_1": HARD.k1,
    }  # fmt: skip
    assert DeadZoneFlocking().k2 == 1.0


def test_the_bounds_of_the_parting_pair_are_the_laws():
    for pair in (HARD, DeadZoneInteraction()):
        force = pair.force(np.linspace(14.0, np.nextafter(15.0, 0.0), 50))
        assert 2.0 < force.max() <= 2.1
        assert force.min() > 0.0


def test_a_pair_that_parts_at_12_parts_for_ever_and_one_at_1_does_not():
    from flockana.dynamics.simulate import simulate

    for speed, parted in ((12.0, True), (1.0, False)):
        p = [[-speed / 2, 0.0], [speed / 2, 0.0]]
        run = simulate(DeadZoneFlocking(), [[0.0, 0.0], [14.0, 0.0]], p, (0.0, 3.0))
        distance = np.linalg.norm(run.q[:, 1] - run.q[:, 0], axis=1)
        assert bool(distance[-1] > 15.0) is parted
        if parted:
            assert np.linalg.norm(run.p[-1, 1] - run.p[-1, 0]) >= 9.0


def test_the_jump_of_the_printed_energy_is_the_laws():
    far = next(step.evidence for step in dead_zone.PROOF.steps() if step.text.startswith("L5"))
    assert "from 36 to 41.8171" in far
    assert float(HARD.far_potential) == pytest.approx(5.81707270869363, abs=1e-12)


def test_claims_of_the_errata_name_this_proof(verdict_of):
    errata = [f"L{k}" for k in range(1, 9)]
    named = {f"{key}:{claim.name}" for key in errata for claim in verdict_of(key).claims if claim.proof == "dead-zone"}
    assert named == {
        *("L2:printed", "L3:printed", "L3:corrected", "L4:printed", "L5:printed", "L5:corrected", "L6:printed"),
        *("L6:bound", "L8:printed", "L8:contact"),
    }
