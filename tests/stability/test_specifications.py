"""Gains from specifications: closed forms of one agent, what binds, a flock, bad input."""

from math import exp, pi, sqrt

import pytest

from flockana.base.errors import ArgumentError
from flockana.environment.targets import StaticTarget
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.stability import delay_margin, delay_system, sampling_margin
from flockana.stability.specifications import Specifications, specified_gains

ONE = Algorithm2(target=StaticTarget((0.0,)))


def test_decay_alone_wants_critical_damping_at_the_largest_gain():
    """Within c2γ <= 4 and c1γ <= 4 the rate is at most 2."""
    found = specified_gains(ONE, [[0.0]], Specifications(decay=1.0), bounds=(0.1, 4.0))
    assert found.reached["decay"] == pytest.approx(2.0, rel=0.02)
    assert (found.met, found.binding) == (True, "decay")


def test_decay_and_period_pull_apart_and_both_bind():
    """A hold bears 2/c2γ or 2 c2γ/c1γ, the rate is c2γ/2 at most: their product is at most 1."""
    found = specified_gains(ONE, [[0.0]], Specifications(decay=2.0, period=0.5))
    assert found.room["decay"] == pytest.approx(found.room["period"], abs=0.05)
    assert found.reached["decay"] * found.reached["period"] == pytest.approx(1.0, rel=0.05)


def test_overshoot_is_that_of_the_damping_ratio():
    found = specified_gains(ONE, [[0.0]], Specifications(overshoot=0.1, decay=0.5))
    gains = found.gains
    ratio = gains.c2_gamma / (2.0 * sqrt(gains.c1_gamma))
    exact = exp(-pi * ratio / sqrt(1.0 - ratio**2)) if ratio < 1.0 else 0.0
    assert found.reached["overshoot"] == pytest.approx(exact)
    assert found.met


def test_a_flock_does_what_is_said_of_it():
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    pair = [[0.0, 0.0], [7.0, 0.0]]
    found = specified_gains(law, pair, Specifications(delay=0.01, h2=1.0), bounds=(0.5, 4.0), grid=2)
    from dataclasses import replace

    from flockana.equilibria import find_equilibrium

    chosen = replace(law, gains=found.gains)
    rest = find_equilibrium(chosen, pair).q
    assert found.reached["delay"] == pytest.approx(delay_margin(delay_system(chosen, rest)).delay, rel=1e-6)
    assert found.binding == min(found.room, key=found.room.get)
    assert sampling_margin(chosen, rest).period > 0.0


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (Specifications, "no specification is given"),
        (lambda: Specifications(decay=0.0), "decay = 0"),
        (lambda: specified_gains(Algorithm1(), [[0.0]], Specifications(decay=1.0)), "expected Algorithm2"),
        (lambda: specified_gains(ONE, [[0.0]], {"decay": 1.0}), "expected Specifications"),
        (
            lambda: specified_gains(ONE, [[0.0]], Specifications(decay=1.0), bounds=(2.0, 1.0)),
            "expected least < greate",
        ),
    ],
)
def test_bad_input(call, message):
    with pytest.raises(ArgumentError, match=message):
        call()
