"""Su, Wang and Lin (2009): what few informed agents, and a leader of varying velocity, are promised."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains, Trajectory, compose, simulate, verify
from flockana.environment.targets import CircleTarget, LinearTarget
from flockana.sources.su_2009.theorems import leader_frame
from flockana.sources.su_2009.theorems.varying_velocity import convergence_rate
from flockana.theorems.observed_run import Observed
from tests.theorems.made_up import hexagon, hypothesis, statuses

Q, P = hexagon(shake=0.3, speed=0.5)
PAIR, LEADER, CIRCLE = AlphaInteraction(), LinearTarget((3.0, 0.0), (1.0, -0.5)), CircleTarget((0.0, 0.0), 9.0, 0.05)
NOBODY, SOME = (0.0,) * 7, "some agents are informed"
FEW = {"pair": PAIR, "consensus": 9.0, "navigation": LEADER, "informed": (0, 2), "agents": 7}
TOLD = {"pair": PAIR, "consensus": 9.0, "navigation": CIRCLE, "feedforward": True}


def run_of(until: float = 4.0, **changes):
    return simulate(compose(**(FEW | changes)), Q, P, (0.0, until))


def test_the_leader_s_frame_is_that_of_a_leader_at_rest():
    run = run_of()
    seen = leader_frame.as_the_leader_sees(Observed.alone(run)).run
    again = simulate(seen.law, seen.q[0], seen.p[0], (0.0, 4.0), t_eval=run.t)
    np.testing.assert_allclose(seen.q[-1], again.q[-1], atol=1e-5)
    u = [seen.law.flow(t, q, p)[0] for t, q, p in zip(seen.t, seen.q, seen.p, strict=True)]
    np.testing.assert_allclose(u, seen.u)
    assert seen.path.t.size == run.path.t.size


def test_links_over_windows_join_who_is_near_an_informed_agent():
    q = np.vstack([Q, [[100.0, 0.0], [107.0, 0.0]]])
    law = compose(**(FEW | {"agents": 9}))
    run = simulate(law, q, np.tile([1.0, -0.5], (9, 1)), (0.0, 2.0))
    assert leader_frame.linked_to_informed(run).tolist() == [True] * 7 + [False] * 2
    assert leader_frame.informed(run).tolist() == [True, False, True] + [False] * 6


@pytest.mark.parametrize(
    ("near", "linked"),
    [((6, 7, 8, 10), True), ((5, 7, 8, 9), True), ((6, 8, 10), False), ((6, 7, 8), False), ((7, 8, 10), False)],
)
def test_a_link_at_one_sample_of_each_window_is_enough(near, linked):
    """Eleven samples of two agents; the four windows of the last half end at 6¼, 7½, 8¾ and 10."""
    law = compose(**(FEW | {"agents": 2, "informed": (0,)}))
    q = np.array([[[0.0, 0.0], [7.0 if t in near else 50.0, 0.0]] for t in range(11)])
    run = Trajectory(np.arange(11.0), q, 0.0 * q, 0.0 * q, law)
    assert leader_frame.linked_to_informed(run).tolist() == [True, linked]


@pytest.mark.parametrize(
    ("law", "text"),
    [
        (Algorithm1(), "Algorithm 2 is applied"),
        (compose(**(FEW | {"navigation": CIRCLE})), "velocity is constant"),
        (Algorithm2(gains=Gains(c1_gamma=(1.0, 2.0, *NOBODY[2:]), c2_gamma=(1.0, *NOBODY[1:])), target=LEADER), SOME),
        (Algorithm2(gains=Gains(c1_gamma=NOBODY, c2_gamma=NOBODY), target=LEADER), SOME),
        (Algorithm2(gains=Gains(c2_alpha=0.0), target=LEADER), "c2α > 0"),
    ],
)  # fmt: skip
def test_vacuous_where_a_hypothesis_fails(law, text):
    verdict = verify("su-informed", simulate(law, Q, P, (0.0, 1.0)))
    assert {*statuses(verdict).values()} == {"vacuous"}
    assert hypothesis(verdict, text).status == "unmet"


@pytest.mark.parametrize(("c1", "c2"), [(1.1, 2.0 * 1.1**0.5), (1.0, 5.0), (4.0, 0.5)])
def test_the_centre_follows_its_closed_form(c1, c2):
    law = compose(**TOLD, pull=c1, match=c2)
    claim = verify("su-varying", simulate(law, Q, P, (0.0, 6.0))).claim("centre")
    assert (claim.status, claim.computed < 1e-8) == ("verified", True)
    assert convergence_rate(law.gains) == pytest.approx(-np.roots([1.0, c2, c1]).real.max(), rel=1e-7)


def test_a_wrong_acceleration_is_found(monkeypatch):
    """Told 1 % too much, the centre leaves the closed form."""
    from flockana.laws.terms.feedforward import TargetFeedforward

    right = TargetFeedforward.act
    law = compose(**TOLD)

    def wrong(term, t, q, p, u):
        pushed = np.zeros_like(u)
        power = right(term, t, q, p, pushed)
        u += 1.01 * pushed
        return power

    monkeypatch.setattr(TargetFeedforward, "act", wrong)
    run = simulate(law, Q, P, (0.0, 6.0), method="scipy-DOP853")
    claim = verify("su-varying", run).claim("centre")
    assert (claim.status, claim.contradicts) == ("inconclusive", "informed-agents")
    assert claim.margin + claim.error < 0.0


@pytest.mark.parametrize("other", [{"informed": (0, 1), "agents": 7}, {"drag": 0.1}, {"bounded": True}, None])
def test_varying_leader_is_vacuous_otherwise(other):
    law = compose(**TOLD, **other) if other else Algorithm2(target=CIRCLE)
    assert {*statuses(verify("su-varying", simulate(law, Q, P, (0.0, 1.0)))).values()} == {"vacuous"}


@pytest.mark.parametrize(
    ("told", "moving", "off"),
    [
        (lambda t: [3.0, -1.0], lambda t: [3.0, -1.0], 0.0),
        (lambda t: [3.0 + 0.5 * t, -1.0], lambda t: [3.0 + 0.5 * t, -1.0], 1.0),
        (lambda t: [3.0, -1.25], lambda t: [3.0, -1.0], 0.25),
    ],
)
def test_a_velocity_is_constant_if_none_that_is_told_or_moved_at_differs_from_the_first(told, moving, off):
    target = SimpleNamespace(state=lambda t: ([5.0 * t, 0.0], told(t)), rate=moving, constant_velocity=None)
    run = SimpleNamespace(law=SimpleNamespace(target=target), path=SimpleNamespace(t=np.array([0.0, 1.0, 2.0])))
    found = leader_frame.constant_velocity(run)
    assert found.status == ("unmet" if off else "assumed")
    assert not off or found.margin == -off


def test_at_constant_velocity_nothing_need_be_told():
    verdict = verify("su-varying", simulate(Algorithm2(target=LEADER), Q, P, (0.0, 5.0)))
    assert verdict.claim("centre").status == "verified"
