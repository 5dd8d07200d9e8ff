"""Linearised loops: parts of K and D by delay against differences of the wrapped law's own input, and runs."""

import numpy as np
import pytest

from flockana import (
    Algorithm1,
    Algorithm2,
    Delayed,
    DirectedNet,
    Disturbed,
    Gains,
    Lossy,
    Measured,
    NetConsensus,
    RationalWeight,
    Sampled,
    Saturated,
    StaticTarget,
    TaylorStep,
    compose,
    find_equilibrium,
    lattice,
    linearise,
    simulate,
)
from flockana.base.errors import ArgumentError
from flockana.base.finite_differences import differences
from flockana.interactions import AlphaInteraction
from flockana.laws.wrapper_base import Step, View
from flockana.stability import DelayLinearisation, DelaySystem, Linearisation, MapLinearisation
from flockana.stability.wrapped_loops import late_parts
from tests.refused import refused

LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))
REST = find_equilibrium(LAW, lattice.hexagonal_patch(1, 7.0))
LAGS = 0.01 + 0.02 * np.random.default_rng(0).permutation(49).reshape(7, 7) / 49.0


def by_differences(law, q, delays):
    """−∂u/∂(what was a delay ago), by differences of the wrapped law's own input about a flock that rests there."""

    def input_after(delay, which, moved):
        past = {0.0: (q, 0.0 * q)} | dict.fromkeys(delays, (q, 0.0 * q))
        past[delay] = (moved, 0.0 * q) if which == 0 else (q, moved)
        nearest = np.array(list(past))

        def recall(s):
            return past[float(nearest[np.argmin(np.abs(nearest + s))])]

        return law.input(Step(0, 1.0, recall), View(0.0, *past[0.0]))

    return {
        delay: [
            -differences(lambda x: input_after(delay, which, x), q if which == 0 else 0.0 * q, 7.0).matrix  # noqa: B023
            for which in (0, 1)
        ]
        for delay in delays
    }


@pytest.mark.slow
@pytest.mark.parametrize(
    "law",
    [
        Delayed(LAW, 0.01),
        Delayed(LAW, 0.01, "pairs"),
        Delayed(LAW, 0.01, "neighbours"),
        Delayed(LAW, LAGS, "neighbours"),
        Delayed(Delayed(LAW, 0.01, "neighbours"), 0.02),
        Saturated(Delayed(LAW, 0.01, "neighbours"), 50.0),
        Delayed(compose(pair=AlphaInteraction(), navigation=StaticTarget((0.0, 0.0)), drag=0.7), 0.01, "pairs"),
        Delayed(compose(pair=AlphaInteraction(), consensus=RationalWeight(9.0, 1.0)), 0.01, "neighbours"),
    ],
    ids=["all", "pairs", "neighbours", "by pair", "nested", "saturated", "drag", "alignment"],
)
def test_the_parts_are_those_of_the_input(law):
    parts = late_parts(law, (0.0, REST.q, 0.0 * REST.q))
    expected = by_differences(law, REST.q, sorted({0.0, *(part.delay for part in parts)}))
    size = max(float(np.abs(k).max()) for k, _ in expected.values())
    known = {part.delay: part for part in parts}
    for delay, (k, d) in expected.items():
        blank = np.zeros_like(k)
        np.testing.assert_allclose(getattr(known.get(delay), "stiffness", blank), k, atol=1e-8 * size)
        np.testing.assert_allclose(getattr(known.get(delay), "damping", blank), d, atol=1e-8 * size)


def test_of_lost_messages_the_mean_remains():
    """With probability ¼ a message is lost: pair terms at ¾, the pull as it is; d is the rest of both."""
    pair = [[0.0, 0.0], [7.0, 0.0]]
    law = Algorithm1()
    mean, own = linearise(Lossy(law, 0.25), pair), linearise(law, pair)
    np.testing.assert_allclose(mean.stiffness.toarray(), 0.75 * own.stiffness.toarray(), atol=1e-12)
    np.testing.assert_allclose(mean.damping.toarray(), 0.75 * own.damping.toarray(), atol=1e-12)
    with pytest.raises(ArgumentError, match="the state is no equilibrium"):  # the pull is balanced by all messages
        linearise(Lossy(LAW, 0.25), REST)


def test_noise_is_left_out_and_limits_are_not_met():
    own = linearise(LAW, REST)
    for law in (Measured(LAW, 0.1), Disturbed(LAW, intensity=0.3), Saturated(LAW, 30.0), Saturated(Measured(LAW), 9.0)):
        flock = linearise(law, REST)
        assert type(flock) is Linearisation
        np.testing.assert_allclose(flock.A, own.A, atol=1e-12 * np.abs(own.A).max())
        assert flock.state_space.input_labels == own.state_space.input_labels  # the γ-agent's too


def test_beyond_its_limit_an_input_turns_and_does_not_grow():
    """u = −(k q + d p) cut to length L: ∂u/∂q = −k L/|u| (1 − û ûᵀ)."""
    one = Algorithm2(gains=Gains(c1_gamma=2.0, c2_gamma=1.0), target=StaticTarget((0.0, 0.0)))
    flock = linearise(Saturated(one, 5.0), [[3.0, 4.0]], allow_residual=True)
    u = np.array([0.6, 0.8])
    expected = 2.0 * 0.5 * (np.eye(2) - np.outer(u, u))
    np.testing.assert_allclose(flock.stiffness.toarray(), expected, atol=1e-14)
    clipped = linearise(Saturated(one, 7.0, by="component"), [[3.0, 4.0]], allow_residual=True)
    np.testing.assert_allclose(clipped.stiffness.toarray(), [[2.0, 0.0], [0.0, 0.0]], atol=1e-14)


def test_a_directed_net_is_linearised_by_its_own_ranges():
    """Agent 0 sees agent 1 with its spring and damper; agent 1, whose range is shorter, does not see agent 0."""
    law, pair = DirectedNet(Algorithm1(), (8.4, 3.0)), [[0.0], [7.0]]
    k, d = (part.toarray() for part in (linearise(law, pair).stiffness, linearise(law, pair).damping))
    full = linearise(Algorithm1(), pair)
    np.testing.assert_allclose(k, np.vstack([full.stiffness.toarray()[0], [0.0, 0.0]]), atol=1e-12)
    np.testing.assert_allclose(d, np.vstack([full.damping.toarray()[0], [0.0, 0.0]]), atol=1e-12)
    assert linearise(law, pair).stable


@pytest.mark.slow
@pytest.mark.parametrize("late", ["all", "pairs", "neighbours"])
def test_a_delayed_flock_decays_as_its_rightmost_root(late):
    """Two agents on a line, their distance pushed: ln of the swing over time falls as the rightmost root says."""
    law = Algorithm1(gains=Gains(c1_alpha=3.0, c2_alpha=11.0))
    delayed = Delayed(law, 0.02, late)
    flock = linearise(delayed, [[0.0], [7.0]])
    root = next(s for s in flock.rightmost(6) if s.imag > 0.0)  # of the distance; a common drift may be slower
    assert flock.stable
    run = simulate(delayed, [[0.0], [7.0 + 1e-5]], np.zeros((2, 1)), (0.0, 6.0), dt=0.01)
    gap = run.q[:, 1, 0] - run.q[:, 0, 0] - 7.0
    late_half = run.t >= 2.0
    wave = np.exp(root * run.t[late_half])
    basis = np.column_stack([wave.real, wave.imag, np.ones(wave.size)])
    fit, *_ = np.linalg.lstsq(basis, gap[late_half], rcond=None)
    # what is left beside the slowest swing is far below it
    assert np.abs(basis @ fit - gap[late_half]).max() < 2e-3 * np.abs(gap[late_half]).max()


def test_delays_of_pairs_have_margins_together():
    """Of one delay it is the margin over the delay; of many there is no other."""
    late = linearise(Delayed(LAW, LAGS, "neighbours"), REST)
    assert isinstance(late, DelayLinearisation)
    assert len(late.delays) > 20
    assert late.stable
    with pytest.raises(ArgumentError, match=r"the flock has \d+ delays"):
        late.delay_margin()
    one = linearise(Delayed(Algorithm2(target=StaticTarget((0.0,))), 0.2), [[0.0]])
    assert 0.2 * one.scaled_margin(5.0) == pytest.approx(one.delay_margin().delay, rel=1e-9)


def test_the_margin_of_a_delayed_law_is_that_of_its_system():
    late, flock = linearise(Delayed(LAW, 0.01, "pairs"), REST), linearise(LAW, REST)
    margin = late.delay_margin().delay
    assert margin == pytest.approx(flock.delay_margin(delayed="pairs").delay, rel=1e-9)
    assert margin > 0.01
    assert isinstance(late.system, DelaySystem)
    assert "rightmost roots" in str(late)
    table = late.damp(4)
    assert table.shape == (4, 5)
    beyond = linearise(Delayed(LAW, 0.014, "pairs"), REST)
    assert not beyond.stable
    assert beyond.decay_rate < 0.0


def test_a_sampled_law_is_the_taylor_step_of_its_period():
    sampled, stepped = linearise(Sampled(LAW, 0.02), REST), linearise(TaylorStep(LAW, 0.02), REST)
    assert isinstance(sampled, MapLinearisation)
    assert sampled.dt == 0.02
    np.testing.assert_allclose(sampled.A, stepped.A, atol=1e-14)
    assert [mode.name for mode in sampled.zero_modes] == ["rotation"]


def test_a_linearisation_is_taken_as_it_is():
    flock = linearise(LAW, REST)
    assert linearise(LAW, flock) is flock


test_bad_input = refused(
    (lambda: linearise(Sampled(Sampled(LAW, 0.1), 0.1), REST), "the law has 2 holds, Sampled within Sampled"),
    (
        lambda: linearise(Delayed(NetConsensus(np.eye(2, k=1)), 0.1), [[0.0], [0.0]], [[0.0], [1.0]]),
        "the state is no equilibrium of NetConsensus",
    ),
    (
        lambda: linearise(Delayed(Algorithm1(), 0.1, "neighbours"), [[0.0], [7.0]], [[1.0], [1.0]]),
        "agents that move hear where their neighbours were",
    ),
    (
        lambda: linearise(Saturated(Disturbed(LAW, force=(1.0, 0.0)), 1.0), [[0.0, 0.0]], allow_residual=True),
        "the input of agent 0 is at its limit 1",
    ),
)


NET = NetConsensus([[0, 1, 0, 0], [0, 0, 1, 0], [0.5, 0, 0, 1], [1, 0, 0, 0]], velocity=2.0)


@pytest.mark.slow
@pytest.mark.parametrize("late", ["pairs", "neighbours"])
def test_a_delay_margin_of_a_net_is_met_by_its_runs(late):
    """3 % below the margin the delayed net comes together, 3 % above it swings apart, at the margin's frequency."""
    margin = linearise(NET, np.zeros((4, 1))).delay_margin(delayed=late)
    for factor, decays in ((0.97, True), (1.03, False)):
        law = Delayed(NET, factor * margin.delay, late)
        about = linearise(law, np.zeros((4, 1)))
        assert about.stable is decays
        span, step = 40.0 * 2.0 * np.pi / margin.frequency, factor * margin.delay / 8.0
        run = simulate(law, [[1.0], [-1.0], [0.5], [0.0]], np.zeros((4, 1)), (0.0, span), dt=step)
        apart = np.abs(run.q[:, 1:, 0] - run.q[:, :1, 0]).max(axis=1)
        middle, end = (float(apart[(run.t > a * span) & (run.t <= (a + 0.25) * span)].max()) for a in (0.5, 0.75))
        assert np.log(end / middle) / (0.25 * span) == pytest.approx(-about.decay_rate, rel=0.15)
