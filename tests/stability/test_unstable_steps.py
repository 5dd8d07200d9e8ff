"""Steps at which sampled nets begin to grow, against a zero-order hold by the matrix exponential, and closed forms."""

from math import cos, inf, nan, pi, sin

import numpy as np
import pytest
from scipy.sparse import csr_array

from flockana import Algorithm2, Linearisation, StaticTarget
from flockana.stability.map_linearisation import moved_before
from flockana.stability.sampling import SamplingMargin, margin_of_flow
from flockana.stability.unstable_steps import MOST, Steps, first_growth

LAW = Algorithm2(target=StaticTarget((0.0,)))


def net(k, d):
    """A flock on a line with these K and D."""
    n = len(k)
    a = np.block([[np.zeros((n, n)), np.eye(n)], [-k, -d]])
    places, links = np.arange(n, dtype=float)[:, None], np.zeros((0, 2), dtype=np.int32)
    return Linearisation(LAW, places, 0.0 * places, 0.0, 0.0, links, csr_array(a), 1e-12)


def hold(k, d, h):
    """Multipliers of a flock whose u is held for h, by the exponential of (q, p, u), a series of three terms."""
    n = len(k)
    flow = np.kron([[1.0, h, 0.5 * h * h], [0.0, 1.0, h]], np.eye(n))
    return np.linalg.eigvals(flow @ np.vstack([np.eye(2 * n), -np.hstack([k, d])]))


def decays(k, d, h, neutral):
    """Whether all multipliers but those of neutral motions are inside the circle."""
    z = hold(k, d, h)
    return np.abs(np.delete(z, np.argsort(np.abs(z - 1.0))[:neutral])).max() < 1.0


def stiff_chain(*stiffness):
    """Each follower hears the one before: s² + k s + k."""
    k = np.diag(stiffness) - np.diag(stiffness[1:], -1)
    k[0, 0] = 0.0 if np.isnan(stiffness[0]) else stiffness[0]
    return k, k.copy()


def test_a_star_whose_leader_is_free_bears_what_one_follower_does():
    """S3: s² + s + 1 under a hold flips at h = 2; nobody answers, so that 19 followers bear no less."""
    k, d = np.diag([0.0] + [1.0] * 19), np.diag([0.0] + [1.0] * 19)
    k[1:, 0] = d[1:, 0] = -1.0
    found = margin_of_flow("hold", net(k, d), 0.5)
    assert found.period == pytest.approx(2.0, rel=1e-9)
    assert found.certified
    assert found.first.multiplier == pytest.approx(-1.0, abs=1e-5)
    assert decays(k, d, 1.999, 2)
    assert not decays(k, d, 2.001, 2)


@pytest.mark.parametrize(
    "stiffness", [(nan, 1.0, 1.0, 100.0), (2.0, 2.0, 2.0, 2.0), (1e-3, 50.0, 1.0), (nan, *(3.0,) * 14)]
)
def test_chains_bear_what_their_stiffest_follower_does(stiffness):
    """Under a hold s² + k s + k bears 2/k·(...): min(2 d/k, 2/d) with d = k, which is 2 or 2/k."""
    k, d = stiff_chain(*stiffness)
    expected = min(min(2.0, 2.0 / x) for x in stiffness if x == x)
    found = margin_of_flow("hold", net(k, d), 0.5)
    assert found.period == pytest.approx(expected, rel=1e-9)
    assert found.certified
    v = found.first.shape.ravel()
    w = (found.first.multiplier - 1.0) / found.period
    assert np.abs(w * w * v + w * (d @ v + 0.5 * found.period * (k @ v)) + k @ v).max() < 1e-6 * np.abs(k).max()


@pytest.mark.parametrize("n", [3, 7, 20])
def test_a_ring_grows_where_the_first_of_its_circulants_does(n):
    """Each hears the one before and has a pull and a drag of its own: scalar modes s² + (1 + x) s + 1 + x."""
    k = 1.5 * np.eye(n) - np.roll(np.eye(n), -1, axis=1)
    values = 1.5 - np.exp(2j * pi * np.arange(n) / n)

    def radius(h):
        z = [np.roots([1.0, h * x + 0.5 * h * h * x - 2.0, 1.0 - h * x + 0.5 * h * h * x]) for x in values]
        return np.abs(z).max()

    found = margin_of_flow("hold", net(k, k), 0.5)
    assert found.certified
    assert radius(found.period * (1.0 - 1e-7)) < 1.0 < radius(found.period * (1.0 + 1e-7))
    assert all(radius(x) < 1.0 for x in np.linspace(1e-3, 0.9999, 300) * found.period)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("n", [4, 16])
def test_random_one_way_nets_with_loops(seed, n):
    """By pairs of multipliers up to 24 states of a component, by certified intervals beyond."""
    rng = np.random.default_rng(seed)
    k, d = (rng.uniform(0.0, 2.0, (n, n)) * (rng.random((n, n)) < 2.0 / n) for _ in range(2))
    k, d = (x * rng.choice([0.1, 1.0, 10.0], n)[:, None] for x in (k, d))
    k, d = (np.diag(x.sum(axis=1) + 0.3) - x for x in (k, 2.0 * d))
    flock = net(k, d)
    found = margin_of_flow("hold", flock, 0.5)
    if not flock.stable:
        assert found.period == 0.0
        return
    assert found.certified
    assert not decays(k, d, (1.0 + 1e-5) * found.period, 0)
    for share in np.linspace(0.002, 0.99999, 200):
        assert decays(k, d, share * found.period, 0)


def test_both_roads_lead_to_one_margin(monkeypatch):
    rng = np.random.default_rng(3)
    k, d = (np.diag(rng.uniform(2.0, 4.0, 6)) - rng.uniform(0.0, 0.4, (6, 6)) for _ in range(2))
    exact = margin_of_flow("hold", net(k, d), 0.5)
    assert 2 * len(k) <= MOST
    monkeypatch.setattr("flockana.stability.unstable_steps.MOST", 0)
    assert margin_of_flow("hold", net(k, d), 0.5).period == pytest.approx(exact.period, rel=1e-9)


@pytest.mark.parametrize("factor", [0.5, 1.0, 1.5])
def test_agents_that_move_one_after_another(factor):
    """Agent i sees those before it where they have moved to: multipliers of the two-sided step, for random nets."""
    rng = np.random.default_rng(5)
    n = 4
    k, d = (np.diag(rng.uniform(3.0, 5.0, n)) - rng.uniform(0.0, 1.0, (n, n)) for _ in range(2))
    found = margin_of_flow("map", net(k, d), factor, in_place=True)
    k_l, d_l = (moved_before(csr_array(x), 1).toarray() for x in (k, d))

    def radius(h):
        one = np.eye(n)
        mass = one + h * d_l + factor * h * h * k_l
        drag, pull = np.linalg.solve(mass, d + factor * h * k + h * k_l), np.linalg.solve(mass, k)
        w = np.linalg.eigvals(np.block([[0.0 * one, one], [-pull, -drag]]))
        return np.abs(1.0 + h * w).max()

    assert found.certified
    assert radius(found.period * (1.0 - 1e-7)) < 1.0 < radius(found.period * (1.0 + 1e-7))
    assert all(radius(x) < 1.0 for x in np.linspace(0.01, 0.999, 100) * found.period)


def test_nothing_that_moves_never_grows_and_what_is_not_known_is_not_said():
    zero = np.zeros((2, 2))
    assert margin_of_flow("hold", net(zero, zero), 0.5).period == inf
    empty = Steps(*(np.zeros((0, 0)),) * 4)
    assert first_growth(empty, 1.0) == (inf, inf)
    open_end = SamplingMargin("hold", nan, 0.1, ())
    assert not open_end.certified
    assert np.isnan(open_end.times(0.05))


def test_a_turn_that_only_touches_the_circle_is_no_growth():
    """(1 + h f) of one state: |1 + h f| with f = −1 is back at 1 for h = 2 only."""
    turn = np.array([[cos(1.0), sin(1.0)], [-sin(1.0), cos(1.0)]])
    steps = Steps(np.zeros((2, 2)), np.zeros((2, 2)), -np.eye(2), 0.0 * turn)
    assert first_growth(steps, 1.0).period == pytest.approx(2.0)
