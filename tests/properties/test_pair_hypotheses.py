"""What each theorem asks of a pair law by a formula: a law that breaks one hypothesis alone makes claims vacuous.

Each planted law is the good one with one property broken. The theorem may then claim nothing that rests on it.
"""

from dataclasses import replace
from functools import cache
from typing import ClassVar

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, compose, simulate, theorem, theorems, verify
from flockana.interactions.weights import RationalWeight
from tests.toys.formulas import breakable

START = np.array([[0.0, 0.0], [1.9, 0.0], [0.9, 1.7]])


def law_of(**changed):
    gains = Gains(c1_alpha=1.0, c2_alpha=0.5, c1_gamma=0.5, c2_gamma=1.0)
    return Algorithm2(breakable(**changed), gains, StaticTarget((1.0, 0.5)))


BROKEN = {  # hypothesis: part of its name, and what breaks it; how else a formula breaks, symbolic/test_pair_facts.py
    "smooth": ("C¹", {"b": 0.1}),  # the force jumps at the range
    "weight": ("a_ij >", {"c": 2000.0}),  # 0, or = 0: negative between two of 257 distances
}
NEEDS = {  # claims that rest on each of them, by theorem
    "energy": {"smooth": ("rate", "balance"), "weight": ("rate",)},
    "cohesion": dict.fromkeys(BROKEN, ("bound",)),
    "collision-energy": dict.fromkeys(BROKEN, ("below", "twice")),
    "su-varying": dict.fromkeys(BROKEN, ("velocities", "distance", "no-collision")),
    "any-potential": dict.fromkeys(BROKEN, ("cohesion", "velocities", "critical", "one-instant")),
    "os-1": dict.fromkeys(BROKEN, ("i", "ii", "iii", "iii-barrier")),
    "os-3": dict.fromkeys(BROKEN, ("i", "ii", "ii-converges", "ii-semidefinite", "iii", "iv-none")),
}


@cache
def run_of(law):
    return simulate(law, START, 0.1 * START[::-1], (0.0, 0.05), rtol=1e-6)


def verdict_of(name, law):
    if name == "os-1":
        law = Algorithm1(law.alpha, replace(law.gains, c1_gamma=0.0, c2_gamma=0.0))
    return verify(name, run_of(law))


def test_these_are_the_theorems_that_admit_a_formula():
    good = simulate(law_of(), START, 0.0 * START, (0.0, 0.05))
    of_runs = [
        theorem(name) for name in theorems() if theorem(name).kind == "trajectory" and not theorem(name).on_motion
    ]
    admitting = {one.id for one in of_runs if one.law is not None and one.law(good).status != "unmet"}
    composed = simulate(compose(pair=law_of().alpha, consensus=1.0), START, 0.0 * START, (0.0, 0.05))
    admitting |= {one.id for one in of_runs if one.law is not None and one.law(composed).status != "unmet"}
    assert admitting == {*NEEDS}


@pytest.mark.parametrize("name", NEEDS)
def test_of_the_good_law_nothing_is_asked_in_vain(name):
    verdict = verdict_of(name, law_of())
    assert name != "energy" or verdict.status == "verified"
    assert {one.status for one in verdict.hypotheses if "C¹" in one.name or "a_ij" in one.name} <= {"met"}


@pytest.mark.parametrize("what", BROKEN)
@pytest.mark.parametrize("name", NEEDS)
def test_a_law_that_breaks_one_hypothesis_makes_what_rests_on_it_vacuous(name, what):
    part, broken = BROKEN[what]
    verdict, claims = verdict_of(name, law_of(**broken)), NEEDS[name][what]
    missed = [one for one in verdict.hypotheses if one.status == "unmet"]
    assert [part in one.name for one in missed[:1]] == [True]
    assert {claim: verdict.claim(claim).status for claim in claims} == dict.fromkeys(claims, "vacuous")


def test_a_coincident_pair_with_less_energy_than_others_bounds_no_collision():
    """ψ(0) = 0 and ψ >= 0: the largest |ψ| is no barrier, and agents on a line pass through each other."""
    gains = Gains(c1_alpha=1.0, c2_alpha=0.01, c1_gamma=0.5, c2_gamma=0.01)
    law = Algorithm2(breakable(e=0.0), gains, StaticTarget((0.0, 0.0)))
    run = simulate(law, [[-1.0, 0.0], [1.0, 0.0]], [[0.1, 0.0], [-0.1, 0.0]], (0.0, 4.0))
    for name, claim in (("su-varying", "no-collision"), ("collision-energy", "below")):
        assert verify(name, run).claim(claim).status == "vacuous"


def test_a_user_s_weight_is_nonnegative_by_its_proof_only():
    class Unproved(RationalWeight):
        """A weight that names no proof."""

        proofs: ClassVar[dict[str, str]] = {}

    for weight, status in ((RationalWeight(), "met"), (Unproved(), "assumed")):
        law = compose(pair=law_of().alpha, consensus=weight)
        found = [one for one in verdict_of("energy", law).hypotheses if "a_ij" in one.name]
        assert [one.status for one in found] == ([] if status == "met" else ["assumed"])
