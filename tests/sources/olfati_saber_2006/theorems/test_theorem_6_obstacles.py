"""Theorem 6 on runs: verified, t0 found, vacuous where a hypothesis fails, refuted where a law is wrong."""

from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm3, Gains, LinearTarget, RescaledVelocity, Sphere, StaticTarget, Wall, simulate, verify
from flockana.sources.olfati_saber_2006.theorems.theorem_6_obstacles import condition_76
from flockana.theorems.observed_run import Observed
from tests.theorems.made_up import hypothesis, judged, made_up

OBSTACLES = (Sphere((3.0, 2.0), 2.0), Wall((0.0, -14.0), (0.0, 1.0)))


def _run(target, obstacles=OBSTACLES, span=6.0, **gains):
    rng = np.random.default_rng(5)
    q = rng.uniform((-25.0, -12.0), (0.0, 12.0), (12, 2))
    law = Algorithm3(target=target, obstacles=obstacles, gains=Gains(**gains))
    return simulate(law, q, rng.normal(size=q.shape), (0.0, span), rtol=1e-9)  # the β-taper is steep


@pytest.fixture(scope="module")
def static():
    return _run(StaticTarget((30.0, 0.0)))


@pytest.mark.slow
def test_a_static_gamma_agent_verifies(static):
    verdict = verify("os-6", static)
    assert verdict.status == "verified"
    assert all(h.status == "met" for h in verdict.hypotheses)
    assert hypothesis(verdict, "(76)").detail == "p_d = 0: T >= 0 at all times"
    assert 0.0 < hypothesis(verdict, "obstacle").margin < 4.2
    assert verdict.claim("rate").computed == Observed.of(static).run.energy_rate().max()
    assert verdict.claim("rate").margin > 0.0
    assert verdict.claim("balance").computed < 1e-6
    assert verify("energy", static).status == "verified"
    assert verify("energy", static).claim("rate").status == "verified"


def test_t0_is_the_first_sample_after_which_the_condition_stays():
    """p_d ≠ 0 at a fixed q_r, towards it: (76) holds once the flock is faster than p_d, as pulled it becomes."""
    law = Algorithm3(target=StaticTarget((300.0, 0.0), (2.0, 0.0)), obstacles=(Sphere((0.0, 90.0), 1.0), OBSTACLES[1]))
    run = simulate(law, [[-9.0, 0.0], [-9.0, 7.0]], [[1.0, 0.0], [1.0, 0.0]], (0.0, 6.0))
    slack, verdict = condition_76(run), verify("os-6", run)
    dense = [0.5 * np.sum(p * p) - 0.5 * len(p) * p.mean(axis=0) @ [2.0, 0.0] for p in run.p]
    np.testing.assert_allclose(slack, dense, rtol=1e-12, atol=1e-12)
    condition = hypothesis(verdict, "(76)")
    k = max((i for i in range(len(slack)) if slack[i] < 0.0), default=-1) + 1
    assert 0 < k < len(slack)
    assert condition.status == "met"
    assert f"t0 = {run.t[k]:.6g}" in condition.detail
    assert f"broken at {100.0 * np.mean(slack < 0.0):.2g} % of the samples before" in condition.detail
    assert 0.0 <= condition.margin <= condition_76(Observed.of(run).run)[k:].min()
    assert verdict.status == "verified"
    assert f"{run.t[k]:.6g} <= t <= 6" in verdict.claim("rate").stated


def test_a_condition_broken_at_the_end_makes_it_vacuous():
    run = _run(StaticTarget((300.0, 0.0), (-2.0, 0.0)))
    verdict = verify("os-6", run)
    assert condition_76(run)[-1] < 0.0
    assert hypothesis(verdict, "(76)").status == "unmet"
    assert f"it fails until t = {run.t[-1]:g}, by" in hypothesis(verdict, "(76)").detail
    assert hypothesis(verdict, "static").status == "met"
    assert "p_r = [-2.0, 0.0] though q_r does not move" in hypothesis(verdict, "static").detail
    assert verdict.status == "vacuous"
    energy = verify("energy", run)
    assert energy.claim("rate").status == "vacuous"
    assert energy.claim("balance").status == "verified"


def test_a_condition_that_holds_at_the_last_sample_alone_makes_it_vacuous():
    """One instant is no "from some t0 on": an agent that comes from behind, cut just after it is as fast as p_d."""
    law = Algorithm3(target=StaticTarget((300.0, 0.0), (2.0, 0.0)))
    run = simulate(law, [[-9.0, 0.0]], [[1.9, 0.0]], (0.0, 2.0), t_eval=np.linspace(0.0, 2.0, 400))
    k = int(np.flatnonzero(condition_76(run) < 0.0)[-1]) + 1
    assert 0 < k < 399
    short = run.window(0.0, float(run.t[k]))
    assert condition_76(short)[-1] >= 0.0
    assert hypothesis(judged("os-6", short), "(76)").status == "unmet"
    assert hypothesis(judged("os-6", run), "(76)").status == "met"


def test_a_condition_that_rounding_decides_is_assumed():
    """All agents at p_d, to the last bit: T = (n/2)⟨p_c, p_d⟩."""
    law = Algorithm3(gains=Gains(c1_gamma=0.0), target=StaticTarget((0.0, 0.0), (0.1, 0.7)))
    run = simulate(law, [[5.0, 5.0]], [[0.1, 0.7]], (0.0, 2.0))
    assert hypothesis(judged("os-6", run), "(76)").status == "assumed"
    assert judged("os-6", run).claim("rate").status != "refuted"


@pytest.mark.slow
@pytest.mark.parametrize(
    "target",
    [LinearTarget((20.0, 0.0), (3.0, 0.0)), RescaledVelocity(LinearTarget((20.0, 0.0), (3.0, 0.0)), 0.0)],
    ids=["consistent", "hidden velocity"],
)
def test_a_moving_gamma_agent_is_outside_the_theorem(target):
    run = _run(target)
    verdict, energy = verify("os-6", run), verify("energy", run)
    assert hypothesis(verdict, "static").status == "unmet"
    assert "outside the theorem" in hypothesis(verdict, "static").detail
    assert verdict.status == "vacuous"
    assert energy.claim("rate").status == "vacuous"
    assert energy.claim("balance").status == "verified"
    assert energy.claim("balance").computed < 1e-6


def test_inside_a_sphere_the_energy_can_rise():
    law = Algorithm3(target=StaticTarget((0.0, 0.0)), obstacles=(Sphere((0.0, 0.0), 2.0),), gains=Gains(c2_gamma=0.0))
    assert law.energy_rate(0.0, [[1.0, 0.0]], [[0.0, 1.0]]) > 0.0
    assert law.energy_rate(0.0, [[3.0, 0.0]], [[0.0, 1.0]]) < 0.0


def test_numbers_of_another_law_contradict_the_proof(static, monkeypatch):
    wrong = judged("os-6", replace(static, extra={"work": 0.99 * static.extra["work"]}))
    assert [claim.contradicts for claim in wrong.claims] == ["", "theorem6"]
    right = Algorithm3.flow

    def flow(self, t, q, p):
        u, rate = right(self, t, q, p)
        return u, -rate

    monkeypatch.setattr(Algorithm3, "flow", flow)
    rising = judged("os-6", replace(static))
    assert [claim.contradicts for claim in rising.claims] == ["theorem6", ""]
    assert rising.claim("rate").margin < -0.1


def test_an_obstacle_that_is_grazed_is_left_open_and_where_there_is_none_rest_verifies():
    law = Algorithm3(target=StaticTarget((20.0, 0.0)), obstacles=(Sphere((0.0, 0.0), 3.0),))
    grazing = made_up(law, [[[-4.0, 3.0]], [[4.0, 3.0]]], [[[8.0, 0.0]]] * 2, t=(0.0, 1.0))
    assert hypothesis(judged("os-6", grazing), "obstacle").status == "assumed"
    inside = made_up(law, [[[-4.0, 2.9]], [[4.0, 2.9]]], [[[8.0, 0.0]]] * 2, t=(0.0, 1.0))
    assert hypothesis(judged("os-6", inside), "obstacle").status == "unmet"
    # dH/dt = 0 exactly
    run = simulate(Algorithm3(target=StaticTarget((0.0, 0.0))), [[0.0, 0.0]], [[0.0, 0.0]], (0.0, 1.0))
    assert verify("os-6", run).claim("rate").status == "verified"
    assert "there is none" in hypothesis(verify("os-6", run), "obstacle").detail


def test_output_times_chosen_where_the_condition_holds_change_nothing():
    """One agent swings about 0 with p_d = ½: (76) is v² >= v/2, which fails while 0 < v < ½."""
    law = Algorithm3(gains=Gains(c1_gamma=1.0, c2_gamma=0.02), target=StaticTarget((0.0,), (0.5,)))
    run = simulate(law, [[0.0]], [[3.0]], (0.0, 40.0))
    good = run.t[condition_76(run) >= 0.02]
    chosen = simulate(law, [[0.0]], [[3.0]], (0.0, 40.0), t_eval=np.unique([0.0, *good[::8], 40.0]))
    v = run.p[:, 0, 0]
    last = run.t[np.flatnonzero((v > 0.0) & (v < 0.5))[-1]]
    for each in (run, chosen):
        verdict = verify("os-6", each)
        condition, claim = hypothesis(verdict, "(76)"), verdict.claim("rate")
        if claim.status == "verified":
            assert float(condition.detail.split("t0 = ")[1].split(",")[0]) >= last - 1e-5
        assert condition.decided in ("enclosed", "assumed")
