"""Bounds on a flock between samples, against the same run looked at a thousand times as often."""

from dataclasses import replace

import numpy as np
import pytest

import flockana as fl
from flockana.lattice import hexagonal_patch
from flockana.sources.isola_2024.laws import MSNDiscretisation
from flockana.theorems import bounds_between_samples
from flockana.theorems.observed_run import Observed

COARSE = np.linspace(0.0, 3.0, 7)


@pytest.fixture(scope="module")
def runs():
    law = fl.Algorithm2(gains=fl.Gains(c2_alpha=0.1, c2_gamma=0.0), target=fl.StaticTarget((0.0, 0.0)))
    q = 1.1 * hexagonal_patch(1, 7.0)
    p = np.random.default_rng(0).normal(0.0, 2.0, q.shape)
    fine = np.linspace(0.0, 3.0, 3001)
    return tuple(fl.simulate(law, q, p, (0.0, 3.0), t_eval=times) for times in (COARSE, fine))


def largest(series):
    return np.array([series[500 * k : 500 * (k + 1) + 1].max() for k in range(6)])


def test_the_mismatch_is_bounded_and_not_by_much(runs):
    coarse, fine = runs
    true = largest(fine.metric("normalised_velocity_mismatch"))
    bound = bounds_between_samples.mismatch_over(Observed.alone(coarse)).hi
    assert np.all(bound >= true * (1.0 - 1e-9))
    assert np.all(bound <= 1.05 * true)
    at_ends = coarse.metric("normalised_velocity_mismatch")
    assert np.any(true > 1.2 * np.maximum(at_ends[:-1], at_ends[1:]))  # which samples alone would miss


def test_no_distance_strays_further_than_its_bound(runs):
    coarse, fine = runs
    i, j = np.triu_indices(coarse.n, 1)
    lengths = np.linalg.norm(fine.q[:, i] - fine.q[:, j], axis=2)
    for k, bound in enumerate(bounds_between_samples.stretch_between(Observed.alone(coarse))):
        part = lengths[500 * k : 500 * (k + 1) + 1]
        low, high = np.minimum(part[0], part[-1]), np.maximum(part[0], part[-1])
        assert max((low - part).max(), (part - high).max()) <= bound


def test_where_steps_were_not_kept_speeds_are_unknown(runs):
    coarse, _ = runs
    slack = np.zeros((len(coarse.path.t) - 1, coarse.n))
    slack[0, 3] = 1e-12
    thin = replace(coarse, between=replace(coarse.between, slack=slack))
    bound = bounds_between_samples.mismatch_over(Observed.alone(thin)).hi
    assert bound[0] == np.inf
    np.testing.assert_array_equal(bound[1:], bounds_between_samples.mismatch_over(Observed.alone(coarse)).hi[1:])


def straight(q, p, until, samples=2):
    """A run of agents out of each other's range, at constant velocities, taken as exact."""
    return Observed.alone(fl.simulate(fl.Algorithm1(), q, p, (0.0, until), t_eval=np.linspace(0.0, until, samples)))


@pytest.mark.parametrize(
    ("apart", "speed", "until", "expected"),
    [
        (99.0, 1.0, 1.0, 1.0 / 8.0 * 2.0 * 2.0**2 / 99.0),  # h²/8 (2w²/l): it passes w h/2 slowly
        (99.0, 1.0, 3.0, 9.0 / 8.0 * 2.0 * 2.0**2 / 99.0),
        (99.0, 20.0, 3.0, 0.5 * 40.0 * 3.0),  # might come nearer than half of it: w h/2
    ],
)
def test_straight_ways_may_stray_by_what_their_speeds_allow(apart, speed, until, expected):
    run = straight([[0.0, 0.0], [apart, 0.0]], [[-speed, 0.0], [speed, 0.0]], until)
    assert bounds_between_samples.stretch_between(run) == pytest.approx([expected], rel=1e-8)
    assert bounds_between_samples.fastest_between(run) == pytest.approx([speed], rel=1e-9)
    assert bounds_between_samples.mismatch_over(run).hi == pytest.approx([0.5 * speed**2], rel=1e-9)
    ends = 0.5 * apart + speed * until
    assert bounds_between_samples.radius_over(run).hi == pytest.approx([ends], rel=1e-9)
    assert bounds_between_samples.spread_over(run).hi == pytest.approx(np.sqrt(2.0) * ends, rel=1e-9)
    assert bounds_between_samples.least_distance(run, [0], [1]).lo == pytest.approx(apart, rel=1e-9)


@pytest.mark.parametrize(("share", "open_links"), [(0.9, 1), (1.1, 0)])
@pytest.mark.parametrize("until", [1.0, 2.0])
def test_a_pair_is_open_as_far_from_the_range_as_it_might_come_between_samples(share, open_links, until):
    """Two pass abreast, at relative speed 0.2: their distance may sink by h²/8 (2w²/r), which tells of others, too."""
    r, w = 8.4, 0.2
    gap = share * until**2 / 8.0 * 2.0 * w**2 / r
    q = [[0.0, 0.0], [r + gap, 0.0], [50.0, 0.0], [50.0, 7.0]]
    run = straight(q, [[0.0, 0.0], [0.0, w], [0.0, 3.0], [0.0, 3.0]], until)
    net = bounds_between_samples.nets_between(run)
    assert net.open_links.tolist() == [open_links]
    assert net.links.tolist() == [1]
    assert (net.components.tolist(), net.components_least.tolist()) == ([3], [3 - open_links])
    assert (net.giant.tolist(), net.giant_most.tolist()) == ([2], [2])
    assert bounds_between_samples.nets_at(run).open_links.tolist() == [0, 0]


def test_a_link_that_parts_is_open_while_it_does():
    run = straight([[0.0, 0.0], [8.35, 0.0]], [[0.0, 0.0], [0.9, 0.0]], 1.0, 6)
    apart = np.linalg.norm(run.run.q[:, 1] - run.run.q[:, 0], axis=1)
    linked = apart < 8.4
    assert linked[0]
    assert not linked[-1]
    net = bounds_between_samples.nets_between(run)
    assert net.open_links.tolist() == (linked[:-1] & ~linked[1:]).astype(float).tolist()
    assert bounds_between_samples.nets_at(run).links.tolist() == linked.astype(float).tolist()
    assert bounds_between_samples.nets_at(run).components.tolist() == (2.0 - linked).tolist()


def test_a_map_moves_at_its_samples_only():
    law = MSNDiscretisation(fl.Algorithm1(), dt=0.5)
    run = Observed.of(fl.simulate(law, [[0.0], [99.0]], [[1.0], [-1.0]], (0.0, 1.0)))
    assert bounds_between_samples.stretch_between(run).tolist() == [0.0, 0.0]
    assert bounds_between_samples.mismatch_over(run).hi == pytest.approx([0.5, 0.5])
    assert bounds_between_samples.radius_over(run).hi == pytest.approx([49.5, 49.0])
    assert bounds_between_samples.nets_between(run).components.tolist() == [2.0, 2.0]


def test_what_the_run_is_off_by_is_added_to_every_bound(runs):
    coarse, _ = runs
    again = fl.simulate(coarse.law, coarse.q[0], coarse.p[0], (0.0, 3.0), t_eval=COARSE, rtol=1e-3)
    exact, loose = Observed.alone(coarse), Observed.of(again)
    assert (loose.between_error > 1e-6).all()
    assert (
        bounds_between_samples.radius_over(loose).hi - bounds_between_samples.radius_over(exact).hi
        > 0.5 * loose.between_error
    ).all()
    assert (bounds_between_samples.stretch_between(loose) > bounds_between_samples.stretch_between(exact)).all()
    assert np.all(bounds_between_samples.radius_over(loose).lo <= bounds_between_samples.radius_over(exact).mid)
