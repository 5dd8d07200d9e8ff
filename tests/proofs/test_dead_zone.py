"""The proof about dead-zone flocking: another factor, damping or primitive makes a step fail."""

import numpy as np
import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

import sympy as sp

from flockana import DeadZoneFlocking, DeadZoneInteraction, simulate
from flockana.sources.li_dead_zone import symbolic
from flockana.sources.li_dead_zone.symbolic import D_1, D_2, K_1, R_D, RHO, R
from proofs import dead_zone, dead_zone_pairs, dead_zone_parting
from proofs.evaluate import enclosed
from tests.proofs.steps import failing

HARD = DeadZoneInteraction(ramp=0.0)


def test_the_collision_bound_needs_its_factor():
    assert dead_zone.no_collision("H/2k_r").holds is True
    assert dead_zone.no_collision("H/k_r, weaker", factor=1).holds is True
    assert dead_zone.no_collision("H/3k_r, stronger", factor=3).holds is False


def test_the_collision_bound_rests_on_the_library_s_potential(monkeypatch):
    right = dead_zone.repulsive_primitive
    monkeypatch.setattr(dead_zone, "repulsive_primitive", lambda *args, **kwargs: right(*args, **kwargs) / 2)
    assert dead_zone.no_collision("H/2k_r").holds is False


def test_the_energy_rate_is_the_library_s(monkeypatch):
    monkeypatch.setattr(symbolic, "K_2", 2 * symbolic.K_2)
    assert symbolic.saturated_energy_identity(2).holds
    monkeypatch.setattr(symbolic, "along_flow", lambda *args: 0)
    broken = [text for text in failing(dead_zone._energy()) if "adds -k₂|p_j - p_i|²" in text]
    assert len(broken) == 3


def wrong_repulsion(pieces):
    (far, near, *rest) = pieces
    pull = K_1 * RHO**2 / 2
    return sp.Piecewise(far, (2 * pull - near[0], near[1]), *rest)


def wrong_pull(pieces):
    return sp.Piecewise(*((value + K_1 * RHO**2 / 2, condition) for value, condition in pieces))


@pytest.mark.parametrize(
    ("wrong", "told"), [(wrong_repulsion, ["below d₁"]), (wrong_pull, ["below d₁", "on the dead zone"])]
)
def test_another_potential_is_no_potential_of_the_force(monkeypatch, wrong, told):
    """The repulsive piece flipped; ½k₁ρ² doubled."""
    right = dead_zone_pairs.potential
    monkeypatch.setattr(dead_zone_pairs, "potential", lambda *args, **kwargs: wrong(right(*args, **kwargs).args))
    for wide in (False, True):
        zones = dead_zone_pairs.zones(wide=wide)
        broken = [name for name in told if dead_zone_pairs.slope_residual(zones[name], wide=wide, eta=sp.S.Zero) != 0]
        assert broken == told


def test_with_a_dead_zone_beyond_the_range_the_attraction_adds_nothing():
    whole, narrow = (dead_zone_pairs.saturated(wide=wide, eta=sp.S.Zero) for wide in (True, False))
    place = dict.fromkeys((dead_zone_pairs.K_R, dead_zone_pairs.K_DELTA), 1) | {K_1: sp.Rational(1, 50)}
    values = {D_1: 7, D_2: 16, R: 15, R_D: 40} | place
    pair = DeadZoneInteraction(r_b=11.5, k_r=1.0, k_delta=1.0, eta=0.0, k1=0.02, ramp=0.0)
    assert (pair.d1, pair.d2) == (7.0, 16.0)
    assert float(pair.far_potential) == pytest.approx(float(whole.args[0][0].subs(values)), abs=1e-12)
    assert float(narrow.args[0][0].subs(values)) != pytest.approx(2.25, abs=1e-2)


def test_a_strong_pull_leaves_no_contact_at_d_1():
    values = dead_zone_pairs.defaults()
    assert dead_zone_pairs.is_contact(values) is True
    values |= {K_1: sp.Integer(50)}
    assert dead_zone_pairs.is_contact(values) is False
    place = dead_zone_pairs.rest_below(values)
    pair = DeadZoneInteraction(k1=50.0, ramp=0.0)
    assert pair.force(float(place.lower())) > 0.0 > pair.force(float(place.upper()))
    assert 1.93 < float(place.mid()) < 1.94
    edge = pair.d1**2 * np.sqrt(1.0 + pair.eta * pair.d1**2)
    least = (2.0 * pair.k_r + pair.k_delta * pair.d1**2) / edge  # of k₁: from there on no contact at d₁
    for share, contact in ((0.999, True), (1.001, False)):
        values |= {K_1: sp.Rational(str(share * least))}
        assert dead_zone_pairs.is_contact(values) is contact


def test_a_strong_attraction_holds_a_pair_that_parts_at_12():
    values = dead_zone_pairs.defaults()
    assert dead_zone_parting.parting_speed(values, 14, 9) <= 12
    assert not dead_zone_parting.parting_speed(values, 13, 9) <= 12
    assert not dead_zone_parting.parting_speed(values | {dead_zone_pairs.R_D: sp.Integer(16)}, 14, 9) <= 12
    strong = values | {dead_zone_pairs.K_R: sp.Integer(200_000)}
    assert dead_zone_parting.parting_speed(strong, 14, 9) > 12
    law = DeadZoneFlocking(DeadZoneInteraction(k_r=2e5))
    run = simulate(law, [[0.0, 0.0], [14.0, 0.0]], [[-6.0, 0.0], [6.0, 0.0]], (0.0, 0.1))
    assert np.linalg.norm(run.q[:, 1] - run.q[:, 0], axis=1).max() < 15.0


@pytest.mark.parametrize("name", ["repulsive_primitive", "attractive_primitive"])
def test_another_primitive_is_told(monkeypatch, name):
    right = getattr(dead_zone, name)
    monkeypatch.setattr(dead_zone, name, lambda *args, **kwargs: 2 * right(*args, **kwargs))
    broken = failing(dead_zone.PROOF.steps())
    assert sum("its closed form has that derivative" in text for text in broken) == 2


def test_a_bounded_force_is_told(monkeypatch):
    monkeypatch.setattr(dead_zone, "repulsion", lambda *args: -sp.Symbol("k_r", nonnegative=True))
    assert any("L3" in text for text in failing(dead_zone.PROOF.steps()))


def test_the_constants_are_those_of_the_default_law():
    values = {symbol.name: float(value) for symbol, value in dead_zone_pairs.defaults().items()}
    assert values == {
        "d_1": HARD.d1, "d_2": HARD.d2, "r": HARD.r, "r_d": HARD.r_d, "k_r": HARD.k_r, "k_delta": HARD.k_delta,
        "eta": HARD.eta, "k_1": HARD.k1, "k_2": DeadZoneFlocking().k2,
    }  # fmt: skip


def test_the_force_of_a_pair_is_at_most_that_just_below_r():
    for pair in (HARD, DeadZoneInteraction()):
        most = enclosed(symbolic.jumps()["r"][0], dead_zone_pairs.balls(dead_zone_pairs.defaults())).real
        force = -pair.force(np.linspace(0.1, np.nextafter(15.0, 0.0), 300))
        assert force.max() == pytest.approx(float(most), rel=1e-12)


def test_a_pair_that_parts_at_12_parts_for_ever_and_one_at_1_does_not():
    for speed, parted in ((12.0, True), (1.0, False)):
        p = [[-speed / 2, 0.0], [speed / 2, 0.0]]
        run = simulate(DeadZoneFlocking(), [[0.0, 0.0], [14.0, 0.0]], p, (0.0, 3.0))
        distance = np.linalg.norm(run.q[:, 1] - run.q[:, 0], axis=1)
        assert bool(distance[-1] > 15.0) is parted
        if parted:
            assert np.linalg.norm(run.p[-1, 1] - run.p[-1, 0]) >= 9.0


def test_the_jump_of_the_printed_energy_is_the_laws():
    (_, shown) = dead_zone._printed_energy()
    assert shown.evidence == "36 + ψ̄(r) in [41.817072, 41.817073]"
    assert float(HARD.far_potential) == pytest.approx(5.81707270869363, abs=1e-12)


def test_claims_of_the_errata_name_this_proof(verdict_of):
    errata = [f"L{k}" for k in range(1, 9)]
    claims = [(key, claim) for key in errata for claim in verdict_of(key).claims]
    named = {f"{key}:{claim.name}" for key, claim in claims if "dead-zone" in (claim.proof, claim.disproof)}
    assert named == {
        *("L2:printed", "L3:printed", "L3:corrected", "L4:printed", "L5:printed", "L5:corrected", "L6:printed"),
        *("L6:bound", "L8:printed", "L8:balance-distance"),
    }
