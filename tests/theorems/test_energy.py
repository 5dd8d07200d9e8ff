"""The energy identities along runs: what falls, what balances, and whose error it is where they do not."""

from dataclasses import dataclass, replace
from functools import cached_property
from types import SimpleNamespace

import numpy as np
import pytest

from flockana import Algorithm3, PairTerm, Sphere, StaticTarget, Tolerances, simulate, verify
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.theorems.energy import balance, falling_share, never_rises, stays_outside
from flockana.theorems.observed_run import Observed, observed
from flockana.theorems.second_runs import Errors
from tests.theorems.made_up import hexagon, hypothesis, judged, made_up, statuses
from tests.toys.sources.toy_2026.laws import ToyDrag, ToySwarm

LAW = Algorithm1()


def bounce(**options):
    return simulate(LAW, [[0.0], [3.0]], [[20.0], [-20.0]], (0.0, 2.0), **options)


def test_a_good_run_balances_and_falls():
    verdict = verify("energy", simulate(LAW, *hexagon(), (0.0, 5.0)))
    assert statuses(verdict) == {"rate": "verified", "balance": "verified"}
    assert verdict.claim("balance").computed < 1e-7
    assert (verdict.claim("rate").margin, verdict.claim("rate").error) == (1.0, 0.0)  # all terms are squares


@pytest.mark.parametrize("dt", [0.1, 0.05])
def test_a_rough_integration_refutes_no_identity(dt):
    run = simulate(LAW, *hexagon(shake=1.0, speed=5.0), (0.0, 2.0), method="RK4", dt=dt)
    assert balance(Observed.alone(run), [], Tolerances()).status == "refuted"
    assert balance(Observed.of(run), [], Tolerances()).status == "inconclusive"
    assert judged("energy", run).claim("balance").contradicts == "energy-identities"
    claim = verify("energy", run).claim("balance")
    assert (claim.status, claim.rigour, claim.margin < claim.error) == ("verified", "symbolic", True)


def test_a_wrong_identity_stays_wrong_however_tightly_it_is_integrated(monkeypatch):
    right = Algorithm1.flow

    def flow(self, t, q, p):
        u, rate = right(self, t, q, p)
        return u, 1.001 * rate

    monkeypatch.setattr(Algorithm1, "flow", flow)
    run = bounce()
    claim = verify("energy", run).claim("balance")
    assert (claim.status, claim.contradicts) == ("inconclusive", "energy-identities")
    assert balance(Observed.of(run), [], Tolerances()).status == "refuted"
    lost = 1.0 - run.energy()[-1] / run.energy()[0]
    assert claim.computed == pytest.approx(1e-3 * lost, rel=1e-2)


def test_a_work_that_the_law_does_not_do_is_refuted_by_one_run_and_not_by_two():
    run = bounce(rtol=1e-9)
    forged = replace(run, extra={"work": 0.9 * run.extra["work"]})
    assert balance(Observed.alone(forged), [], Tolerances()).status == "refuted"
    assert balance(Observed.of(forged), [], Tolerances()).status == "inconclusive"


@pytest.mark.parametrize("offset", [0.0, 1e4, 1e7])
def test_rounding_far_from_the_origin_is_in_the_error(offset):
    q, p = hexagon()
    run = simulate(LAW, q + offset, p, (0.0, 2.0))
    claim = judged("energy", run).claim("balance")
    assert claim.error > 1e-16 * offset
    assert claim.status in ("verified", "inconclusive")


class TestTheSign:
    """dH/dt is a sum of terms of one sign, or one of differences: the margin is what is left of their magnitude."""

    def test_without_damping_or_motion_nothing_can_raise_it(self):
        undamped = simulate(Algorithm1(gains=Gains(c2_alpha=0.0)), *hexagon(), (0.0, 1.0))
        for run in (undamped, simulate(LAW, [[0.0], [7.0]], [[0.0], [0.0]], (0.0, 1.0))):
            claim = never_rises(Observed.of(run), [])
            assert (claim.status, claim.margin) == ("verified", 1.0)

    def test_at_speeds_next_to_rounding_it_still_falls(self):
        q, p = hexagon(shake=0.0, speed=1e-14)
        claim = never_rises(observed(Algorithm2(target=StaticTarget((0.0, 0.0))), q, p + 1.0, (0.0, 0.1)), [])
        assert claim.status == "verified"

    def test_a_rate_of_the_wrong_sign_is_refuted(self):
        class Rising(Algorithm1):
            def flow(self, t, q, p):
                u, rate = super().flow(t, q, p)
                return u, -rate

        run = simulate(LAW, *hexagon(), (0.0, 1.0))
        assert never_rises(Observed.alone(replace(run, law=Rising())), []).status == "refuted"

    def test_terms_that_cancel_within_their_rounding_decide_nothing(self, monkeypatch):
        """An agent that moves with the γ-agent's own velocity, told, not kept: ⟨p, p - p_d⟩ is 0 but for rounding."""
        law = Algorithm3(gains=Gains(c1_gamma=0.0), target=StaticTarget((0.0, 0.0), (0.1, 0.7)), obstacles=())
        seen = observed(law, [[5.0, 5.0]], [[0.1 * (1.0 + 1e-16), 0.7]], (0.0, 0.5))
        assert never_rises(seen, []).status == "inconclusive"

    @pytest.mark.parametrize(("told", "status"), [((0.0, 0.0), "verified"), ((0.5, 0.0), "inconclusive")])
    def test_a_sum_of_squares_keeps_its_sign_whatever_the_error_of_the_state(self, told, status):
        law = Algorithm3(target=StaticTarget((0.0, 0.0), told), obstacles=(Sphere((12.0, 0.0), 2.0),))
        run = simulate(law, [[8.0, 0.5]], [[-1.0, 0.1]], (0.0, 0.1))
        other = simulate(law, [[8.0, 0.5]], [[0.25, 0.0]], (0.0, 0.1), t_eval=run.t)
        errors = [np.full((len(run.t), 1), 1.0)] * 2 + [np.full(len(run.t), 1.0)] * 2
        seen = Observed(run, run, other, Errors(run.t, *errors))
        assert never_rises(seen, []).status == status

    def test_the_margin_is_the_share_of_the_terms_that_is_left(self):
        """One agent towards a γ-agent that tells p_d: the rate is -c2γ p (p - p_d), its terms c2γ p (p + p_d)."""
        law = Algorithm3(gains=Gains(c1_gamma=0.0, c2_gamma=2.0), target=StaticTarget((0.0,), (1.0,)))
        seen = observed(law, [[50.0]], [[3.0]], (0.0, 1e-6))
        fall = 3.0 * (3.0 - 1.0)
        assert never_rises(seen, []).margin == pytest.approx(fall / (fall + 2.0 * 3.0 * (3.0 + 1.0)), rel=1e-4)


class Lying(StaticTarget):
    """A γ-agent that moves and declares that it does not."""

    def state(self, t):
        return np.array([np.sin(t), 0.0]), np.zeros(2)


def test_a_gamma_agent_that_lies_about_its_rate_takes_the_balance_with_it():
    run = simulate(Algorithm3(target=Lying((0.0, 0.0))), [[5.0, 0.0], [12.0, 0.0]], np.zeros((2, 2)), (0.0, 3.0))
    verdict = verify("energy", run)
    assert hypothesis(verdict, "declared rate").status == "unmet"
    assert statuses(verdict) == {"rate": "vacuous", "balance": "vacuous"}


@dataclass(frozen=True)
class Swelling(ToyDrag):
    """A drag that says of itself that it takes no energy out."""

    def act(self, t, q, p, u):
        super().act(t, q, p, u)
        return 0.0


@dataclass(frozen=True)
class Unsaid(ToySwarm):
    """The toy, with that drag."""

    @cached_property
    def terms(self):
        return (PairTerm(self.pair, 1.0, 0.0), Swelling(self.k))


@pytest.mark.parametrize(
    ("law", "k", "rate", "balance"),
    [
        (ToySwarm, 0.5, "inconclusive", "verified"),  # samples of a term of one's own bound nothing between them
        (ToySwarm, 0.0, "inconclusive", "verified"),
        (ToySwarm, -0.5, "vacuous", "verified"),  # it adds energy, and says so
        (Unsaid, 0.5, "inconclusive", "inconclusive"),  # its energy falls; nobody says how fast its term changes
    ],
)
def test_a_law_of_one_s_own_is_judged_by_what_its_terms_give(law, k, rate, balance):
    q, p = np.array([[0.0, 0.0], [7.5, 0.0], [3.0, 6.0]]), np.array([[1.0, 0.0], [0.0, 0.5], [-0.5, 0.0]])
    verdict = verify("energy", law=law(AlphaInteraction(), k), q0=q, p0=p, t_span=(0.0, 3.0))
    assert statuses(verdict) == {"rate": rate, "balance": balance}
    assert hypothesis(verdict, "sum of terms").detail.startswith(f"{law.__name__}: PairTerm, ")
    assert hypothesis(verdict, "no term adds energy").status == ("unmet" if rate == "vacuous" else "assumed")


@pytest.mark.parametrize("unit", [1e-30, 1.0, 1e30])
def test_the_share_that_falls_is_a_pure_number(unit):
    """All of what has one sign, a third of what may cancel as much again as it is, and 1 where nothing moves."""
    rate, cancels = unit * np.array([-1.0, -1.0, 1.0, 0.0]), unit * np.array([0.0, 1.0, 0.0, 0.0])
    three = Observed.alone(made_up(LAW, np.zeros((4, 3, 1))))
    share = falling_share(three, lambda run: rate, lambda run: cancels)
    np.testing.assert_allclose(share.mid, [1.0, 1.0 / 3.0, -1.0, 1.0], rtol=1e-15)
    np.testing.assert_allclose(share.half_width, 73.0 * 2.0**-52, rtol=0.02)


@pytest.mark.parametrize(
    ("lower", "reached", "status", "margin"),
    [
        (0.5, 0.6, "met", 0.5),
        (-0.1, 0.2, "assumed", -0.1),
        (-0.1, -1e-16, "assumed", -0.1),  # in contact but for rounding
        (-0.4, -0.3, "unmet", -0.3),
    ],
)
def test_whether_an_agent_has_entered_an_obstacle(lower, reached, status, margin):
    least = SimpleNamespace(lower=lower, reached=reached, agent=3, obstacle=1, time=2.5)
    law = SimpleNamespace(obstacles=(1,))
    run = SimpleNamespace(q=np.ones((2, 1, 1)), clearance=lambda: least)
    exact = SimpleNamespace(law=law, run=run, shape_error=np.zeros((2, 1)), centre_error=np.zeros(2))
    need = stays_outside(exact)
    assert (need.status, need.margin) == (status, margin)
    assert "(agent 3 at obstacles[1], t = 2.5)" in need.detail
