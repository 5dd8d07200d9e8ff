"""Encounters looked for along a list: what is bounded, and what is cut short, is what all control points say."""

import numpy as np
import pytest

from flockana.kernels.advance import _met
from flockana.kernels.encounters import farthest_ways, mean_way, share_of_listed, share_of_pairs
from flockana.kernels.neighbours import pair_list
from flockana.kernels.paths import bernstein, centred

H, R, FAR = 0.7, 8.4, 3.5


def ends(n, m, speed, seed=0):
    """Two states of a drifting flock, whose accelerations differ, so that paths bend."""
    rng = np.random.default_rng(seed)
    q0, p0 = rng.uniform(0.0, 3.0 * n ** (1.0 / m), (n, m)), rng.normal(3.0, speed, (n, m))
    p1 = p0 + rng.normal(0.0, 0.2 * speed, (n, m))
    q1 = q0 + 0.5 * H * (p0 + p1) + rng.normal(0.0, 0.02 * speed, (n, m))
    return q0, p0, rng.normal(0.0, speed, (n, m)), q1, p1, rng.normal(0.0, speed, (n, m))


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("n", [3, 700])
def test_the_longest_way_and_the_largest_allowance_are_those_of_the_control_points(n, m):
    states = ends(n, m, 1.5)
    points, _, allowance = bernstein(H, *states)
    ways, mean = centred(points.copy(), allowance), mean_way(H, *states)
    assert mean[:, :m] == pytest.approx((points - points[:, :1]).mean(axis=0)[:, :m], abs=1e-12)
    assert not mean[:, m:].any()
    assert farthest_ways(H, *states, mean) == pytest.approx((ways.max(), allowance.max()), rel=1e-12)


@pytest.mark.parametrize("speed", [3.0, 12.0])  # about, and far above `FAR` a step
@pytest.mark.parametrize("m", [1, 2, 3])
def test_pairs_of_a_list_cut_a_step_as_they_do_with_all_control_points(m, speed):
    cut = 0
    for seed in range(20):
        states = ends(40, m, speed, seed)
        points, _, allowance = bernstein(H, *states)
        ways, mean = centred(points, allowance), mean_way(H, *states)
        radii = np.sort(np.random.default_rng(seed).uniform(0.5, R, (40, 2)), axis=1)
        i, j = pair_list(states[0], 1e6)
        whole = share_of_pairs(points, ways, allowance, radii, FAR, i, j, 1.0)
        listed = i.astype(np.uint32), j.astype(np.uint32)
        bound = farthest_ways(H, *states, mean)
        assert share_of_listed(H, *states, mean, bound, radii, FAR, *listed, 1.0) == pytest.approx(whole, rel=1e-9)
        cut += whole < 1.0
    assert cut > 0


@pytest.mark.parametrize("listed", [False, True])
@pytest.mark.parametrize("m", [1, 2, 3])
def test_a_step_of_the_integrator_is_cut_by_ways_seen_from_the_mean_motion(m, listed):
    """Whether the list holds all that may meet, or pairs are searched for."""
    q0, p0, u0, q1, p1, u1 = ends(40, m, 12.0)
    y0, f0, y1, f1 = (
        np.append(np.concatenate([a.ravel(), b.ravel()]), 0.0) for a, b in ((q0, p0), (p0, u0), (q1, p1), (p1, u1))
    )
    points, _, allowance = bernstein(H, q0, p0, u0, q1, p1, u1)
    ways, radii = centred(points, allowance), np.full((40, 2), [R / 2, R])
    i, j = (each.astype(np.uint32) for each in pair_list(q0, 1e6))
    whole = share_of_pairs(points, ways, allowance, radii, FAR, i.astype(int), j.astype(int), 1.0)
    pairs = (i, j, i.size, q0 if listed else np.empty((0, m)), None)
    none = np.empty(0)
    system = [None] * 4 + [(40, m), None, None, (1e6, 0.0), None, lambda q, within, a, b: (i, j, i.size, None)]
    encounters = (radii, FAR, None, none, None)
    share, _ = _met.py_func(0.0, H, y0, f0, y1, f1, encounters, system, pairs, (i, j))
    assert share == pytest.approx(whole, rel=1e-9)
    assert share < 1.0
