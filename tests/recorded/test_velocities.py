"""Velocities from positions lie within their errors, and nothing is invented across long gaps."""

import warnings

import numpy as np
import pytest

import flockana as fl
from flockana.recorded.velocities import grid_of, motions
from tools import velocity_coverage

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
    given = fl.Recording(T, noisy, bound=3.0 * NOISE)
    rec = given.with_velocities()
    assert (rec.bound, rec.sd, rec.accuracy.kind) == (3.0 * NOISE, None, "estimated")  # they decide nothing
    assert (np.linalg.norm(rec.p - places(T)[1], axis=2) <= rec.accuracy.speed).all()
    assert rec.measured.accuracy.kind == "bound"
    assert rec.measured.p is None
    unknown = fl.Recording(T, noisy).with_velocities()
    assert unknown.estimated
    assert unknown.sd == pytest.approx(NOISE, rel=0.15)


def test_exact_positions_give_velocities_to_the_third_power_of_the_interval():
    fit = motions(fl.Recording(T, places(T)[0], bound=0.0))
    assert np.abs(fit.p - places(T)[1])[3:-3].max() < 2e-4
    assert np.abs(fit.q - places(T)[0]).max() < 1e-6


def test_a_gap_says_nothing_of_the_samples_beside_it():
    """A rests at 0, is hidden for two time units, and rests at a shift; B rests. All velocities are 0."""
    t = np.arange(101) * 0.1
    for shift in (0.01, 1.0, 200.0):
        q = np.zeros((101, 2, 1))
        q[60:, 0], q[:, 1] = shift, 3.0
        q[40:60, 0] = np.nan
        rec = fl.Recording(t, q, bound=1e-3)
        fit = motions(rec)
        assert (np.abs(fit.p[:, :, 0]) <= fit.p_sd)[rec.present].all()
        assert np.nanmax(np.abs(fit.p)) < 1e-6  # shift/4 across the gap
        assert np.isnan(fit.p[40:60, 0]).all()
        assert rec.filled().gaps == rec.gaps


@pytest.mark.parametrize("kind", velocity_coverage.KINDS)
@pytest.mark.parametrize(
    "seeds",
    [
        range(3),
        pytest.param(range(3, 40), marks=pytest.mark.slow),
        pytest.param(range(200), marks=[pytest.mark.slow, pytest.mark.attack]),
    ],
    ids=["few", "many", "all"],
)
def test_velocities_lie_within_95_percent_beside_gaps_too(kind, seeds):
    outcomes = [velocity_coverage.outcome(kind, seed) for seed in seeds]
    assert np.mean([one["all"] for one in outcomes]) >= 0.93
    assert len(seeds) < 30 or np.mean([one["beside"] for one in outcomes]) >= 0.93


def test_a_straight_motion_is_told_from_one_that_bends():
    """Velocities of straight pieces are those of least squares; one of a curve that noise does not hide is not."""
    rng, t = np.random.default_rng(7), np.arange(80) * 0.05
    p = rng.normal(0.0, 1.0, (4, 2))
    q = p * t[:, None, None] + rng.normal(0.0, NOISE, (80, 4, 2))
    q[30:40, 0] = np.nan
    q[:, 2] += 0.1 * (t[:, None] - 2.0) ** 2
    q[:, 3] += 0.2 * np.sin(1.6 * (t[:, None] - t.mean()))  # no part of it is a constant acceleration
    fit = motions(fl.Recording(t, q, sd=NOISE))
    for agent, part in ((0, slice(0, 30)), (0, slice(40, 80)), (1, slice(0, 80))):
        slope = np.polyfit(t[part], q[part, agent], 1)[0]
        np.testing.assert_allclose(fit.p[part, agent], np.broadcast_to(slope, fit.p[part, agent].shape), rtol=1e-9)
        np.testing.assert_allclose(np.abs(slope - p[agent]), 0.0, atol=0.05)  # 0.15 at their deviation before
    assert np.ptp(fit.p[:, 2], axis=0).min() > 0.5  # 0.8 in truth
    assert np.ptp(fit.p[:, 3], axis=0).min() > 0.4  # 0.64 in truth
    assert (fit.u[:, 1] == 0.0).all()
    assert (np.abs(fit.p[:, 1] - p[1]) <= fit.p_sd[:, 1, None]).all()


def test_the_step_of_a_grid_is_found():
    rng = np.random.default_rng(0)
    assert grid_of(0.25 * rng.integers(-9, 9, (30, 2))) == 0.25
    assert grid_of(np.round(rng.normal(size=(300, 2)), 2)) == pytest.approx(0.01)
    assert grid_of(rng.normal(size=(30, 2))) == 0.0


def bounded_motion(rng, most):
    """Positions and velocities every 0.05 under an acceleration that turns at random and is `most` in size."""
    u = rng.normal(size=(20, 2))
    u = np.repeat(most * u / np.linalg.norm(u, axis=1, keepdims=True), 4, axis=0)
    p = np.vstack([np.zeros((1, 2)), 0.05 * np.cumsum(u, axis=0)])
    return np.vstack([np.zeros((1, 2)), np.cumsum(0.05 * p[:-1] + 0.5 * 0.05**2 * u, axis=0)]), p


@pytest.mark.slow
@pytest.mark.parametrize("velocities", ["none", "recorded", "smoothed"])
def test_a_filled_gap_holds_every_motion_of_bounded_acceleration(velocities):
    """No bound holds of smoothed velocities, on which the positions in the gap must not rest."""
    rng, widest = np.random.default_rng(1), 0.0
    for end in (50, 33) * 30:
        q, p = bounded_motion(rng, 2.0)
        hidden = q.copy()
        hidden[30:end] = np.nan
        recorded = p[:, None] if velocities == "recorded" else None
        rec = fl.Recording(np.arange(81) * 0.05, hidden[:, None], recorded, bound=1e-6)
        full = (rec.with_velocities() if velocities == "smoothed" else rec).filled(most_acceleration=2.0)
        assert full.gaps == 0
        off = np.linalg.norm(full.q[:, 0] - q, axis=1)
        assert (off <= full.bound[:, 0] + 1e-9).all()
        if velocities != "none":
            slip = np.linalg.norm(full.p[:, 0] - p, axis=1)[30:end]
            assert (slip <= (full.p_bound if velocities == "recorded" else full.p_sd)[30:end, 0] + 1e-9).all()
        widest = max(widest, float((off / full.bound[:, 0])[30:end].max()))
    assert widest > 0.3  # and not for nothing


def test_the_error_in_a_gap_is_that_of_the_worst_motion():
    """A T²/8 off the middle of a chord; with velocities A T²/16, by Peano's kernel of the cubic."""
    q = np.zeros((9, 1, 1))
    q[3:6] = np.nan
    t, p = np.arange(9.0), np.zeros((9, 1, 1))
    for velocities, error in ((None, 2.0 * 16.0 / 8.0), (p, 2.0 * 16.0 / 16.0)):
        full = fl.Recording(t, q, velocities, bound=0.0).filled(most_acceleration=2.0)
        assert full.bound[4, 0] == pytest.approx(error)
    assert fl.Recording(t, q, bound=0.0).filled(most_acceleration=2.0, longest=3.0).gaps == 3


@pytest.mark.slow
def test_exact_samples_around_a_filled_gap_are_smoothed_without_overflow():
    """Deviations from 1e-7 to 1 of the flock's size: without jerk covariances would be rounding, which grows."""
    t, rng = np.linspace(0.0, 3.0, 151), np.random.default_rng(3)
    q = fl.lattice.triangular(5, 7.0) + rng.normal(0.0, 0.3, (5, 2))
    a, w = rng.normal(0.0, 1.0, (5, 2)), rng.uniform(1.0, 4.0, (5, 1))
    q, p = q + a * np.sin(w * t[:, None, None]), a * w * np.cos(w * t[:, None, None])
    q[40:60, 1] = np.nan
    with warnings.catch_warnings(action="error"):
        fit = motions(fl.Recording(t, q).filled(most_acceleration=200.0))
    assert np.abs(fit.p - p)[100:].max() < 0.01


def test_pieces_of_three_samples_have_no_velocity():
    q = np.where(np.arange(201)[:, None, None] < [[[9], [3]]], places(T)[0], np.nan)
    fit = motions(fl.Recording(T, q, sd=NOISE))
    assert (fit.known.sum(axis=0) == [9, 0]).all()


@pytest.mark.parametrize("count", [4, 5, 6])
def test_the_fewest_samples_have_velocities(count):
    fit = motions(fl.Recording(T[:count], places(T[:count])[0], sd=1e-6))
    assert (np.abs(fit.p - places(T[:count])[1]) <= 3.0 * fit.p_sd[:, :, None]).all()


def test_units_do_not_change_what_is_smoothed(noisy):
    one, other = fl.Recording(T, noisy, sd=NOISE), fl.Recording(60.0 * T, 1e3 * noisy, sd=1e3 * NOISE)
    np.testing.assert_allclose(motions(one).p * 1e3 / 60.0, motions(other).p, rtol=1e-6, atol=1e-8)
