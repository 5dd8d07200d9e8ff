"""The centre of mass against its closed form, on motions by hand."""

from math import exp

import numpy as np
import pytest

from flockana import Algorithm2, AlphaInteraction, CircleTarget, Gains, StaticTarget, compose, pair_law
from flockana.sources.su_2009.theorems.leader_frame import as_the_leader_sees
from flockana.sources.su_2009.theorems.varying_velocity import centre_of, convergence_rate
from flockana.theorems.observed_run import Observed
from tests.theorems.made_up import hypothesis, judged, made_up, statuses

EPS = np.finfo(float).eps
LAW = Algorithm2(gains=Gains(c1_gamma=1.0, c2_gamma=2.0), target=StaticTarget((3.0, 0.0)))  # critically damped
CIRCLE = CircleTarget((0.0, 0.0), 9.0, 0.05)
OTHER = pair_law("k*(s-d)**2*(s-r)**2/2", adjacency="(1-s/r)**2", range=8.4, length=7.0, parameters={"k": 1.0})
APART = np.array([[0.0, 3.5], [0.0, -3.5]])


def critical(z, v, t):
    """The solution of z'' = −z − 2z', and its derivative."""
    return (z + (z + v) * t) * exp(-t), (v - (z + v) * t) * exp(-t)


def centre_and_form(run):
    return centre_of(as_the_leader_sees(Observed.alone(run)).run)


def motion(path, times=(0.0, 1.0, 2.0)):
    """Two agents whose centre goes as told, 3 beside the γ-agent."""
    centres = [path(t) for t in times]
    q = [APART + np.array([3.0 + z, 0.0]) for z, _ in centres]
    return made_up(LAW, q, [np.tile([v, 0.0], (2, 1)) for _, v in centres], t=times)


@pytest.mark.parametrize(
    ("c1", "c2", "rate"), [(1.0, 2.0, 1.0), (4.0, 5.0, 1.0), (6.0, 5.0, 2.0), (25.0, 6.0, 3.0), (0.0, 5.0, 0.0)]
)
def test_the_rate_is_that_of_the_slower_root(c1, c2, rate):
    assert convergence_rate(Gains(c1_gamma=c1, c2_gamma=c2)) == pytest.approx(rate, rel=1e-12)


@pytest.mark.parametrize(("z", "v"), [(10.0, 0.0), (0.0, 4.0), (-20.0, 3.0)])
def test_a_centre_that_follows_the_closed_form_is_off_by_nothing(z, v):
    run = motion(lambda t: critical(z, v, t))
    found, said = centre_and_form(run)
    np.testing.assert_allclose(found, said, atol=1e-12)
    claim = judged("su-varying", run).claim("centre")
    assert claim.status == "verified"
    assert claim.margin == pytest.approx(1e-6, abs=1e-12)


@pytest.mark.parametrize("z", [1.0, 10.0, -30.0])
def test_a_centre_that_stays_is_off_by_what_it_should_have_gone(z):
    """At t = 2 z(1 − 3/e²), to |z| or the length of the law; in velocity z·2/e² times its time, which is less."""
    claim = judged("su-varying", motion(lambda t: (z, 0.0))).claim("centre")
    off = abs(z) * (1.0 - 3.0 * exp(-2.0)) / max(abs(z), LAW.scales.length)
    assert LAW.scales.time * 2.0 * exp(-2.0) < 1.0 - 3.0 * exp(-2.0)
    assert (claim.status, claim.contradicts) == ("inconclusive", "informed-agents")
    assert claim.computed == pytest.approx(off, rel=1e-12)
    assert claim.margin == pytest.approx(1e-6 - off, rel=1e-12)
    assert claim.witness["time"] == 2.0
    assert claim.error == pytest.approx((2 + 4) * EPS * max(abs(z), 3.5) / max(abs(z), 7.0), rel=0.0, abs=4.0 * EPS)


def test_velocities_count_by_the_time_of_the_law():
    """At its place, but told a velocity of 5 that it does not keep: z = 5 t e^−t, and z' = 5 (1 − t) e^−t."""
    run = motion(lambda t: (critical(0.0, 5.0, t)[0], 5.0), times=(0.0, 1.0))
    claim = judged("su-varying", run).claim("centre")
    assert claim.computed == pytest.approx(5.0 * LAW.scales.time / LAW.scales.length, rel=1e-12)
    rounding = (2 + 4) * EPS * max(3.5, 5.0 * LAW.scales.time)
    assert claim.error == pytest.approx(rounding / 7.0, rel=0.0, abs=4.0 * EPS)


def test_a_flock_that_starts_later_is_the_same():
    one, two = (motion(lambda t, at=at: critical(10.0, 0.0, t - at), (at, at + 1.0)) for at in (0.0, 7.0))
    np.testing.assert_allclose(centre_and_form(one)[1], centre_and_form(two)[1], atol=1e-12)
    assert statuses(judged("su-varying", two))["centre"] == "verified"


@pytest.mark.parametrize(
    ("changes", "status"),
    [({}, "met"), ({"pair": OTHER}, "unmet"), ({"feedforward": False}, "unmet"), ({"drag": 0.1}, "unmet")],
    ids=["its own", "another pair law", "not told", "with drag"],
)
def test_the_law_is_that_of_the_paper_and_told(changes, status):
    told = {"pair": AlphaInteraction(), "consensus": 9.0, "navigation": CIRCLE, "feedforward": True}
    law = compose(**(told | changes))
    verdict = judged("su-varying", made_up(law, [APART, APART]))
    assert hypothesis(verdict, "acceleration fed forward").status == status
    assert (statuses(verdict)["centre"] == "vacuous") == (status == "unmet")
