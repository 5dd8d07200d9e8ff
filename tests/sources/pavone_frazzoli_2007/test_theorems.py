"""The theorem on cyclic pursuit: three sides of the critical angle, starts without a part that grows, scenarios."""

import numpy as np
import pytest

import flockana as fl
from flockana.scenarios import scenario
from tests.theorems.made_up import statuses

Q = np.random.default_rng(5).normal(size=(10, 2))
SIDES = ("meet", "circle", "spread")


@pytest.mark.parametrize(("n", "critical"), [(2, 90.0), (3, 60.0), (5, 36.0), (8, 22.5), (10, 18.0)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_three_sides_of_the_critical_angle(n, critical, sign):
    for side, off in zip(SIDES, (1.0 - 1e-13, 1.0, 1.0 + 1e-13), strict=True):
        law = fl.CyclicPursuit(1.0, sign * critical * off)
        told = statuses(fl.verify("cyclic-pursuit", law=law, q0=Q[:n], t_span=(0.0, 1.0)))
        assert [told[name] for name in SIDES] == ["verified" if name == side else "vacuous" for name in SIDES]
        assert told["centroid"] == told["motion"] == "verified"


def test_a_start_that_has_no_part_in_a_growing_mode_does_not_spread():
    """At 50° of four agents the mode 3 alone grows; the corners of a square in turn are the mode 1."""
    law, square = fl.CyclicPursuit(1.0, 50.0), np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    told = statuses(fl.verify("cyclic-pursuit", law=law, q0=square, t_span=(0.0, 5.0)))
    assert told["spread"] in ("inconclusive", "vacuous")
    told = statuses(fl.verify("cyclic-pursuit", law=law, q0=square[::-1], t_span=(0.0, 5.0)))
    assert told["spread"] == "verified"


def test_scenarios_say_what_is_expected_of_them():
    for name in ("pursuit-meet", "pursuit-below", "pursuit-circle", "pursuit-spread"):
        item = scenario(name)
        run = item.run()
        assert [line for verdict in item.verify(run) for line in item.surprises(verdict)] == []
    radius = run.metric("cohesion_radius")  # the mode 3 grows at 2 sin 45° sin 5°
    rate = 2.0**0.5 * np.sin(np.radians(5.0))
    late = run.t > 14.0
    assert np.polyfit(run.t[late], np.log(radius[late]), 1)[0] == pytest.approx(rate, rel=0.01)
