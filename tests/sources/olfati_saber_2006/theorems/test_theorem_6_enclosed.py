"""Theorem 6 from a tube past a sphere."""

from dataclasses import replace

import numpy as np
import pytest
from flint import arb

from flockana import Algorithm3, AlphaInteraction, Gains, LinearTarget, Sphere, StaticTarget, enclose, simulate, verify
from flockana.certified.energies_in_balls import powers_during, total_energy, work
from flockana.certified.flow_in_balls import Flow, flow_of
from flockana.interactions import BetaInteraction
from tests.theorems.made_up import statuses

LAW = Algorithm3(
    gains=Gains(c1_alpha=1.5, c2_alpha=2.0, c1_beta=100.0, c2_beta=20.0),
    target=StaticTarget((4.0, 2.0)),
    beta=BetaInteraction(d=1.0, r=1.25, h=0.5),
    obstacles=(Sphere((0.0, 0.0), 1.0),),
)
START = np.array([[-1.5, 1.0], [-1.5, 6.0]]), np.array([[4.0, 3.0], [0.0, -1.0]])
SPAN = (0.0, 0.0625)


@pytest.fixture(scope="module")
def tube():
    return enclose(LAW, *START, SPAN, order=12)


def test_all_of_theorem_6_is_decided_and_its_rigour_is_that_of_the_proof(tube):
    verdict = verify("os-6", tube)
    assert statuses(verdict) == {"rate": "verified", "balance": "verified"}
    assert verdict.rigour == "smt"
    assert all(claim.margin > claim.error for claim in verdict.claims)  # as the tube says by itself
    assert {h.status for h in verdict.hypotheses} == {"met"}
    assert "proved" in verdict.hypotheses[-1].detail
    assert verdict.claim("rate").computed < -1.0


def test_the_energy_its_rate_and_their_balance_are_those_of_the_run(tube):
    run = simulate(LAW, *START, SPAN, rtol=1e-12, t_eval=tube.t)
    for k in (0, -1):
        assert abs(total_energy(LAW, *tube.state(k)) - float(run.energy()[k])).lower() < 1e-9
    flow, rate = flow_of(LAW, 2, 2), run.energy_rate()
    for k in range(len(tube.taken)):
        during = sum(powers_during(tube, flow, k), arb(0)) + arb(0, 1e-7)
        assert all(during.contains(arb(float(x))) for x in rate[k : k + 2])
    assert abs(work(tube) - float(run.energy()[-1] - run.energy()[0])).lower() < 1e-9
    assert work(tube).rad() < 1e-7


def test_a_rate_of_another_law_contradicts_the_proof_of_the_balance(tube, monkeypatch):
    own = Flow.powers
    monkeypatch.setattr(Flow, "powers", lambda *a: [0.99 * x for x in own(*a)])
    verdict = verify("os-6", tube)
    assert statuses(verdict) == {"rate": "inconclusive", "balance": "inconclusive"}  # for a hypothesis is in doubt
    assert [claim.contradicts for claim in verdict.claims] == ["", "theorem6"]


def test_a_flock_that_is_told_to_move_breaks_the_condition_76():
    """At rest with p_r told, dH/dt = 0 and then rises with the first motion towards p_r."""
    told = replace(LAW, target=StaticTarget((-1.5, 6.0), (0.0, 4.0)))
    tube = enclose(told, START[0], np.array([[0.0, 0.0], [0.0, 0.5]]), (0.0, 0.0625), order=12)
    verdict = verify("os-6", tube)
    assert verdict.hypotheses[3].status == "unmet"
    assert statuses(verdict) == {"rate": "vacuous", "balance": "verified"}


def test_a_moving_target_is_outside_the_theorem():
    moving = replace(LAW, target=LinearTarget((4.0, 2.0), (1.0, 0.0)))
    verdict = verify("os-6", enclose(moving, *START, (0.0, 0.015625), order=12))
    assert set(statuses(verdict).values()) == {"vacuous"}


def test_a_tube_too_wide_leaves_the_balance_to_its_proof_and_one_that_ends_early_decides_nothing(tube):
    wide = enclose(LAW, *START, (0.0, 0.0078125), radius=(0.02, 0.0), order=8)
    balance = verify("os-6", wide).claim("balance")
    assert (balance.status, balance.rigour, balance.margin < balance.error) == ("verified", "smt", True)
    assert "the enclosure alone is too wide to tell" in balance.detail
    early = enclose(LAW, *START, (0.0, 1.0), steps=2, order=8)
    verdict = verify("os-6", early)
    assert statuses(verdict) == {"rate": "inconclusive", "balance": "inconclusive"}
    assert "the tube ends early: it took 2 steps" in verdict.claim("rate").detail


def test_a_tube_that_may_touch_the_sphere_assumes_that_it_does_not():
    near = enclose(LAW, START[0] * 0.6, 0.0 * START[1], (0.0, 0.0009765625), radius=(0.2, 0.0), order=8, widest=10.0)
    assert near.min_clearance().lower < 0.0
    assert verify("os-6", near).hypotheses[-1].status == "assumed"


def test_the_energy_in_other_units_of_length_is_that_of_the_law():
    alpha, beta = AlphaInteraction(unit=1.5), BetaInteraction(d=3.0, r=4.0, eps=0.2, unit=2.0)
    law = Algorithm3(alpha=alpha, beta=beta, target=StaticTarget((4.0, 2.0)), obstacles=(Sphere((0.0, 0.0), 1.0),))
    q, p = START
    ball = total_energy(law, *([[arb(x) for x in row] for row in z.tolist()] for z in START))
    assert float(ball) == pytest.approx(law.energy(0.0, q, p), rel=1e-10)


def slow_at_first(speed, span):
    """One agent at half of p_r; pulled from far with c1γ = p_r, it has v = p_r (2 − 1.5 e^−t), c2γ being 1."""
    law = Algorithm3(gains=Gains(c1_gamma=speed, c2_gamma=1.0), target=StaticTarget((1e3, 0.0), (speed, 0.0)))
    tube = enclose(law, np.zeros((1, 2)), np.array([[0.5 * speed, 0.0]]), span, order=20)
    return tube, verify("os-6", tube)


@pytest.mark.parametrize(("speed", "start"), [(1.0, 0.0), (1.0, 100.0), (0.01, 0.0), (0.01, 100.0)])
def test_the_condition_76_is_met_from_the_step_on_after_the_agent_is_as_fast_as_told(speed, start):
    """That is at ln 1.5; after it the rate −v (v − p_r) falls, and a share of it is the same at any speed."""
    tube, verdict = slow_at_first(speed, (start, start + 1.0))
    rate = verdict.claim("rate")
    since = rate.witness["time"]
    k = tube.t.index(since)
    assert tube.t[k - 1] < start + np.log(1.5) < since
    assert f"t >= {since:.6g}" in rate.stated
    v = 2.0 - 1.5 * np.exp(start - since)
    assert -(speed**2) * v * (v - 1.0) <= rate.computed < -0.5 * speed**2 * v * (v - 1.0)
    assert [h.status for h in verdict.hypotheses] == ["met"] * 5
    assert statuses(verdict) == {"rate": "verified", "balance": "verified"}
    assert rate.margin - rate.error == pytest.approx(0.251964, abs=1e-5)


@pytest.mark.parametrize(("end", "status"), [(0.18, "unmet"), (0.7, "assumed"), (0.9, "assumed"), (0.93, "met")])
def test_the_condition_76_is_met_for_the_time_of_the_law_or_not_known(end, status):
    """It is broken up to ln 1.5 and certain from 0.776 on; the law's time is 0.142."""
    tube, verdict = slow_at_first(1.0, (0.0, end))
    assert tube.law.scales.time == pytest.approx(0.1421, abs=1e-4)
    assert verdict.hypotheses[3].status == status
