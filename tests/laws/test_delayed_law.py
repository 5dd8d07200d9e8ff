"""Delayed laws: the method of steps by hand, its order, what is heard, delays link by link."""

from math import cos, sin

import numpy as np
import pytest

from flockana import (
    RK4,
    Algorithm1,
    Algorithm2,
    CuckerSmale,
    DirectedNet,
    Gains,
    LinearTarget,
    StaticTarget,
    rescale,
    simulate,
)
from flockana.base.serialize import from_data, to_data
from flockana.lattice import hexagonal_spiral
from flockana.laws.delayed_law import LATE, Delayed
from tests.refused import refused

LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))
PAST = {"history_t": (-0.2, -0.1), "history_q": [[[0.0, 0.0]], [[1.0, 0.0]]]}


def lone(c1, c2, target=None):
    return Algorithm2(gains=Gains(c1_gamma=c1, c2_gamma=c2), target=target or StaticTarget((0.0,)))


def test_the_method_of_steps_by_hand():
    """x'' = −2 x(t − 1), at rest at 1 before: 1 − t², then 1 − t² + (t − 1)⁴/6."""
    run = simulate(Delayed(lone(2.0, 0.0), 1.0), [[1.0]], [[0.0]], (0.0, 2.0), dt=1.0 / 10)
    t = run.t
    exact = 1.0 - t**2 + np.where(t > 1.0, (t - 1.0) ** 4 / 6.0, 0.0)
    np.testing.assert_allclose(run.q[:, 0, 0], exact, atol=2e-5)
    fine = simulate(Delayed(lone(2.0, 0.0), 1.0), [[1.0]], [[0.0]], (0.0, 2.0), dt=1.0 / 80)
    assert abs(fine.q[-1, 0, 0] - exact[-1]) < 1e-8


def test_a_moving_past_is_heard():
    """Before the start the agent moved steadily: what is heard at t = 0 is where it was τ ago, and so is the target."""
    law = Delayed(lone(2.0, 0.5, LinearTarget((1.0,), (3.0,))), 0.1)
    run = simulate(law, [[0.0]], [[4.0]], (0.0, 0.1), dt=0.1 / 50)
    u = -2.0 * ((-0.4) - (1.0 - 0.3)) - 0.5 * (4.0 - 3.0)
    assert (run.p[1, 0, 0] - 4.0) / run.t[1] == pytest.approx(u, abs=5e-3)


@pytest.mark.slow
def test_a_swing_that_was_there_before_goes_on():
    """At the margin cos ωt is a solution: from its own history it goes on, from a motion with its velocity it does not.

    The cubic spline through 81 samples is off by up to 1e-5 at its free end.
    """
    w, tau = 1.3, 0.4
    law = lone(w * w * cos(w * tau), w * sin(w * tau))
    t = np.linspace(-tau, 0.0, 81)[:-1]
    told = Delayed(law, tau, history_t=t, history_q=np.cos(w * t)[:, None, None])
    for late, least, most in ((told, 0.0, 1e-4), (Delayed(law, tau), 0.03, 0.1), (Delayed(told, 0.0), 0.0, 1e-4)):
        run = simulate(late, [[1.0]], [[0.0]], (0.0, 20.0), dt=0.02)
        assert least <= np.abs(run.q[:, 0, 0] - np.cos(w * run.t)).max() <= most
    there = rescale(told, length=3.0, time=2.0)
    assert (there.history_t[0], there.history_q[-1][0][0]) == pytest.approx((-2.0 * tau, 3.0 * cos(w * t[-1])))
    assert from_data(to_data(told)) == told


@pytest.mark.parametrize("late", LATE)
def test_a_short_delay_is_none(late):
    q = hexagonal_spiral(4, 7.0) + 0.2
    p = np.random.default_rng(1).standard_normal(q.shape)
    run = simulate(Delayed(LAW, 1e-3, late), q, p, (0.0, 0.3), dt=1e-3)
    prompt = simulate(LAW, q, p, (0.0, 0.3), t_eval=[0.3])
    np.testing.assert_allclose(run.q[-1], prompt.q[-1], atol=5e-3)
    for none in (0.0, np.zeros((4, 4))) if late == "neighbours" else (0.0,):  # stages see their own states
        steps = simulate(Delayed(LAW, none, late), q, p, (0.0, 0.3), dt=0.01)
        np.testing.assert_allclose(steps.q[-1], simulate(RK4(LAW, 0.01), q, p, (0.0, 0.3)).q[-1], rtol=1e-12)


@pytest.mark.slow
def test_what_is_heard_by_hand():
    """Two agents on a line, the first step from rest: each sees where the other was, "neighbours" itself where it is.

    Drifting together at speed 2 for τ = 0.25 the one behind finds the other half a length nearer, the one ahead finds
    it half a length farther off; both are pushed backwards, and the centre of mass with them. "pairs" has its own past.
    """
    law, q, p = Algorithm1(gains=Gains(c1_alpha=1.0, c2_alpha=0.0)), [[0.0], [7.0]], [[2.0], [2.0]]
    for late, seen in (("neighbours", (6.5, 7.5)), ("pairs", (7.0, 7.0))):
        run = simulate(Delayed(law, 0.25, late), q, p, (0.0, 1e-4), dt=1e-4)
        pulls = [law.acceleration(0.0, [[0.0], [x]], [[0.0], [0.0]])[0, 0] for x in seen]
        u = (run.p[1] - run.p[0])[:, 0] / run.t[1]
        np.testing.assert_allclose(u, [pulls[0], -pulls[1]], atol=1e-3)


def test_one_delay_for_each_pair_is_that_of_all_where_they_agree():
    q = hexagonal_spiral(4, 7.0) + 0.2
    p = np.random.default_rng(1).standard_normal(q.shape)
    runs = [
        simulate(Delayed(LAW, lag, "neighbours"), q, p, (0.0, 0.2), dt=0.005) for lag in (0.02, np.full((4, 4), 0.02))
    ]
    np.testing.assert_allclose(runs[0].q, runs[1].q, rtol=0.0, atol=1e-13)


def test_who_hears_whom_late_is_told_link_by_link():
    """Agent 0 hears agent 1 a quarter late, agent 1 hears agent 0 at once: drifting, only agent 0 is wrong."""
    law, q, p = Algorithm1(gains=Gains(c1_alpha=1.0, c2_alpha=0.0)), [[0.0], [7.0]], [[2.0], [2.0]]
    run = simulate(Delayed(law, [[0.0, 0.25], [0.0, 0.0]], "neighbours"), q, p, (0.0, 1e-4), dt=1e-4)
    pull = law.acceleration(0.0, [[0.0], [6.5]], [[0.0], [0.0]])[0, 0]
    np.testing.assert_allclose((run.p[1] - run.p[0])[:, 0] / 1e-4, [pull, 0.0], atol=1e-3)


def test_a_law_without_pair_terms_hears_agent_by_agent():
    """Cones that look all round are the law itself, whose pair terms are told apart."""
    q = hexagonal_spiral(5, 6.5)
    p = np.random.default_rng(2).standard_normal(q.shape)
    lag = np.linspace(0.0, 0.05, 25).reshape(5, 5)
    laws = (LAW, DirectedNet(LAW, ranges=LAW.alpha.r))
    apart, whole = (simulate(Delayed(law, lag, "neighbours"), q, p, (0.0, 0.2), dt=0.01) for law in laws)
    np.testing.assert_allclose(whole.q, apart.q, rtol=0.0, atol=1e-12)


test_bad_input = refused(
    (lambda: Delayed(LAW, 0.3, **PAST), "delay = 0.3: the history given goes back 0.2, expected one as long as the"),
    (
        lambda: simulate(Delayed(Delayed(LAW, 0.2, **PAST), 0.1), [[0.0, 0.0]], [[0.0, 0.0]], (0, 1), dt=0.1),
        "delay = 0.3: the history given goes back 0.2",
    ),
    (lambda: Delayed(LAW, 0.1, history_t=(-0.2, 0.0), history_q=PAST["history_q"]), "expected rising times below 0"),
    (lambda: Delayed(LAW, 0.1, history_t=(-0.2,), history_q=1.0), r"history_q has shape \(\): expected finite"),
    (
        lambda: simulate(Delayed(LAW, 0.1, **PAST), 2 * [[0.0, 0.0]], 2 * [[0, 0]], (0, 1), dt=0.1),
        "positions of 2 agents",
    ),
    (lambda: Delayed(LAW, [[0.0, 0.1], [0.1, 0.0]]), 'expected late="neighbours"'),
    (lambda: Delayed(CuckerSmale(), 0.1, "pairs"), "expected a sum of terms with a pair term"),
    (lambda: Delayed(None, 0.1), "law = None: expected a continuous law"),
    (lambda: Delayed(LAW, 0.1, "some"), "late = 'some'"),
    (lambda: simulate(Delayed(LAW, 0.1), [[0.0, 0.0]], [[0.0, 0.0]], (0, 1)), "dt = None: Delayed is run in fixed"),
    (lambda: simulate(Delayed(LAW, 0.1), [[0.0]], [[0.0]], (0, 1), dt=0.1), "the target has 2 components"),
    (
        lambda: simulate(Delayed(LAW, 0.1), [[0.0, 0.0]], [[0.0, 0.0]], (0, 1), dt=0.03),
        "dt = 0.03: expected a step that divides the delay or period 0.1, such as 0.025",
    ),
    (
        lambda: simulate(Delayed(LAW, [[0.0, 0.1]], "neighbours"), [[0.0, 0.0]], [[0.0, 0.0]], (0, 1), dt=0.1),
        r"delay has shape \(1, 2\): expected \(1, 1\)",
    ),
    (lambda: Delayed(LAW, 0.1).acceleration(0.0, [[0.0, 0.0]], [[0.0, 0.0]]), "no input at an instant"),
)
