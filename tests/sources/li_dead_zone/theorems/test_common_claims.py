"""What both dead-zone theorems say of distances and of velocities, on motions by hand."""

from math import inf, log

import numpy as np
import pytest

from flockana import Algorithm1, DeadZoneFlocking, DeadZoneInteraction, SemiImplicitEuler
from flockana.sources.li_dead_zone.theorems import common_claims as case
from flockana.theorems.theorem_toolkit import Enclosure, Observed
from tests.theorems.made_up import made_up as made_up_run

EPS, LAW = np.finfo(float).eps, DeadZoneFlocking()
PATH = 1e-5  # a path's least distance is bounded from below to some 1e-6 of it
STEPS = SemiImplicitEuler(LAW, 1.0)


def made_up(*args, **kwargs):
    return Observed.alone(made_up_run(*args, **kwargs))


def no_collision(seen, bound):
    return case.no_collision(seen, LAW, Enclosure.of(bound), [], name="distance")


def passing(law, beside):
    """Two agents that pass each other in a second, free of forces: 4 apart along x at both ends, and so far beside."""
    q = np.array([[[-2.0, 0.0], [2.0, beside]], [[2.0, 0.0], [-2.0, beside]]])
    p = np.array([[4.0, 0.0], [-4.0, 0.0]])
    return made_up(law, q, [p, p])


@pytest.mark.parametrize("bound", [1e-30, 0.5, 2.9, 3.1])
def test_the_margin_is_the_logarithm_of_the_distance_over_the_bound(bound):
    claim = no_collision(passing(LAW, 3.0), bound)
    assert claim.margin == pytest.approx(log(3.0 / bound), abs=PATH)
    assert 0.0 < claim.error < PATH
    assert claim.status == ("verified" if bound < 3.0 else "inconclusive")
    assert (claim.rigour, claim.contradicts) == (("smt", "") if bound < 3.0 else ("numeric", "dead-zone"))
    assert 3.0 - PATH <= claim.computed <= 3.0
    assert claim.witness["time"] == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize("size", [1e6, 1.0, 1e-3, 1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_bound_is_never_misjudged_and_is_open_within_the_noise(size, sign):
    """Two agents of a map 3 apart, and a bound of 3 (1 − size) or 3/(1 − size): what is true and what is false."""
    bound = 3.0 / (1.0 + size) if sign > 0.0 else 3.0 * (1.0 + size)
    q = np.array([[[0.0], [3.0]]] * 2)
    claim = no_collision(made_up(STEPS, q), bound)
    assert claim.status == ("verified" if sign > 0.0 else "refuted")
    far = no_collision(made_up(STEPS, q + 1e4), bound)  # where places are known to 1e-12
    assert far.status == ("inconclusive" if size < 1e-11 else claim.status)


def test_without_a_bound_it_is_the_distance_in_units():
    claim = no_collision(passing(LAW, 3.0), 0.0)
    assert claim.margin == pytest.approx(3.0 / LAW.scales.length, abs=PATH)
    assert 0.0 < claim.error < PATH
    assert claim.status == "verified"


@pytest.mark.parametrize(("law", "least"), [(LAW, 3.0), (STEPS, 5.0)])
def test_a_map_has_nothing_between_its_samples(law, least):
    assert no_collision(passing(law, 3.0), 1.0).computed == pytest.approx(least, abs=PATH)


def test_one_sample_of_a_flow_shows_no_distance_between_samples():
    run = passing(LAW, 3.0).run
    claim = no_collision(made_up(LAW, run.q[:1], run.p[:1]), 1.0)
    assert (claim.rigour, claim.computed, claim.witness["time"]) == ("smt", 0.0, 0.0)  # by the proof alone
    assert claim.margin - claim.error < 0.0


@pytest.mark.parametrize("bound", [0.5, 0.0])
def test_agents_that_coincide_refute_a_bound_and_decide_nothing_without_one(bound):
    assert no_collision(passing(STEPS, 0.0), bound).status == "verified"  # the samples alone
    claim = no_collision(made_up(STEPS, np.zeros((2, 2, 1))), bound)
    assert claim.status == ("refuted" if bound else "inconclusive")
    assert claim.error == (0.0 if bound else inf)  # towards 0: that ln 0 is far below ln ½ is certain
    assert claim.margin <= 0.0


def test_one_agent_has_no_distances_and_far_from_the_origin_they_are_less_exact():
    for bound in (0.0, 1.0):
        claim = no_collision(made_up(LAW, np.zeros((2, 1, 2))), bound)
        assert (claim.margin, claim.error, claim.status) == (1.0, 0.0, "verified")
    run = passing(STEPS, 3.0).run
    near, far = (no_collision(made_up(STEPS, run.q + x, run.p), 1.0).error for x in (0.0, 1e9))
    assert near < 1e-14
    assert far == pytest.approx(4.0 * EPS * 1e9 / 5.0, rel=0.2, abs=0.0)


def test_the_bound_is_that_of_the_energy_at_the_start():
    q, p = np.array([[[0.0], [5.0]]] * 2), np.array([[[-3.0], [3.0]]] * 2)
    bound = case.distance_bound(made_up(LAW, q, p), LAW)
    exact = LAW.interaction.least_distance(9.0 + float(LAW.interaction.energy(5.0)))
    assert bound.lo < exact < bound.hi
    assert bound.half_width == pytest.approx(1e-9 * exact, rel=1e-3, abs=0.0)


def test_the_law_is_that_of_its_steps_and_no_other():
    class Other(DeadZoneInteraction):
        pass

    q = np.array([[[0.0], [5.0]]] * 2)
    assert case.dead_zone_law(made_up(LAW, q)) is LAW
    assert case.dead_zone_law(made_up(STEPS, q)) is LAW
    assert case.dead_zone_law(made_up(DeadZoneFlocking(Other()), q)) is None
    assert case.dead_zone_law(made_up(Algorithm1(), q)) is None
    assert [case.applied(made_up(law, q)).status for law in (LAW, STEPS, Algorithm1())] == ["met", "met", "unmet"]
    apart, together = (case.hypotheses(made_up(LAW, x))[0] for x in (q, 0.0 * q))
    assert (apart.status, apart.margin, together.status) == ("met", 5.0, "unmet")


@pytest.mark.parametrize("speed", [0.25, 3.0])
def test_two_that_part_keep_half_the_square_of_their_speed(speed):
    """16 apart, 1 beyond the range of 15, and each at its own velocity for ever: the lesser of 1/15 and the drift."""
    q, p = np.array([[0.0], [16.0]]), np.array([[-speed], [speed]])
    run = made_up(LAW, [q - p, q, q + p], [0.5 * p, p, p])
    end = case.final_components(run, LAW)
    gap = (16.0 + 2.0 * speed - 15.0) / 15.0
    claim = case.velocities_match(run, end, [], name="velocity")
    assert claim.status == "refuted"
    assert claim.margin == pytest.approx(-min(gap, 0.5 * speed**2 / LAW.scales.speed**2), rel=1e-9)
    assert claim.computed == pytest.approx(0.5 * speed**2, rel=1e-12)
    assert claim.witness == {"time": 2.0, "K̃ at the start": pytest.approx(0.125 * speed**2)}
    assert case.settling(end).margin == pytest.approx(min(gap, 1.0), rel=1e-9)


def test_one_component_settles_if_its_energy_cannot_break_it():
    """Two agents at rest in the dead zone, where only k₁ pulls: their energy is less than ψ(r)."""
    q = np.array([[[0.0], [5.0]]] * 2)
    run = made_up(LAW, q)
    claim = case.velocities_match(run, case.final_components(run, LAW), [], name="velocity")
    share = float(LAW.interaction.energy(5.0)) / LAW.interaction.far_potential
    assert claim.status == "verified"
    assert claim.margin == pytest.approx(1.0 - share, rel=1e-9)
