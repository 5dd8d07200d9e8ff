"""Disturbed laws: forces against closed forms, compiled and not; noise whose covariance is known; bad input."""

from math import pi, sqrt

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Disturbed, Gains, StaticTarget, Trajectory, rescale, simulate, verify
from flockana.lattice import hexagonal_patch
from flockana.laws.wrapper_base import Step
from tests.refused import refused

LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))
Q = hexagonal_patch(1, 7.0)


def lone(c1, c2):
    return Algorithm2(gains=Gains(c1_gamma=c1, c2_gamma=c2), target=StaticTarget((0.0,)))


@pytest.mark.parametrize("method", ["DOP853", "scipy-DOP853"])
def test_a_swing_is_answered_as_the_bode_plot_says(method):
    """|G(jω)| = 1/|4 − ω² + 3jω| at ω = 2: 1/6, a quarter of a turn late."""
    law = Disturbed(lone(4.0, 3.0), swing=(1.2,), frequency=1.0 / pi)
    run = simulate(law, [[0.0]], [[0.0]], (0.0, 40.0), method=method, t_eval=np.linspace(30.0, 40.0, 401))
    exact = 0.2 * np.sin(2.0 * run.t - 0.5 * pi)
    np.testing.assert_allclose(run.q[:, 0, 0], exact, atol=1e-7)


def forces(t):
    return np.array([1.2 * np.sin(2.0 * t)])


TABLE = {"times": np.linspace(0.0, 40.0, 4001), "table": forces(np.linspace(0.0, 40.0, 4001)).T}


@pytest.mark.slow
@pytest.mark.parametrize("push", [{"force": forces}, TABLE], ids=["function", "table"])
@pytest.mark.parametrize("noise", [0.0, 1e-12])
def test_a_force_of_time_acts_as_the_swing_that_it_is(push, noise):
    """In the adaptive solver and in fixed steps; a table is linear between times 0.01 apart: off by 1e-4/8 · 4.8."""
    law = Disturbed(lone(4.0, 3.0), **push, intensity=noise)
    run = simulate(law, [[0.0]], [[0.0]], (0.0, 40.0), t_eval=np.arange(30.0, 40.0, 0.1), dt=0.01 if noise else None)
    np.testing.assert_allclose(run.q[:, 0, 0], 0.2 * np.sin(2.0 * run.t - 0.5 * pi), atol=1e-4 if noise else 2e-5)
    assert np.ptp(run.q[:, 0, 0]) > 0.39


def test_a_table_is_linear_between_its_times_and_constant_beyond():
    law = Disturbed(LAW, times=(1.0, 3.0), table=np.arange(28.0).reshape(2, 7, 2))
    for t, share in ((-5.0, 0.0), (1.0, 0.0), (2.5, 0.75), (3.0, 1.0), (9.0, 1.0)):
        np.testing.assert_allclose(law.push(t), (1.0 - share) * np.array(law.table[0]) + share * np.array(law.table[1]))
    one = Disturbed(LAW, times=[1.0], table=[[2.0, 3.0]], force=(1.0, 0.0))
    assert (one.push(0.0).tolist(), one.push(2.0).tolist()) == ([3.0, 3.0], [3.0, 3.0])


def test_compiled_and_not_are_the_same_and_so_is_the_work():
    push = np.random.default_rng(0).standard_normal((7, 2))
    law = Disturbed(LAW, force=push, swing=-push, frequency=0.3, phase=0.7)
    assert law.compiled(2) is not None
    runs = [simulate(law, Q, 0.0 * Q, (0.0, 3.0), method=method, t_eval=[3.0]) for method in ("DOP853", "scipy-DOP853")]
    np.testing.assert_allclose(runs[0].q, runs[1].q, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(runs[0].extra["work"], runs[1].extra["work"], rtol=1e-6)
    assert np.abs(runs[0].energy_residual).max() < 1e-6 * abs(runs[0].energy()).max()
    plain = Disturbed(Algorithm1(), force=push)  # its energy is that in the given frame
    moving = simulate(plain, Q, 0.0 * Q + 3.0, (0.0, 1.0))
    assert np.abs(moving.energy_residual).max() < 1e-6 * abs(moving.energy()).max()


@pytest.mark.parametrize("method", ["Euler-Maruyama", "Heun"])
def test_the_stationary_variance_is_that_of_the_lyapunov_equation(method):
    """x'' = −k x − d x' + s w: s²/2dk in place and s²/2d in velocity; 64 agents that do not see each other."""
    k, d, s = 4.0, 2.0, 0.6
    law = Disturbed(
        Algorithm2(gains=Gains(c1_alpha=0.0, c2_alpha=0.0, c1_gamma=k, c2_gamma=d), target=LAW.target), intensity=s
    )
    q = np.zeros((64, 2))
    run = simulate(law, q, 0.0 * q, (0.0, 60.0), dt=0.02, method=method, t_eval=np.arange(10.0, 60.0, 1.0))
    for series, exact in ((run.q, s * s / (2.0 * d * k)), (run.p, s * s / (2.0 * d))):
        spread = sqrt(2.0 / (series.size / 3.0))  # samples a time unit apart are nearly independent
        assert series.var() == pytest.approx(exact, rel=4.0 * spread + (0.05 if method[0] == "E" else 0.0))


def test_heun_is_of_weak_order_two_and_euler_of_order_one():
    """Moments of x'' = −k x − d x' + s w by the linear step itself, without chance: the stationary variance."""
    k, d, s = 4.0, 1.0, 1.0

    def variance(method, h):
        law = Disturbed(lone(k, d), intensity=s)
        run = [
            simulate(law, [[x]], [[v]], (0.0, h), dt=h, method=method) for x, v in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
        ]
        ends = [np.array([one.q[-1, 0, 0], one.p[-1, 0, 0]]) for one in run]
        a = np.column_stack([ends[1] - ends[0], ends[2] - ends[0]])
        noise = ends[0]  # b z with the same z in all runs
        z = law.kick(step_of(h), (1, 1))[0, 0] / (s * sqrt(h))
        b = noise / z
        p = np.linalg.solve(np.eye(4) - np.kron(a, a), np.outer(b, b).ravel())
        return p[0]

    exact = s * s / (2.0 * d * k)
    for method, order in (("Euler-Maruyama", 1.0), ("Heun", 2.0)):
        errors = [abs(variance(method, h) - exact) for h in (0.1, 0.05, 0.025)]
        assert np.log2(errors[1] / errors[2]) == pytest.approx(order, abs=0.35)


def step_of(h):
    return Step(0, h, lambda t: None)


def test_a_seed_is_a_run_and_another_seed_another():
    one, same, other = (
        simulate(Disturbed(LAW, intensity=0.1, seed=seed), Q, 0.0 * Q, (0.0, 6.0), dt=0.01, t_eval=times)
        for seed, times in ((1, None), (1, [3.0, 6.0]), (2, None))
    )
    np.testing.assert_array_equal(one.q[[300, 600]], same.q)  # however many steps are made at once
    assert np.abs(one.q - other.q).max() > 1e-3


def test_it_is_saved_and_its_theorems_are_vacuous(tmp_path):
    gusts = {"times": (0.0, 1.0), "table": ((0.0, 0.0), (1.0, 2.0))}
    run = simulate(Disturbed(LAW, force=(0.1, 0.0), **gusts, intensity=0.1, seed=5), Q, 0.0 * Q, (0.0, 1.0), dt=0.01)
    again = Trajectory.load(run.save(tmp_path / "run.nc"))
    assert again.law == run.law
    np.testing.assert_array_equal(simulate(again.law, run.q[0], run.p[0], (0.0, 1.0)).q, run.q)
    verdict = verify("os-3", again)
    assert verdict.status == "vacuous"
    assert "wrapped in Disturbed" in verdict.claims[0].detail
    assert verify("energy", simulate(Disturbed(LAW, force=(0.1, 0.0)), Q, 0.0 * Q, (0.0, 1.0))).status == "vacuous"


def test_units():
    law = rescale(
        Disturbed(LAW, force=(1.0, 0.0), intensity=2.0, swing=(1.0, 2.0), frequency=1.0), length=3.0, time=4.0
    )
    assert law.force == pytest.approx((3.0 / 16.0, 0.0))
    assert (law.intensity, law.frequency) == (pytest.approx(6.0 / 8.0), 0.25)
    for push in ({"force": lambda t: (t, 1.0)}, {"times": (0.0, 8.0), "table": ((0.0, 1.0), (8.0, 1.0))}):
        there = rescale(Disturbed(LAW, **push), length=3.0, time=4.0)
        assert there.push(20.0) == pytest.approx(3.0 / 16.0 * np.array([5.0, 1.0]))


test_bad_input = refused(
    (lambda: Disturbed(LAW, force="wind"), "force = 'wind': expected finite components"),
    (lambda: Disturbed(LAW, force=lambda t: "wind").push(1.5), r"force\(1.5\) = 'wind': expected finite components"),
    (lambda: simulate(Disturbed(LAW, force=lambda t: (t,)), Q, Q, (0, 1)), "force has 1 components, the agents 2"),
    (lambda: Disturbed(LAW, times=(0.0, 1.0)), "times has 2 numbers and table 0 rows: expected the same"),
    (lambda: Disturbed(LAW, times=(1.0, 0.0), table=((0.0, 0.0), (1.0, 1.0))), "expected rising times"),
    (lambda: Disturbed(LAW, times=(1.0,), table=(1.0,)), r"table = .*: expected finite components, \(K, m\)"),
    (lambda: Disturbed(LAW, frequency=-1.0), "frequency = -1"),
    (lambda: Disturbed(LAW, intensity=1.0, seed=-1), "seed = -1: expected a whole number >= 0"),
    (lambda: Disturbed(LAW, intensity=1.0, seed=2**62), r"expected a whole number below 2\*\*62"),
    (lambda: Disturbed(3), "law = 3: expected a continuous law"),
    (lambda: simulate(Disturbed(LAW, force=(1.0,)), Q, Q, (0.0, 1.0)), "force has 1 components, the agents 2"),
    (lambda: simulate(Disturbed(LAW, force=[[1.0, 0.0]]), Q, Q, (0.0, 1.0)), "force has 1 rows and there are 7"),
    (lambda: simulate(Disturbed(LAW, intensity=1.0), Q, Q, (0.0, 1.0)), "dt = None: Disturbed is run in fixed steps"),
    (
        lambda: simulate(Disturbed(LAW, intensity=1.0), Q, Q, (0.0, 1.0), dt=0.1, method="RK4"),
        "RK4: Disturbed draws random numbers; expected a solver that takes noise",
    ),
    (
        lambda: simulate(Disturbed(LAW, intensity=1.0), Q, Q, (0.0, 1.0), dt=0.1, method="RK45"),
        "RK45 chooses its own steps",
    ),
)
