"""The dead-zone pair law: potential by quadrature and in mpmath, extremes, slopes, sums, zones, bad input."""

from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from flockana.sources.li_dead_zone import DeadZoneInteraction
from flockana.sources.li_dead_zone.kernels.pair import zone_forces, zone_margins, zones
from tests.refused import refused

CASES = [
    {},
    {"ramp": 0.0},
    {"eta": 0.0},
    {"eta": 1e-10},
    {"ramp": 3.4},
    {"r_b": 12.0, "k_r": 60.0, "k1": 0.02},
    {"k1": 0.0, "r_d": 15.01},
    {"r_b": 10.3, "ramp": 0.5},  # the outer ramp is cut by r
]


def by_quadrature(pair, s):
    """½ k1 d1² + ∫_{d1}^{s} F, split at every edge."""
    top = min(s, pair.r)
    marks = (pair.d1 - pair.ramp, pair.d2, pair.d2 + pair.ramp)
    inner = sorted((x for x in marks if min(top, pair.d1) < x < max(top, pair.d1)), reverse=top < pair.d1)
    edges, total = [pair.d1, *inner, top], 0.5 * pair.k1 * pair.d1**2
    for a, b in pairwise(edges):
        inside = lambda x: -pair.force(min(float(x), np.nextafter(pair.r, 0.0)))  # noqa: E731
        total += quad(inside, a, b, epsabs=1e-13, epsrel=1e-13, limit=200)[0]
    return total


@pytest.mark.parametrize("options", CASES)
def test_the_potential_is_the_integral_of_the_force(options):
    pair = DeadZoneInteraction(**options)
    for s in (0.01, 0.3, 2.0, 3.2, 3.3, 3.45, 3.5, 5.0, 12.6, 12.75, 14.9, 15.0, 30.0):
        # quad's own floor
        assert pair.energy(s) == pytest.approx(by_quadrature(pair, s), rel=3e-13, abs=3e-13)


@pytest.mark.parametrize("eta", [0.0, 1e-14, 1e-3, 1.0, 1e6])
def test_no_digits_are_lost_at_any_eta(eta):
    pair = DeadZoneInteraction(eta=eta, ramp=0.0, k1=0.0)
    with mp.workdps(40):
        for s in (mp.mpf("1e-9"), mp.mpf("3.4999"), mp.mpf("12.5001"), mp.mpf("14.9")):
            weight = (lambda x: 2 * pair.k_r / x**2) if s < 4 else (lambda x: 2 * pair.k_r / (pair.r_d - x) ** 2)
            f = lambda x, w=weight: (w(x) + mp.mpf(pair.k_delta)) * x / mp.sqrt(1 + mp.mpf(eta) * x**2)  # noqa: E731
            s = mp.mpf(float(s))
            points = (
                [s, *(10 ** mp.mpf(k) for k in range(-8, 1) if 10 ** mp.mpf(k) > s), mp.mpf(3.5)]
                if s < 4
                else [12.5, s]
            )
            exact = mp.quad(f, points)
            assert float(abs(pair.energy(float(s)) / exact - 1)) < 2e-14 if s < 3 else True
            # next to the edge of the dead zone psi vanishes: relative to (s - edge) F there
            assert float(abs(pair.energy(float(s)) - exact)) < 1e-15 * max(1.0, 400.0, float(exact))


def test_it_grows_only_logarithmically_at_zero():
    pair = DeadZoneInteraction()
    # psi(s/10) - psi(s) -> 2 k_r ln 10
    steps = -np.diff(pair.energy([1e-9, 1e-8, 1e-7]))
    assert steps == pytest.approx(2.0 * 200.0 * np.log(10.0), rel=1e-9)
    assert pair.energy(0.0) == np.inf
    assert pair.force(1e-9) == pytest.approx(400.0 / 1e-9, rel=1e-9)


@pytest.mark.parametrize("options", CASES[:6])
def test_slope_of_the_weight_against_differences(options):
    pair = DeadZoneInteraction(**options)
    one, two = np.array([0], np.int32), np.array([1], np.int32)
    for s in (0.7, 2.0, 3.3, 3.41, 6.0, 12.6, 14.0):
        weight, adjacency, slope = pair.kernels.terms(np.array([[0.0], [s]]), one, two, pair.par)[:, 0]
        step = 1e-6 * s * s
        low, high = (np.sqrt(s * s + x) for x in (-step, step))
        difference = (pair.force(low) / low - pair.force(high) / high) / (2.0 * step)
        assert (weight, adjacency) == (pytest.approx(-pair.force(s) / s, rel=1e-14), 1.0)
        assert slope == pytest.approx(difference, rel=1e-6, abs=1e-7)


@given(st.floats(0.01, 14.99), st.floats(0.0, 3.0))
def test_a_pair_held_in_its_zone_feels_the_printed_force(s, speed):
    pair = DeadZoneInteraction(ramp=0.0)
    q, p = np.array([[0.0, 0.0], [s, 0.0]]), np.array([[0.0, 0.0], [0.0, speed]])
    zone, u = zones(q, pair.par), np.zeros((2, 2))
    dissipation = zone_forces(q, p, zone, pair.par, 2.0, u)
    expected, rate = pair.forces(q, p, stiffness=1.0, damping=2.0)
    assert u == pytest.approx(expected, rel=1e-13)
    assert dissipation == rate
    margins, _ = zone_margins(q, zone, pair.par)
    edges = np.array([0.0, pair.d1, pair.d2, pair.r])
    assert margins[0] == pytest.approx(np.abs(edges - s)[np.abs(edges) > 0 if zone[0] == 0 else slice(None)].min())


def test_a_held_pair_keeps_its_force_beyond_its_zone():
    pair = DeadZoneInteraction(ramp=0.0, k1=0.0)
    q, u = np.array([[0.0], [3.6]]), np.zeros((2, 1))
    zone_forces(q, 0.0 * q, np.array([0], np.int8), pair.par, 0.0, u)
    assert u[1, 0] == pytest.approx((400.0 / 3.6**2 + 1.3) * 3.6 / np.sqrt(1.0 + 3.6**2))  # repulsion goes on


def test_the_dead_zone_is_closed_and_the_range_open():
    pair = DeadZoneInteraction(ramp=0.0, k1=0.0)
    assert pair.force([3.5, 12.5, 15.0]).tolist() == [0.0, 0.0, 0.0]
    assert pair.action(np.nextafter(3.5, 0.0)) < -30.0
    assert pair.action(np.nextafter(12.5, 13.0)) > 1.0


def test_with_a_ramp_only_the_range_jumps():
    assert [jump.where for jump in DeadZoneInteraction().jumps()] == ["r"]
    assert DeadZoneInteraction(r_b=12.0, k1=0.0).jumps() == ()  # no attraction, no pull: nothing ends at r


@pytest.mark.parametrize("eta", [0.04, 1.0])
def test_least_distance_is_where_repulsion_has_that_potential(eta):
    pair = DeadZoneInteraction(ramp=0.0, k_delta=0.0, k1=0.0, eta=eta)
    for s in (2.0, 0.1, 1e-5):
        assert pair.least_distance(pair.energy(s)) == pytest.approx(s, rel=1e-12)
    bare = DeadZoneInteraction(ramp=0.0, k_delta=0.0, k1=0.0, eta=0.0)
    assert bare.least_distance(bare.energy(0.1)) == pytest.approx(0.1, rel=1e-12)
    assert 0.0 < DeadZoneInteraction().least_distance(285_000.0) < 1e-300  # where sinh overflows


test_bad_parameters_are_named = refused(
    ({"delta": 8.0}, "delta = 8 and r_b = 8: expected delta < r_b"),
    ({"r_d": 15.0}, "r_d = 15 and r = 15: expected r_d > r"),
    ({"r_b": 25.0}, "expected the dead zone to begin below r"),
    ({"ramp": 3.5}, "ramp = 3.5: expected less than r_b - delta = 3.5"),
    ({"k1": -1.0}, "k1 = -1: expected a number >= 0"),
    ({"k_r": 0.0}, "k_r"),
    make=DeadZoneInteraction,
)
