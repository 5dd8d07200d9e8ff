"""The search breaks what is false and does not break what is true; its findings are whole, repeatable and portable."""

import pickle
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm2, Gains, StaticTarget, Tolerances, falsify, replay, scenario, simulate, theorem, verify
from flockana.base.errors import ArgumentError
from flockana.falsify.bounded_space import search_space
from flockana.falsify.cma_search import Search
from flockana.falsify.point_evaluation import Problem
from flockana.sources.geschwender_2016.theorems.energy_printed import _printed_rate
from flockana.theorems.attraction_basin import final_basin
from flockana.theorems.observed_run import Observed
from tests.falsify.conftest import HEAD_ON, OWN, THREE_AT_REST, fast
from tests.programs import Starts, out_of_a_kernel


class TestFindsWhatIsFalse:
    def test_a_collision_as_soon_as_the_energy_bound_is_exceeded(self, collision):
        assert collision.found
        assert collision.ended == "found"
        law, c_star = HEAD_ON.law, HEAD_ON.law.gains.c1_alpha * HEAD_ON.law.alpha.c_star
        energy = law.structural_energy(collision.q0, collision.p0)
        assert c_star < energy < 2.0 * c_star  # never below: what excludes it is proved
        run = collision.run()
        order = np.sign(run.q[:, 1, 0] - run.q[:, 0, 0])
        assert order.min() == -order.max() == -1.0  # they ran through each other
        assert collision.worst_status("below") in ("verified", "vacuous")

    @pytest.mark.parametrize("seed", [0, 1])
    def test_e2_the_printed_energy_rises(self, seed):
        found = falsify("energy-printed", "beside-a-sphere", budget=60, seed=seed)
        assert found.found
        assert found.evaluations > 1  # the start itself keeps it
        run, pairs = found.run(), []
        for q in run.q:
            pairs.append(run.law.gains.c1_alpha * run.law.alpha.potential_energy(q))
        printed = run.energy() + np.array(pairs)
        above = printed - np.minimum.accumulate(printed)  # the least that it was before
        assert found.margin < -found.error
        assert above.max() > 0.0 or _printed_rate(run).max() > 0.0  # by the energy, or by its rate between samples
        assert np.diff(run.energy()).max() <= found.error

    def test_e3_a_limit_of_algorithm_1_that_is_no_lattice(self):
        found = falsify("lattice-limit-printed", "five-agents", budget=100, region=0.5, vary="q", seed=1)
        assert found.statuses["lattice"][0] != "refuted"
        assert found.found
        assert found.evaluations > 1
        assert final_basin(Observed.of(found.run())).certificate.margin > 0.0  # for ever
        end = found.run().q[-1]
        assert np.linalg.norm(end[0] - end[4]) < 1e-6  # two agents have become one
        assert found.margin == pytest.approx(-1.0, abs=1e-5)

    def test_e3_every_limit_of_algorithm_2(self):
        hexagon = scenario("hexagon")
        pulled = replace(hexagon, law=Algorithm2(target=StaticTarget((0.0, 0.0))), t_span=(0.0, 20.0))
        found = falsify("lattice-limit-printed", pulled, budget=5)
        assert (found.found, found.evaluations) == (True, 1)

    def test_e13_two_pairs_meet_where_energy_pays_for_one(self):
        found = falsify("E13", THREE_AT_REST, claim="printed", budget=100, speed=2500.0, seed=2)
        assert found.margins["printed"][0] > 0.0
        assert found.found
        verdict = verify("E13", found.run())
        assert len(verdict.claim("printed").witness) > int(verdict.claim("printed").stated.split()[2])
        assert found.worst_status("corrected") == "verified"

    @pytest.mark.parametrize("claim", ["equilibrium", "edges", "hurwitz"])
    def test_the_bearing_distance_theorem_as_printed(self, claim, tmp_path):
        found = falsify("zone-1-printed", "zone-tree", claim=claim, budget=5)
        assert found.found
        assert replay(found.save(tmp_path / "c.json")).claim(claim).margin == found.margin


class TestDoesNotBreakWhatIsTrue:
    """Nor do the searches of tests/adversarial/test_falsified.py, from wider regions."""

    @pytest.mark.slow  # an attack on theorems that hold
    @pytest.mark.parametrize(
        ("name", "case", "claim", "options"),
        [
            ("os-1", replace(scenario("hexagon"), t_span=(0.0, 2.0)), "iii", {"region": 0.5, "speed": 1.0}),
            ("os-3", THREE_AT_REST, "i", {"speed": 2500.0}),
            ("E13", THREE_AT_REST, "corrected", {"speed": 2500.0}),
            ("energy", "beside-a-sphere", None, {}),
            ("zone-1-corrected", "zone-tree", None, {}),
            ("zone-1-corrected", replace(scenario("zone-path"), t_span=(0.0, 60.0)), "energy", {}),
            ("dead-zone-1-corrected", replace(scenario("dead-zone-flow", n=4, box=8.0), t_span=(0.0, 3.0)), None, {}),
        ],
    )
    def test_in_a_few_generations(self, name, case, claim, options):
        found = falsify(name, case, claim=claim, budget=40, **options)
        assert claim not in found.broken if claim else not found.broken
        assert (found.evaluations, found.ended, found.failures) == (40, "budget", 0)
        judged = [status for status in found.statuses[found.claim] if status != "vacuous"]
        assert len(judged) > 5  # it was tested, not only vacuous

    def test_a_balance_that_only_the_integrator_spoils_is_not_broken(self):
        coarse = replace(scenario("three-agents-1d"), options={"method": "RK4", "dt": 1e-4})
        found = falsify("energy", coarse, claim="balance", budget=8)
        assert not found.broken
        assert "refuted" not in found.statuses["balance"]


class TestSearch:
    def test_it_restarts_with_twice_the_population_when_it_has_converged(self):
        search = Search(np.array([0.5]), 0)  # one dimension
        sizes = set()
        while search.restarts < 2:
            points = search.ask()
            assert all(x.shape == (1,) and 0.0 <= x[0] <= 1.0 for x in points)
            sizes.add(len(points))
            search.tell([(x[0] - 0.2) ** 2 for x in points])
        assert sizes == {6, 12}

    def test_a_large_flock_is_searched_by_the_diagonal(self):
        points = Search(np.full(301, 0.5), 0).ask()
        assert len(points) == 4 + int(3 * np.log(301))
        assert points[0].shape == (301,)


class TestTheOutcome:
    def test_the_history_is_the_least_margin_so_far(self, collision):
        margins = collision.margins["twice"]
        assert len(margins) == collision.evaluations == len(collision.statuses["below"])
        np.testing.assert_array_equal(collision.history, np.fmin.accumulate(margins))
        assert collision.history[-1] == collision.margin < 0.0
        assert margins[0] == verify("collision-energy", HEAD_ON.run()).claim("twice").margin
        assert collision.refuting("twice") == (collision.evaluations - 1,)
        assert (collision.broken, collision.scenario, collision.parameters) == (("twice",), "head-on", {})
        vacuous = np.array(collision.statuses["below"]) == "vacuous"
        assert np.isnan(collision.margins["below"][vacuous]).all()
        assert vacuous.any()

    def test_the_same_arguments_give_the_same_result_whoever_computes(self, collision):
        with ThreadPoolExecutor(2) as pool:
            again = falsify("collision-energy", HEAD_ON, claim="twice", budget=60, executor=pool)
        np.testing.assert_array_equal(again.q0, collision.q0)
        np.testing.assert_array_equal(again.margins["twice"], collision.margins["twice"])
        other = falsify("collision-energy", HEAD_ON, claim="twice", budget=60, seed=1)
        assert not np.array_equal(other.q0, collision.q0)

    def test_what_workers_need_travels(self):
        space = search_space(HEAD_ON)
        problem = pickle.loads(pickle.dumps(Problem(space, "collision-energy", Tolerances(), "twice")))
        one = pickle.loads(pickle.dumps(problem(space.start)))
        assert one.grade == Problem(space, "collision-energy", Tolerances(), "twice")(space.start).grade

    def test_the_budget_may_be_used_up_for_a_worse_one(self):
        found = falsify(OWN, HEAD_ON, budget=60, deepen=True, vary="p", speed=40.0)
        shallow = falsify(OWN, HEAD_ON, budget=60, vary="p", speed=40.0)
        assert (found.evaluations, found.ended) == (60, "budget")
        assert shallow.evaluations < 30
        assert found.margin < shallow.margin < 0.0

    def test_parameters_are_searched_and_reported(self):
        near = replace(HEAD_ON, q0=np.array([[0.0], [3.0]]))
        found = falsify(OWN, near, budget=60, vary=(), parameters={"gains.c1_alpha": (1.0, 1000.0)})
        assert found.found
        assert found.parameters == {"gains.c1_alpha": found.case.law.gains.c1_alpha}
        assert found.parameters["gains.c1_alpha"] > 30.0
        np.testing.assert_array_equal(found.q0, near.q0)

    def test_it_is_led_back_into_the_hypotheses(self):
        away = replace(HEAD_ON, q0=np.array([[3.0], [9.0]]), p0=np.zeros((2, 1)))
        found = falsify(OWN, away, budget=80, region=(0.0, 10.0), speed=60.0)
        assert found.statuses["slow"][0] == "vacuous"
        assert np.isnan(found.history[0])
        assert found.found
        assert found.q0[0, 0] < 1.0

    def test_hypotheses_that_no_run_meets_are_named_first_and_last(self, caplog):
        """A law without friction where the theorem asks for it: no start mends that, and other gains do."""
        gains = Gains(c1_alpha=30.0, c2_alpha=0.0, c1_gamma=1.0, c2_gamma=0.0)
        idle = replace(HEAD_ON, law=Algorithm2(gains=gains, target=StaticTarget((0.0,))), t_span=(0.0, 0.1))
        found = falsify("os-3", idle, budget=3)
        assert found.unmet
        assert all(verdict in ("vacuous",) for verdict in found.statuses["iii"])
        (told,) = [record.getMessage() for record in caplog.records if "own start" in record.getMessage()]
        assert told.startswith(f"os-3 on {idle.name}: no claim at its own start, which does not meet: ")
        assert all(name in told for name in found.unmet)
        caplog.clear()
        with pytest.raises(ArgumentError, match=r"Algorithm 1 is applied.*which no start meets"):
            falsify("os-1", idle, budget=30)
        assert falsify("collision-energy", HEAD_ON, claim="below", budget=2).unmet == ()
        assert not caplog.records

    def test_runs_that_fail_are_counted_and_end_nothing(self):
        starts = Starts()

        def broken(run, tolerances):
            if starts.number(run.run) % 3 == 1:
                raise np.linalg.LinAlgError("no\nluck")
            return fast(run, tolerances)

        found = falsify(replace(OWN, check=broken), HEAD_ON, budget=9, vary="p", speed=1.0)
        assert found.evaluations == 9
        assert found.failures == 3
        assert found.message == "LinAlgError: no luck"
        assert found.statuses["slow"].count("failed") == 3

    def test_a_law_that_refuses_its_parameters_is_a_failed_run(self):
        found = falsify(OWN, HEAD_ON, budget=12, vary=(), parameters={"alpha.r": (1.0, 9.0)})
        assert found.failures > 0
        assert "r = " in found.message or "r" in found.message
        assert found.verdict is not None

    @pytest.mark.parametrize("error", [KeyboardInterrupt(), out_of_a_kernel()])
    def test_ctrl_c_returns_the_best_so_far(self, error):
        starts = Starts()

        def interrupted(run, tolerances):
            if starts.number(run.run) == 5:
                raise error
            return fast(run, tolerances)

        found = falsify(replace(OWN, check=interrupted), HEAD_ON, budget=50, vary="p", speed=1.0)
        assert (found.ended, found.evaluations) == ("interrupted", 5)
        assert found.margin == np.nanmin(found.margins["slow"])


class TestBadInput:
    @pytest.mark.parametrize(
        ("arguments", "options", "message"),
        [
            (("os-9", "head-on"), {}, "unknown theorem 'os-9'"),
            (("os-1", "head-of"), {}, "unknown scenario 'head-of'; did you mean 'head-on'"),
            (("E8", "head-on"), {}, "E8 is not about a run"),
            (("os-5", "head-on"), {}, "os-5 is not about a run"),
            ((7, "head-on"), {}, "theorem = 7: expected a name"),
            (("os-1", 7), {}, "scenario = 7: expected a name"),
            (("os-1", "head-on"), {"budget": 0}, "budget = 0: expected a whole number >= 1"),
            (("os-1", "head-on"), {"seed": -1}, "seed = -1: expected a whole number >= 0"),
            (("os-1", "head-on"), {"claim": "iv"}, "unknown claim 'iv'"),
            (("os-1", "head-on"), {"tolerances": 0.1}, "tolerances = 0.1"),
            (("os-1", "head-on"), {"surrogate": 0.1}, "surrogate = 0.1"),
        ],
    )
    def test_is_named_before_the_search(self, arguments, options, message):
        with pytest.raises(ArgumentError, match=message):
            falsify(*arguments, **({"budget": 5} | options))


class TestTheClaimsForTheSearch:
    """The three theorems that stand in the catalogue for it."""

    @pytest.mark.parametrize("name", ["collision-energy", "lattice-limit-printed", "energy-printed"])
    def test_another_law_makes_them_vacuous(self, name):
        run = scenario("zone-tree").run()
        verdict = verify(name, run)
        assert verdict.status == "vacuous"
        assert theorem(name).kind == "trajectory"

    def test_the_bound_is_judged_by_the_energy_in_the_moving_frame(self):
        law, c_star = HEAD_ON.law, 30.0 * HEAD_ON.law.alpha.c_star
        boosted = simulate(law, HEAD_ON.q0, HEAD_ON.p0 + 100.0, (0.0, 0.1))
        (*_, below, twice) = verify("collision-energy", boosted).hypotheses
        assert below.margin == pytest.approx(0.5 * c_star, rel=1e-9)
        assert twice.margin == pytest.approx(1.5 * c_star, rel=1e-9)

    def test_a_moving_target_makes_the_printed_energy_vacuous(self):
        case = scenario("beside-a-sphere")
        law = replace(case.law, target=StaticTarget((2.0, 0.0), (1.0, 0.0)))
        run = simulate(law, case.q0, case.p0, (0.0, 1.0))
        assert verify("energy-printed", run).claim("printed-run").status == "vacuous"
