"""The dead-zone law: forces by hand, energy balance, derivatives, located switches, sliding, the Euler scheme."""

import numpy as np
import pytest

from flockana import Algorithm1, AlphaInteraction, DeadZoneFlocking, DeadZoneInteraction, SemiImplicitEuler, simulate
from flockana.base.errors import ArgumentError
from flockana.dynamics.switch_location import turns
from flockana.measures.path_bounds import closest_approach
from tests.refused import refused

HARD = DeadZoneInteraction(ramp=0.0)


def start(n=12, box=12.0, seed=0, m=2):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, box, (n, m)), rng.uniform(-1.0, 1.0, (n, m))


@pytest.mark.parametrize("m", [1, 2, 3])
def test_the_input_is_the_sum_of_the_paper(m):
    q, p = start(9, 25.0, m=m)
    pair, k2 = DeadZoneInteraction(ramp=0.0, k1=0.03), 0.7
    u = np.zeros_like(q)
    for i in range(9):
        for j in range(9):
            x = q[j] - q[i]
            rho = np.linalg.norm(x)
            if i == j or rho >= 15.0:
                continue
            f = -(400.0 / rho**2 + 1.3) if rho < 3.5 else 400.0 / (40.0 - rho) ** 2 + 1.3 if rho > 12.5 else 0.0
            u[i] += f * x / np.sqrt(1.0 + rho**2) + 0.03 * x + k2 * (p[j] - p[i])
    found = DeadZoneFlocking(pair, k2).acceleration(0.0, q, p)
    assert np.abs(found - u).max() <= 1e-13 * np.abs(u).max()
    assert np.abs(found.sum(axis=0)).max() <= 1e-12 * np.abs(u).max()  # momentum


def test_the_saturated_energy_is_measured_about_the_centre_and_counts_pairs_out_of_range():
    law = DeadZoneFlocking()
    q, p = np.array([[0.0, 0.0], [99.0, 0.0]]), np.array([[5.0, 1.0], [7.0, 1.0]])
    far = law.interaction.far_potential
    assert law.energy(0.0, q, p) == pytest.approx(far + 1.0, rel=1e-15)  # ½(1 + 1)
    assert law.literal_energy(q, p) == pytest.approx(1.0, rel=1e-13)


def test_a_pair_crosses_every_zone_and_each_switch_is_located():
    # k2 = 0: in through r and d2, and head on to repulsion and back out, so six switches
    law = DeadZoneFlocking(HARD, k2=0.0)
    run = simulate(law, [[0.0, 0.0], [16.0, 0.0]], [[2.0, 0.0], [-2.0, 0.0]], (0.0, 12.0))
    assert (run.status, run.stats["switches"]) == ("complete", 6)
    assert np.abs(run.energy_residual).max() < 1e-8 * run.energy()[0]
    rho = np.linalg.norm(run.q[:, 1] - run.q[:, 0], axis=1)
    for edge in (15.0, 12.5, 3.5):
        assert np.sum(np.abs(rho - edge) < 1e-12) == 2  # a sample at each switch
    assert run.p[-1] == pytest.approx(-run.p[0], abs=1e-7)  # a mirror image in time: it leaves as it came
    assert run.closest_approach().distance < 3.5


@pytest.mark.parametrize("sparse", [False, True])
@pytest.mark.parametrize("since", [0.0, 1e6])
def test_what_happened_before_a_switch_blurs_no_bound_after_it(since, sparse):
    """Out of the repulsion, no force acts: the way to the next step is known as well as that before the switch.

    A path that went on from there with the repulsion would be off by 0.004.
    """
    law = DeadZoneFlocking(DeadZoneInteraction(ramp=0.0, k1=0.0), k2=0.0)
    span = since, since + 5.0
    run = simulate(law, [[0.0], [3.45]], np.zeros((2, 1)), span, t_eval=span if sparse else None)
    path = run.path
    k = int(np.flatnonzero(path.q[:, 1, 0] - path.q[:, 0, 0] >= 3.5)[0])  # the switch
    gap = path.t[k + 1] - path.t[k]
    assert gap < 1e-9
    assert (abs(path.u[k, 0, 0]) > 30.0, path.u[k + 1, 0, 0]) == (True, 0.0)
    assert path.q[k + 1] - path.q[k] == pytest.approx(gap * path.p[k], abs=1e-14)
    assert closest_approach(*path).lower_by_interval[k + 1] == pytest.approx(3.5, abs=1e-6)


@pytest.mark.parametrize("method", ["DOP853", "RK45", "Radau", "BDF", "LSODA"])
@pytest.mark.parametrize(("past", "switches"), [(14.9999999, 2), (14.99, 2), (15.0000001, 0)])
def test_a_pair_that_grazes_the_range_is_not_missed(method, past, switches):
    """Straight past each other at a least distance of r less 1e-7, for 1.7e-4 of 80 time units, in steps of any length.

    Every solver takes the whole way in a few steps, and at no step's end, nor at fixed shares of it, are they in range.
    """
    run = simulate(
        DeadZoneFlocking(HARD, k2=0.0),
        [[-400.0, 0.0], [400.0, past]],
        [[10.0, 0.0], [-10.0, 0.0]],
        (0.0, 80.0),
        method=method,
    )
    assert (run.status, run.stats["switches"]) == ("complete", switches)
    assert np.abs(run.energy_residual).max() < 1e-7 * run.energy()[0]


def test_the_turns_of_a_distance_are_those_of_its_polynomial():
    law = DeadZoneFlocking(HARD)

    def course(t, swing=7.5):
        """Two agents on a line, 8 + 7.5 T_5 apart: five monotone pieces, four turns, within the unit step."""
        x = 2.0 * t - 1.0
        return np.array([[0.0], [8.0 + swing * (16.0 * x**5 - 20.0 * x**3 + 5.0 * x)]])

    held = law.pieces(np.array([[0.0], [8.0]]))
    found = turns(law, held, course, 0.0, 1.0)
    expected = 0.5 + 0.5 * np.cos(np.pi * np.arange(4, 0, -1) / 5.0)
    assert np.abs(np.array(found)[:, None] - expected).min(axis=0).max() < 1e-12
    # 8 ± 4 stays between d1 = 3.5 and d2 = 12.5: nobody asks
    assert turns(law, held, lambda t: course(t, swing=4.0), 0.0, 1.0) == []


def test_output_times_do_not_change_a_located_run():
    law, q, p = DeadZoneFlocking(HARD), [[0.0, 0.0], [16.0, 0.0]], [[1.0, 0.1], [-1.0, 0.0]]
    whole, kept = simulate(law, q, p, (0.0, 20.0)), simulate(law, q, p, (0.0, 20.0), t_eval=[0.0, 7.3, 20.0])
    assert kept.t.tolist() == [0.0, 7.3, 20.0]
    assert kept.q[-1] == pytest.approx(whole.q[-1], abs=1e-12)
    assert kept.stats["switches"] == whole.stats["switches"]


def test_sliding_ends_the_run_and_is_told():
    run = simulate(DeadZoneFlocking(HARD), [[0.0, 0.0], [3.6, 0.0]], np.zeros((2, 2)), (0.0, 500.0))
    assert run.status == "failed"
    assert "sliding at t = " in run.message
    assert "agents 0 and 1 slide at distance 3.5" in run.message
    assert run.message.endswith("give the interaction a ramp to go on")  # and names no nearest pair beside it
    assert "ramp" in run.stats["sliding"]
    assert run.stats["switches"] > 2
    assert np.linalg.norm(run.q[-1, 1] - run.q[-1, 0]) == pytest.approx(3.5, abs=1e-9)


def test_without_a_pull_nothing_slides():
    # in the dead zone with k1 = 0 no force drives the pair back to d1; at speed 0.1 damping brings it there at rest
    law = DeadZoneFlocking(DeadZoneInteraction(ramp=0.0, k1=0.0))
    for speed in (0.1, 0.3):
        run = simulate(law, [[0.0], [3.6]], [[speed], [-speed]], (0.0, 50.0))
        assert (run.status, run.stats["switches"]) == ("complete", 2)


def test_a_wide_dead_zone_leads_straight_out_of_range():
    law = DeadZoneFlocking(DeadZoneInteraction(r_b=12.0, k1=0.0, ramp=0.0), k2=0.0)
    run = simulate(law, [[0.0], [14.0]], [[0.0], [1.0]], (0.0, 3.0))
    assert run.stats["switches"] == 1
    assert run.q[-1].ravel() == pytest.approx([0.0, 17.0], abs=1e-12)


@pytest.mark.parametrize("ramp", [0.0, 0.25])
def test_semi_implicit_steps_apply_the_force_of_the_law_in_every_zone(ramp):
    """Pairs from 0.5 to beyond the range on a line; rows of pairs are summed in any order."""
    law = DeadZoneFlocking(DeadZoneInteraction(ramp=ramp))
    q = np.column_stack([np.linspace(0.0, 40.0, 81), np.zeros(81)])
    p = np.random.default_rng(0).normal(0.0, 1.0, q.shape)
    u = SemiImplicitEuler(law, 0.01).step(0.0, q, p, {})[2]
    np.testing.assert_allclose(u, law.flow(0.0, q, p)[0], rtol=1e-12, atol=1e-10 * np.abs(u).max())


def test_semi_implicit_steps_at_once_are_steps_one_by_one():
    q, p = start(5, 10.0)
    for law in (DeadZoneFlocking(HARD), Algorithm1(AlphaInteraction(d=3.0, r=4.0))):
        euler = SemiImplicitEuler(law, 0.01)
        many, state = euler.iterate(0.0, q, p, {}, 7), (q, p)
        for _ in range(7):
            state = euler.step(0.0, *state, {})[:2]
        assert np.array_equal([many[0][-1], many[1][-1]], state)


def test_metrics_show_the_energy_of_neighbours():
    q, p = start(6, 60.0, seed=2)
    run = simulate(SemiImplicitEuler(DeadZoneFlocking(), 0.01), q, p, (0.0, 0.1))
    assert float(run.metric("literal_energy")[0]) == DeadZoneFlocking().literal_energy(q, p)


def test_coincident_agents_are_refused():
    law, q = DeadZoneFlocking(), [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]]
    for act in (
        lambda: law.acceleration(0.0, q, q),
        lambda: law.stiffness(q),
        lambda: simulate(law, q, q, (0.0, 1.0)),
        lambda: simulate(SemiImplicitEuler(law), q, q, (0.0, 1.0)),
    ):
        with pytest.raises(ArgumentError, match=r"agents 1 and 2 (coincide|are 0 apart)"):
            act()


test_bad_parameters_are_named = refused(
    (lambda: DeadZoneFlocking(k2=-1.0), "k2 = -1: expected a gain >= 0"),
    (lambda: DeadZoneFlocking(AlphaInteraction()), "expected DeadZoneInteraction"),
    (lambda: SemiImplicitEuler(SemiImplicitEuler(DeadZoneFlocking())), "expected a continuous law"),
)


def test_evaluations_are_counted_after_a_switch_too():
    """Each step of DOP853 takes eleven at least."""
    law = DeadZoneFlocking(DeadZoneInteraction(ramp=0.0))
    run = simulate(law, [[0.0, 0.0], [16.0, 0.0]], [[4.0, 0.0], [-4.0, 0.0]], (0.0, 2.0))
    assert run.stats["switches"] > 0
    assert run.stats["evaluations"] >= 11 * run.stats["steps"]
