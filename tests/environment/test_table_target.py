"""A γ-agent from a table: through its samples, smooth between, saved with runs."""

import numpy as np
import pytest

import flockana as fl
from tests.refused import refused

T = np.linspace(5.0, 15.0, 41)
Q = np.stack([3.0 * np.cos(T), T**2 / 10.0], axis=1)
P = np.stack([-3.0 * np.sin(T), T / 5.0], axis=1)


@pytest.mark.parametrize("p", [None, P])
def test_the_path_goes_through_its_samples_with_their_velocities(p):
    target = fl.TableTarget(T, Q, p)
    for k in range(len(T)):
        np.testing.assert_allclose(target.position(T[k]), Q[k], rtol=0.0, atol=1e-12)
    fine = np.linspace(5.0, 15.0, 333)
    exact = np.stack([3.0 * np.cos(fine), fine**2 / 10.0], axis=1)
    np.testing.assert_allclose([target.position(t) for t in fine], exact, atol=2e-3)
    rates = np.array([target.rate(t) for t in fine])
    np.testing.assert_allclose(rates, np.stack([-3.0 * np.sin(fine), fine / 5.0], axis=1), atol=2e-2)
    if p is not None:
        np.testing.assert_allclose([target.rate(t) for t in T], P, atol=1e-12)


@pytest.mark.parametrize("p", [None, P])
def test_velocities_are_continuous_and_those_of_the_path(p):
    target = fl.TableTarget(T, Q, p)
    for t in (*T[1:-1], 7.77):
        before, after = target.rate(t - 1e-9), target.rate(t + 1e-9)
        np.testing.assert_allclose(before, after, atol=1e-6)
        slope = (target.position(t + 1e-6) - target.position(t - 1e-6)) / 2e-6
        np.testing.assert_allclose(target.rate(t), slope, atol=1e-6)
    assert target.mismatch(T) == 0.0
    assert target.rate(4.9).tolist() == target.rate(15.1).tolist() == [0.0, 0.0]
    assert target.dimension == 2


def test_a_run_with_it_is_saved_judged_and_rescaled(tmp_path):
    law = fl.Algorithm2(target=fl.TableTarget(T, Q))
    q0 = np.array([[0.0, 0.0], [7.0, 0.0], [3.0, 6.0]])
    run = fl.simulate(law, q0, np.zeros((3, 2)), (5.0, 8.0))
    back = fl.Trajectory.load(run.save(tmp_path / "it.nc"))
    assert back.law == law
    assert fl.verify("energy", back).status == "verified"
    other = fl.rescale(law.target, length=1000.0, time=60.0)
    np.testing.assert_allclose(other.position(60.0 * 7.3), 1000.0 * law.target.position(7.3))
    np.testing.assert_allclose(other.rate(60.0 * 7.3), 1000.0 / 60.0 * law.target.rate(7.3))


test_what_is_no_table_is_refused = refused(
    (lambda: fl.TableTarget([0.0], [[1.0]]), "two or more"),
    (lambda: fl.TableTarget([0.0, 1.0], [[1.0]]), "t has 2 times and q 1 positions"),
    (lambda: fl.TableTarget([1.0, 0.0], [[1.0], [2.0]]), "expected rising times"),
    (lambda: fl.TableTarget([0.0, 1.0], [[1.0], [np.nan]]), "expected finite numbers"),
    (lambda: fl.TableTarget([0.0, 1.0], [[1.0], [2.0]], [[1.0]]), r"p has shape \(1, 1\): expected \(2, 1\)"),
)


def test_the_acceleration_of_a_table_by_hand():
    """q = t³ − 3 t² + 3 t on [0, 1]: q'' = 6 t − 6, and the velocity jumps at t = 0 alone."""
    path = fl.TableTarget([0.0, 1.0], [[0.0], [1.0]], [[3.0], [0.0]])
    assert (path.consistent, path.feature) == (True, 1.0)
    assert path.acceleration_bound(-1.0) == np.inf
    assert path.acceleration_bound(0.5) == pytest.approx(6.0, rel=1e-14)  # of the whole piece
    assert path.acceleration_bound(2.0) == 0.0
