"""Between the samples: two crossings in one interval, bounds below analytic minima, first contacts."""

from math import comb

import numpy as np
import pytest

from flockana.kernels.quintic_paths import ALLOWED, bernstein
from flockana.measures import path_bounds
from flockana.measures.metrics import cohesion_radii
from flockana.measures.path_bounds import closest_approach, cohesion_bound, contacts


def sampled(t, *motions):
    """Stack (position, velocity, acceleration) functions of t into arrays of shape (T, n, m)."""
    return tuple(np.stack([np.atleast_2d(f[k](t).T).reshape(len(t), -1) for f in motions], axis=1) for k in range(3))


def polynomial(*coefficients):
    """A motion on a line with position Σ c_k t^k."""
    f = np.polynomial.Polynomial(coefficients)
    return tuple(lambda t, g=g: g(t)[None] for g in (f, f.deriv(), f.deriv(2)))


def circle(radius, omega, phase=0.0, centre=(0.0, 0.0)):
    def at(t, k):
        angle = omega * t + phase + k * np.pi / 2
        move = np.array(centre)[:, None] if k == 0 else 0.0
        return radius * omega**k * np.array([np.cos(angle), np.sin(angle)]) + move

    return tuple(lambda t, k=k: at(t, k) for k in range(3))


T01 = np.array([0.0, 1.0])


def test_two_crossings_hidden_in_one_interval():
    """Relative path (t − 0.3)(t − 0.6): apart at both samples, twice together between them."""
    q, p, u = sampled(T01, polynomial(0.0), polynomial(0.18, -0.9, 1.0))
    assert q[0, 1, 0] > 0.0
    assert q[1, 1, 0] > 0.0
    found = closest_approach(T01, q, p, u)
    assert found.lower == 0.0
    assert found.distance < 1e-6
    assert found.pair == (0, 1)
    assert min(abs(found.time - 0.3), abs(found.time - 0.6)) < 1e-5
    (contact,) = contacts(T01, q, p, u, tol=1e-9)
    assert (contact.i, contact.j, contact.crossed) == (0, 1, False)  # it came back: no change of order shows
    assert contact.time == pytest.approx(0.3, abs=1e-8)  # the first of the two


def test_a_near_miss_keeps_its_distance():
    """(t − 0.5)² + 0.01 is a quintic: the bound is the true minimum to the subdivision's tolerance."""
    q, p, u = sampled(T01, polynomial(0.0), polynomial(0.26, -1.0, 1.0))
    found = closest_approach(T01, q, p, u)
    assert 0.01 * (1 - 3e-5) <= found.lower <= 0.01 * (1 + 1e-12)  # tolerance 1e-6 of the sampled distance 0.26
    assert found.distance == pytest.approx(0.01, rel=3e-5)
    assert found.time == pytest.approx(0.5, abs=1e-2)
    assert contacts(T01, q, p, u, tol=0.0099) == ()
    assert contacts(T01, q, p, u, tol=0.0101)[0].time == pytest.approx(0.5 - 0.01, abs=1e-6)


def test_a_distance_within_the_rounding_of_the_places_is_none():
    far = np.array([[[1e9], [1e9 + 2.4e-7]]] * 2)  # two of the last digit's steps
    still = np.zeros_like(far)
    assert closest_approach(T01, far, still, still).lower == 0.0
    assert closest_approach(T01, far - 1e9, still, still).lower == pytest.approx(2.4e-7, rel=0.01)


def test_passing_in_the_plane():
    """Straight lines that miss by 0.3; a common drift of 10⁴ per unit time changes nothing."""

    start = np.array([[-1.0, 0.0], [1.0, 0.3]])
    for drift in (0.0, 1e4):
        p = np.array([[[2.0 + drift, 0.0], [-2.0 + drift, 0.0]]] * 2)
        found = closest_approach(T01, np.stack([start, start + p[0]]), p, 0.0 * p)
        assert found.lower == pytest.approx(0.3, rel=1e-5)
        assert found.lower <= 0.3 + 1e-11  # rounding of 10⁴
        assert found.time == pytest.approx(0.5, abs=1e-3)


@pytest.mark.parametrize("per_turn", [3, 7, 25, 400])
@pytest.mark.parametrize("seed", range(4))
def test_circular_motions_are_bounded_from_below(per_turn, seed):
    rng = np.random.default_rng(seed)
    radius, centre = rng.uniform(0.5, 2.0), rng.normal(0.0, 2.0, 2)
    phase, speed = rng.uniform(0, 6), rng.uniform(0.5, 1)
    one, two = circle(1.0, 1.0), circle(radius, -speed, phase, centre)
    t = np.linspace(0.0, 2 * np.pi, per_turn + 1)
    fine = np.linspace(0.0, 2 * np.pi, 200_001)
    truth = float(np.min(np.linalg.norm(one[0](fine) - two[0](fine), axis=0)))
    found = closest_approach(t, *sampled(t, one, two))
    assert found.lower <= truth + 1e-12
    if per_turn >= 100:  # resolved: error allowance about (ωh)⁴/384·(1 + R)
        assert found.lower >= truth - 3e-6 * 2.0 - 1e-6 * truth
    assert np.min(found.lower_by_interval) == found.lower


def test_a_still_lattice_is_exact():
    """No motion, no allowance: the bound is the sampled distance itself."""
    q = np.array([[[0.0, 0.0], [7.0, 0.0], [3.5, 9.0]]] * 3)
    found = closest_approach(np.array([0.0, 1.0, 5.0]), q, 0 * q, 0 * q)
    assert found.lower == found.distance == 7.0
    assert found.pair == (0, 1)
    assert found.lower_by_interval.tolist() == [7.0, 7.0]


def test_coincident_at_a_sample_names_the_pair():
    q = np.zeros((2, 3, 2))
    q[:, 0] = 5.0
    found = closest_approach(T01, q, 0 * q, 0 * q)
    assert (found.lower, found.pair) == (0.0, (1, 2))


def test_one_agent_and_one_sample():
    q = np.zeros((2, 1, 2))
    assert closest_approach(T01, q, q, q).lower == np.inf
    q = np.array([[[0.0], [2.0], [3.0]]])
    found = closest_approach(np.array([4.0]), q, 0 * q, 0 * q)
    assert (found.lower, found.time, found.pair, found.lower_by_interval.size) == (1.0, 4.0, (1, 2), 0)


@pytest.mark.parametrize(("speed", "when"), [(-1.0, 5.0), (1.0, 0.0)])
def test_the_time_of_a_least_distance_at_a_sample_is_that_sample_s(speed, when):
    """An agent comes from (10, 1), or goes there from (5, 1): the other one stays at 0."""
    t = np.array([0.0, 2.0, 5.0])
    q = np.zeros((3, 2, 2))
    q[:, 1, 0], q[:, 1, 1] = (10.0 if speed < 0.0 else 5.0) + speed * t, 1.0
    p = np.zeros((3, 2, 2))
    p[:, 1, 0] = speed
    found = closest_approach(t, q, p, 0.0 * p)
    assert found.time == when
    assert found.distance == pytest.approx(np.sqrt(26.0), rel=1e-15)
    assert np.sqrt(26.0) * (1.0 - 1e-6) < found.lower <= np.sqrt(26.0)


@pytest.mark.parametrize("height", [0.75, 1.0, 3.0])
def test_a_bound_is_as_near_as_the_least_distance_asks_however_far_the_other_end_is(height):
    """A thousand lengths away at the begin of a step; with a bend, so that no one hull tells."""
    ends = (([1000.5, height], [0.5, height]), ([-1900.0, 0.0], [-100.0, 0.0]), ([1800.0, 0.0],) * 2)
    found = closest_approach(T01, *(np.array([[[0.0, 0.0], first], [[0.0, 0.0], last]]) for first, last in ends))
    least = np.hypot(0.5, height)
    assert least * (1.0 - 1.1e-6) < found.lower <= least


def test_the_right_pair_among_many():
    """Thirty still agents on a grid and one that passes two of them at 0.05."""
    grid = np.stack(np.meshgrid(np.arange(6.0), np.arange(5.0)), -1).reshape(-1, 2)
    q = np.stack([np.vstack([grid, [[x, 2.05]]]) for x in (-3.5, 9.5)])
    p, u = np.zeros_like(q), np.zeros_like(q)
    p[:, -1, 0] = 13.0
    found = closest_approach(T01, q, p, u)
    assert found.lower == pytest.approx(0.05, rel=1e-4)
    assert found.lower <= 0.05 + 1e-12
    assert found.pair[1] == 30
    hits = contacts(T01, q, p, u, tol=0.06)
    assert [(c.i, c.j) for c in hits] == [(12 + k, 30) for k in range(6)]
    reach = np.sqrt(0.06**2 - 0.05**2)
    np.testing.assert_allclose([c.time for c in hits], (3.5 + np.arange(6) - reach) / 13.0, atol=1e-6)


def test_small_flocks_are_bounded_as_large_ones_are(monkeypatch):
    """All pairs in one compiled loop over intervals, or those that a search finds in each: the same numbers."""
    rng, t = np.random.default_rng(0), np.linspace(0.0, 3.0, 40)
    draw = rng.uniform
    motions = [circle(draw(1, 3), draw(-2, 2), draw(0, 6), draw(-3, 3, 2)) for _ in range(12)]
    motions.append(motions[0])  # two in one place: intervals in which the distance is 0 from the start are skipped
    for states in (sampled(t, *motions), sampled(t, *motions[:-1])):
        slack = 0.01 * rng.uniform(size=(39, states[0].shape[1]))
        few = closest_approach(t, *states, slack)
        with monkeypatch.context() as patch:
            patch.setattr(path_bounds, "DENSE_MAX", 0)
            many = closest_approach(t, *states, slack)
        assert (few.lower, few.distance, few.time, few.pair) == (many.lower, many.distance, many.time, many.pair)
        np.testing.assert_array_equal(few.lower_by_interval, many.lower_by_interval)
    assert few.lower < few.distance


def test_contacts_across_samples_say_who_crossed():
    q, p, u = sampled(np.linspace(0, 2, 5), polynomial(0.0), polynomial(1.05, -1.0), polynomial(50.0))
    (contact,) = contacts(np.linspace(0, 2, 5), q, p, u, tol=1e-9)
    assert (contact.i, contact.j, contact.crossed) == (0, 1, True)
    assert contact.time == pytest.approx(1.05, abs=2e-9)


def test_contact_exactly_at_the_last_sample():
    q, p, u = sampled(T01, polynomial(0.0), polynomial(1.0, -1.0))
    (contact,) = contacts(T01, q, p, u, tol=1e-9)
    assert contact.time == pytest.approx(1.0, abs=2e-9)


def test_lasting_contact_is_reported_once_from_the_start():
    q = np.zeros((4, 2, 1))
    (contact,) = contacts(np.arange(4.0), q, 0 * q, 0 * q, tol=1e-9)
    assert (contact.time, contact.crossed) == (0.0, False)


def truncated(theta, degree):
    """(t − θ)₊^degree with its first two derivatives."""
    factors = (1.0, float(degree), float(degree * (degree - 1)))
    return tuple(lambda t, k=k: np.maximum(np.asarray(t) - theta, 0.0) ** (degree - k) * factors[k] for k in range(3))


def quintic_of(motion):
    """(control points, allowance) of a motion on [0, 1] in m dimensions."""
    ends = [np.atleast_2d([f(t) for f in motion[k]]) for t in (0.0, 1.0) for k in range(3)]
    points, _, allowance = bernstein(1.0, *ends)
    return points[0, :, : ends[0].shape[1]], float(allowance[0])


S = np.linspace(0.0, 1.0, 801)
BASIS = np.array([comb(5, k) * S**k * (1.0 - S) ** (5 - k) for k in range(6)]).T
RAISE = np.array([[0.1, 0.6, 0.3, 0.0], [0.0, 0.3, 0.6, 0.1]])  # of a cubic to degree five: its two inner points


@pytest.mark.parametrize("degree", range(3, 11))
def test_the_allowance_bounds_the_error_of_every_truncated_power(degree):
    """What its proof rests on: L2 and L3 are never negative, and 0.35 (L2 + L3) is never below the error."""
    for theta in np.linspace(0.0, 0.99, 100):
        f = truncated(theta, degree)
        points, allowance = quintic_of(tuple((g,) for g in f))
        cubic = np.array([f[0](0.0), f[0](0.0) + f[1](0.0) / 3.0, f[0](1.0) - f[1](1.0) / 3.0, f[0](1.0)])
        off = points[2:4, 0] - RAISE @ cubic
        assert off.min() >= -1e-15
        assert allowance == pytest.approx(ALLOWED * off.sum(), rel=1e-9, abs=1e-15)
        assert np.abs(BASIS @ points[:, 0] - f[0](S)).max() <= allowance + 1e-15


class TestCohesion:
    def test_out_and_back_between_two_samples(self):
        """One agent stays, the other goes out from 1 to 2 and back: the centre lies halfway."""
        q, p, u = sampled(T01, polynomial(0.0), polynomial(1.0, 4.0, -4.0))  # 1 at both ends, 2 between
        (bound,) = cohesion_bound(T01, q, p, u)
        assert 1.0 <= bound <= 1.0 + 2e-6
        assert cohesion_radii(q).tolist() == [0.5, 0.5]

    def test_a_still_flock_has_its_own_radius(self):
        q = np.array([[[0.0, 0.0], [6.0, 0.0], [3.0, 4.0]]] * 3)
        bound = cohesion_bound(np.array([0.0, 1.0, 5.0]), q, 0 * q, 0 * q)
        np.testing.assert_allclose(bound, cohesion_radii(q)[0], rtol=2e-6)
        assert (bound >= cohesion_radii(q)[0]).all()

    @pytest.mark.parametrize("per_turn", [3, 7, 25, 100])
    @pytest.mark.parametrize("seed", range(3))
    def test_above_the_true_radius_of_circular_motions(self, seed, per_turn):
        rng = np.random.default_rng(seed)
        draw = rng.uniform
        motions = [circle(draw(0.5, 3.0), draw(-1.0, 1.0), draw(0, 6), rng.normal(0, 2, 2)) for _ in range(4)]
        t, fine = np.linspace(0.0, 2 * np.pi, per_turn + 1), np.linspace(0.0, 2 * np.pi, 20_001)
        bound = cohesion_bound(t, *sampled(t, *motions))
        truth = cohesion_radii(sampled(fine, *motions)[0])
        for k in range(per_turn):
            assert truth[(fine >= t[k]) & (fine <= t[k + 1])].max() <= bound[k]
        if per_turn == 100:
            assert bound.max() == pytest.approx(truth.max(), rel=1e-4)

    def test_a_common_drift_does_not_count(self):
        q, p, u = sampled(T01, polynomial(0.0, 1e3), polynomial(2.0, 1e3))
        assert cohesion_bound(T01, q, p, u)[0] == pytest.approx(1.0, rel=2e-6)

    def test_slack_is_added(self):
        q = np.array([[[0.0], [2.0]]] * 2)
        slack = np.array([[0.25, 0.5]])
        assert cohesion_bound(T01, q, 0 * q, 0 * q, slack)[0] == pytest.approx(1.0 + 0.5 + 0.375, rel=2e-6)
        assert closest_approach(T01, q, 0 * q, 0 * q, slack).lower == pytest.approx(2.0 - 0.75, rel=2e-6)
