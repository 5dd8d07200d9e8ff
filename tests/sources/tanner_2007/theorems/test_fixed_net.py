"""A fixed net: connected or not, and which pairs may not meet, on agents by hand."""

from math import exp

import numpy as np
import pytest
from scipy.optimize import brentq

from flockana import FixedNetFlocking
from tests.theorems.made_up import hypothesis, judged, made_up, statuses

NAMES = ["energy", "no-collision", "velocities", "critical"]


def at_rest(edges, *places):
    q = np.array(places)[:, None]
    return made_up(FixedNetFlocking(edges=edges), [q, q, q])


@pytest.mark.parametrize(
    ("edges", "parts"), [(((0, 1), (1, 2)), 1), (((0, 2), (1, 2)), 1), (((0, 1),), 2), (((1, 2),), 2), ((), 3)]
)
def test_a_net_is_connected_or_says_nothing(edges, parts):
    verdict = judged("tanner-fixed", at_rest(edges, 0.0, 1.0, 2.0))
    need = hypothesis(verdict, "connected")
    assert (need.status, need.margin) == ("met" if parts == 1 else "unmet", 1.5 - parts)
    assert need.detail == f"{parts} component(s)"
    assert [claim.name for claim in verdict.claims] == NAMES
    assert (set(statuses(verdict).values()) == {"vacuous"}) == (parts > 1)
    missed = f"'the net is connected' does not hold: {parts} component(s)"
    assert parts == 1 or verdict.claim("energy").detail == missed


def test_those_that_are_joined_may_not_meet_and_the_others_may():
    """Joined at 1.2, twice: V of both is what one may have; the ends, which nothing joins, are at one place."""
    verdict = judged("tanner-fixed", at_rest(((0, 1), (1, 2)), 0.0, 1.2, 0.0))
    claim = verdict.claim("no-collision")

    def lacks(s):
        return 1.0 / s**2 - 1.0 + 2.0 * np.log(s) - 2.0 * (1.0 / 1.44 - 1.0 + 2.0 * np.log(1.2))

    assert (claim.status, claim.computed, claim.proof) == ("verified", pytest.approx(1.2), "tanner")
    assert claim.margin == pytest.approx(1.2 - brentq(lacks, 0.3, 1.0, xtol=1e-14), rel=1e-9)
    assert verdict.claim("energy").proof == "tanner"


def settling(rate):
    """Two that come to their distance at a rate, and slow down by it."""
    t = np.linspace(0.0, 20.0, 201)
    fall = np.exp(-rate * t)[:, None, None] * np.array([[-0.1], [0.1]])
    q = np.array([[-0.5], [0.5]]) + fall
    return made_up(FixedNetFlocking(edges=((0, 1),)), q, -rate * fall, t, rate**2 * fall)


def test_what_comes_to_rest_is_proved_and_its_forces_are_those_of_the_end():
    verdict = judged("tanner-fixed", settling(1.0))
    for name in ("velocities", "critical"):
        claim = verdict.claim(name)
        assert (claim.status, claim.proof, claim.about) == ("verified", "matched-velocities", "limit")
    s = 1.0 + 0.2 * exp(-20.0)
    assert verdict.claim("critical").computed == pytest.approx(abs(-2.0 / s**3 + 2.0 / s), rel=1e-4, abs=0.0)
