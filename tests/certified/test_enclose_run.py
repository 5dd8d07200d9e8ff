"""Tubes: exact solutions, runs in high precision and numerical runs lie in them."""

import mpmath
import numpy as np
import pytest
from flint import arb, ctx

from flockana import Algorithm1, Algorithm2, Algorithm3, Gains, Wall, enclose, simulate
from flockana.base.errors import ArgumentError
from flockana.environment.targets import CircleTarget, LinearTarget, StaticTarget
from tests.certified.conftest import ALONE, oscillator

TOLD = Algorithm2(target=StaticTarget((0.0, 0.0)))
TRIANGLE = np.array([[-4.625, -2.5], [4.5, -2.75], [0.25, 5.5]])


@pytest.fixture(autouse=True)
def precise():
    """What is expected is computed with more digits than the tubes."""
    with ctx.workprec(200):
        yield


@pytest.fixture(scope="module")
def forming():
    """Three agents whose first two links form on the way."""
    return enclose(TOLD, TRIANGLE, 0.0 * TRIANGLE, (0.0, 0.53125))


def inside(run, tube, slack):
    """Whether the samples of a numerical run, at the tube's steps, lie in it but for the run's own error."""
    return all(
        (np.abs(x - y) <= radii + slack).all()
        for x, y, radii in ((run.q, tube.q, tube.radii[:, 0]), (run.p, tube.p, tube.radii[:, 1]))
    )


@pytest.mark.parametrize("order", [4, 9, 16])
def test_one_agent_swings_to_its_target_as_the_closed_form_says(order):
    law, off = Algorithm2(gains=ALONE, target=StaticTarget((0.0,))), 1e-9 if order == 4 else 1e-16
    tube = enclose(law, [[1.0]], [[0.0]], (0.0, 3.0), order=order, remainder=off)
    assert (tube.status, tube.t[-1]) == ("complete", 3.0)
    for k, t in enumerate(tube.t):
        (q,), (p,) = tube.state(k)
        position, velocity = oscillator(t)
        assert q[0].contains(position)
        assert p[0].contains(velocity)
    assert tube.radii.max() < 1e5 * off
    assert tube.min_distance().lower == np.inf


def test_a_target_that_moves_and_one_that_lies_are_followed():
    t = (0.0, 1.0)
    moving = enclose(Algorithm2(gains=ALONE, target=LinearTarget((0.0,), (3.0,))), [[1.0]], [[3.0]], t)
    lying = enclose(Algorithm2(gains=ALONE, target=StaticTarget((0.0,), (1.25,))), [[2.0]], [[0.0]], t)
    position, velocity = oscillator(1.0)
    assert moving.state(-1)[0][0][0].contains(position + 3)
    assert moving.state(-1)[1][0][0].contains(velocity + 3)
    assert lying.state(-1)[0][0][0].contains(position + 1)  # it rests where 1.25 q = 1 · 1.25


@pytest.mark.parametrize("start", [3.0, 5.0, 8.0])
def test_a_run_in_high_precision_is_inside(start):
    """Taylor series of mpmath with its own formulas, on one piece: two agents, by their distance."""
    law = Algorithm1()
    tube = enclose(law, [[0.0], [start]], [[0.0], [0.0]], (0.0, 0.0625))
    with mpmath.workdps(30):
        eps, one = mpmath.mpf(1) / 10, mpmath.mpf(1)
        c1, c2 = mpmath.mpf(30), mpmath.mpf(repr(law.gains.c2_alpha))
        z_of = lambda x: (mpmath.sqrt(1 + eps * x**2) - 1) / eps  # noqa: E731
        d, r = z_of(mpmath.mpf(7)), z_of(mpmath.mpf("8.4"))

        def rate(t, y):
            z = z_of(y[0])
            rho = (1 + mpmath.cos(mpmath.pi * (z / r - one / 5) / (1 - one / 5))) / 2
            force = rho * 5 * (z - d) / mpmath.sqrt(1 + (z - d) ** 2) * y[0] / mpmath.sqrt(1 + eps * y[0] ** 2)
            return [y[1], -2 * c1 * force - 2 * c2 * rho * y[1]]

        y = mpmath.odefun(rate, 0, [mpmath.mpf(start), mpmath.mpf(0)])(mpmath.mpf("0.0625"))
        gap, speed = (arb(mpmath.nstr(x, 30)) for x in y)
    q, p = tube.state(-1)
    for found, expected in ((q[1][0] - q[0][0], gap), (p[1][0] - p[0][0], speed)):
        assert (found + arb(0, "1e-24")).contains(expected)
        assert found.rad() < 1e-12


def test_links_form_on_the_way_and_the_run_stays_inside(forming):
    assert forming.status == "complete"
    beyond = [all(x > 8.4 for x in forming.distances_during(k)) for k in (0, -1)]
    assert beyond == [True, False]
    run = simulate(TOLD, TRIANGLE, 0.0 * TRIANGLE, (0.0, 0.53125), rtol=1e-12, t_eval=forming.t)
    assert inside(run, forming, 1e-10)
    assert forming.radii.max() < 1e-9


def test_what_is_told_of_the_time_between_steps_holds_of_the_run(forming):
    middles = 0.5 * (np.array(forming.t[:-1]) + np.array(forming.t[1:]))
    run = simulate(TOLD, TRIANGLE, 0.0 * TRIANGLE, (0.0, 0.53125), rtol=1e-12, t_eval=middles)
    radius, slack = forming.cohesion_radius(), arb(0, 1e-9)
    for k, (q, p) in enumerate(zip(run.q, run.p, strict=True)):
        values = [*q.ravel(), *p.ravel()]
        assert all((box + slack).contains(arb(x)) for box, x in zip(forming.taken[k].during, values, strict=True))
        for (i, j), distance in zip(forming.pairs, forming.distances_during(k), strict=True):
            assert (distance + slack).contains(arb(float(np.linalg.norm(q[j] - q[i]))))
        assert np.linalg.norm(q - q.mean(axis=0), axis=1).max() <= radius[k] + 1e-9
    least = forming.min_distance()
    assert least.lower <= float(np.linalg.norm(run.q[-1, 1] - run.q[-1, 0])) < least.lower + 0.3


def test_a_box_of_starts_is_followed_as_a_whole():
    law, t = Algorithm1(), (0.0, 0.25)
    wide = 2.0**-10
    tube = enclose(law, [[0.0], [6.5]], [[0.25], [-0.25]], t, radius=(wide, 0.0))
    assert tube.status == "complete"
    for a, b in ((-1, -1), (-1, 1), (1, -1), (1, 1), (0, 0.5)):
        q0 = [[wide * a], [6.5 + wide * b]]
        assert inside(simulate(law, q0, [[0.25], [-0.25]], t, rtol=1e-12, t_eval=tube.t), tube, 1e-9)
    assert tube.radii[0, 0].max() < 1.01 * wide
    assert tube.radii[-1, 0].max() < 5.0 * wide


def test_it_ends_where_it_breaks_and_says_why(capsys):
    few = enclose(TOLD, TRIANGLE, 0.0 * TRIANGLE, (0.0, 1.0), steps=3, progress=True)
    assert (few.status, len(few.taken), few.stats["steps"]) == ("broken", 3, 3)
    assert few.message == "it took 3 steps, as many as it may"
    wide = enclose(Algorithm1(), [[0.0], [9.0]], [[0.0], [0.0]], (0.0, 4.0), radius=(0.0, 0.5))
    assert wide.status == "broken"
    assert wide.message.startswith("the set is wider than 0.2 d at t = ")


@pytest.mark.parametrize(
    ("law", "knobs", "message"),
    [
        (Algorithm2(target=CircleTarget((0.0, 0.0), 1.0, 0.1)), {}, "expected StaticTarget or LinearTarget"),
        (
            Algorithm3(target=StaticTarget((0.0, 0.0)), obstacles=(Wall((0.0, 9.0), (0.0, -1.0)),)),
            {},
            r"obstacles\[0\] = Wall.*expected a Sphere",
        ),
        (Algorithm2(gains=Gains(c1_gamma=(1.0, 2.0)), target=StaticTarget((0.0, 0.0))), {}, "given per agent"),
        (Algorithm1(), {"order": 3}, "order = 3: expected a whole number from 4 to 40"),
        (Algorithm1(), {"steps": 0}, "steps = 0: expected a whole number >= 1"),
        (Algorithm1(), {"radius": (1.0, 2.0, 3.0)}, "expected one, or one of positions and one of velocities"),
        (Algorithm1(), {"radius": -1.0}, "radius = -1"),
        (Algorithm1(), {"remainder": 0.0}, "remainder = 0"),
        ("a law", {}, "expected Algorithm1, 2 or 3"),
    ],
)
def test_what_cannot_be_enclosed_is_said_before_work_starts(law, knobs, message):
    with pytest.raises(ArgumentError, match=message):
        enclose(law, [[0.0, 0.0], [7.0, 0.0]], [[0.0, 0.0], [0.0, 0.0]], (0.0, 1.0), **knobs)


def test_the_energy_of_algorithm_3_is_another():
    tube = enclose(Algorithm3(target=StaticTarget((0.0,))), [[0.0], [9.0]], [[1.0], [2.0]], (0.0, 0.125))
    with pytest.raises(ArgumentError, match="whose structural energy this is"):
        tube.energy(0)
