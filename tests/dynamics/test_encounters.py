"""No encounter is leapt over: planted ones, in single steps whose truth is free flight, and in runs of every method."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm3, Capsule, Delayed, Law, Polygon, Sphere, StaticTarget, Wall, scenario, verify
from flockana.base.errors import ArgumentError
from flockana.dynamics import encounters
from flockana.dynamics.encounters import SHARE, Encounters, State, StepChecks
from flockana.dynamics.simulate import simulate
from flockana.interactions import BetaInteraction, Gains
from flockana.jit import callback_like, kernel
from flockana.kernels.agent_sums import put
from flockana.kernels.verlet_list import COUNT, CROWDED, no_pairs
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.solvers.solver_names import ADAPTIVE, METHODS
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.li_dead_zone import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.notebook_r2.laws import PushedAlgorithm1

R, D = 8.4, 7.0
FAR = SHARE * D
PAIR = Encounters.of(Algorithm1(), 2)


def flight(q, p, h=1.0):
    """The states at both ends of a free flight."""
    q, p = np.array(q, dtype=float), np.array(p, dtype=float)
    return h, State(q, p, 0.0 * q), State(q + h * p, p.copy(), 0.0 * q)


def bend(h, relative):
    """Two agents, the first at rest, the second on a polynomial path on the line."""
    f = np.polynomial.Polynomial(relative)
    ends = []
    for t in (0.0, h):
        q, p, u = (np.array([[0.0], [g(t)]]) for g in (f, f.deriv(), f.deriv(2)))
        ends.append(State(q, p, u))
    return h, *ends


class TestPairsInOneStep:
    @pytest.mark.parametrize("boost", [0.0, 1e6])
    @pytest.mark.parametrize("m", [1, 2, 3])
    def test_head_on_the_step_is_to_end_well_within_range(self, m, boost):
        q, p = np.zeros((2, m)), np.full((2, m), boost)
        q[1, 0], p[0, 0], p[1, 0] = 200.0, boost + 150.0, boost - 150.0
        share = PAIR.share(*flight(q, p))
        assert 200.0 - 300.0 * share == pytest.approx(R - FAR, rel=1e-6 if boost else 1e-9)

    def test_a_graze_is_met_at_the_closest_approach(self):
        offset = R - 1e-4  # the chord is 0.08 long
        share = PAIR.share(*flight([[0.0, 0.0], [200.0, offset]], [[150.0, 0.0], [-150.0, 0.0]]))
        assert share == pytest.approx(200.0 / 300.0, rel=1e-9)

    @pytest.mark.parametrize("offset", [R + 1e-9, 9.0, -50.0])
    def test_a_pass_beyond_the_range_shortens_nothing(self, offset):
        assert PAIR.share(*flight([[0.0, 0.0], [200.0, offset]], [[150.0, 0.0], [-150.0, 0.0]])) == 1.0

    def test_of_two_visits_in_one_step_the_first_is_met(self):
        """The distance is 5 + 1200 (t − 0.3)² (t − 0.8)² on [0, 1]: in range twice, not at the ends nor between."""
        root = np.polynomial.Polynomial([-0.3, 1.0]) * np.polynomial.Polynomial([-0.8, 1.0])
        distance, ends = 5.0 + 1200.0 * root**2, [1.0]
        assert min(distance(0.0), distance(1.0), distance(0.55)) > R
        while (share := PAIR.share(*bend(ends[-1], distance.coef))) < 1.0:
            ends.append(share * ends[-1])
        assert ends[-1] < 0.4  # the first visit lasts from 0.2 to 0.42: the step ends in it, or before it
        assert len(ends) < 6

    def test_within_range_a_step_goes_half_the_length_at_most(self):
        h, before, after = flight([[0.0], [5.0]], [[20.0], [0.0]])
        assert PAIR.share(h, before, after) == pytest.approx(FAR / 20.0, rel=1e-12)
        assert PAIR.share(*flight([[0.0], [5.0]], [[3.4], [0.0]])) == 1.0

    def test_to_come_in_and_stop_short_is_no_leap(self):
        assert PAIR.share(*flight([[0.0], [10.0]], [[3.0], [0.0]])) == 1.0  # ends at 7 < r, 1.4 within it

    def test_to_part_is_no_leap(self):
        assert PAIR.share(*flight([[0.0], [8.5]], [[-1e6], [1e6]])) == 1.0

    def test_whoever_meets_first_among_many_decides(self):
        """Still agents on a grid with gaps wider than r, and two that fly along it."""
        for side in (5, 25):
            grid = 20.0 * np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2)
            q = np.vstack([grid, [[-300.0, 5.0], [-100.0, 45.0]]])
            p = np.vstack([0.0 * grid, [[1000.0, 0.0], [1000.0, 0.0]]])
            share = Encounters.of(Algorithm1(), len(q)).share(*flight(q, p))
            half = np.sqrt(R**2 - 5.0**2)  # both pass at 5; the second is in range of (0, 40) from x = −half on
            assert 1000.0 * share == pytest.approx(100.0 - half + FAR, rel=1e-9)

    def test_each_agent_has_its_own_radius(self):
        """Agent 0 sees as far as 1, agent 1 as far as 3: passing at 2 only the second sees the first."""
        law = MinimalFlocking((1.0, 3.0), spacing=1.0)
        step = flight([[0.0, 0.0], [50.0, 2.0]], [[100.0, 0.0], [0.0, 0.0]])
        share = Encounters.of(law, 2).share(*step)
        assert 0.5 - np.sqrt(5.0) / 100.0 < share < 0.5
        assert Encounters.of(MinimalFlocking((1.0, 1.5), spacing=1.0), 2).share(*step) == 1.0
        near = Encounters.of(law, 2).share(*flight([[0.0, 0.9], [2.5, 0.0]], [[0.0, 0.0], [-5.0, 0.0]]))
        assert near < 1.0  # in range of the second all the time, and within 1 of the first in between

    def test_inner_surfaces_are_met_too(self):
        """From the dead zone into the repulsion and out: a chord of 2 √(3.5² − 3.4²) = 1.7 at a distance of 3.4."""
        law = DeadZoneFlocking()
        assert law.surfaces == (3.5, 12.5, 15.0)
        share = Encounters.of(law, 2).share(*flight([[0.0, 0.0], [0.87, 3.4]], [[1.74, 0.0], [0.0, 0.0]]))
        assert share == pytest.approx(0.5, abs=1e-9)
        pushed = PushedAlgorithm1()
        assert pushed.surfaces == (pushed.min_distance, R)
        share = Encounters.of(pushed, 2).share(*flight([[0.0, 0.0], [1.0, 0.01]], [[2.0, 0.0], [0.0, 0.0]]))
        assert share == pytest.approx(0.5, abs=1e-9)

    def test_laws_without_a_range_have_no_encounters(self):
        class Free(Law):
            def flow(self, t, q, p):
                return 0.0 * q, float("nan")

        frozen = MinimalFlocking(edges=[(0, 1)], spacing=1.0)
        for law in (Free(), frozen):
            found = Encounters.of(law, 2)
            assert not found.any
            assert found.share(*flight([[0.0], [200.0]], [[1e3], [0.0]])) == 1.0


def among(*obstacles, m=2):
    return Encounters.of(Algorithm3(target=StaticTarget((0.0,) * m), obstacles=obstacles), 1)


SHELL, SKIRT = BetaInteraction().r, SHARE * BetaInteraction().d


class TestObstaclesInOneStep:
    @pytest.mark.parametrize("radius", [1e-3, 2.0])
    @pytest.mark.parametrize("m", [2, 3])
    def test_a_sphere_hit_at_speed(self, m, radius):
        sphere, start = Sphere((100.0, *(0.0,) * (m - 1)), radius), np.zeros((1, m))
        share = among(sphere, m=m).share(*flight(start, start + 1000.0 * np.eye(m)[:1]))
        assert 100.0 - radius - 1000.0 * share == pytest.approx(SHELL - SKIRT, abs=1e-3)

    @pytest.mark.parametrize(
        "body",
        [
            Wall((100.0, 0.0), (-1.0, 0.0)),
            Capsule((103.0, -5.0), (103.0, 5.0), 3.0),
            Polygon([(100.0, -4.0), (100.5, -4.0), (100.5, 4.0), (100.0, 4.0)]),
        ],
        ids=str,
    )
    def test_bodies_thinner_than_a_step(self, body):
        """The end is beyond the body, or deep inside of it, where it exerts no force."""
        share = among(body).share(*flight([[0.0, 0.0]], [[1000.0, 0.0]]))
        assert 100.0 - 1000.0 * share == pytest.approx(SHELL - SKIRT, abs=1e-3)

    def test_a_graze_is_met_where_it_is_deepest(self):
        share = among(Sphere((50.0, 2.0 + SHELL - 0.01), 2.0)).share(*flight([[0.0, 0.0]], [[100.0, 0.0]]))
        assert share == pytest.approx(0.5, abs=5e-3)
        clear = among(Sphere((50.0, 2.0 + SHELL + 0.01), 2.0))
        assert clear.share(*flight([[0.0, 0.0]], [[100.0, 0.0]])) == 1.0

    def test_within_range_a_step_goes_half_the_distance_kept(self):
        wall = Wall((0.0, 0.0), (0.0, 1.0))
        assert among(wall).share(*flight([[0.0, 4.0]], [[21.0, 0.0]])) == pytest.approx(SKIRT / 21.0, rel=1e-9)
        assert among(wall).share(*flight([[0.0, 4.0]], [[2.0, 0.0]])) == 1.0
        assert among(wall).share(*flight([[0.0, 6.0]], [[1e4, 0.0]])) == 1.0

    def test_who_comes_in_goes_no_farther_within_either(self):
        wall, edge = Wall((0.0, 0.0), (0.0, 1.0)), SHELL + 0.5
        deep = among(wall).share(*flight([[0.0, edge]], [[0.0, -4.5]]))
        assert 4.5 * deep == pytest.approx(0.5 + SKIRT, rel=1e-5)
        assert among(wall).share(*flight([[0.0, edge]], [[0.0, -SKIRT]])) == 1.0

    def test_the_nearest_of_many_decides(self):
        spheres = [Sphere((x, 0.0), 1.0) for x in (90.0, 60.0, 30.0)]
        share = among(*spheres, Wall((0.0, -20.0), (0.0, 1.0))).share(*flight([[0.0, 0.0]], [[1000.0, 0.0]]))
        assert 29.0 - 1000.0 * share == pytest.approx(SHELL - SKIRT, abs=1e-3)


HEAD_ON = [[0.0], [200.0]], [[15.0], [-15.0]]
DAMPED = Algorithm1()
RUNS = {
    "head-on": (DAMPED, *HEAD_ON, 14.0),
    "fast": (DAMPED, [[0.0], [20000.0]], [[1500.0], [-1500.0]], 14.0),
    "graze": (DAMPED, [[0.0, 0.0], [200.0, 8.0]], [[15.0, 0.0], [-15.0, 0.0]], 14.0),
    "space": (DAMPED, [[0.0, 0.0, 0.0], [120.0, 100.0, 3.0]], [[15.0, 10.0, 0.0], [-5.0, -7.0, 0.0]], 14.0),
    "three": (DAMPED, [[0.0], [200.0], [500.0]], [[15.0], [-15.0], [-40.0]], 16.0),
    "dead zone": (DeadZoneFlocking(k2=0.0), [[-400.0, 0.0], [400.0, 14.9]], [[10.0, 0.0], [-10.0, 0.0]], 80.0),
    "inner zone": (DeadZoneFlocking(k2=0.0), [[-400.0, 0.0], [400.0, 3.2]], [[10.0, 0.0], [-10.0, 0.0]], 80.0),
    "perception": (MinimalFlocking(2.0, spacing=1.0), [[-400.0, 0.0], [400.0, 1.9]], [[10.0, 0.0], [-10.0, 0.0]], 80.0),
}


class TestRuns:
    @pytest.mark.slow
    @pytest.mark.parametrize("name", RUNS)
    def test_every_method_sees_what_a_tight_run_sees(self, name):
        """Free flight would leave the velocities as they are; tolerances 1e-8 leave errors of some 1e-5 of them."""
        law, q0, p0, end = RUNS[name]
        exact = simulate(law, q0, p0, (0.0, end), rtol=1e-12, t_eval=[end])
        speed = float(np.abs(p0).max())
        assert np.abs(exact.p[-1] - p0).max() > 1e-3 * speed
        for method in ADAPTIVE:
            run = simulate(law, q0, p0, (0.0, end), method=method)
            assert run.status == "complete"
            assert run.stats["redone"] > 0
            assert np.abs(run.p[-1] - exact.p[-1]).max() < 5e-6 * speed, method

    def test_rk4_makes_a_leaping_step_shorter_and_no_other(self):
        run = simulate(DAMPED, *HEAD_ON, (0.0, 14.0), method="RK4", dt=1.0)
        assert run.stats["redone"] > 0
        assert np.abs(run.p[-1] - HEAD_ON[1]).max() > 1.0  # a leap would have left them in free flight
        assert np.diff(run.t).max() == 1.0
        assert np.abs(run.energy_residual).max() > 0.0  # what so coarse a step gets wrong, it says
        fine = simulate(DAMPED, *HEAD_ON, (0.0, 14.0), method="RK4", dt=0.01)
        assert (fine.stats["redone"], fine.stats["steps"]) == (0, 1400)
        exact = simulate(DAMPED, *HEAD_ON, (0.0, 14.0), rtol=1e-12, t_eval=[14.0])
        np.testing.assert_allclose(fine.p[-1], exact.p[-1], atol=1e-3)  # of a force that is once differentiable

    @pytest.mark.parametrize("dt", [1.0, 14.0])
    def test_rk4_finds_the_step_that_an_encounter_allows_in_a_few(self, dt):
        """A step far too long throws agents far apart: what it foresees is no measure of the step to take."""
        run = simulate(DAMPED, [[0.0], [8.0]], [[1500.0], [-1500.0]], (0.0, 14.0), method="RK4", dt=dt)
        assert run.status == "complete"
        assert run.stats["steps"] + run.stats["redone"] < 50

    def test_rk4_keeps_its_times_to_keep(self):
        times = np.linspace(0.0, 14.0, 8)
        run = simulate(DAMPED, *HEAD_ON, (0.0, 14.0), method="RK4", dt=2.0, t_eval=times)
        np.testing.assert_array_equal(run.t, times)
        assert run.stats["redone"] > 0

    def test_a_boost_changes_nothing(self):
        """Seen from a frame at 1e3 per unit time, as many steps, and the same motion to the rounding of 1e5."""
        q0, p0 = np.array([[0.0, 0.0], [200.0, 5.0]]), np.array([[15.0, 0.0], [-15.0, 0.0]])
        still = simulate(DAMPED, q0, p0, (0.0, 14.0))
        boosted = simulate(DAMPED, np.add(q0, [1e5, 0.0]), np.add(p0, [0.0, 1e3]), (0.0, 14.0))
        assert boosted.stats["steps"] == pytest.approx(still.stats["steps"], rel=0.15)
        np.testing.assert_allclose(boosted.p[-1] - [0.0, 1e3], still.p[-1], atol=1e-5)

    def test_obstacles_hit_at_speed(self):
        """The sphere throws the agent off its line; a leap would leave it there."""
        law = Algorithm3(
            target=StaticTarget((0.0, 0.0)),
            gains=Gains(c1_gamma=0.0, c2_gamma=0.0),
            obstacles=[Sphere((300.0, 0.5), 0.5)],
        )
        start = [[0.0, 0.0]], [[100.0, 0.0]]
        exact = simulate(law, *start, (0.0, 6.0), rtol=1e-12, t_eval=[6.0])
        assert abs(exact.p[-1, 0, 1]) > 1.0
        for method in ADAPTIVE:
            run = simulate(law, *start, (0.0, 6.0), method=method)
            np.testing.assert_allclose(run.p[-1], exact.p[-1], atol=1e-3, err_msg=method)
            assert run.clearance().lower < 5.0

    def test_two_agents_pulled_together_from_rest_within_one_step(self):
        """At rest nothing closes in: only the path of the step itself tells that they will meet."""
        law = Algorithm2(gains=Gains(c1_gamma=1e-4, c2_gamma=0.0), target=StaticTarget((0.0, 0.0)))
        q0 = [[-3000.0, 1.0], [3000.0, -1.0]]
        exact = simulate(law, q0, np.zeros((2, 2)), (0.0, 300.0), rtol=1e-12, t_eval=[300.0])
        run = simulate(law, q0, np.zeros((2, 2)), (0.0, 300.0))
        assert run.stats["redone"] > 0
        np.testing.assert_allclose(run.q[-1], exact.q[-1], atol=1e-3)

    @pytest.mark.parametrize("seed", range(4))
    def test_many_agents_in_a_thin_gas(self, seed):
        """Twelve agents at 100 per unit time, tens of r apart: as the tight run has it but for errors."""
        rng = np.random.default_rng(seed)
        law = Algorithm1(gains=Gains(c1_alpha=30.0, c2_alpha=0.0))
        q0, p0 = rng.uniform(-150.0, 150.0, (12, 2)), rng.normal(0.0, 100.0, (12, 2))
        exact = simulate(law, q0, p0, (0.0, 3.0), rtol=1e-12, t_eval=[3.0])
        run = simulate(law, q0, p0, (0.0, 3.0))
        np.testing.assert_allclose(run.p[-1], exact.p[-1], rtol=0.0, atol=5e-6 * np.abs(exact.p[-1]).max())

    @pytest.mark.slow
    @pytest.mark.parametrize("method", METHODS)
    def test_output_times_hide_nothing(self, method):
        options = {"dt": 0.02} if method == "RK4" else {}
        every = simulate(DAMPED, *HEAD_ON, (0.0, 14.0), method=method, **options)
        ends = simulate(DAMPED, *HEAD_ON, (0.0, 14.0), method=method, t_eval=[0.0, 14.0], **options)
        splits = 1e-9 if method == "RK4" else 0.0  # the way to the end is split evenly, which rounds otherwise
        np.testing.assert_allclose(ends.q[-1], every.q[-1], rtol=splits)
        assert ends.min_distance() == pytest.approx(every.min_distance(), rel=splits, abs=0.0)
        assert ends.min_distance() < 6.0  # at its samples the flock is never nearer than 100


class TestDelayed:
    def test_a_leap_names_the_step_that_it_takes(self):
        with pytest.raises(ArgumentError, match=r"dt = 2: .* expected dt <= 0.\d+"):
            simulate(Delayed(DAMPED, 2.0), *HEAD_ON, (0.0, 14.0), dt=2.0)

    @pytest.mark.slow
    def test_steps_short_enough_see_it(self):
        late, fine = (simulate(Delayed(DAMPED, 0.01), *HEAD_ON, (0.0, 14.0), dt=dt) for dt in (0.01, 0.0025))
        assert np.abs(late.p[-1] - HEAD_ON[1]).max() > 1.0
        np.testing.assert_allclose(late.p[-1], fine.p[-1], atol=1e-2)

    def test_what_was_heard_before_the_start_counts(self):
        """They passed each other before the start, and hear of it after."""
        with pytest.raises(ArgumentError, match=r"within the step from t = -"):
            simulate(Delayed(DAMPED, 2.0), [[100.0], [-100.0]], [[150.0], [-150.0]], (0.0, 1.0), dt=1.0)

    def test_output_times_change_nothing(self):
        every, some = (
            simulate(Delayed(DAMPED, 0.01), *HEAD_ON, (0.0, 1.0), dt=0.01, t_eval=times) for times in (None, [0.5, 1.0])
        )
        np.testing.assert_array_equal(some.q, every.q[[50, 100]])
        np.testing.assert_array_equal(some.t, every.t[[50, 100]])


class TestVerdicts:
    def test_a_proved_claim_is_not_refuted_by_a_leap(self):
        verdict = verify("collision-energy", law=Algorithm1(), q0=HEAD_ON[0], p0=HEAD_ON[1], t_span=(0.0, 14.0))
        assert verdict.status != "refuted"

    def test_the_energy_printed_for_the_dead_zone_is_not_verified_by_a_leap(self):
        """It jumps by ψ(r) when the two come into range, and again when they part."""
        case = scenario("dead-zone-flow")
        law = replace(case.law, k2=0.0)
        q0, p0 = [[-400.0, 0.0], [400.0, 3.0]], [[40.0, 0.0], [-40.0, 0.0]]
        verdict = verify("dead-zone-1-printed", law=law, q0=q0, p0=p0, t_span=(0.0, 20.0))
        assert verdict.claim("energy").status != "verified"


class TestBalance:
    @pytest.mark.parametrize("seed", range(5))
    def test_a_passage_near_a_kink_is_resolved(self, seed):
        """One step missed the kink of the bump; of starts moved by 1e-13, one in thirteen was off by more than 1e-6."""
        case, rng = scenario("three-agents-1d"), np.random.default_rng(seed)
        for _ in range(4):
            q0, p0 = (x * (1.0 + 1e-13 * rng.uniform(-1.0, 1.0, x.shape)) for x in (case.q0, case.p0))
            run = simulate(case.law, q0, p0, case.t_span, **case.options)
            assert np.abs(run.energy_residual).max() < 2e-7 * np.abs(run.energy()).max()

    @pytest.mark.parametrize("method", ["DOP853", "RK45", "Radau"])
    def test_no_step_is_off_by_more_than_a_twentieth_of_the_tolerance(self, method):
        case = scenario("head-on")
        run = simulate(case.law, case.q0, case.p0, case.t_span, method=method, rtol=1e-6)
        off = np.abs(np.diff(run.energy_residual))
        assert off.max() <= 0.05 * 1e-6 * np.abs(run.energy()).max() * (1.0 + 1e-9)

    def test_a_wrong_identity_is_no_reason_to_crawl(self):
        """A rate that is not the energy's leaves the same residual at any step: given up, and seen all the same."""

        class Wrong(Algorithm1):
            def flow(self, t, q, p):
                u, rate = super().flow(t, q, p)
                return u, rate + 1.0

        case = scenario("five-agents")
        right, wrong = (
            simulate(law, case.q0, case.p0, case.t_span) for law in (case.law, Wrong(case.law.alpha, case.law.gains))
        )
        assert wrong.stats["evaluations"] < 1.3 * right.stats["evaluations"]
        assert wrong.energy_residual[-1] == pytest.approx(-(case.t_span[1] - case.t_span[0]), rel=1e-3)

    def test_hard_edges_are_located_as_before(self):
        hard = DeadZoneInteraction(ramp=0.0)
        run = simulate(
            DeadZoneFlocking(hard, k2=0.0), [[-400.0, 0.0], [400.0, 14.9]], [[10.0, 0.0], [-10.0, 0.0]], (0.0, 80.0)
        )
        assert (run.status, run.stats["switches"]) == ("complete", 2)


class TestFarAway:
    """Places a billion away are known to 1e-7: nobody can be asked to integrate more finely than that."""

    Q = np.array([[0.0, 0.0], [9.0, 0.0], [4.5, 7.2]])

    @pytest.mark.parametrize("far", [1e3, 1e6, 1e9])
    def test_it_takes_no_more_steps_there(self, far):
        here, there = (simulate(DeadZoneFlocking(), x + self.Q, np.ones((3, 2)), (0.0, 20.0)) for x in (0.0, far))
        assert there.stats["steps"] <= 1.5 * here.stats["steps"]

    def test_a_second_tolerance_still_makes_another_run(self):
        """Or two runs would agree for no better reason than that both are as rough as the places are."""
        q = 1e9 + self.Q
        one, two = (simulate(DeadZoneFlocking(), q, np.ones((3, 2)), (0.0, 20.0), rtol=rtol) for rtol in (1e-8, 1e-10))
        assert one.stats["steps"] < two.stats["steps"]


@kernel
def no_room(q, reach, pairs):
    """List nothing, as there are too many pairs."""
    put(q, pairs.places)
    pairs.reach[0] = reach
    pairs.counts[COUNT] = CROWDED
    return CROWDED


@pytest.mark.slow
@pytest.mark.parametrize("method", ["DOP853", "scipy-DOP853"])
def test_pairs_too_many_for_a_list_cut_the_same_steps(method, monkeypatch):
    """Two that fly through each other's range in one long step, beside a third: checked without a list of pairs."""
    q, p = np.array([[0.0, 0.0], [30.0, 1.0], [0.0, 40.0]]), np.array([[0.0, 0.0], [-9.0, 0.0], [0.0, 0.0]])
    listed = simulate(Algorithm1(), q, p, (0.0, 6.0), method=method)
    pairs, looked = no_pairs(1, 2), []
    callback = callback_like(no_room, 0, np.empty((1, 2)), 0.0, pairs)
    monkeypatch.setattr(encounters, "as_callback", lambda _: callback)
    at_crowd = StepChecks.make_room
    monkeypatch.setattr(StepChecks, "make_room", lambda self: (looked.append(at_crowd(self)), looked[-1])[1])
    crowd = simulate(Algorithm1(), q, p, (0.0, 6.0), method=method)
    assert True in looked
    assert crowd.status == "complete"
    np.testing.assert_array_equal(crowd.t, listed.t)
    np.testing.assert_allclose(crowd.q, listed.q, atol=1e-12)
