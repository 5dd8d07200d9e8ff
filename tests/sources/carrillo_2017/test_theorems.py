"""A singular weight: its force and facts, runs that end at a contact, and the speed of contact of a pair."""

from math import exp, log

import numpy as np
import pytest

import flockana as fl
from flockana import SingularAlignment, SingularWeight, verify
from tests.refused import refused
from tests.theorems.made_up import statuses

HALF = SingularAlignment(SingularWeight(decay=0.5))
PAIR = [[0.0], [1.0]]


def closing(speed, law=HALF, end=2.0, **how):
    """A run of two agents, 1 apart, that approach."""
    return fl.simulate(law, PAIR, [[0.0], [-speed]], (0.0, end), **how)


def test_weight_slope_and_facts():
    weight, s = SingularWeight(3.0, 1.5, 2.0), np.array([0.1, 2.0, 50.0])
    np.testing.assert_allclose(weight(s), 3.0 * (2.0 / s) ** 1.5, rtol=1e-14)
    np.testing.assert_allclose(weight.values(s).adjacency_slope, -1.5 * weight(s) / s, rtol=1e-14)
    assert weight(0.0) == np.inf
    assert not weight.coincidence
    assert "at 0 it has a pole" in weight.facts.smooth.detail
    bounds = weight.slopes()
    assert (bounds[0].left, bounds[0].adjacency, bounds[-1].right) == (0.0, np.inf, np.inf)
    inner = bounds[5]
    assert inner.adjacency == pytest.approx(1.5 * weight(inner.left) / inner.left, rel=1e-10)


def test_laws_know_the_pole_of_their_weight():
    assert HALF.poles == fl.compose(consensus=SingularWeight()).poles == (0.0,)
    assert fl.CuckerSmale().poles == ()
    np.testing.assert_allclose(HALF.jacobian(0.0, [[0.0], [4.0]], [[1.0], [-2.0]])[2], [-3 / 16, 3 / 16, -0.5, 0.5])


@pytest.mark.parametrize("how", [{}, {"method": "scipy-DOP853"}], ids=str)
def test_a_run_ends_at_a_contact_and_names_pair_and_time(how):
    """Of w = -5: 1/2 - ln(5)/8 = 0.298820, at the relative speed 1."""
    q, p = [[3.0], [0.0], [1.0]], [[0.0], [2.5], [-2.5]]
    run = closing(5.0, **how)
    assert run.status == "failed"
    assert run.t[-1] == pytest.approx(0.5 - log(5.0) / 8.0, rel=1e-3)
    assert f"t = {run.t[-1]:.4g}"[:9] in run.message
    assert "; the nearest agents, 0 and 1, are " in run.message
    assert np.ptp(run.p[-1]) == pytest.approx(1.0, rel=1e-2)
    others = fl.simulate(SingularAlignment(SingularWeight(0.1, 0.5)), q, p, (0.0, 2.0), **how)
    assert "; the nearest agents, 1 and 2, are " in others.message


def test_below_the_speed_of_contact_the_distance_has_the_limit_of_the_invariant():
    """√x_∞ = (4 − 3.9)/4."""
    run = closing(3.9)
    assert np.ptp(run.q[-1]) == pytest.approx(0.025**2, rel=1e-6)
    strong = closing(5.0, SingularAlignment(), end=4.0)  # α = 1: w + 2 ln x stays
    assert np.ptp(strong.q[-1]) == pytest.approx(exp(-2.5), rel=1e-6)


@pytest.mark.parametrize(("speed", "meets"), [(4.0 * (1 - 1e-12), False), (4.0, True), (4.0 * (1 + 1e-12), True)])
def test_the_pair_is_decided_at_its_threshold(speed, meets):
    verdict = verify("singular-pair", law=HALF, q0=PAIR, p0=[[0.0], [-speed]], t_span=(0.0, 0.2))
    sides = ("verified", "vacuous") if meets else ("vacuous", "verified")
    assert (verdict.claim("meet").status, verdict.claim("apart").status) == sides
    if speed == 4.0:
        assert verdict.claim("meet").stated == "they meet at t = 0.5, at a relative speed of 0"


def test_a_run_that_ended_at_the_contact_is_judged_too():
    verdict = verify("singular-pair", closing(5.0))
    assert statuses(verdict) == {"meet": "verified", "apart": "vacuous"}
    assert verdict.claim("meet").computed == pytest.approx(0.29882, rel=1e-3)
    other = closing(5.0, end=0.2)
    later = verify("singular-pair", law=HALF, q0=PAIR[::-1], p0=[[0.0], [5.0]], t_span=(0.0, 0.2))
    assert later.claim("meet").status == verify("singular-pair", other).claim("meet").status == "verified"


test_what_is_refused = refused(
    (lambda: SingularWeight(decay=0.0), "decay = 0"),
    (lambda: SingularAlignment(fl.RationalWeight()), "expected SingularWeight"),
    (lambda: fl.simulate(HALF, [[1.0], [1.0]], PAIR, (0.0, 1.0)), "agents 0 and 1 coincide: the alignment weight has"),
)


def test_a_pair_that_meets_at_rest_or_nearly_is_judged():
    """At w = −4 both end at one place to the last bit, where the law has no input: that was taken for an edited run."""
    for speed in (4.0, 4.0000001):
        assert statuses(verify("singular-pair", closing(speed, end=20.0))) == {"meet": "verified", "apart": "vacuous"}
