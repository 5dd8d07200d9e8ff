"""Sums over all pairs by the sweep, at the edges of blocks and cells; against a dense transcription: test_alpha.py."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana import AlphaInteraction, DeadZoneInteraction
from flockana.jit import register_jitable
from flockana.kernels.cell_grid import LARGE, sort_into_grid
from flockana.kernels.neighbours import pair_list
from flockana.kernels.pair_kernels import lift

ALPHA = AlphaInteraction(d=2.0, r=2.6, a=2.0, b=5.0)


@register_jitable
def _shun(s2, par):
    return 0.0 * s2, -1.0


@register_jitable
def _shun_slope(s2, par):
    return 0.0 * s2


@register_jitable
def _shun_potential(s2, par, panels):
    return 0.0 * s2


def flock(seed, n, m, spread):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, spread, (n, m)), rng.normal(size=(n, m))


def test_an_agent_far_away_widens_no_cells_and_changes_no_sum():
    q, p = flock(0, 50, 2, 6.0)
    near, _ = ALPHA.forces(q, p, stiffness=1.0, damping=1.0)
    far, still = np.vstack([q, [[1e9, -1e9]]]), np.vstack([p, [[0.0, 0.0]]])
    counts = [np.diff(sort_into_grid(each, 2.0)[1].astype(int)) for each in (q, far)]
    assert max(each.max() for each in counts) < 12
    np.testing.assert_allclose(ALPHA.forces(far, still, stiffness=1.0, damping=1.0)[0][:-1], near, atol=1e-12)


def test_forces_are_added_and_their_sum_is_kept():
    q, p = flock(1, 200, 2, 15.0)
    given_before = np.ones_like(q)
    u, _ = ALPHA.forces(q, p, stiffness=1.0, damping=1.0)
    np.testing.assert_array_equal(ALPHA.forces(q, p, stiffness=1.0, damping=1.0, out=given_before)[0], u + 1.0)
    np.testing.assert_allclose(u.sum(axis=0), 0.0, atol=1e-11)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_the_potential_of_a_large_flock_is_that_of_its_pairs(m):
    q, _ = flock(2, LARGE, m, LARGE ** (1.0 / m))
    q[0], q[1] = q[2], np.nan  # two at one place, and one at none
    potential, pairs = ALPHA.kernels.energy_in_slabs(several=False)(q, ALPHA.r, ALPHA.par, ALPHA.panels)
    i, j = pair_list(q, ALPHA.r)
    assert pairs == i.size
    assert potential == pytest.approx(ALPHA.kernels.potential(q, i, j, ALPHA.par, ALPHA.panels), rel=1e-12)


def test_a_pair_at_the_range_feels_nothing_and_one_inside_does():
    for gap, moved in ((ALPHA.r, False), (np.nextafter(ALPHA.r, 0.0), True), (0.0, False)):
        u, rate = ALPHA.forces(np.array([[0.0], [gap]]), np.array([[0.0], [1.0]]), stiffness=1.0, damping=1.0)
        assert bool(u.any()) == (moved or gap == 0.0)
        assert rate == pytest.approx({0.0: 1.0}.get(gap, 0.0), abs=1e-12)


def test_the_range_is_open_where_the_force_jumps_there():
    pair, p = DeadZoneInteraction(), np.array([[0.0, 0.0], [1.0, 0.0]])
    for gap, rate in ((pair.r, 0.0), (np.nextafter(pair.r, 0.0), 1.0)):
        q = np.array([[0.0, 0.0], [gap, 0.0]])
        assert pair.forces(q, p, stiffness=1.0, damping=1.0)[1] == rate


def test_a_law_may_have_a_negative_adjacency():
    """Velocities that part: the dissipation is negative, and the forces are summed once all the same."""
    shun = lift(_shun, _shun_slope, _shun_potential)
    q, p, u = np.array([[0.0], [1.0]]), np.array([[0.0], [3.0]]), np.zeros((2, 1))
    assert shun.sums(1, 1).forces(q, p, 2.0, np.zeros(1), 1.0, 1.0, u, np.empty((3, *q.shape))) == -9.0
    np.testing.assert_array_equal(u, [[-3.0], [3.0]])


def test_an_agent_at_no_number_is_near_nobody_and_breaks_nothing():
    q, p = flock(2, 30, 2, 6.0)
    expected, _ = ALPHA.forces(q[1:], p[1:], stiffness=1.0, damping=1.0)
    q[0] = np.nan
    np.testing.assert_allclose(ALPHA.forces(q, p, stiffness=1.0, damping=1.0)[0][1:], expected, atol=1e-12)


@given(
    st.integers(1, 3),
    st.integers(1, 60),
    st.floats(0.5, 12.0),
    st.sampled_from([0.0, 1e4, -1e150]),
    st.integers(0, 10**6),
)
def test_each_two_agents_within_range_are_in_adjacent_cells_once(m, n, spread, far, seed):
    q = np.random.default_rng(seed).uniform(-spread, spread, (n, m))
    q[-1, -1] += far
    order, start, rows = (part.astype(int) for part in sort_into_grid(q, 1.0))
    assert sorted(order) == list(range(n))
    seen = []
    for cell in range(start.size - 2):
        for i in range(start[cell], start[cell + 1]):
            spans = [(i + 1, start[cell + 2]), *((start[cell + d - 1], start[cell + d + 2]) for d in rows)]
            seen += [tuple(sorted((order[i], order[j]))) for begin, end in spans for j in range(begin, end)]
    assert len(seen) == len(set(seen))
    i, j = np.triu_indices(n, 1)
    near = np.linalg.norm(q[i] - q[j], axis=1) < 1.0
    assert set(zip(i[near].tolist(), j[near].tolist(), strict=True)) <= set(seen)
