"""Lists of pairs: none missing, whatever the density, and kept no longer than they hold."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana.kernels.neighbours import pair_list
from flockana.kernels.verlet import empty_list, list_pairs, listed_anew, outdated, spatial_order, strayed


def listed(q, reach, room=1):
    first, second, count, _ = list_pairs(q, reach, np.empty(room, np.uint32), np.empty(room, np.uint32))
    return sorted((min(i, j), max(i, j)) for i, j in zip(first[:count].tolist(), second[:count].tolist(), strict=True))


@pytest.mark.parametrize("reach", [1.0, 0.3, 8.4])
@given(st.integers(0, 10**6), st.integers(1, 60), st.integers(1, 3), st.floats(0.05, 60.0), st.booleans())
def test_every_pair_once_from_the_grid_and_from_hashed_cells(reach, seed, n, m, side, sparse):
    rng = np.random.default_rng(seed)
    q = reach * rng.uniform(0.0, side, (n, m))
    if sparse:  # a box of far more cells than agents
        q[rng.integers(n)] += 1e5 * reach
    i, j = pair_list(q, reach)
    assert listed(q, reach) == list(zip(i.tolist(), j.tolist(), strict=True))


def test_agents_in_one_place_and_one_agent_alone():
    assert len(listed(np.zeros((40, 2)), 1.0)) == 40 * 39 // 2
    assert listed(np.zeros((1, 2)), 1.0) == []


@given(st.integers(0, 10**6), st.integers(1, 40), st.integers(1, 3))
def test_the_bound_of_ways_holds_and_is_not_far_off(seed, n, m):
    rng = np.random.default_rng(seed)
    q, way = rng.normal(size=(n, m)), rng.normal(size=(n, m))
    later = q + way + rng.normal(size=m)
    middle = 0.5 * (way.min(axis=0) + way.max(axis=0))
    longest = np.square(way - middle).sum(axis=1).max()
    bound = strayed(later, q)
    assert longest * (1 - 1e-12) - 1e-12 <= bound <= m * longest * (1 + 1e-12) + 1e-12
    assert bound == pytest.approx(0.25 * np.sum(np.ptp(way, axis=0) ** 2), rel=1e-12, abs=1e-12)


def test_a_list_is_kept_until_an_agent_has_gone_half_the_skin_in_the_moving_frame():
    q = np.array([[0.0, 0.0], [9.0, 0.0], [30.0, 0.0], [39.5, 0.0]])
    assert outdated(q, 1.0, empty_list(4))
    pairs = listed_anew(q, 10.0, empty_list(4), list_pairs)
    assert pairs[2] == 2  # both within range and skin

    moved = q + np.array([100.0, -50.0])
    assert not outdated(moved, 1.0, pairs)  # a common motion is none
    moved[3] += [0.98, 0.0]  # 0.49 from half way to the others
    assert not outdated(moved, 1.0, pairs)
    moved[3] += [0.04, 0.0]
    assert outdated(moved, 1.0, pairs)
    pairs = listed_anew(moved, 10.0, pairs, list_pairs)
    assert pairs[2] == 1
    assert not outdated(moved, 1.0, pairs)


def test_too_many_pairs_are_told_before_memory_is_full():
    few = np.empty(1, np.uint32)
    assert list_pairs(np.zeros((12_000, 2)), 1.0, few, few)[2] == -1


def test_the_order_is_one_of_all_agents_and_neighbours_follow_each_other():
    rng = np.random.default_rng(0)
    q = rng.uniform(0.0, 100.0, (500, 2))
    order = spatial_order(q, 10.0)
    assert sorted(order.tolist()) == list(range(500))
    gaps = np.linalg.norm(np.diff(q[order], axis=0), axis=1)
    assert np.median(gaps) < 0.25 * np.median(np.linalg.norm(np.diff(q, axis=0), axis=1))


def test_what_is_not_finite_ends_no_list():
    q = np.array([[0.0], [0.5], [np.nan]])
    pairs = listed_anew(q, 1.1, empty_list(3), list_pairs)
    assert pairs[2] == 1
    assert not outdated(q, 0.1, pairs)


def test_a_law_without_pairs_needs_no_list():
    few = np.empty(1, np.uint32)
    for n, m in ((1, 1), (2, 2), (40, 3)):
        q = np.random.default_rng(n).normal(size=(n, m))
        assert list_pairs(q, 0.0, few, few)[2] == 0
