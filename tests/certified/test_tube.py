"""What a tube says of a run that is known exactly: bounds are attained, and rounded to the safe side."""

import sys
from dataclasses import replace
from itertools import islice
from types import SimpleNamespace

import pytest
from flint import arb, ctx

from flockana import Algorithm1, Algorithm2, Algorithm3, Gains, LinearTarget, Sphere, StaticTarget, enclose, simulate
from flockana.certified.tube import down, up
from tests.certified.conftest import ALONE, oscillator

MODULE = sys.modules[enclose.__module__]  # which has the function's name
FREE = Gains(c1_alpha=0.0, c2_alpha=0.0, c1_beta=0.0, c2_beta=0.0, c1_gamma=0.0, c2_gamma=0.0)


@pytest.fixture(autouse=True)
def precise():
    with ctx.workprec(200):
        yield


@pytest.fixture(scope="module")
def meeting():
    """Three agents on a line, out of range: two come nearer, by 2 in a time unit, and one leaves."""
    return enclose(Algorithm1(), [[0.0], [20.0], [40.0]], [[1.0], [-1.0], [3.0]], (0.0, 4.0))


def test_the_least_distance_is_that_of_the_nearest_pair_at_its_time(meeting):
    found = meeting.min_distance()
    assert 11.0 < found.lower <= 12.0
    assert (found.pair, found.time) == ((0, 1), meeting.t[-2])
    assert enclose(Algorithm1(), [[0.0], [20.0]], [[1.0], [3.0]], (0.0, 1.0)).min_distance()[1:] == ((0, 1), 0.0)
    for k, end in enumerate(meeting.t[1:]):
        near, far, _ = meeting.distances_during(k)
        assert near.contains(20 - 2 * arb(end))
        assert far.contains(40 + 2 * arb(end))


def test_the_radius_of_each_step_is_that_at_its_end(meeting):
    """The centre moves by 1 in a time unit, so that the last agent is 20 + 2t from it, and none farther."""
    for radius, end in zip(meeting.cohesion_radius(), meeting.t[1:], strict=True):
        assert 20.0 + 2.0 * end <= radius < 20.0 + 2.5 * end


def test_the_energy_of_free_motion_is_the_same_all_the_time(meeting):
    """½ Σ (v − v_c)², v − v_c = 0, −2 and 2, and three pairs out of range."""
    law = meeting.law
    exact = 4 + 3 * 30 * arb(float(law.alpha.far_potential))
    for ball in (meeting.energy(0), meeting.energy(-1)):
        assert abs(ball - exact) < 1e-9


def test_the_least_clearance_is_attained():
    """An agent that nothing moves flies by a disc of radius 1, whose centre it passes at 3; another one stays away."""
    spheres = Sphere((9.0, 50.0), 2.0), Sphere((0.0, 0.0), 1.0)
    law = Algorithm3(gains=FREE, target=StaticTarget((0.0, 0.0)), obstacles=spheres)
    tube = enclose(law, [[-2.0, 3.0], [60.0, 40.0]], [[1.0, 0.0], [0.0, 0.0]], (0.0, 2.5))
    found = tube.min_clearance()
    assert 2.0 - 1e-3 < found.lower <= 2.0
    assert (found.agent, found.obstacle) == (0, 1)
    assert found.time <= 2.0
    still = enclose(law, [[0.0, 4.0], [60.0, 40.0]], [[0.0, 0.0], [0.0, 0.0]], (0.0, 0.5)).min_clearance()
    assert (still.agent, still.obstacle) == (0, 1)
    assert 3.0 - 1e-12 < still.lower <= 3.0
    start = replace(tube, t=tube.t[:1], sets=tube.sets[:1], taken=()).min_clearance()  # it broke at once
    assert (start.agent, start.obstacle, start.time) == (0, 1, 0.0)
    assert 13.0**0.5 - 1.0 - 1e-12 < start.lower <= 13.0**0.5 - 1.0


@pytest.mark.parametrize(("number", "by"), [(1, 3), (-1, 3), (2, 3), (10**30, 7), (0, 1)])
def test_floats_are_on_the_safe_side(number, by):
    """Of a third, the nearest float is below; of a seventh, above."""
    x = arb(number) / by
    assert arb(down(x)) < x < arb(up(x))
    assert up(x) - down(x) <= 2.0**-51 * abs(float(x)) + 1e-300


def test_a_tube_ends_in_a_basin_of_its_own_law_only(meeting):
    other = Algorithm1(gains=Gains(c1_alpha=29.0))
    for law, holds, inside in ((Algorithm1(), True, True), (other, True, False), (Algorithm1(), False, False)):
        basin = SimpleNamespace(ensure_unedited=lambda: None, law=law, holds=lambda q, p, holds=holds: holds)
        assert meeting.ends_in(basin) is inside


def test_a_run_that_starts_later_follows_the_target_from_there():
    law = Algorithm2(gains=ALONE, target=LinearTarget((0.0,), (3.0,)))
    tube = enclose(law, [[7.0]], [[3.0]], (2.0, 3.0))
    assert (tube.status, tube.message, tube.t[0], tube.t[-1]) == ("complete", "", 2.0, 3.0)
    assert tube.state(-1)[0][0][0].contains(oscillator(1.0)[0] + 9)


def test_a_switch_that_is_crossed_later_is_crossed_under_the_target_of_then():
    """A link forms 1.5 ms after t = 2, when the target is at 6 and not at 0."""
    law, q, p = Algorithm2(target=LinearTarget((0.0,), (3.0,))), [[1.8], [10.2015]], [[3.0], [2.0]]
    tube = enclose(law, q, p, (2.0, 2.0078125))
    run = simulate(law, q, p, (2.0, 2.0078125), rtol=1e-12, atol=1e-12)
    assert (abs(run.q[-1] - tube.q[-1]) <= tube.radii[-1, 0] + 1e-9).all()
    assert (abs(run.p[-1] - tube.p[-1]) <= tube.radii[-1, 1] + 1e-8).all()


def test_one_radius_is_that_of_places_and_of_velocities():
    tube = enclose(Algorithm2(gains=ALONE, target=StaticTarget((0.0,))), [[1.0]], [[0.0]], (0.0, 0.125), radius=0.25)
    q, p = (state[0][0] for state in tube.state(0))
    for ball, middle in ((q, 1.0), (p, 0.0)):
        assert all(ball.overlaps(arb(middle + off)) for off in (-0.25, 0.25))
        assert not any(ball.overlaps(arb(middle + off)) for off in (-0.26, 0.26))


def test_a_tube_that_was_interrupted_holds_what_it_has_and_says_so(monkeypatch):
    steps = MODULE._March.steps

    def stopped(*given):
        yield from islice(steps(*given), 2)
        raise KeyboardInterrupt

    monkeypatch.setattr(MODULE._March, "steps", stopped)
    tube = enclose(Algorithm2(gains=ALONE, target=StaticTarget((0.0,))), [[1.0]], [[0.0]], (0.0, 3.0))
    assert (tube.status, len(tube.taken), len(tube.t)) == ("interrupted", 2, 3)
    assert tube.message == f"interrupted: it ends at t = {tube.t[-1]:g}"
