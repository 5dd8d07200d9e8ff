"""The search breaks what is false and does not break what is true; its findings are whole, repeatable and portable."""

from __future__ import annotations

import json
import pickle
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from flockana.base.errors import ArgumentError, FileError, UnknownNameError
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.targets import StaticTarget
from flockana.falsify import Counterexample, falsify, replay
from flockana.falsify.evaluate import Evaluation, Problem, units
from flockana.falsify.grade import FAILED, grade, missing
from flockana.falsify.search import Search
from flockana.falsify.space import law_parameter, search_space
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.scenarios import scenario
from flockana.theorems import Claim, Hypothesis, Theorem, Tolerances, Verdict, theorem, theorems, verify
from flockana.theorems.claims import judged
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.leads import bridge, pairs_apart, squash, strained
from flockana.theorems.observed import Observed
from flockana.theorems.olfati_saber.attraction import final_basin
from flockana.theorems.slides.energy_printed import _printed_rate
from tests.programs import Starts, out_of_a_kernel

HEAD_ON = scenario("head-on")
THREE_AT_REST = replace(scenario("three-agents-1d"), p0=np.zeros((3, 1)))


def fast(run, tolerances):
    """The last agent never moves faster than 10 in the first second: false, and with a slope."""
    q, speed = run.run.q, float(np.abs(run.run.p).max())
    unmet = Hypothesis("agent 0 starts left of 1", "met" if q[0, 0, 0] < 1.0 else "unmet", 1.0 - q[0, 0, 0])
    return [unmet], [judged("slow", Enclosure.of(35.0 - speed), [unmet])]


OWN = Theorem("slow", "Agents are slow", "No agent ever moves faster than 35, " * 2, "ours", "trajectory", fast)


@pytest.fixture(scope="module")
def collision():
    return falsify("collision-energy", HEAD_ON, claim="twice", budget=60)


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


class TestGrades:
    def test_refuted_before_judged_before_vacuous_before_failed(self):
        far = [Hypothesis("a", "unmet", -1e9), Hypothesis("b", "unmet")]
        grades = [
            grade(Claim("i", "refuted", margin=-5.0), []),
            grade(Claim("i", "refuted", margin=0.0), []),
            grade(Claim("i", "inconclusive", margin=-1e9), []),
            grade(Claim("i", "verified", margin=1e-9), []),
            grade(Claim("i", "verified", margin=1e9), [], lead=0.5),
            grade(Claim("i", "vacuous", margin=-1e9), [Hypothesis("a", "unmet", -1e-9)]),
            grade(Claim("i", "vacuous"), far, lead=1.0),
            FAILED,
        ]
        assert grades == sorted(grades)
        assert len(set(grades)) == len(grades)

    def test_numbers(self):
        assert grade(Claim("i", "verified", margin=6.0), [], scale=2.0) == 0.75
        assert grade(Claim("i", "refuted", margin=-1.0), []) == -2.5
        assert grade(Claim("i", "refuted"), []) == -2.0
        assert grade(Claim("i", "verified"), [], lead=1.0) == 1.001
        assert grade(Claim("i", "inconclusive", margin=float("nan")), []) == 0.0
        assert (squash(float("-inf")), squash(0.0)) == (-1.0, 0.0)
        assert missing([Hypothesis("a", "assumed", -1.0), Hypothesis("b", "unmet", float("nan"))]) == 1.0

    def test_how_well_a_limit_is_known_does_not_draw_the_search(self):
        """A flock that parts for ever has the margin −1 of no certificate: it is no nearer to a strained limit."""
        parts, settles, breaks, nothing = (
            Claim("i", status, margin=margin, about="limit")
            for status, margin in (("inconclusive", -1.0), ("verified", 1e-6), ("refuted", -1.0), ("vacuous", None))
        )
        assert grade(settles, [], lead=0.9) < grade(parts, [], lead=0.99)
        assert grade(breaks, [], lead=1.0) == -2.5
        assert grade(nothing, []) == 2.0

    @pytest.mark.parametrize("margin", [-1e9, -1.0, -1e-12])
    def test_numbers_that_contradict_a_proof_neither_break_it_nor_draw_the_search(self, margin):
        claim = judged("i", Enclosure.of(margin), proof="cohesion")
        assert (claim.status, claim.contradicts) == ("inconclusive", "cohesion")
        assert grade(claim, []) == 0.0
        assert not Evaluation(0.0, "i", Verdict("x", (), (claim,))).found

    def test_a_surrogate_never_outweighs_a_count(self):
        for k in range(30):
            more, less = (Claim("i", "verified", margin=float(m)) for m in (k, k + 1))
            assert grade(more, [], lead=1.0) < grade(less, [], lead=0.0)

    def test_units_are_the_margins_at_the_start_where_they_have_a_size(self):
        margins = {"a": -2.0, "b": 0.0, "c": None, "d": float("inf"), "e": float("nan"), "f": 1e-8}
        claims = tuple(Claim(name, "verified", margin=margin) for name, margin in margins.items())
        assert units(Verdict("x", (), claims)) == {"a": 2.0, "f": 1e-8}

    def test_every_claim_that_has_a_surrogate_exists(self):
        runs = {"os-3": "three-agents-1d", "E13": "three-agents-1d", "su-informed": "informed-through"}
        led = [(name, claim, lead) for name in theorems() for claim, lead in theorem(name).leads.items()]
        assert len(led) == 10
        ran = cache(lambda entry: scenario(entry).run())
        for name, claim, lead in led:
            run = ran("five-agents" if name.startswith("alpha") else runs.get(name, "head-on-collision"))
            one = verify(name, run).claim(claim)
            assert 0.0 <= lead(run, one) <= 1.0

    @pytest.mark.parametrize("entry", ["cucker-smale", "headings-meet", "minimal-2d-printed", "tanner-switching"])
    def test_no_surrogate_is_asked_where_the_law_is_another(self, entry):
        """It may have no lattice and no pair force, which surrogates measure by."""
        begin = scenario(entry)
        for name in theorems():
            if theorem(name).leads:
                found = falsify(name, begin, budget=1)
                assert {found.worst_status(claim) for claim in found.statuses} == {"vacuous"}, name

    def test_a_surrogate_is_asked_where_a_claim_alone_is_vacuous(self):
        run, asked = HEAD_ON.run(), Problem(None, OWN, Tolerances(), surrogate=lambda run, claim: 0.5)
        claim = Claim("slow", "vacuous")
        met, unmet = (Verdict("slow", (Hypothesis("a", status, 0.0),), (claim,)) for status in ("met", "unmet"))
        assert asked.graded(run, met).grade == 2.0 + 0.5e-3
        assert asked.graded(run, unmet).grade == 2.0


def made_up(*states):
    q = np.array(states, dtype=float)
    return Trajectory(np.arange(len(q), dtype=float), q, 0.0 * q, 0.0 * q, Algorithm1())


class TestSurrogates:
    def test_the_nearest_pair_that_has_not_met(self):
        run = made_up([[0.0], [1.0], [9.0]], [[1.0], [0.0], [7.0]])  # agents 0 and 1 change places
        assert pairs_apart(run, Claim("i", "verified")) == pytest.approx(squash(6.0 / 7.0), rel=1e-12)

    def test_the_longest_link_that_holds_the_flock(self):
        run = made_up([[0.0], [4.0], [8.0]], [[0.0], [4.0], [12.4]])
        assert bridge(run, Claim("i", "verified")) == pytest.approx(0.5, rel=1e-12)  # 8.4 of r = 8.4
        assert bridge(made_up([[0.0]], [[1.0]]), Claim("i", "verified")) == 1.0

    def test_strain_over_time(self):
        run = made_up([[0.0], [7.0]], [[0.0], [3.5]], [[0.0], [7.0]])
        assert strained(run, Claim("i", "verified")) == pytest.approx(1.0 - 0.5 * 0.5, rel=1e-12)


class TestSpace:
    def test_the_box_is_the_flock_s_with_a_tenth_of_room(self):
        case = replace(HEAD_ON, q0=np.array([[0.0, 5.0], [10.0, 5.0]]), p0=np.array([[3.0, 0.0], [-1.0, 0.0]]))
        space = search_space(case)
        np.testing.assert_array_equal(space.low, [-1.0, 4.0, -1.0, 4.0, -6.0, -6.0, -6.0, -6.0])
        np.testing.assert_array_equal(space.high, [11.0, 6.0, 11.0, 6.0, 6.0, 6.0, 6.0, 6.0])
        start = space.case(space.start)
        np.testing.assert_allclose(start.q0, case.q0, rtol=1e-14)
        np.testing.assert_allclose(start.p0, case.p0, atol=1e-14)

    def test_a_flock_at_one_place_and_at_rest_has_room_all_the_same(self):
        space = search_space(replace(HEAD_ON, q0=np.zeros((2, 1)), p0=np.zeros((2, 1))))
        assert (space.low.tolist(), space.high.tolist()) == ([-1.0] * 4, [1.0] * 4)

    def test_a_region_about_each_agent_or_a_box_for_all(self):
        near = search_space(HEAD_ON, vary="q", region=0.5)
        np.testing.assert_array_equal(near.low, [-0.5, 6.5])
        box = search_space(HEAD_ON, vary=["q"], region=(2.0, [9.0]))
        np.testing.assert_array_equal(box.case(np.zeros(2)).q0, [[2.0], [2.0]])
        np.testing.assert_array_equal(box.start, [0.0, 5.0 / 7.0])  # agent 0 starts outside: the nearest point

    def test_parameters_are_varied_on_a_logarithmic_scale_and_what_is_not_varied_stays(self):
        ranges = {"gains.c1_alpha": (0.3, 3000.0), "gains.c2_gamma": (0.0, 4.0)}
        space = search_space(HEAD_ON, vary=(), parameters=ranges)
        assert space.dimension == 2
        middle = space.case(np.full(2, 0.5))
        assert law_parameter(middle.law, "gains.c1_alpha") == pytest.approx(30.0, rel=1e-12)
        assert law_parameter(middle.law, "gains.c2_gamma") == 2.0
        assert middle.q0 is HEAD_ON.q0
        assert middle.law.alpha == HEAD_ON.law.alpha
        assert space.start[0] == pytest.approx(0.5, rel=1e-12)
        ends = [law_parameter(space.case(np.full(2, x)).law, "gains.c1_alpha") for x in (0.0, 1.0)]
        assert ends == [0.3, 3000.0]

    @pytest.mark.parametrize(
        ("options", "message"),
        [
            ({"vary": "v"}, "vary = 'v': expected 'q', 'p', both"),
            ({"vary": ("q", "q")}, "expected 'q', 'p', both"),
            ({"vary": ()}, "nothing is varied"),
            ({"region": -1.0}, "region = -1: expected a number > 0"),
            ({"region": (1.0, 1.0)}, "expected low < high on every axis"),
            ({"region": (1.0,)}, r"expected two bounds \(low, high\)"),
            ({"region": ([0.0, 0.0], 1.0)}, "expected a number or 1 of them for each corner"),
            ({"region": (0.0, np.inf)}, "expected finite numbers"),
            ({"region": 1e-18}, "region = 1e-18: expected more than the rounding of positions up to 7, such as 7e-09"),
            ({"region": 1e-300}, "region = 1e-300: expected more than the rounding"),
            ({"region": 1e308}, "region = 1e[+]308: expected bounds whose difference is a finite number"),
            ({"region": (-1e308, 1e308)}, r"region = \(-1e[+]308, 1e[+]308\): expected bounds whose difference"),
            ({"speed": 1e308}, "speed = 1e[+]308: expected bounds whose difference"),
            ({"speed": 0.0}, "speed = 0: expected a number > 0"),
            ({"parameters": {"gains.c3": (1.0, 2.0)}}, "gains.c3: Algorithm1 has no such number"),
            ({"parameters": {"alpha": (1.0, 2.0)}}, "alpha: Algorithm1 has no such number"),
            ({"parameters": {"gains.c1_alpha": (2.0, 1.0)}}, r"gains.c1_alpha = \(2, 1\): expected low < high"),
            ({"parameters": {"gains.c1_alpha": 2.0}}, r"expected two bounds \(low, high\)"),
        ],
    )
    def test_bad_bounds(self, options, message):
        with pytest.raises(ArgumentError, match=message):
            search_space(HEAD_ON, **options)


class TestTheProblem:
    """Several claims at once: each margin in its own unit, and none that does not decide."""

    RUN = made_up([[0.0], [7.0]], [[0.0], [7.0]])

    def worst(self, *claims, scales):
        problem = Problem(search_space(HEAD_ON), OWN, Tolerances(), scales=scales)
        return problem.graded(self.RUN, Verdict("slow", (), claims))

    def test_margins_are_compared_in_their_units(self):
        claims = Claim("a", "verified", margin=3.0), Claim("b", "verified", margin=1e-6)
        assert self.worst(*claims, scales={"a": 9.0, "b": 1e-8}).claim == "a"
        assert self.worst(*claims, scales={}).claim == "b"

    def test_a_negative_margin_that_does_not_decide_does_not_draw_the_search(self):
        found = self.worst(Claim("limit", "inconclusive", margin=-9.0), Claim("b", "verified", margin=0.0), scales={})
        assert found.grade == 0.0
        assert self.worst(Claim("limit", "inconclusive", margin=-9.0), scales={}).grade == 0.0


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


class TestTheFile:
    def test_it_breaks_again_to_the_bit(self, collision, tmp_path):
        path = collision.save(tmp_path / "c.json")
        again = Counterexample.load(path)
        np.testing.assert_array_equal(again.q0, collision.q0)
        np.testing.assert_array_equal(again.p0, collision.p0)
        assert again.law == collision.case.law
        assert (again.theorem, again.claim, again.margin) == ("collision-energy", "twice", collision.margin)
        verdict = replay(path)
        assert verdict.claim("twice").status == "refuted"
        assert verdict.claim("twice").witness == collision.verdict.claim("twice").witness
        assert [p.name for p in tmp_path.iterdir()] == ["c.json"]

    def test_options_of_the_run_and_tolerances_are_kept(self, tmp_path):
        case = replace(HEAD_ON, options={"rtol": 1e-6, "t_eval": np.linspace(0.0, 3.0, 200)})
        tolerances = Tolerances(contact=1e-3)
        found = falsify("collision-energy", case, claim="twice", budget=40, tolerances=tolerances)
        again = Counterexample.load(found.save(tmp_path / "c.json"))
        assert again.tolerances == tolerances
        assert len(again.run().t) == 200
        assert again.run().stats["rtol"] == 1e-6

    def test_a_theorem_of_one_s_own_is_brought_along(self, tmp_path):
        path = falsify(OWN, HEAD_ON, budget=40, vary="p", speed=40.0).save(tmp_path / "c.json")
        with pytest.raises(UnknownNameError, match="unknown theorem 'slow'"):
            replay(path)
        assert replay(path, theorem=OWN).claim("slow").status == "refuted"

    def test_there_is_none_where_nothing_broke(self, tmp_path):
        found = falsify("collision-energy", HEAD_ON, claim="below", budget=2)
        with pytest.raises(ArgumentError, match="collision-energy:below did not break"):
            found.save(tmp_path / "c.json")

    def test_a_folder_that_does_not_exist(self, collision, tmp_path):
        with pytest.raises(FileError, match=r"cannot write .*choose another file"):
            collision.save(tmp_path / "no" / "c.json")

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            ({"format": "flockana-trajectory"}, "holds no counterexample .*'flockana-trajectory'"),
            ({"format_version": 2}, "is of format 2, expected 1: use the flockana that wrote it"),
            ({"q0": [[0.0], ["x"]]}, "is damaged: q"),
            ({"q0": [[0.0]]}, "is damaged: q has shape"),
            ({"law": {"type": "flockana.laws.olfati_saber:Algorithm9"}}, "is damaged: cannot rebuild"),
            ({"law": [1.0]}, "is damaged: law"),
            ({"t_span": [3.0, 0.0]}, "is damaged: t_span"),
            ({"options": [1]}, "is damaged"),
            ({"tolerances": {"energie": 1.0}}, "is damaged: .*energie"),
            ({"theorem": 3}, "is damaged: 3 is no text"),
            ({"margin": "x"}, "is damaged"),
        ],
    )
    def test_damage_is_named(self, collision, tmp_path, change, message):
        path = collision.save(tmp_path / "c.json")
        path.write_text(json.dumps(json.loads(path.read_text()) | change))
        with pytest.raises(FileError, match=message):
            replay(path)

    @pytest.mark.parametrize(
        ("text", "message"), [("{", "is no JSON"), ("[1]", "format 'list'"), ("{}", "format None")]
    )
    def test_what_is_no_file_of_ours(self, tmp_path, text, message):
        path = tmp_path / "c.json"
        path.write_text(text)
        with pytest.raises(FileError, match=message):
            replay(path)
        with pytest.raises(FileError, match=r"cannot read .*No such file"):
            replay(tmp_path / "none.json")
        path.write_bytes(bytes(range(128, 200)))
        with pytest.raises(FileError, match="is no JSON"):
            replay(path)

    def test_a_missing_entry(self, collision, tmp_path):
        path = collision.save(tmp_path / "c.json")
        data = json.loads(path.read_text())
        del data["p0"]
        path.write_text(json.dumps(data))
        with pytest.raises(FileError, match="is damaged: 'p0'"):
            replay(path)


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
