"""What each theorem asks of a pair law by a formula: a law that breaks one hypothesis alone makes claims vacuous.

Each planted law is the good one with one property broken. The theorem may then claim nothing that rests on it.
"""

from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, compose, pair_law, simulate, theorems, verify
from flockana.interactions.weights import RationalWeight
from flockana.theorems.catalogue import theorem

GOOD = "k*(s - d)**2*(r - s)**2"
WEIGHT = "(1 - s/r)**2"
CENTRE = 110.5 * 3.0 / 256.0
START = np.array([[0.0, 0.0], [1.9, 0.0], [0.9, 1.7]])


def law_of(potential=GOOD, adjacency=WEIGHT):
    used = {"k": 0.5} if "k" in potential.replace("Piecewise", "") else {}
    pair = pair_law(potential, adjacency=adjacency, range=3.0, length=2.0, parameters=used)
    return Algorithm2(pair, Gains(c1_alpha=1.0, c2_alpha=0.5, c1_gamma=0.5, c2_gamma=1.0), StaticTarget((1.0, 0.5)))


BROKEN = {  # hypothesis that it breaks: (part of its name, laws)
    "smooth": (
        "C¹",
        [
            law_of(f"{GOOD} + asin(sin(4*s))*(r - s)**2"),
            law_of(f"{GOOD} + atan(tan(s))*(r - s)**2*s**2"),
            law_of(f"{GOOD} + (r - s)**2/(s - 1.3)**2"),
            law_of(f"{GOOD} + atan(1/(s - 1.3))*(r - s)**2"),
            law_of("k*(s - d)**2"),
        ],
    ),
    "weight": (
        "a_ij >",  # 0, or = 0
        [
            law_of(adjacency="-4*(1 - s/r)**2"),
            law_of(adjacency=f"(1 - s/r)**2*(1 - 2000*exp(-((s - {CENTRE})*1000)**2))"),
            law_of(adjacency=f"(1 - s/r)**2*(1 - 1.1*exp(-((s - {CENTRE})*1000000)**2))"),
        ],
    ),
}
NEEDS = {  # claims that rest on each of them, by theorem
    "energy": {"smooth": ("rate", "balance"), "weight": ("rate",)},
    "cohesion": {"smooth": ("bound",), "weight": ("bound",)},
    "collision-energy": {"smooth": ("below", "twice"), "weight": ("below", "twice")},
    "su-varying": {
        "smooth": ("velocities", "distance", "no-collision"),
        "weight": ("velocities", "distance", "no-collision"),
    },
    "any-potential": dict.fromkeys(("smooth", "weight"), ("cohesion", "velocities", "critical", "one-instant")),
    "os-1": dict.fromkeys(("smooth", "weight"), ("i", "ii", "iii", "iii-barrier")),
    "os-3": dict.fromkeys(("smooth", "weight"), ("i", "ii", "ii-converges", "ii-semidefinite", "iii", "iv-none")),
}
CASES = [(name, what, k) for name, table in NEEDS.items() for what in table for k in range(len(BROKEN[what][1]))]


def verdict_of(name, law):
    if name == "os-1":
        law = Algorithm1(law.alpha, replace(law.gains, c1_gamma=0.0, c2_gamma=0.0))
    return verify(name, simulate(law, START, 0.1 * START[::-1], (0.0, 0.05), rtol=1e-6))


def test_these_are_the_theorems_that_admit_a_formula():
    """A theorem that comes to admit pair laws by formulas has to name here what it asks of them."""
    good = simulate(law_of(), START, 0.0 * START, (0.0, 0.05))
    of_runs = [theorem(name) for name in theorems() if theorem(name).kind == "trajectory"]
    admitting = {one.id for one in of_runs if one.law is not None and one.law(good).status != "unmet"}
    composed = simulate(compose(pair=law_of().alpha, consensus=1.0), START, 0.0 * START, (0.0, 0.05))
    admitting |= {one.id for one in of_runs if one.law is not None and one.law(composed).status != "unmet"}
    assert admitting == {*NEEDS}


@pytest.mark.parametrize("name", NEEDS)
def test_of_the_good_law_nothing_is_asked_in_vain(name):
    verdict = verdict_of(name, law_of())
    assert {one.status for one in verdict.hypotheses if "C¹" in one.name or "a_ij" in one.name} <= {"met"}


@pytest.mark.parametrize(("name", "what", "k"), CASES)
def test_a_law_that_breaks_one_hypothesis_makes_what_rests_on_it_vacuous(name, what, k):
    part, laws = BROKEN[what]
    verdict = verdict_of(name, laws[k])
    missed = [one for one in verdict.hypotheses if one.status == "unmet"]
    assert [part in one.name for one in missed[:1]] == [True]
    assert {claim: verdict.claim(claim).status for claim in NEEDS[name][what]} == dict.fromkeys(
        NEEDS[name][what], "vacuous"
    )


def test_a_coincident_pair_with_less_energy_than_others_bounds_no_collision():
    """ψ(0) = 0 and ψ >= 0: the largest |ψ| is no barrier, and agents on a line pass through each other."""
    pair = pair_law("s**2*(r - s)**2", adjacency=WEIGHT, range=3.0, length=2.0)
    law = Algorithm2(pair, Gains(c1_alpha=1.0, c2_alpha=0.01, c1_gamma=0.5, c2_gamma=0.01), StaticTarget((0.0,)))
    run = simulate(law, [[-1.0], [1.0]], [[0.1], [-0.1]], (0.0, 4.0))
    for name, claim in (("su-varying", "no-collision"), ("collision-energy", "below")):
        assert verify(name, run).claim(claim).status == "vacuous"


def test_a_spike_of_negative_adjacency_is_not_verified_as_dissipation():
    """-646 between two of 257 distances: the energy rises from 0.8287 to 0.8956 where the solver's steps meet it."""
    adjacency = f"(1 - s/r)**2*(1 - 2000*exp(-((s - {CENTRE})*1000)**2))"
    pair = pair_law("2*(s - 2)**2*(r - s)**2*s**2", adjacency=adjacency, range=3.0, length=2.0)
    law = Algorithm1(pair, Gains(c1_alpha=0.05, c2_alpha=0.05))
    run = simulate(law, [[0.0, 0.0], [1.8, 0.0]], [[0.9, 0.0], [-0.9, 0.0]], (0.0, 0.6))
    assert verify("energy", run).claim("rate").status == "vacuous"


def test_a_user_s_weight_is_nonnegative_by_its_proof_only():
    class Unproved(RationalWeight):
        """A weight that names no proof."""

        proof = ""

    for weight, status in ((RationalWeight(), "met"), (Unproved(), "assumed")):
        law = compose(pair=law_of().alpha, consensus=weight)
        found = [one for one in verdict_of("energy", law).hypotheses if "a_ij" in one.name]
        assert [one.status for one in found] == ([] if status == "met" else ["assumed"])
