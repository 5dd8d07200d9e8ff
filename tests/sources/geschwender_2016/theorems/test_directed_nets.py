"""Directed nets: two that see each other one-sidedly, by hand, and laws that are off."""

from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm1, DirectedNet, Tolerances
from flockana.sources.geschwender_2016.theorems import directed_nets
from flockana.theorems.observed_run import Observed, observed

LAW = Algorithm1()


@pytest.fixture(scope="module")
def run():
    return observed(DirectedNet(LAW, ranges=(8.4, 3.0)), [[0.0], [7.0]], [[0.0], [1.0]], (0.0, 30.0), rtol=1e-10).run


@pytest.fixture(scope="module")
def claims():
    return {claim.name: claim for claim in directed_nets.theorem.examine(Tolerances())[1]}


@pytest.mark.slow
def test_one_range_for_all_gives_the_laws(claims):
    claim = claims["undirected"]
    assert 0.0 <= claim.computed < 1e-14
    assert claim.margin == pytest.approx(1e-12 - claim.computed, rel=1e-12, abs=0.0)
    assert claim.witness == {"agents": 40}


@pytest.mark.parametrize("which", ["Algorithm1", "Algorithm2", "Algorithm3"])
def test_one_law_that_is_off_is_told_by_its_share_of_the_largest(monkeypatch, which):
    class Off(DirectedNet):
        def acceleration(self, t, q, p):
            u = super().acceleration(t, q, p)
            return 1.25 * u if type(self.law).__name__ == which and len(u) == 40 else u

    monkeypatch.setattr(directed_nets, "DirectedNet", Off)
    claim = directed_nets._undirected()
    assert (claim.status, claim.computed) == ("refuted", pytest.approx(0.25, rel=1e-12))
    assert claim.margin == pytest.approx(1e-12 - 0.25, rel=1e-12)


def test_who_is_drawn_is_not_answered(claims):
    """It has all of the force that each of two has under Algorithm 1."""
    claim = claims["momentum-lost"]
    pull = LAW.acceleration(0.0, [[0.0], [7.5]], [[0.0], [0.0]])[0, 0]
    assert pull > 0.0
    assert claim.computed == pytest.approx(pull / (30.0 * LAW.alpha.strength), rel=1e-12)
    assert (claim.margin, claim.error) == (claim.computed, pytest.approx(1e-12, rel=1e-3))
    assert claim.witness == {"q": [0.0, 7.5], "u": [pytest.approx(pull, rel=1e-12), 0.0]}
    assert f"Σ u_i = {pull:.4g}" in claim.detail


@pytest.mark.slow
def test_the_energy_rises_by_that_of_who_follows(claims, run):
    claim = claims["energy-rises"]
    h = [LAW.energy(0.0, q, p) for q, p in zip(run.q, run.p, strict=True)]
    assert claim.computed == claim.margin == pytest.approx(h[-1] - h[0], rel=1e-9)
    assert claim.computed == pytest.approx(0.5, abs=1e-6)
    assert max(h) > 2.0 * h[-1]  # in between it is more than at either end
    assert claim.witness == {"H": [pytest.approx(h[0], rel=1e-9), pytest.approx(h[-1], rel=1e-9)]}
    assert "away at 1," in claim.detail


def test_of_two_alone_what_follows_loses_its_own_energy(claims, run):
    claim = claims["follower"]
    apart, faster = (z[:, 1, 0] - z[:, 0, 0] for z in (run.q, run.p))
    own = 30.0 * LAW.alpha.energy(apart) + 0.5 * faster**2
    assert own[0] == pytest.approx(0.5, rel=1e-9)
    assert claim.computed == pytest.approx((own - np.minimum.accumulate(own)).max(), abs=1e-12)
    assert claim.witness == {"from": pytest.approx(0.5, rel=1e-9), "to": pytest.approx(own[-1], abs=1e-12)}


def test_who_sees_nobody_leads(claims, run):
    claim, length = claims["leader"], (run.q[-1, 1, 0] - run.q[-1, 0, 0]) / 7.0
    assert claim.computed == {"swerve": 0.0, "length over d": pytest.approx(length, rel=1e-12)}
    assert claim.margin == pytest.approx(1e-6, rel=1e-12, abs=0.0)
    assert length == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize(
    ("scale", "push", "lag", "margin"),
    [
        (1.0, 0.25, 0.25, 1e-6 - 0.25),
        (1.0, -0.25, -0.25, 1e-6 - 0.25),
        (1.5, 0.0, 0.0, 1e-3 - 0.5),
        (0.5, 0.0, 0.0, 1e-3 - 0.5),
        (1.0, 0.0, 0.1, 1e-3 - 0.1),
    ],
)
def test_a_leader_that_swerves_a_follower_that_lags_and_a_length_that_is_not_d(run, scale, push, lag, margin):
    q, p = run.q.copy(), run.p.copy()
    q[-1, 1] = q[-1, 0] + 7.0 * scale
    p[-1] += [[lag], [push]]
    seen = Observed.alone(replace(run, q=q, p=p))
    claims = {claim.name: claim for claim in directed_nets._claims_on(seen, 1.0)}
    assert claims["leader"].status == "refuted"
    assert claims["leader"].margin == pytest.approx(margin, rel=1e-5)
    own = 30.0 * float(LAW.alpha.energy(np.array([7.0 * scale]))[0]) + 0.5 * (push - lag) ** 2
    assert claims["follower"].computed == pytest.approx(own, rel=1e-5, abs=1e-9)
    assert claims["follower"].status == ("refuted" if own > 1e-5 else "verified")
