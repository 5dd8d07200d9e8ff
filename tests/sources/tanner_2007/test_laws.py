"""The laws on nets: force against gradient, power, Jacobian, the jump at R, and what is refused."""

import numpy as np
import pytest
import sympy as sp

import flockana as fl
from flockana.sources.tanner_2007.laws import FixedNetFlocking, ProximityFlocking
from flockana.symbolic.energy_balances import WEIGHT, matching_identity
from flockana.symbolic.generic_pair import vector
from tests.refused import refused

RNG = np.random.default_rng(5)
Q, P = RNG.normal(0.0, 1.0, (5, 2)), RNG.normal(0.0, 1.0, (5, 2))
POTENTIAL = fl.LogPotential(2.0, 1.1)
LAWS = {
    "fixed": FixedNetFlocking(((0, 1), (2, 1), (3, 4), (0, 4)), POTENTIAL, 1.5),
    "near": ProximityFlocking(POTENTIAL, 1.7, 1.5),
}


def test_the_potential_and_its_derivatives():
    s2, k, d = sp.symbols("s2 k d", positive=True)
    potential = k * (d**2 / s2 - 1 + sp.log(s2 / d**2))
    at = {k: 2, d: sp.Rational(11, 10), s2: sp.Rational(7, 3)}
    stress = 2 * sp.diff(potential, s2)  # V'/s = 2 dV/d(s²)
    w, adjacency, slope, fading = POTENTIAL.inner(np.array([7 / 3]))
    assert (adjacency, fading) == (1.0, 0.0)
    for computed, exact in (
        (POTENTIAL.energy(np.sqrt(7 / 3)), potential),
        (POTENTIAL.force(np.sqrt(7 / 3)), -sp.sqrt(s2) * stress),
        (w[0], stress),
        (slope[0], sp.diff(stress, s2)),
    ):
        assert float(computed) == pytest.approx(float(exact.subs(at)), rel=1e-13)
    for energy in (1e-9, 0.3, 40.0, 1e6):
        assert float(POTENTIAL.energy(POTENTIAL.nearest(energy))) == pytest.approx(energy, rel=1e-6)
    assert POTENTIAL.nearest(0.0) == POTENTIAL.d


def test_a_potential_is_of_unit_strength_and_distance_by_itself():
    assert fl.LogPotential() == fl.LogPotential(1.0, 1.0)


def test_a_pair_slides_where_each_side_drives_it_into_the_other():
    """0 and 1 at R: while near, 1 is drawn away by 2 and 3; once all three let go, 2 and 3 draw 0 after it."""
    q = np.array([[1.3, 2.0], [3.0, 2.0], [4.9, 2.2], [4.9, 1.8]])
    near, far = 0, 1
    before = np.array([near, far, far, near, near, far], np.int8)
    after = np.array([far, near, near, far, far, far], np.int8)
    law, rest = ProximityFlocking(POTENTIAL, 1.7, 1.5), np.zeros((4, 2))
    length = float(np.hypot(1.9, 0.2))
    own, drawn = -2.0 * POTENTIAL.force(1.7), -2.0 * POTENTIAL.force(length) * 1.9 / length
    assert drawn > own > 0.0
    said = "agents 0 and 1 slide at distance 1.7 = R: each side drives them into the other"
    assert law.sliding(before, after, 0.0, q, rest) == said
    assert law.sliding(after, before, 0.0, q, rest) == said
    assert law.sliding(before, before, 0.0, q, rest) is None
    apart, turning = rest.copy(), rest.copy()
    apart[1, 0], turning[1, 1] = 1e-3, 1.0
    assert law.sliding(before, after, 0.0, q, apart) is None  # it passes through
    bend = 1.0 / 1.7
    assert (law.sliding(before, after, 0.0, q, turning) == said) is bool(drawn - own > 0.0 > bend - drawn)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_the_energy_identity(m):
    assert matching_identity(m).holds
    assert matching_identity(m, potential=False).holds


def test_the_energy_is_that_of_three_pairs_and_of_the_deviations_from_their_mean():
    """With a(s²) = s² and velocities 0, 3, 6 at 0, 1, 3: deviations −3, 0, 3, and 9·1 + 9·4 + 36·9 lost."""
    identity = matching_identity(1, potential=False)
    symbols = [vector(f"{name}_{i}", 1)[0] for name in "qp" for i in range(3)]
    places = dict(zip(symbols, (0, 1, 3, 0, 3, 6), strict=True))
    kinetic, lost = (step.equation.replace(WEIGHT, lambda square: square).subs(places) for step in identity.steps)
    assert (kinetic, lost) == (9, -369)


def test_the_force_jumps_at_r_and_the_energy_does_not():
    law, rest = ProximityFlocking(POTENTIAL, 1.7), np.zeros((2, 1))
    near, far = np.array([[0.0], [1.7 * (1.0 - 1e-12)]]), np.array([[0.0], [1.7 * (1.0 + 1e-12)]])
    assert law.acceleration(0.0, near, rest)[0, 0] == pytest.approx(2.0 * 2.0 * (1.0 - (1.1 / 1.7) ** 2) / 1.7)
    assert not law.acceleration(0.0, far, rest).any()
    assert law.energy(0.0, near, rest) == pytest.approx(law.energy(0.0, far, rest), rel=1e-10)
    run = fl.simulate(law, [[0.0], [2.0]], [[0.5], [-0.5]], (0.0, 8.0))
    assert run.status == "complete"
    assert np.abs(run.energy_residual).max() < 1e-7
    assert abs(run.q[-1, 1, 0] - run.q[-1, 0, 0]) < 1.7 < 2.0


test_bad_input_is_named = refused(
    (lambda: FixedNetFlocking(3), "edges = 3: expected pairs"),
    (lambda: FixedNetFlocking(((0, 0),)), r"edges\[0\] = \(0, 0\): expected two different agents"),
    (lambda: FixedNetFlocking(((0, -1),)), r"edges\[0\] = \(0, -1\): expected two different agents, counted from 0"),
    (lambda: FixedNetFlocking(((0, 1), (1, 0))), r"edges\[1\] = \(0, 1\): expected each link once"),
    (lambda: FixedNetFlocking(((0, 1),), k2=0.0), "k2 = 0: expected a number > 0"),
    (lambda: FixedNetFlocking(((0, 1),), potential=1), "potential = 1: expected LogPotential"),
    (lambda: fl.LogPotential(d=-1.0), "d = -1: expected a number > 0"),
    (lambda: ProximityFlocking(r=1.0), "r = 1: expected more than d = 1"),
    (lambda: FixedNetFlocking(((0, 7),)).acceleration(0.0, Q, P), "edges name agent 7 but there are 5 agents"),
    (lambda: fl.simulate(LAWS["fixed"], 0.0 * Q, P, (0.0, 1.0)), "agents 0 and 1 are joined and coincide"),
    (
        lambda: fl.simulate(LAWS["near"], 0.0 * Q, P, (0.0, 1.0)),
        "the force of the logarithmic potential is infinite there",
    ),
)
