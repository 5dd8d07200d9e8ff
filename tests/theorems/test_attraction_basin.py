"""The certificate of attraction: its Lipschitz constant against the Hessian itself, its verdict against long runs."""

import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

import flockana as fl
from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains, rescale
from flockana.equilibria.gradient_flow import structural_force
from flockana.lattice import hexagonal_patch, hexagonal_spiral
from flockana.sources.geschwender_2016.theorems.e03_strained_limits import rhombus_with_double_agent
from flockana.theorems.attraction_basin import _action, attraction, lipschitz_within
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.rounding_bounds import pair_force_error

LAW1 = Algorithm1()
LAW2 = Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
seeds = st.integers(0, 2**32 - 1)


def margin(law, q, p=None):
    q = np.asarray(q, dtype=float)
    return attraction(law, q, 0.0 * q if p is None else np.asarray(p, dtype=float)).certificate.margin


def shaken(seed, n=7, size=0.02, speed=0.02):
    rng = np.random.default_rng(seed)
    q = hexagonal_spiral(n, 7.0)
    return q + size * rng.normal(size=q.shape), speed * rng.normal(size=q.shape)


@given(seeds, st.integers(2, 8), st.integers(1, 3), st.floats(-6.0, -0.7).map(lambda x: 10.0**x), st.data())
def test_the_hessian_never_changes_faster_than_the_constant_says(seed, n, m, window, data):
    some = AlphaInteraction(), AlphaInteraction(1.9, 2.8, 0.1, 0.4, 7.0, 9.0), AlphaInteraction(7.0, 8.4, 5.0, 0.9)
    alpha = data.draw(st.sampled_from(some))
    law, rng = Algorithm1(alpha), np.random.default_rng(seed)
    q = alpha.d * rng.uniform(0.0, 1.0, (n, m)) * n ** (1.0 / m)
    q[1] = q[0] + data.draw(st.sampled_from([0.0, alpha.r, alpha.d, 0.5 * alpha.r])) * np.eye(m)[0]
    bound = lipschitz_within(law, q, window * alpha.d)
    for _ in range(4):
        step = rng.normal(size=q.shape)
        step *= window * alpha.d * rng.uniform() / np.linalg.norm(step)
        change = np.linalg.norm(law.stiffness(q + step).toarray() - law.stiffness(q).toarray(), 2)
        rounding = 1e-12 * np.linalg.norm(law.stiffness(q).toarray(), 2)
        assert change <= bound * np.linalg.norm(step) + rounding


def test_a_pair_at_its_length_needs_no_more_than_its_bond_to_be_torn():
    """The barrier is a bound from below: c1α ψ_α(r_α) tears the bond."""
    q = np.array([[0.0, 0.0], [7.0, 0.0]])
    found = attraction(LAW1, q, 0.0 * q)
    assert 0.0 < found.barrier < 30.0 * LAW1.alpha.far_potential
    assert found.excess < 1e-20
    # two agents move against each other: twice the stiffness of the bond
    bond = 30.0 * (LAW1.alpha.phi_alpha_slope(LAW1.alpha.d_alpha) * 49.0 / (1.0 + 0.1 * 49.0))
    assert found.curvature == pytest.approx(2.0 * bond, rel=1e-9)


@pytest.mark.parametrize("share", [0.05, 0.9, 1.1, 1e3])
def test_the_energy_is_held_against_the_barrier(share):
    q = hexagonal_patch(1, 7.0)
    barrier = attraction(LAW1, q, 0.0 * q).barrier
    rng = np.random.default_rng(0)
    p = rng.normal(size=q.shape)
    p -= p.mean(axis=0)
    p *= np.sqrt(2.0 * share * barrier) / np.linalg.norm(p)
    found = attraction(LAW1, q, p + np.array([300.0, -20.0]))  # a common velocity is none
    assert found.excess == pytest.approx(share * barrier, rel=1e-3)
    assert (found.certificate.margin > 0.0) is (share < 1.0)
    assert found.certificate.margin == pytest.approx(max(-1.0, 1.0 - share), abs=2e-3)


@pytest.mark.parametrize("law", [LAW1, LAW2], ids=["Algorithm 1", "Algorithm 2"])
@given(seed=seeds)
@settings(max_examples=6)
def test_what_is_caught_stays_and_comes_to_rest(law, seed):
    q, p = shaken(seed, size=0.03, speed=0.3)
    if isinstance(law, Algorithm2):
        q = fl.simulate(law, q, 0.0 * q, (0.0, 30.0)).q[-1] + 0.01 * np.random.default_rng(seed).normal(size=q.shape)
    found = attraction(law, q, p)
    if found.certificate.margin < 0.0:
        p = 0.5 * p * np.sqrt(found.barrier / max(found.excess, found.barrier))
        found = attraction(law, q, p)
    if found.certificate.margin < 0.0:
        return
    run = fl.simulate(law, q, p, (0.0, 30.0), rtol=1e-10)
    lengths = [np.linalg.norm(x[:, None] - x[None], axis=2) for x in run.q]
    moved = max(np.abs(one - lengths[-1]).max() for one in lengths)
    reach = np.sqrt(2.0 * found.barrier / found.curvature)  # of the quadratic well of that height
    assert moved <= 4.0 * reach
    assert run.metric("normalised_velocity_mismatch")[-1] < 1e-12
    assert attraction(law, run.q[-1], run.p[-1]).excess < 1e-9 * found.barrier


@pytest.mark.parametrize(
    ("law", "q"),
    [
        (LAW1, [[0.0, 0.0], [7.0, 0.0], [14.0, 0.0]]),  # a chain flexes
        (LAW1, [[0.0, 0.0], [7.0, 0.0], [100.0, 0.0]]),  # one is not held
        (LAW1, [[0.0, 0.0], [7.0, 0.0], [100.0, 0.0], [107.0, 0.0]]),  # two pairs that need not be at rest together
        (LAW2, [[0.0, 0.0], [0.0, 0.0]]),  # repelled by each other: a maximum
        (LAW1, [[0.0], [0.0]]),
        (Algorithm1(gains=Gains(c2_alpha=0.0)), hexagonal_patch(1, 7.0)),  # swings for ever
        (Algorithm2(gains=Gains(c2_alpha=0.0, c2_gamma=0.0), target=LAW2.target), hexagonal_patch(1, 6.98)),
        (Algorithm1(gains=Gains(c1_alpha=0.0)), hexagonal_patch(1, 7.0)),  # nothing pulls back
    ],
)
def test_what_is_not_held_is_not_caught(law, q):
    assert margin(law, q) == -1.0


def test_agents_that_coincide_at_a_strict_minimum_and_one_agent_are_caught():
    assert margin(LAW1, rhombus_with_double_agent(7.0)) > 0.99
    assert margin(LAW1, [[3.0, 1.0]], [[9.0, 0.0]]) == 1.0


def test_a_flock_too_large_for_a_dense_hessian_is_left_open(monkeypatch):
    monkeypatch.setattr(sys.modules["flockana.theorems.attraction_basin"], "DENSE_LIMIT", 12)
    assert margin(LAW1, hexagonal_patch(1, 7.0)) == -1.0


@pytest.mark.slow
@given(seeds, st.floats(-6.0, 6.0).map(lambda x: 10.0**x), st.floats(-6.0, 6.0).map(lambda x: 10.0**x))
def test_units_places_turns_and_names_change_nothing(seed, length, time):
    q, p = shaken(seed, size=1e-3, speed=0.05)
    rng = np.random.default_rng(seed)
    turn, order = np.linalg.qr(rng.normal(size=(2, 2)))[0], rng.permutation(len(q))
    one = attraction(LAW1, q, p)
    for law, x, v, by in (
        (rescale(LAW1, length=length, time=time), q * length, p * (length / time), (length / time) ** 2),
        (LAW1, q @ turn + 40.0 * rng.normal(size=2), p @ turn + 3.0, 1.0),
        (LAW1, q[order], p[order], 1.0),
    ):
        two = attraction(law, x, v)
        assert two.barrier / by == pytest.approx(one.barrier, rel=1e-5)
        assert two.certificate.margin == pytest.approx(one.certificate.margin, abs=1e-5)


@pytest.mark.parametrize("n", [2, 3, 7])
def test_a_lattice_has_no_force_but_what_its_sums_round(n):
    """c1α times what a pair is off by, once for each neighbour and once more, over all coordinates."""
    q = np.array([[7.0, 0.0], [0.0, 0.0], [3.5, 7.0 * np.sqrt(0.75)]])[:n] if n < 7 else hexagonal_patch(1, 7.0)
    found = attraction(LAW1, q, 0.0 * q)
    near = n - 1  # of the agent in the middle
    rounding = np.sqrt(2.0 * n) * 30.0 * pair_force_error(LAW1.alpha) * (near + 1.0)
    force = np.linalg.norm(structural_force(LAW1, q))
    assert force < 0.1 * rounding
    assert 0.5 * found.distance * found.curvature == pytest.approx(force + rounding, rel=1e-9, abs=0.0)
    assert found.excess == pytest.approx((force + rounding) ** 2 / found.curvature, rel=1e-9, abs=0.0)


def test_a_pull_rounds_with_the_place():
    """Two agents whose repulsion the pull to the γ-agent between them balances: 16 ε of the pull besides."""
    law = Algorithm2(gains=Gains(c1_alpha=1.0, c2_alpha=1.0, c1_gamma=1.0, c2_gamma=1.0), target=LAW2.target)

    def state(s):
        return np.array([[-s, 0.0], [s, 0.0]])

    s = brentq(lambda s: structural_force(law, state(s))[1, 0], 3.0, 3.5, xtol=1e-18, rtol=1e-15)
    found, force = attraction(law, state(s), np.zeros((2, 2))), np.linalg.norm(structural_force(law, state(s)))
    rounding = 2.0 * (2.0 * pair_force_error(law.alpha) + 16.0 * np.finfo(float).eps * s)
    assert 0.5 * found.distance * found.curvature == pytest.approx(force + rounding, rel=1e-9, abs=0.0)


def test_the_enclosed_action_and_its_slopes_are_those_of_the_law():
    """φ_α and φ_α' of the law itself, and its second derivative by central differences."""
    alpha = AlphaInteraction(7.0, 8.4, 0.1, 0.4, 7.0, 9.0)
    z = np.linspace(0.1, 0.99, 40) * alpha.r_alpha
    found, slope, bend = _action(alpha, Enclosure.around(z, 0.0))
    step = 1e-5 * alpha.r_alpha
    differences = (alpha.phi_alpha_slope(z + step) - alpha.phi_alpha_slope(z - step)) / (2.0 * step)
    np.testing.assert_allclose(found.mid, alpha.phi_alpha(z), rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(slope.mid, alpha.phi_alpha_slope(z), rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(bend.mid, differences, rtol=0.0, atol=1e-6 * np.abs(differences).max())
    assert (found.hi - found.lo).max() < 1e-12
