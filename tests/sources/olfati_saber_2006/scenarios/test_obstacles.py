"""The entries with obstacles: parameters as printed, starts clear of obstacles, and what their reports find."""

from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm3, Sphere, StaticTarget, Tolerances, Trajectory, scenario, simulate, verify
from flockana.scenarios.report_claims import component_counts
from flockana.sources.olfati_saber_2006.scenarios.obstacle_claims import blocked, rests
from flockana.sources.olfati_saber_2006.scenarios.obstacles import GAINS, SCENARIOS, free_start

FINDS = Tolerances()


def report(entry, name):
    return next(one.check for one in entry.reports if one.name == name)


def moved(law, q, t=None):
    """A made-up run through given positions; velocities and accelerations vanish."""
    q = np.asarray(q, dtype=float)
    t = np.arange(len(q), dtype=float) if t is None else t
    return Trajectory(t, q, 0.0 * q, 0.0 * q, law)


def test_all_share_the_gains():
    for name in SCENARIOS:
        assert scenario(name).law.gains == GAINS
    # the pull on an agent is at most c1γ; at rest it must be able to outweigh c2γ p_d of the printed p_d = (5, 0)
    assert GAINS.c1_gamma > 5.0 * GAINS.c2_gamma


def test_the_obstacles_of_the_figures():
    split = scenario("paper-split-rejoin").law
    assert [o.centre[0] for o in split.obstacles] == [100, 110, 120, 130, 150, 160]
    assert [o.centre[1] for o in split.obstacles] == [20, 60, 40, -20, 40, 0]
    assert [o.radius for o in split.obstacles] == [10, 4, 2, 5, 5, 3]
    np.testing.assert_array_equal(split.target.position(60.0), (200.0, 30.0))
    np.testing.assert_array_equal(split.target.rate(0.0), (5.0, 0.0))
    gap = scenario("paper-squeezing").law
    assert gap.obstacles == (Sphere((150.0, 30.0), 25.0), Sphere((150.0, 100.0), 25.0))
    for t, point in ((54.0, (150.0, 65.0)), (70.0, (230.0, 60.0))):
        np.testing.assert_allclose(gap.target.position(t), point)
    for law in (split, gap):
        assert (law.alpha.d, law.alpha.r, law.beta.d) == pytest.approx((7.0, 8.4, 4.2))
        assert law.beta.r == pytest.approx(1.2 * 4.2)


@pytest.mark.parametrize("name", SCENARIOS)
def test_starts_follow_from_the_seed_and_keep_clear(name):
    first, again, other = scenario(name, seed=5), scenario(name, seed=5), scenario(name, seed=6)
    assert np.array_equal(first.q0, again.q0)
    assert not np.array_equal(first.q0, other.q0)
    assert all(o.clearance(first.q0).min() >= first.law.beta.d for o in first.law.obstacles)
    assert (first.p0.min() >= -2.0) & (first.p0.max() <= -1.0)
    assert first.law == other.law


def test_only_agents_too_near_are_drawn_again():
    solid = Sphere((0.0, 0.0), 20.0)
    q, p = free_start(3, 200, (0.0, 0.0), 20.0, [solid], room=5.0)
    plain, same = free_start(3, 200, (0.0, 0.0), 20.0, [Sphere((1e4, 0.0), 1.0)], room=5.0)
    kept = solid.clearance(plain) >= 5.0
    assert 10 < kept.sum() < 190
    np.testing.assert_array_equal(q[kept], plain[kept])
    np.testing.assert_array_equal(p, same)
    assert solid.clearance(q).min() >= 5.0


def test_blocked_is_by_the_segment_not_the_line():
    q = np.array([[-9.0, 0.0], [9.0, 0.0], [-9.0, 8.0], [0.0, -9.0]])
    found = blocked(q, np.array([6.0, 0.0]), [Sphere((0.0, 0.0), 2.0), Sphere((20.0, 0.0), 3.0)])
    assert found.tolist() == [True, False, False, False]


@pytest.mark.parametrize(
    ("gaps", "splits", "parts"),
    [
        ([20.0, 7.0, 20.0, 7.0], "verified", 1),  # apart, together, apart, together
        ([20.0, 7.0, 7.0, 7.0], "refuted", 1),  # never split after it was connected
        ([7.0, 20.0, 20.0, 20.0], "verified", 2),  # never rejoined
        ([20.0, 20.0, 20.0, 20.0], "refuted", 2),  # never connected
    ],
)
def test_splitting_and_rejoining_are_read_off_the_components(gaps, splits, parts):
    entry = scenario("paper-split-rejoin")
    run = moved(entry.law, [[[0.0, 0.0], [gap, 0.0], [gap + 7.0, 0.0]] for gap in gaps])
    assert component_counts(run).tolist() == [1 if gap < 8.4 else 2 for gap in gaps]
    assert report(entry, "splits")(run, FINDS).status == splits
    rejoins = report(entry, "rejoins")(run, FINDS)
    assert (rejoins.status, rejoins.computed) == ("inconclusive", parts)  # one instant is no limit
    if (splits, parts) == ("verified", 1):
        detail = report(entry, "splits")(run, FINDS).detail
        assert detail == "connected from t = 1; in up to 2 components between t = 2 and 2"
        assert "connected again from t = 3 on" in rejoins.detail


def test_passing_the_gap_is_not_going_round_it():
    entry = scenario("paper-squeezing")
    past = [[[180.0, y] for y in (65.0, 65.0, 65.0)]]
    between = moved(entry.law, [[[140.0, 65.0], [140.0, 64.0], [140.0, 130.0]], *past])
    found = report(entry, "squeezes")(between, FINDS)
    assert (found.computed, found.status) == (3, "verified")  # where each is once it has crossed
    round_it = moved(entry.law, [[[140.0, 65.0], [140.0, 0.0], [140.0, 130.0]], [[180.0, y] for y in (65, 0, 130)]])
    found = report(entry, "squeezes")(round_it, FINDS)
    assert (found.computed, found.status) == (1, "refuted")
    stopped = moved(entry.law, [[[140.0, 65.0], [140.0, 65.0]], [[180.0, 65.0], [150.0, 65.0]]])
    assert report(entry, "past")(stopped, FINDS).status == "refuted"
    assert report(entry, "past")(stopped, FINDS).margin == -25.0


def test_an_agent_that_tunnels_between_two_samples_is_seen():
    entry = scenario("paper-split-rejoin")
    q, p = np.array([[[80.0, 20.0]], [[120.0, 20.0]]]), np.full((2, 1, 2), (40.0, 0.0))
    run = Trajectory(np.array([0.0, 1.0]), q, p, 0.0 * p, entry.law, stats={"steps": 1})
    found = report(entry, "clear")(run, FINDS)
    assert found.status == "refuted"
    assert found.computed == pytest.approx(-10.0, abs=1e-6)
    assert found.witness["obstacle"] == 0


def test_agents_behind_no_obstacle_or_under_way_are_not_trapped():
    entry = scenario("paper-trapped-convex")
    run = moved(entry.law, [[[50.0, 0.0], [110.0, 0.0], [40.0, 0.0]]] * 2)
    p = np.zeros((2, 3, 2))
    p[-1, 2] = (1.0, 0.0)
    assert report(entry, "trapped")(replace(run, p=p), FINDS).computed == 1


def test_a_single_agent_rests_before_the_bar_where_the_pull_and_the_push_balance():
    """Head-on, c1β φ_β σ_ε balances c1γ σ₁: the agent stands a little closer than d', and Theorem 6 is verified."""
    law = scenario("paper-trapped-convex").law
    run = simulate(law, [[30.0, 0.0]], [[0.0, 0.0]], (0.0, 60.0))
    gap = float(law.obstacles[0].clearance(run.q[-1])[0])
    assert 4.0 < gap < law.beta.d
    entry = replace(scenario("paper-trapped-convex"), q0=run.q[0], p0=run.p[0])
    for name in ("clear", "trapped", "rests", "in-touch"):
        assert report(entry, name)(run, FINDS).status == "verified"
    assert verify("os-6", run).status == "verified"


def test_the_short_start_of_a_large_run_is_sampled_evenly_and_balanced():
    entry = scenario("paper-squeezing")
    times = entry.options["t_eval"]
    np.testing.assert_allclose(np.diff(times), 0.05)
    run = simulate(entry.law, entry.q0, entry.p0, (0.0, 1.0), **(dict(entry.options) | {"t_eval": times[:21]}))
    # 1e-6 is the tolerance of the verdict; the whole run stays within 2e-7
    assert np.abs(run.energy_residual).max() < 2e-7 * np.abs(run.energy()).max()


def test_rest_is_judged_at_the_calmest_of_the_last_instants():
    """An agent at its target; in the last sample it is off by what a solver may leave, and pulled."""
    law = Algorithm3(target=StaticTarget((5.0, 0.0)))
    t, q = np.linspace(0.0, 100.0, 101), np.full((101, 1, 2), (5.0, 0.0))
    q[-1, 0, 0] += 1e-2
    claim = rests.check(Trajectory(t, q, 0.0 * q, 0.0 * q, law), Tolerances())
    assert (claim.status, claim.computed) == ("verified", 0.0)
    q[90:, 0, 0] += 1e-2
    assert rests.check(Trajectory(t, q, 0.0 * q, 0.0 * q, law), Tolerances()).status == "inconclusive"
