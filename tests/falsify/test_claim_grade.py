"""Grades: a run is the lower the nearer it comes to refuting a claim."""

from functools import cache

import numpy as np
import pytest

from flockana import Algorithm1, Trajectory, falsify, scenario
from flockana.base.errors import ArgumentError
from flockana.falsify.bounded_space import search_space
from flockana.falsify.claim_grade import FAILED, grade, shortfall
from flockana.falsify.point_evaluation import Evaluation, Problem, units
from flockana.theorems import Claim, Hypothesis, Tolerances, Verdict, theorem, theorems, verify
from flockana.theorems.claims import judged
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.search_objectives import bridge, pairs_apart, squash, strained
from tests.falsify.conftest import HEAD_ON, OWN


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
        assert shortfall([Hypothesis("a", "assumed", -1.0), Hypothesis("b", "unmet", float("nan"))]) == 1.0

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
        assert Evaluation(0.0, "i", Verdict("x", (), (claim,))).status == "inconclusive"

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
                with pytest.raises(ArgumentError, match="which no start meets; expected a theorem about this law"):
                    falsify(name, begin, budget=1)

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
