"""Encounters looked for along a list: what is bounded, and what is cut short, is what all control points say."""

import numpy as np
import pytest

from flockana.kernels import step_shares
from flockana.kernels.cell_grid import empty_cuts
from flockana.kernels.encounter_checks import (
    Around,
    Ends,
    _stays_beyond,
    band,
    common_way,
    farthest_ways,
    means_of,
    pair_room,
    share_of_listed,
    share_of_pair,
    steepest,
)
from flockana.kernels.neighbours import pair_list
from flockana.kernels.quintic_paths import bernstein, centred
from flockana.kernels.slab_checks import means_in_parts, ways_in_parts
from flockana.kernels.verlet_list import Pairs, covers, listed_anew, no_pairs

H, R, FAR = 0.7, 8.4, 3.5


def ends(n, m, speed, seed=0, *, bend=1.0):
    """Two states of a drifting flock, whose accelerations differ, so that paths bend, and are known less well."""
    rng = np.random.default_rng(seed)
    q0, p0 = rng.uniform(0.0, 3.0 * n ** (1.0 / m), (n, m)), rng.normal(3.0, speed, (n, m))
    p1 = p0 + rng.normal(0.0, 0.2 * speed, (n, m))
    q1 = q0 + 0.5 * H * (p0 + p1) + rng.normal(0.0, 0.02 * speed, (n, m))
    return Ends(H, q0, p0, rng.normal(0.0, bend * speed, (n, m)), q1, p1, rng.normal(0.0, bend * speed, (n, m)))


def share_of_pairs(states, radii):
    """The share that pairs allow, one after the other, with the control points of all agents."""
    points, _, allowance = bernstein(*states)
    ways, share, room = centred(points, allowance), 1.0, pair_room(radii.shape[1])
    for pair in zip(*pair_list(states.q0, 1e6), strict=True):
        room.points[:], room.reach[:] = points[list(pair)], ways[list(pair)]
        room.allowance[:], room.radii[:] = allowance[list(pair)], radii[list(pair)]
        share = share_of_pair(room, FAR, share)
    return share


def around(radii):
    """No poles and no obstacles."""
    none, edges, kinds = np.empty(0, np.uint32), (float(radii.min()), float(radii.max())), np.zeros(1, int)
    return Around(
        radii, FAR, edges, np.empty(0), 1.0, none, none, False, 0, np.empty(0), kinds, (0.0, 0.0), None, covers
    )


def drawn(states, factor):
    """The same, drawn together to a place of its own within the step, as by a target: seen from there all slow down."""
    _, q0, p0, u0, q1, p1, u1 = states
    along = q0 - 2.0
    pull = 2.0 * (1.0 - factor) / H**2 * along
    return Ends(H, q0, p0, u0 - pull, q1 - 0.5 * H**2 * pull, p1 - H * pull, u1 - pull)


@pytest.mark.parametrize("factor", [1.0, 0.8])
@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("n", [3, 250])
def test_bounds_of_ways_and_allowances_are_those_of_the_control_points(n, m, factor):
    states = drawn(ends(n, m, 1.5), factor)
    points, _, allowance = bernstein(*states)
    ways, (mean, slope, centre) = points - points[:, :1], common_way(states)
    assert mean[:, :m] == pytest.approx(ways.mean(axis=0)[:, :m], abs=1e-12)
    assert centre[:m] == pytest.approx(states.q0.mean(axis=0))
    assert not mean[:, m:].any()
    along = points[:, 0] - centre
    least = np.einsum("nc,nkc->kc", along, ways)[:, :m] / np.square(along).sum(axis=0)[:m]
    assert slope[:, :m] == pytest.approx(least if np.abs(least).max() < 0.5 else 0.0 * least, abs=1e-12)
    beside = np.linalg.norm(ways - mean - slope * along[:, None], axis=2).max(axis=1)
    h, q0, p0, _, q1, p1, _ = states
    bend0, bend1 = q0 + h * p0 / 3.0, q1 - h * p1 / 3.0  # the inner control points of the cubic through q and p
    parts = points[:, 2, :m] - 0.1 * (q0 + 6 * bend0 + 3 * bend1), points[:, 3, :m] - 0.1 * (3 * bend0 + 6 * bend1 + q1)
    blur = 0.35 * sum(np.linalg.norm(part, axis=1).max() for part in parts)
    way, slack = farthest_ways(states, (mean, slope, centre))
    assert (way, slack) == pytest.approx((beside.max() + blur, blur), rel=1e-12)
    assert way >= (beside + allowance).max() * (1.0 - 1e-12)
    assert slack >= allowance.max() * (1.0 - 1e-12)


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("n", [3, 250])
def test_parts_of_the_agents_have_the_means_and_bounds_of_all(n, m):
    states = ends(n, m, 1.5)
    common = common_way(states)
    assert means_in_parts.py_func(states) == pytest.approx(means_of(states), rel=1e-12)
    assert ways_in_parts.py_func(states, *common) == farthest_ways(states, common)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_a_pair_stays_beyond_what_its_control_points_keep_beyond(m):
    states = ends(80, m, 6.0)
    (i, j), points = np.triu_indices(80, 1), bernstein(*states)[0]
    gaps = points[j] - points[i]
    along = np.einsum("pkc,pc->pk", gaps, gaps[:, 0]) / np.linalg.norm(gaps[:, 0], axis=1)[:, None]
    assert set(along.argmin(axis=1)) == set(range(6))
    for pair, least in zip(zip(i, j, strict=True), along.min(axis=1), strict=True):
        assert _stays_beyond(states, *pair, least - 1e-6)
        assert not _stays_beyond(states, *pair, least + 1e-6)


@pytest.mark.parametrize("node", [1, 2, 3, 4, 5])
def test_each_control_point_may_be_the_farthest(node):
    """Of one agent among 99 at rest."""
    ways = np.zeros(6)
    ways[node] = 40.0
    gone, out, back = ways[5], ways[1], ways[5] - ways[4]
    q0 = np.random.default_rng(0).uniform(0.0, 900.0, (100, 2))
    p0, u0, q1, p1, u1 = np.zeros_like(q0), np.zeros_like(q0), q0.copy(), np.zeros_like(q0), np.zeros_like(q0)
    q1[7, 0] += gone
    p0[7, 0], p1[7, 0] = 5.0 * out / H, 5.0 * back / H
    u0[7, 0], u1[7, 0] = 20.0 * (ways[2] - 2.0 * out) / H**2, 20.0 * (ways[3] - gone + 2.0 * back) / H**2
    states = Ends(H, q0, p0, u0, q1, p1, u1)
    points, _, allowance = bernstein(*states)
    assert points[7, :, 0] - q0[7, 0] == pytest.approx(ways, abs=1e-12)
    farthest, blur = farthest_ways(states, common_way(states))
    assert blur == pytest.approx(allowance[7])
    assert 0.9 < (farthest - blur) / 40.0 <= 1.0  # beside what it adds to the mean itself


def test_only_what_is_drawn_together_by_less_than_half_has_slopes():
    still = np.zeros((90, 2))
    q0 = np.random.default_rng(0).uniform(0.0, 900.0, (90, 2))
    for factor, expected in ((0.9, 0.1), (0.51, 0.49), (0.49, 0.0), (1.4, 0.4), (-1.0, 0.0)):
        states = Ends(H, q0, still, still, factor * q0, still, still)
        common = common_way(states)
        assert steepest(common[1]) == pytest.approx(expected, abs=1e-12)
        farthest, blur = farthest_ways(states, common)
        assert (farthest == pytest.approx(blur)) == (expected > 0.0)  # beside it nobody moves


def test_the_band_is_where_a_pair_may_come_within_reach_or_be_within_it():
    """From 11 a pair comes nearer by a fifth and two ways of 0.3, off by two allowances of 0.1: it stays at 8."""
    slope, edges = np.zeros((6, 3)), (5.0, 8.0)
    slope[4, 1] = -0.2
    common = np.zeros((6, 3)), slope, np.zeros(3)
    assert band(common, (0.3, 0.1), edges, 2.81) == pytest.approx((5.0, 11.0))  # the longest relative way is 2.8
    assert band(common, (0.3, 0.1), edges, 2.79) == pytest.approx((0.0, 11.0))


@pytest.mark.slow
@pytest.mark.parametrize("factor", [1.0, 0.8, 0.3, 1.3])
@pytest.mark.parametrize(("speed", "bend"), [(0.3, 1.0), (3.0, 1.0), (12.0, 1.0), (0.3, 60.0)])  # of FAR = 3.5 a step
@pytest.mark.parametrize("m", [1, 2, 3])
def test_pairs_of_a_list_cut_a_step_as_they_do_with_all_control_points(m, speed, bend, factor):
    cut = 0
    for seed in range(20):
        states = drawn(ends(40, m, speed, seed, bend=bend), factor)
        radii = np.sort(np.random.default_rng(seed).uniform(0.5, R, (40, 2)), axis=1)
        whole, common, given = share_of_pairs(states, radii), common_way(states), around(radii)
        listed = (each.astype(np.uint32) for each in pair_list(states.q0, 1e6))
        ways = farthest_ways(states, common)
        between = band(common, ways, given.edges, FAR)
        found = share_of_listed(states, (common[0], ways[1]), between, given, *listed, 1.0)
        assert found == pytest.approx(whole, rel=1e-9)
        cut += whole < 1.0
    assert cut > 0 or speed * bend < 1.0


@pytest.mark.slow
@pytest.mark.parametrize("large", [False, True])
@pytest.mark.parametrize("listed", ["all", "none yet", "too few", "too many for memory"])
@pytest.mark.parametrize("m", [1, 2, 3])
def test_a_step_is_cut_by_ways_seen_from_the_mean_motion(m, listed, large, monkeypatch):
    """Pairs are searched for unless the list holds all that may meet; of too many to list, some at a time.

    A large flock is looked at in parts.
    """
    states, radii, view = ends(40, m, 12.0), np.full((40, 2), [R / 2, R]), (0.0, np.zeros(m), np.zeros(m))
    i, j = (each.astype(np.uint32) for each in pair_list(states.q0, 1e6))
    searched = []

    def found(q, within, near):
        searched.append(within)
        listed_anew(q, within, near)
        if listed == "too many for memory":
            near.counts[0] = -1

    monkeypatch.setattr(step_shares, "_BLOCK", 50)
    monkeypatch.setattr(step_shares, "BODIES", False)
    monkeypatch.setattr(step_shares, "POLES", False)
    monkeypatch.setattr(step_shares, "LARGE", large)
    for name in ("means_in_parts", "ways_in_parts", "share_in_parts"):
        monkeypatch.setattr(step_shares, name, getattr(step_shares, name).py_func)
    kept, near = no_pairs(40, m), no_pairs(200, m)._replace(places=np.empty((40, m)))
    if listed in ("all", "too few"):
        count, reach = (i.size, 1e6) if listed == "all" else (0, R)
        kept = Pairs(i, j, states.q0, np.array([reach]), empty_cuts(40), np.array([count, 1]))
    given = around(radii)._replace(listed=found)
    share = step_shares.share_of_step.py_func(0.0, states, given, view, kept, near)
    assert share == pytest.approx(share_of_pairs(states, radii), rel=1e-9)
    assert share < 1.0
    assert len(searched) == (listed != "all")
    again = step_shares.share_of_step.py_func(0.0, states, given, view, kept, near)
    assert (again, len(searched)) == (share, listed != "all")  # a list that was made is kept
