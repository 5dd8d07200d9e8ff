"""The general theorems on compositions: energy, cohesion, collisions, and where each says nothing."""

import numpy as np
import pytest

from flockana import CircleTarget, LinearTarget, Sphere, StaticTarget, compose, simulate, verify
from flockana.interactions import AlphaInteraction
from flockana.sources.li_dead_zone import DeadZoneInteraction
from flockana.theorems.cohesion import bound
from flockana.theorems.enclosure import Enclosure
from tests.theorems.made_up import hexagon, statuses

PAIR, HERE = AlphaInteraction(), StaticTarget((0.0, 0.0))
Q, P = hexagon(shake=0.5, speed=1.0)


def run_of(until: float = 3.0, p=P, **chosen):
    return simulate(compose(**chosen), Q, p, (0.0, until))


FALLING = {
    "drag": {"pair": PAIR, "consensus": 2.0, "drag": 0.3},
    "net": {"pair": PAIR, "consensus": 2.0, "net": AlphaInteraction(r=14.0)},
    "pull and drag": {"pair": PAIR, "navigation": LinearTarget((0.0, 0.0), (1.0, 0.0)), "drag": 0.3},
    "told": {"pair": PAIR, "consensus": 2.0, "navigation": CircleTarget((0.0, 0.0), 5.0, 0.1), "feedforward": True},
    "obstacles": {"pair": PAIR, "navigation": HERE, "obstacles": (Sphere((30.0, 0.0), 3.0),)},
    "few and drag": {"pair": PAIR, "navigation": HERE, "informed": (0, 3), "agents": 7, "drag": 0.1},
    "dead zone": {"pair": DeadZoneInteraction(), "gradient": 1.0, "navigation": HERE, "drag": 0.1},
}


@pytest.mark.parametrize("name", FALLING)
def test_energy_of_a_composition_balances_and_falls(name):
    assert statuses(verify("energy", run_of(**FALLING[name]))) == {"rate": "verified", "balance": "verified"}


def test_thrust_balances_and_may_rise():
    verdict = verify("energy", run_of(pair=PAIR, consensus=2.0, speed=(1.0, 0.5)))
    assert statuses(verdict) == {"rate": "vacuous", "balance": "verified"}
    assert "α = 1" in verdict.claim("rate").detail or any("α = 1" in h.detail for h in verdict.hypotheses)


def test_a_wrong_power_is_found(monkeypatch):
    from flockana.laws.terms.along_velocity import AlongVelocity

    right = AlongVelocity.act
    monkeypatch.setattr(AlongVelocity, "act", lambda self, *state: 1.01 * right(self, *state))
    verdict = verify("energy", simulate(compose(pair=PAIR, drag=0.3), Q, P, (0.0, 2.0), method="scipy-DOP853"))
    assert verdict.claim("balance").status == "refuted"


@pytest.mark.parametrize("name", ["pull and drag", "told", "obstacles", "few and drag", "dead zone"])
def test_those_who_are_pulled_stay(name):
    verdict = verify("cohesion", run_of(**FALLING[name]))
    decided = "verified" if name != "dead zone" else verdict.status
    assert (verdict.status, verdict.claim("bound").margin > 0.0) == (decided, True)
    assert {h.name: h.detail for h in verdict.hypotheses}["c1γ > 0 of an agent"] == ""
    nobody = verify("cohesion", run_of(**FALLING["drag"]))
    assert (nobody.status, nobody.hypotheses[-1].detail) == ("vacuous", "the γ-agent pulls nobody")


def test_the_bound_is_exact():
    """½ c x² = H, and ℓ²(√(1 + x²/ℓ²) − 1) c = H: one agent that swings without loss reaches it, and is not refuted."""
    assert bound(Enclosure.of(2.0), 4.0, None).mid == 1.0
    ell, far = 3.0, 4.0
    assert bound(Enclosure.of(2.0 * ell**2 * (5.0 / 3.0 - 1.0)), 2.0, ell).mid == pytest.approx(far, rel=1e-15)
    for bounded in (False, 3.0):
        swing = compose(navigation=HERE, pull=1.0, match=0.0, bounded=bounded, informed=(0,), agents=1)
        claim = verify("cohesion", simulate(swing, [[2.0, 0.0]], [[0.0, 0.0]], (0.0, 9.0))).claim("bound")
        assert claim.status in ("inconclusive", "verified")
        assert abs(claim.margin) < 1e-6


def test_a_moving_leader_of_a_few_does_work():
    law = {"pair": PAIR, "navigation": LinearTarget((0.0, 0.0), (1.0, 0.0)), "informed": (0,), "agents": 7}
    assert verify("cohesion", run_of(**law)).status == "vacuous"
    assert verify("energy", run_of(**law)).claim("balance").status == "verified"


@pytest.mark.parametrize("name", ["drag", "net", "told", "dead zone"])
def test_below_the_energy_of_a_meeting_nobody_meets(name):
    verdict = verify("collision-energy", run_of(p=0.0 * P, **FALLING[name]))
    assert verdict.claim("below").status in ("verified", "vacuous")
    law = compose(**FALLING[name] | {"obstacles": ()})
    pair = simulate(law, [[0.0, 0.0], [7.2, 0.0]], np.zeros((2, 2)), (0.0, 3.0))
    assert verify("collision-energy", pair).claim("below").status == "verified"
