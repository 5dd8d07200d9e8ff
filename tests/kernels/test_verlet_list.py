"""Lists of pairs: none missing, whatever the density, and kept no longer than they hold."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana.kernels.large_flocks import fill
from flockana.kernels.neighbours import pair_list
from flockana.kernels.verlet_list import COUNT, CROWDED, covers, list_pairs, listed_anew, no_pairs, spatial_order


def listed(q, reach, room=1):
    few = np.empty(room, np.uint32), np.empty(room, np.uint32)
    first, second, *_, (count, _) = fill(no_pairs(*q.shape)._replace(first=few[0], second=few[1]), q, reach)
    return sorted((min(i, j), max(i, j)) for i, j in zip(first[:count].tolist(), second[:count].tolist(), strict=True))


@pytest.mark.parametrize("reach", [1.0, 0.3, 8.4])
@given(st.integers(0, 10**6), st.integers(1, 60), st.integers(1, 3), st.floats(0.05, 60.0), st.booleans())
def test_every_pair_once_of_a_dense_and_of_a_sparse_flock(reach, seed, n, m, side, sparse):
    rng = np.random.default_rng(seed)
    q = reach * rng.uniform(0.0, side, (n, m))
    if sparse:  # a box of far more cells than agents
        q[rng.integers(n)] += 1e5 * reach
    i, j = pair_list(q, reach)
    assert listed(q, reach) == list(zip(i.tolist(), j.tolist(), strict=True))


def test_agents_in_one_place_and_one_agent_alone():
    assert len(listed(np.zeros((40, 2)), 1.0)) == 40 * 39 // 2
    assert listed(np.zeros((1, 2)), 1.0) == []


def kept(q, made):
    return fill(no_pairs(*q.shape), q, made)


def outdated(q, reach, pairs):
    """Whether a list may lack a pair that is within reach now."""
    return not covers(pairs, q, reach)


@given(
    st.integers(0, 10**6),
    st.integers(2, 40),
    st.integers(1, 3),
    st.floats(0.5, 1.5),
    st.floats(0.0, 0.3),
    st.booleans(),
)
def test_a_list_that_holds_lacks_no_pair(seed, n, m, factor, noise, turned):
    """Whatever the flock does: drawn together or apart, each coordinate in its own way, or turned."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-3.0, 3.0, (n, m))
    later = (
        q * rng.uniform(min(factor, 1.0), max(factor, 1.0), m) + rng.normal(size=m) + noise * rng.normal(size=q.shape)
    )
    if turned:
        later = later @ np.linalg.qr(rng.normal(size=(m, m)))[0]
    gaps, apart = (np.linalg.norm(x[:, None] - x[None], axis=2) for x in (q, later))
    missing = apart[gaps >= 1.5].min(initial=np.inf)  # the nearest of those that a list made for 1.5 lacks
    pairs = no_pairs(n, m)._replace(places=q, reach=np.array([1.5]))
    for within in (0.3, 0.8, 1.2, 1.45):
        assert not (covers(pairs, later, within) and missing < within * (1.0 - 1e-12))


def test_a_list_is_kept_until_ways_differ_by_the_skin_beside_the_moving_flock():
    q = np.array([[0.0, 0.0], [9.0, 0.0], [30.0, 0.0], [39.5, 0.0]])
    assert outdated(q, 9.0, no_pairs(4, 2))
    pairs = kept(q, 10.0)
    assert pairs.counts[COUNT] == 2  # both within range and skin
    moved = q + np.array([100.0, -50.0])
    assert not outdated(moved, 9.0, pairs)  # a common motion is none
    moved[2] -= [0.98, 0.0]
    assert not outdated(moved, 9.0, pairs)
    moved[2] -= [0.04, 0.0]
    assert outdated(moved, 9.0, pairs)
    assert listed_anew(moved, 10.0, pairs) == 1
    assert not outdated(moved, 9.0, pairs)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_a_list_of_a_flock_drawn_together_is_kept_until_that_has_used_up_the_skin(m):
    """Drawn together by 1 / 11, a pair that was 11 apart is 10 apart; the ways of the outermost are far longer."""
    q = np.random.default_rng(m).uniform(-300.0, 300.0, (403, m))
    pairs = kept(q, 11.0)
    for factors in np.ones(m) - np.eye(m):  # along one coordinate only, the others as they were
        drawn = q * np.where(factors == 0.0, 10.0 / 11.0 + 1e-9, 1.0) + 1000.0
        assert not outdated(drawn, 10.0, pairs)
        assert outdated(q * np.where(factors == 0.0, 10.0 / 11.0 - 1e-9, 1.0) + 1000.0, 10.0, pairs)
    nudged = q * 0.95 + 1000.0  # leaves 11 · 0.95 − 10 for all other ways
    nudged[7] += 0.44 / np.sqrt(m)
    assert not outdated(nudged, 10.0, pairs)
    nudged[7] += 0.1 / np.sqrt(m)
    assert outdated(nudged, 10.0, pairs)
    apart = 1.2 * q  # leaves 13.2 − 10
    apart[7] += 2.0 / np.sqrt(m)
    assert not outdated(apart, 10.0, pairs)
    assert outdated(-q, 10.0, pairs)


def test_a_flock_on_a_line_is_drawn_together_along_it():
    q = np.zeros((300, 2))
    q[:, 1] = 8.0 * np.arange(300)
    pairs = kept(q, 11.0)
    assert not outdated(q * 0.95, 10.0, pairs)
    assert outdated(q * 0.9, 10.0, pairs)


def test_too_many_pairs_are_told_before_memory_is_full():
    few = np.empty(1, np.uint32)
    assert list_pairs(np.zeros((12_000, 2)), 1.0, few, few) == CROWDED


def test_the_order_is_one_of_all_agents_and_neighbours_follow_each_other():
    rng = np.random.default_rng(0)
    q = rng.uniform(0.0, 100.0, (500, 2))
    order = spatial_order(q, 10.0)
    assert sorted(order.tolist()) == list(range(500))
    gaps = np.linalg.norm(np.diff(q[order], axis=0), axis=1)
    assert np.median(gaps) < 0.25 * np.median(np.linalg.norm(np.diff(q, axis=0), axis=1))


def test_what_is_not_finite_ends_no_list():
    q = np.array([[0.0], [0.5], [np.nan]])
    pairs = kept(q, 1.1)
    assert pairs.counts[COUNT] == 1
    assert not outdated(q, 1.0, pairs)


def test_a_law_without_pairs_needs_no_list():
    few = np.empty(1, np.uint32)
    for n, m in ((1, 1), (2, 2), (40, 3)):
        q = np.random.default_rng(n).normal(size=(n, m))
        assert list_pairs(q, 0.0, few, few) == 0
