"""Laws of first order: runs against other solvers and exact ones, their poles, and what refuses them by name."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.linalg import expm

import flockana as fl
from flockana.base.errors import ArgumentError
from flockana.stability import robustness_margins
from flockana.theorems.run_consistency import ensure_fits
from tests.refused import refused

TURN = np.array([[0.0, -1.0], [1.0, 0.0]])


@dataclass(frozen=True)
class Whirl(fl.VelocityLaw):
    """q' = -rate q + turned q + cos t: rates and motion are known."""

    rate: float = 0.5
    functions = ()

    def velocity(self, t, q):
        return -self.rate * q + q @ TURN.T + np.cos(t)


@dataclass(frozen=True)
class Pulled(Whirl):
    """Another law, whose slopes are not written anew."""

    def velocity(self, t, q):
        return -(q**3)


@dataclass(frozen=True)
class Sloped(Whirl):
    def slopes(self, t, q):
        raise AssertionError


@dataclass(frozen=True)
class Steeper(Sloped):
    def velocity(self, t, q):
        return -2.0 * q


Q = np.random.default_rng(3).normal(size=(4, 2))
LAW = Whirl()
RUN = fl.simulate(LAW, Q, None, (0.5, 3.0), t_eval=[0.5, 1.7, 3.0])


def exact(t):
    """The motion from t = 0.5: e^{Bt} of the start beside that of the push, B with (cos, sin) as two more states."""
    whole = np.zeros((4, 4))
    whole[:2, :2], whole[:2, 2], whole[2:, 2:] = -0.5 * np.eye(2) + TURN, 1.0, TURN
    start = np.concatenate([Q, np.tile([np.cos(0.5), np.sin(0.5)], (4, 1))], axis=1)
    return (start @ expm(whole * (t - 0.5)).T)[:, :2]


def test_a_run_is_the_exact_motion_with_its_velocity_and_the_rate_of_that():
    steps = fl.simulate(LAW, Q, None, (0.5, 3.0))
    for t, q, p, u in (sample for run in (RUN, steps) for sample in zip(run.t, run.q, run.p, run.u, strict=True)):
        np.testing.assert_allclose(q, exact(t), rtol=0.0, atol=2e-8)
        np.testing.assert_allclose(p, LAW.velocity(t, q), rtol=0.0, atol=1e-15)
        np.testing.assert_allclose(u, -0.5 * p + p @ TURN.T - np.sin(t), rtol=0.0, atol=1e-9)
    assert np.isnan(RUN.energy()).all()
    assert {"cohesion_radius", "min_distance"} <= set(RUN.metrics())


@pytest.mark.parametrize(("method", "dt", "error"), [("RK4", 0.05, 4e-7), ("Radau", None, 1e-7), ("BDF", None, 1e-6)])
def test_other_methods_agree_to_their_order(method, dt, error):
    run = fl.simulate(LAW, Q, None, (0.5, 3.0), method=method, dt=dt)
    assert np.abs(run.q[-1] - exact(3.0)).max() <= error
    if dt:
        half = fl.simulate(LAW, Q, None, (0.5, 3.0), method=method, dt=dt / 2.0)
        assert np.abs(run.q[-1] - exact(3.0)).max() / np.abs(half.q[-1] - exact(3.0)).max() == pytest.approx(16.0, 0.1)


def test_files_units_windows_and_starts_keep_it(tmp_path):
    RUN.save(tmp_path / "run.nc")
    again = fl.Trajectory.load(tmp_path / "run.nc")
    assert again.law == LAW
    assert np.array_equal(again.p, RUN.p)
    part = RUN.window(1.0, 3.0)
    for run in (again, part):
        ensure_fits(run)
    fall = fl.simulate(Steeper(), Q, None, (0.0, 1.0)).in_units(3.0, 1.0)
    ensure_fits(fall)
    np.testing.assert_allclose(fall.p, -2.0 * fall.q, rtol=1e-15)
    follow = fl.simulate(LAW, part.q[0], part.p[0], (1.7, 3.0))  # its own velocities are welcome
    np.testing.assert_allclose(follow.q[-1], RUN.q[-1], atol=1e-8)
    assert np.array_equal(fl.Flock(LAW, Q).start()[1], LAW.velocity(0.0, Q))
    assert set(fl.applicable(LAW, Q).columns) >= {"theorem", "status"}


def test_a_run_of_other_velocities_is_no_evidence():
    other = replace(RUN, p=RUN.p + 1e-6)
    with pytest.raises(ArgumentError, match="from the velocity of Whirl"):
        ensure_fits(other)
    ensure_fits(RUN)


def test_the_poles_are_as_many_as_coordinates_and_those_of_the_matrix():
    about = fl.linearise(LAW, np.zeros((3, 2)), t=np.pi / 2.0, force_tolerance=1e-9)
    np.testing.assert_allclose(about.A, np.kron(np.eye(3), -0.5 * np.eye(2) + TURN), atol=1e-12)
    np.testing.assert_allclose(sorted(about.eigenvalues.imag), [-1.0] * 3 + [1.0] * 3, atol=1e-12)
    assert (len(about.eigenvalues), about.zero_modes, about.stable) == (6, 0, True)
    assert about.decay_rate == pytest.approx(0.5, rel=1e-12)
    assert about.state_space.nstates == 6
    assert not fl.linearise(Whirl(-0.1), np.zeros((1, 2)), t=np.pi / 2.0).stable


def test_slopes_of_another_law_are_not_taken():
    np.testing.assert_allclose(Steeper().jacobian(0.0, Q), -2.0 * np.eye(8), atol=1e-10)
    np.testing.assert_allclose(np.diag(Pulled().jacobian(0.0, Q)), -3.0 * Q.ravel() ** 2, atol=1e-9)


HALF, DIRECTED = fl.AverageConsensus([[0.0, 0.5], [0.5, 0.0]]), fl.AverageConsensus(np.roll(np.eye(5), 1, axis=1))
PATH = fl.AverageConsensus([[0.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 0.0]])


@pytest.mark.parametrize("dt", [1.0, 0.05])
def test_a_late_run_is_the_polynomial_of_the_method_of_steps(dt, tmp_path):
    run = fl.simulate(fl.Delayed(HALF, 1.0), [[1.0], [-1.0]], None, (0.0, 4.0), dt=dt)  # x' = -x(t - 1), from rest at 1
    at = [round(t / dt) for t in range(5)]
    np.testing.assert_allclose(run.q[at, 0, 0], [1.0, 0.0, -1 / 2, -1 / 6, 5 / 24], atol=1e-15)
    np.testing.assert_allclose(run.p[at[1:], 0, 0], -run.q[at[:-1], 0, 0], atol=1e-15)  # the velocity that arrives
    np.testing.assert_allclose(run.u[1:], np.diff(run.p, axis=0) / dt, atol=1e-13)  # mean over the step
    run.save(tmp_path / "late.nc")
    again = fl.Trajectory.load(tmp_path / "late.nc")
    assert (again.law, np.array_equal(again.q, run.q)) == (run.law, True)


def test_a_history_is_followed_and_no_delay_is_none():
    t = np.linspace(-1.0, 0.0, 41)[:-1]
    past = np.cos(t)[:, None, None] * [[1.0], [-1.0]]
    late = fl.Delayed(HALF, 1.0, history_t=t, history_q=past)
    run = fl.simulate(late, [[1.0], [-1.0]], None, (0.0, 1.0), dt=0.05)
    assert run.q[-1, 0, 0] == pytest.approx(1.0 - np.sin(1.0), abs=1e-6)  # 1 - the integral of cos over [-1, 0]
    soon = fl.simulate(fl.Delayed(HALF, 0.0), [[1.0], [-1.0]], None, (0.0, 1.0), dt=0.05)
    assert soon.q[-1, 0, 0] == pytest.approx(np.exp(-1.0), abs=1e-6)


@pytest.mark.parametrize("law", [PATH, DIRECTED])
def test_consensus_bears_the_delay_and_the_period_of_the_closed_forms_and_no_more(law):
    moving = [mu for mu in np.linalg.eigvals(law.laplacian) if abs(mu) > 1e-9]
    margin = min((np.pi / 2.0 - abs(np.angle(mu))) / abs(mu) for mu in moving)
    assert law is DIRECTED or margin == pytest.approx(np.pi / 6.0)  # π/(2 λ_n), λ_n = 3
    period, q0 = (
        min(2.0 * mu.real / abs(mu) ** 2 for mu in moving),
        np.linspace(0.0, 1.0, len(law.weights))[:, None] ** 2,
    )
    for share, grows in ((0.95, False), (1.05, True)):
        late = fl.simulate(
            fl.Delayed(law, share * margin), q0, None, (0.0, 150 * share * margin), dt=share * margin / 10
        )
        wide = np.ptp(late.q[:, :, 0], axis=1)
        assert (wide[-200:].max() > 2.0 * wide[400:600].max(), wide[-200:].max() < 0.5 * wide[400:600].max()) == (
            grows,
            not grows,
        )
        np.testing.assert_allclose(late.q.mean(axis=1), np.full((len(late.t), 1), q0.mean()), atol=1e-13)
        step = share * period
        held = fl.simulate(fl.Sampled(law, step), q0, None, (0.0, 40 * step), dt=step / 2)
        powers = [np.linalg.matrix_power(np.eye(len(q0)) - step * law.laplacian, k) @ q0 for k in range(41)]
        np.testing.assert_allclose(held.q[::2], powers, rtol=1e-12, atol=1e-13)


test_what_is_refused = refused(
    (lambda: fl.simulate(LAW, Q, np.zeros((4, 2)), (0.0, 1.0)), "is of first order and has the velocity"),
    (lambda: fl.simulate(LAW, Q, None, (0.0, 1.0), method="TaylorStep", dt=0.1), "Whirl is of first order"),
    (lambda: fl.simulate(fl.Algorithm1(), Q, None, (0.0, 1.0)), "p: expected numbers"),
    (lambda: fl.Saturated(LAW, 0.1), "expected a continuous law of second order"),
    (lambda: fl.Saturated(fl.Delayed(LAW, 0.1), 0.1), "expected a continuous law of second order"),
    (lambda: fl.Delayed(LAW, 0.1, late="pairs"), "expected a sum of terms with a pair term"),
    (lambda: fl.TaylorStep(fl.Sampled(LAW, 0.1), 0.1), "is of first order; expected RK4 or Heun"),
    (
        lambda: fl.simulate(fl.Sampled(LAW, 0.1), Q, 0.0 * Q, (0.0, 1.0), dt=0.1),
        "is of first order and has the velocity",
    ),
    (lambda: fl.RK4(LAW, 0.1), "expected a continuous law of second order"),
    (lambda: LAW.energy(0.0, Q, Q), "Whirl is a law of first order"),
    (lambda: fl.export_lammps(LAW, Q, None, (0.0, 1.0), "x"), "a law of first order; expected one of second order"),
    (lambda: fl.linearise(LAW, Q), "no rest of Whirl: its residual is"),
    (lambda: fl.linearise(LAW, Q, Q), "is of first order and has the velocity"),
    (lambda: fl.linearise(LAW, Q, zero=1.0), "expected None"),
    (lambda: robustness_margins(Steeper(), np.zeros((2, 2))), "Steeper is of first order"),
    (lambda: fl.certify(Q, law=LAW), "Whirl"),
    (lambda: fl.enclose(LAW, Q, Q, (0.0, 1.0)), "Whirl"),
)
