"""The neighbour search: every pair once, strictly within range, wherever the agents are."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana.kernels.neighbours import DENSE_MAX, pair_blocks, pair_list


def brute(q, r):
    """All pairs by broadcasting, as sorted keys i n + j."""
    i, j = np.triu_indices(len(q), 1)
    near = np.sum((q[j] - q[i]) ** 2, axis=1) < r * r
    return i[near] * len(q) + j[near]


def search(q, r, **options):
    """What the search yields, as sorted keys; duplicates stay."""
    keys = [np.minimum(i, j).astype(np.int64) * len(q) + np.maximum(i, j) for i, j in pair_blocks(q, r, **options)]
    return np.sort(np.concatenate(keys))


def check(q, r):
    expected = brute(q, r)
    for options in ({"dense": True}, {"dense": False}, {"dense": True, "block": 1}, {"dense": False, "block": 1}):
        np.testing.assert_array_equal(search(q, r, **options), expected, err_msg=str(options))
    return expected.size


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("n", [1, 2, 3, 50, 400])
def test_random_flocks(n, m):
    q = np.random.default_rng(n + m).normal(0.0, 20.0, (n, m))
    found = check(q, 8.4)
    assert n < 400 or found > 100


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("dense", [True, False])
def test_the_range_is_strict(m, dense):
    q = np.zeros((2, m))
    q[1, 0] = 3.0
    assert search(q, 3.0, dense=dense).size == 0
    assert search(q, np.nextafter(3.0, 4.0), dense=dense).size == 1


@pytest.mark.parametrize("m", [1, 2, 3])
def test_agents_on_the_borders_of_cells(m):
    """A grid of spacing r, r/2 and of the cells' own size, negative side included."""
    for spacing in (1.0, 0.5, 1.0 + 1e-3, (1.0 + 1e-3) / 2):
        side = np.arange(-3, 4) * spacing
        q = np.stack(np.meshgrid(*[side] * m), axis=-1).reshape(-1, m)
        check(q, 1.0)
        check(q, np.nextafter(spacing, 9.0))
        check(np.nextafter(q, -np.inf), spacing)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_all_in_one_cell_and_all_at_one_point(m):
    q = np.random.default_rng(m).uniform(0.0, 0.3, (200, m))
    assert check(q, 1.0) == 200 * 199 // 2
    assert check(np.ones((60, m)), 1e-9) == 60 * 59 // 2


@pytest.mark.parametrize("dense", [True, False])
def test_coincident_agents_are_a_pair_however_small_the_range(dense):
    q = np.array([[1.0], [1.0], [2.0]])
    assert search(q, 1e-200, dense=dense).tolist() == [1]  # r² underflows to 0


@pytest.mark.parametrize("far", [1e9, 1e13, 1e200, -1e200])
@pytest.mark.parametrize("m", [1, 2, 3])
def test_one_agent_far_away_costs_no_pair(far, m):
    q = np.random.default_rng(7).normal(0.0, 20.0, (300, m))
    q[17] = far
    with np.errstate(over="ignore"):
        assert check(q, 8.4) > 100


@pytest.mark.parametrize("offset", [1e6, -1e9, 1e13])
def test_a_flock_far_from_the_origin(offset):
    q = np.random.default_rng(7).normal(0.0, 20.0, (300, 2)) + offset
    assert check(q, 8.4) > 100


def test_a_sparse_box_is_cut_into_strips():
    """Triples spread so wide that a grid of cells would not fit."""
    rng = np.random.default_rng(1)
    centres = rng.integers(-(10**6), 10**6, (150, 3)) * 50.0
    q = np.repeat(centres, 3, axis=0) + rng.uniform(0.0, 4.0, (450, 3))
    assert check(q, 8.4) >= 450


def test_rounding_of_huge_coordinates_skips_no_pair():
    """10¹¹ ranges from the origin the quotient q/side is off by up to 1e-5 cells, more than their margin."""
    rng, misses = np.random.default_rng(3), 0
    for _ in range(150):
        base = 2.0 ** rng.uniform(37.0, 39.9) * 8.4
        ulp = np.spacing(base)
        steps = rng.integers(0, 40_000, 150)
        q = np.concatenate([base + steps * ulp, base + (steps + 2**15) * ulp])[:, None]
        r = 2**15 * ulp * (1.0 + 2.0e-6)  # the partners are just within range
        misses += not np.array_equal(search(q, r, dense=True), search(q, r, dense=False))
    assert misses == 0


@pytest.mark.slow
@pytest.mark.parametrize("far", [-1.5 * 2.0**43, 1.5 * 2.0**43])
def test_an_agent_far_away_takes_no_pair_from_a_flock_whose_coordinates_are_finer(far):
    """Partners just within range, 1.5·2⁴³ from an agent beside which their places are known to 0.002 only."""
    rng, r = np.random.default_rng(5), 4300.5 * 2.0**-9
    for _ in range(60):
        x = rng.uniform(0.0, 1e6, 3000)
        q = np.concatenate([x, x + r * (1.0 - 1e-9), [far]])[:, None]
        np.testing.assert_array_equal(search(q, r, dense=False), search(q, r, dense=True))


def test_infinite_range_gives_all_pairs():
    q = np.random.default_rng(0).normal(0.0, 1e5, (DENSE_MAX + 3, 2))
    assert search(q, np.inf).size == len(q) * (len(q) - 1) // 2


def test_blocks_hold_no_more_than_they_may():
    q = np.random.default_rng(0).uniform(0.0, 1.0, (300, 2))
    for dense in (True, False):
        sizes = [i.size for i, _ in pair_blocks(q, 9.0, dense=dense, block=1000)]
        assert sum(sizes) == 300 * 299 // 2
        assert max(sizes) <= 1000
        assert len(sizes) >= 45


@given(
    st.integers(1, 3).flatmap(
        lambda m: st.lists(st.lists(st.integers(-6, 6), min_size=m, max_size=m), min_size=1, max_size=40)
    ),
    st.sampled_from([0.5, 1.0, np.nextafter(1.0, 2.0), 1.5, 2.0, 5.0]),
    st.sampled_from([1.0, 1e-3, 0.1, 1e12]),
)
def test_cells_and_direct_search_agree_on_grids(points, r, unit):
    check(np.array(points, dtype=float) * unit, r * unit)


@given(
    st.lists(st.tuples(st.floats(-1e18, 1e18), st.floats(-1e18, 1e18)), min_size=1, max_size=30), st.floats(1e-3, 1e18)
)
def test_cells_and_direct_search_agree_on_any_scale(points, r):
    check(np.array(points), r)


def test_pair_list_is_sorted():
    q = np.random.default_rng(5).normal(0.0, 20.0, (400, 2))
    i, j = pair_list(q, 8.4)
    assert i.dtype == np.int32
    assert np.all(i < j)
    np.testing.assert_array_equal(i.astype(np.int64) * 400 + j, brute(q, 8.4))
