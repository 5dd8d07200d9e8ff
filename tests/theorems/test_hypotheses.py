"""The shared parts of verdicts: which law it is, what lies below what, and how far rounding can move either."""

import numpy as np
import pytest

import flockana as fl
from flockana import Algorithm1, Algorithm2, AlphaInteraction, DeadZoneFlocking, Gains, Trajectory
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.hypotheses import alpha_gain, common_gains, has_lattice, law_is, positive, positive_room


def run_of(law, n=2):
    q = np.zeros((2, n, 2))
    return Trajectory(np.array([0.0, 1.0]), q, q, q, law)


@pytest.mark.parametrize(
    ("law", "exact"),
    [
        (Algorithm1(), True),
        (type("Mine", (Algorithm1,), {})(), False),
        (Algorithm1(alpha=type("Softer", (AlphaInteraction,), {})()), False),
        (Algorithm1(gains=type("Mine", (Gains,), {})()), False),
        (Algorithm2(target=fl.StaticTarget((0.0, 0.0))), False),
    ],
    ids=["itself", "a subclass", "another pair law", "other gains", "another law"],
)
def test_a_theorem_is_about_exactly_its_law(law, exact):
    found = law_is("Algorithm 1", Algorithm1)(run_of(law))
    assert found.status == ("met" if exact else "unmet")
    assert type(law).__name__ in found.detail


def test_gains_that_a_theorem_needs():
    target = fl.StaticTarget((0.0, 0.0))
    run = run_of(Algorithm2(gains=Gains(c1_gamma=0.0, c2_gamma=2.0), target=target))
    found = positive(run, c1_gamma="c1γ", c2_gamma="c2γ")
    assert (found.name, found.status, found.margin) == ("c1γ > 0 and c2γ > 0", "unmet", 0.0)
    assert common_gains(run).status == "met"
    each = run_of(Algorithm2(gains=Gains(c1_gamma=[1.0, 2.0]), target=target))
    assert common_gains(each).status == "unmet"
    assert [need.name for need in alpha_gain(each)] == ["one c1γ and one c2γ for all agents", "c1α > 0"]
    assert [need.name for need in alpha_gain(run_of(Algorithm1()))] == ["c1α > 0"]


def test_the_law_of_a_theorem_is_declared_before_there_is_a_run():
    target = fl.StaticTarget((0.0, 0.0))
    each = run_of(Algorithm2(gains=Gains(c1_gamma=[1.0, 2.0]), target=target))
    one, two = law_is("Algorithm 2", Algorithm2), law_is("Algorithm 2", Algorithm2, one_gain=True)
    assert (one(each).name, one(each).status) == ("Algorithm 2 is applied", "met")
    assert (two(each).name, two(each).status) == ("one c1γ and one c2γ for all agents", "unmet")
    assert two(run_of(Algorithm2(target=target))) == one(run_of(Algorithm2(target=target)))
    other = run_of(Algorithm1())
    assert (two(other).name, two(other).status, one(other).status) == ("Algorithm 2 is applied", "unmet", "unmet")
    assert has_lattice(other).status == "met"
    assert has_lattice(run_of(DeadZoneFlocking())).status == "unmet"


def test_equal_but_for_rounding_is_neither_below_nor_above():
    found = [positive_room("x < 1", 1.0 - Enclosure.around(value, 0.1), "") for value in (0.8, 0.95, 1.05, 1.2)]
    assert [need.status for need in found] == ["met", "assumed", "assumed", "unmet"]
    assert [need.error for need in found] == pytest.approx([0.1] * 4)
