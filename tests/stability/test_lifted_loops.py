"""Sampled loops with delays and clocks: against runs of the wrapped law, an augmented map by hand, and closed forms."""

from math import inf

import numpy as np
import pytest
from scipy.linalg import expm

from flockana import Algorithm2, Delayed, Gains, NetConsensus, Sampled, StaticTarget, linearise, simulate
from flockana.stability import delayed_sampling_margin, sampled_delay_margin
from flockana.stability.delay import DelaySystem
from flockana.stability.delay_roots import LatePart
from flockana.stability.lifted_loops import moving_multipliers, period_map
from tests.refused import refused


def scalar(k, d):
    blank = np.zeros((1, 1))
    return DelaySystem((blank, blank), (np.array([[k]]), np.array([[d]])), neutral=int(k == 0.0))


def radius_by_hand(k, d, delay, period):
    """Hold with a delay (l − 1) h < τ <= l h by exponentials: u(kh + τ), the input arrives late, states are prompt."""
    # u_k = −k q(t_k) − d p(t_k) read at t_k and applied from t_k + τ on for a period: the same loop, its clock moved
    whole, rest = divmod(delay, period)
    steps, a = int(whole), np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
    first, second = expm(a * rest), expm(a * (period - rest))
    # state (q, p, u_{k−1}, … u_{k−steps−1}): the older input acts for `rest`, then the newer one
    size = 2 + steps + 1
    step = np.zeros((size, size))
    x = np.eye(2, size)
    newer = -np.array([[k, d]]) @ x if steps == 0 else np.eye(1, size, 2 + steps - 1)
    older = np.eye(1, size, 2 + steps)
    x = first[:2, :2] @ x + first[:2, 2:] @ older
    x = second[:2, :2] @ x + second[:2, 2:] @ newer
    step[:2] = x
    step[2] = (-np.array([[k, d]]) @ np.eye(2, size))[0]
    for j in range(steps):
        step[3 + j, 2 + j] = 1.0
    return float(np.abs(np.linalg.eigvals(step)).max())


@pytest.mark.parametrize(
    ("delay", "period"), [(0.0, 0.3), (0.1, 0.3), (0.3, 0.3), (0.45, 0.3), (0.71, 0.2), (0.2, 0.7)]
)
def test_multipliers_are_those_of_exponentials(delay, period):
    parts = [LatePart(0.0, *np.zeros((2, 1, 1))), LatePart(delay, np.array([[1.3]]), np.array([[0.9]]))]
    found = np.abs(moving_multipliers(parts, period, np.zeros(1), 0)[0])
    assert found == pytest.approx(radius_by_hand(1.3, 0.9, delay, period), rel=1e-10)


def test_without_delay_the_map_has_the_closed_form():
    """z² + (d h + ½ k h² − 2) z + 1 − d h + ½ k h² = 0; a damper alone keeps its place, z = 1 apart."""
    k, d, h = 1.3, 0.9, 0.4
    parts = [LatePart(0.0, np.array([[k]]), np.array([[d]]))]
    roots = np.roots([1.0, d * h + 0.5 * k * h * h - 2.0, 1.0 - d * h + 0.5 * k * h * h])
    found = moving_multipliers(parts, h, np.zeros(1), 0)[:2]
    np.testing.assert_allclose(np.sort_complex(found), np.sort_complex(roots), rtol=1e-12)
    drag = moving_multipliers([LatePart(0.0, np.zeros((1, 1)), np.array([[d]]))], h, np.zeros(1), 1)
    assert drag[0] == pytest.approx(1.0 - d * h, rel=1e-12)


def test_margins_with_a_hold_are_where_the_hand_made_map_grows():
    k, d, h = 1.3, 0.9, 0.3
    margin = sampled_delay_margin(scalar(k, d), h)
    assert (
        radius_by_hand(k, d, margin.delay * (1.0 - 1e-6), h)
        < 1.0
        < radius_by_hand(k, d, margin.delay * (1.0 + 1e-6), h)
    )
    longest = delayed_sampling_margin(scalar(k, d), 0.2)
    assert radius_by_hand(k, d, 0.2, longest.period * (1.0 - 1e-6)) < 1.0
    assert radius_by_hand(k, d, 0.2, longest.period * (1.0 + 1e-6)) > 1.0
    assert not margin.certified
    assert not longest.certified
    assert margin.frequency * h < np.pi


def test_a_short_hold_costs_half_a_period():
    from flockana.stability import scalar_margin

    exact = scalar_margin(1.3, 0.9).delay
    assert sampled_delay_margin(scalar(1.3, 0.9), 0.02).delay == pytest.approx(exact - 0.01, abs=1e-3 * exact)
    assert sampled_delay_margin(scalar(1.3, 0.9), 3.0).delay == 0.0  # without any delay it grows
    assert delayed_sampling_margin(scalar(1.3, 0.9), 2.0 * exact).period == 0.0
    assert sampled_delay_margin(scalar(0.0, 0.0), 0.1).delay == inf


def test_a_run_of_the_wrapped_law_is_the_map():
    """Two agents on a line, one leads and drifts: the run in steps of a quarter period, sample by sample."""
    late = Sampled(Delayed(NetConsensus([[0.0, 0.0], [2.0, 0.0]], velocity=1.5), 0.1), 0.2)
    flock = linearise(late, np.zeros((2, 1)))
    run = simulate(late, [[0.0], [1.0]], [[0.2], [0.3]], (0.0, 4.0), dt=0.05)

    def state(k):
        """q, p at a sample, the input from there on, and those of earlier periods."""
        inputs = [run.u[k + 1 - 4 * j][:, 0] for j in range(len(flock.A) // 2 - 2)]
        return np.concatenate([run.q[k][:, 0], run.p[k][:, 0], *inputs])

    for k in (12, 16, 40):
        np.testing.assert_allclose(flock.A @ state(k), state(k + 4), atol=1e-12)


def test_a_flock_of_clocks_is_stable_as_its_run():
    """c1γ = 4, c2γ = 1: a hold bears 0.5, whatever the clocks of two agents that do not hear each other."""
    law = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=1.0), target=StaticTarget((0.0,)))
    for period, stable in ((0.45, True), (0.55, False)):
        sampled = Sampled(law, period, offsets=(0.0, period / 3.0))
        flock = linearise(sampled, [[-50.0], [50.0]], allow_residual=True)
        assert flock.stable is stable
        assert flock.spectral_radius == pytest.approx(
            linearise(Sampled(law, period), [[0.0]]).spectral_radius, rel=1e-9
        )


def test_the_map_shows_its_states():
    flock = linearise(Sampled(Delayed(Algorithm2(target=StaticTarget((0.0,))), 0.1), 0.2), [[0.0]])
    assert flock.states[:3] == ("q0_x", "p0_x", "u0_x")
    assert flock.inputs == ("dp0_x",)
    assert flock.state_space.dt == 0.2
    np.testing.assert_array_equal(flock.B[:, 0], flock.A[:, 1])


test_bad_input = refused(
    (lambda: period_map([LatePart(1.0, *np.eye(1)[None].repeat(2, 0))], 1e-4, np.zeros(1)), "the lifted map has"),
    (lambda: sampled_delay_margin(scalar(1.0, 1.0), 0.0), "period = 0: expected a number > 0"),
)


def test_growth_that_begins_and_ends_below_a_period_is_seen():
    """A directed net with neighbours heard 1 late: held for 1/7 it grows, for 0.135 and 0.155 it does not."""
    W = [[0, 1.1, 0, 0.5, 0], [0, 0, 1.5, 1.7, 0], [1, 1.2, 0, 0, 1], [0, 0, 0, 0, 1.5], [0.9, 1.2, 0, 0, 0]]
    flock = linearise(NetConsensus(W, position=1.0, velocity=2.8), np.zeros((5, 1)))
    period = flock.sampling_margin(delay=1.0, delayed="neighbours").period
    assert 0.142 < period < 1.0 / 7.0


def test_the_shortest_period_fits_the_largest_map(monkeypatch):
    """With few states allowed the search begins at a longer period, and finds the same margin."""
    system = scalar(4.0, 1.0)
    exact = delayed_sampling_margin(system, 0.1).period
    for module in ("lifted_loops", "sampled_delays"):
        monkeypatch.setattr(f"flockana.stability.{module}.MOST", 40)
    assert delayed_sampling_margin(system, 0.1).period == pytest.approx(exact, rel=1e-9)
