"""Who may be near an agent: never one too few, in rising order; and zone flocking over them, to the last bit."""

import numpy as np
import pytest

from flockana import ZoneFlocking, ZoneRadii
from flockana.sources.jond_2025.kernels.neighbour_candidates import gather, sort_into_cells
from flockana.sources.jond_2025.kernels.zone_counts import fragments, populations

REACH = 5.0


def flock(n, m, seed=0, spacing=2.5):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, spacing * n ** (1.0 / m), (n, m)), rng.normal(size=(n, m))


def near_each(q, cells, reach):
    near = np.arange(len(q))
    return [near[: gather(i, q, reach, cells, near)].tolist() for i in range(len(q))]


def all_within(q, reach):
    return [np.flatnonzero(np.linalg.norm(q - one, axis=1) <= reach).tolist() for one in q]


@pytest.mark.parametrize(("n", "m", "spacing"), [(400, 1, 1.0), (600, 2, 2.5), (4000, 3, 2.5)])
def test_all_within_reach_are_found_in_rising_order_and_nobody_else(n, m, spacing):
    q, _ = flock(n, m, spacing=spacing)
    cells = sort_into_cells.py_func(q, REACH)
    assert cells.start.size > 0
    assert near_each(q, cells, REACH) == all_within(q, REACH)


def test_nobody_is_missed_after_all_moved_by_half_of_what_the_cells_reach_further():
    q, p = flock(600, 2)
    cells = sort_into_cells.py_func(q, REACH + 1.0)
    moved = q + 0.499 * p / np.linalg.norm(p, axis=1, keepdims=True)
    assert near_each(moved, cells, REACH) == all_within(moved, REACH)


def test_few_agents_or_a_crowd_are_looked_through_one_by_one():
    for q in (flock(64, 2)[0], flock(500, 2, spacing=0.2)[0]):
        cells = sort_into_cells.py_func(q, REACH)
        assert cells.start.size == 0
        assert near_each(q, cells, REACH)[7] == list(range(len(q)))


def test_a_sparse_flock_has_wider_cells():
    q = np.concatenate([flock(300, 2)[0], flock(300, 2, seed=1)[0] + 400.0])
    cells = sort_into_cells.py_func(q, 0.01)
    assert 0 < cells.start.size < 10_000
    assert near_each(q, cells, 0.01) == all_within(q, 0.01)


def test_neighbours_at_exactly_the_radius_count():
    x = REACH * np.arange(20.0)
    q = np.stack(np.meshgrid(x, x), axis=-1).reshape(1, -1, 2)
    radii = np.full(400, 1.5), np.full(400, 3.0), np.full(400, REACH)
    np.testing.assert_allclose(populations(q, *radii), [[0.0, 0.0, 4.0 * 19.0 / 20.0]], rtol=1e-13)
    for distance, zone in ((1.5, 0), (3.0, 1), (REACH, 2)):
        pair = np.array([[[0.0, 0.0], [distance, 0.0]]])
        assert populations(pair, *(radius[:2] for radius in radii)).tolist() == [np.eye(3)[zone].tolist()]
    assert fragments(q, radii[2]).tolist() == [[1, 400]]
    assert fragments(q, radii[2] * (1.0 - 1e-12)).tolist() == [[400, 1]]


@pytest.mark.slow
@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("order", ["synchronous", "sequential"])
@pytest.mark.parametrize("form", ["position", "bearing"])
def test_steps_are_those_over_all_pairs_to_the_last_bit(m, order, form):
    """One agent who looks so far that all others share a cell: all pairs are looked at, and it is in nobody's zones."""
    q, p = flock(300, m, spacing=2.5 if m > 1 else 1.0)
    radii = ZoneRadii(1.5, c=3.0, a=tuple(np.random.default_rng(3).uniform(4.0, 5.0, 300).tolist()))
    with_far = ZoneRadii(1.5, c=3.0, a=(*radii.a, 1e30))
    far_q, far_p = np.vstack([q, np.full(m, 1e40)]), np.vstack([p, np.ones(m)])
    assert sort_into_cells.py_func(q, REACH).start.size > 0
    assert np.unique(sort_into_cells.py_func(far_q, 1e30).cell[:300]).size <= 1
    found = []
    for own, start, speed in ((radii, q, p), (with_far, far_q, far_p)):
        law = ZoneFlocking(radii=own, order=order, form=form, dt=0.4)  # long steps: some come into reach within one
        found.append(law.iterate(0.0, start, speed, law.start(start, speed), 30))
    for cells, pairs in zip(found[0][:3], found[1][:3], strict=True):
        np.testing.assert_array_equal(cells, pairs[:, :300])
    series = [law_measures(own, run) for own, run in zip((radii, with_far), found, strict=True)]
    np.testing.assert_allclose(series[0]["in_conflict"] * 300, series[1]["in_conflict"] * 301, rtol=1e-12)
    np.testing.assert_array_equal(series[0]["parts"] + 1, series[1]["parts"])


def law_measures(radii, run):
    n = run[0].shape[1]
    r, c, a, _ = radii.arrays(n)
    return {"in_conflict": populations(run[0], r, c, a)[:, 1], "parts": fragments(run[0], a)[:, 0]}
