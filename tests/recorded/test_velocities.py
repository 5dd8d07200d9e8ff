"""Velocities from positions lie within their errors, and nothing is invented across long gaps."""

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError
from flockana.recorded.velocities import motions

T = np.linspace(0.0, 4.0, 201)
NOISE = 0.02


def places(t):
    """Two agents, on an ellipse and on a line, and their velocities and accelerations in closed form."""
    q = np.stack([np.stack([3.0 * np.cos(t), 2.0 * np.sin(t)], 1), np.stack([t, 0.5 * t**2], 1)], 1)
    p = np.stack([np.stack([-3.0 * np.sin(t), 2.0 * np.cos(t)], 1), np.stack([np.ones_like(t), t], 1)], 1)
    u = np.stack([np.stack([-3.0 * np.cos(t), -2.0 * np.sin(t)], 1), np.stack([0.0 * t, np.ones_like(t)], 1)], 1)
    return q, p, u


@pytest.fixture(scope="module")
def noisy():
    return places(T)[0] + np.random.default_rng(0).normal(0.0, NOISE, (len(T), 2, 2))


def test_velocities_and_accelerations_lie_within_their_stated_deviations(noisy):
    fit, (q, p, u) = motions(fl.Recording(T, noisy, sd=NOISE)), places(T)
    for mean, true, sd in ((fit.q, q, fit.q_sd), (fit.p, p, fit.p_sd), (fit.u, u, fit.u_sd)):
        inside = np.abs(mean - true) < 1.96 * sd[:, :, None]
        assert 0.93 <= inside.mean() <= 1.0
    assert fit.p_sd.mean() < 0.15  # differences of neighbours are off by √2 noise over 0.02: 1.4


def test_the_recording_with_velocities_states_their_accuracy(noisy):
    rec = fl.Recording(T, noisy, bound=3.0 * NOISE).with_velocities()
    assert (rec.bound, rec.sd) == (None, 3.0 * NOISE)
    assert rec.accuracy.kind == "sd"
    assert (np.linalg.norm(rec.p - places(T)[1], axis=2) <= rec.accuracy.speed).all()
    unknown = fl.Recording(T, noisy).with_velocities()
    assert unknown.estimated
    assert unknown.sd == pytest.approx(NOISE, rel=0.15)


def test_exact_positions_give_velocities_to_the_third_power_of_the_interval():
    fit = motions(fl.Recording(T, places(T)[0], bound=0.0))
    assert np.abs(fit.p - places(T)[1])[3:-3].max() < 2e-4
    assert np.abs(fit.q - places(T)[0]).max() < 1e-6


def test_a_short_gap_is_filled_with_its_own_error_and_a_long_one_stays(noisy):
    q = noisy.copy()
    q[50:56, 0] = np.nan
    q[70:170, 1] = np.nan
    q[:4, 1] = np.nan
    rec = fl.Recording(T, q, sd=NOISE)
    full = rec.filled()
    assert full.present[50:56, 0].all()
    off = np.linalg.norm(full.q - places(T)[0], axis=2)[50:56, 0]
    assert (off < 4.0 * full.sd[50:56, 0]).all()
    assert not full.present[:4, 1].any()  # nothing before the first sample
    assert not full.present[70:170, 1].any()
    assert rec.filled(longest=0.05).gaps == rec.gaps
    with pytest.raises(ArgumentError, match="agent 1 has 3 samples: expected 4 or more"):
        motions(fl.Recording(T, np.where(np.arange(201)[:, None, None] < [[[9], [3]]], noisy, np.nan), sd=NOISE))


def test_units_do_not_change_what_is_smoothed(noisy):
    one, other = fl.Recording(T, noisy, sd=NOISE), fl.Recording(60.0 * T, 1e3 * noisy, sd=1e3 * NOISE)
    np.testing.assert_allclose(motions(one).p * 1e3 / 60.0, motions(other).p, rtol=1e-6, atol=1e-8)
