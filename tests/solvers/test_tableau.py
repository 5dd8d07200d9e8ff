"""The coefficients: what every Runge-Kutta method fulfils, and scipy's own interpolants."""

import numpy as np
import pytest
from scipy.integrate import DOP853, RK23, RK45

from flockana.jit import thawed
from flockana.kernels.runge_kutta import Method, Step, combine, error_of, interpolated
from flockana.solvers import dop853
from flockana.solvers.solver_names import solver_of


def tableau(method):
    """The coefficients of a method."""
    return solver_of(method, 0.1 if method == "RK4" else None).tableau


def as_numba_takes_it(value):
    """A number, or an array that may be written to."""
    return thawed(value) if isinstance(value, np.ndarray) else value


ORDERS = {"DOP853": 8, "RK45": 5, "RK23": 3, "RK4": 4}


@pytest.mark.parametrize("method", ORDERS)
def test_quadrature_conditions_up_to_the_order(method):
    a, c, estimates, _, _, stages, *_ = tableau(method)
    np.testing.assert_allclose(a.sum(axis=1), c, atol=1e-14)
    weights = a[stages, : stages + 1]
    for power in range(ORDERS[method]):
        assert weights @ c[: stages + 1] ** power == pytest.approx(1 / (power + 1), abs=1e-14)
    for power in range(3 if method in ("DOP853", "RK45") else 1):  # an estimate is of a difference of two methods
        np.testing.assert_allclose(estimates @ c[: stages + 1] ** power, 0.0, atol=1e-14)


@pytest.mark.parametrize("solver", [DOP853, RK45, RK23])
def test_steps_errors_and_interpolants_are_those_of_scipy(solver):
    rng = np.random.default_rng(3)
    matrix, y0 = rng.normal(size=(4, 4)), rng.normal(size=4)
    theirs = solver(lambda t, y: matrix @ y + np.sin(t), 0.3, y0, 9.0, first_step=0.2, rtol=1e-1, atol=1e-1)
    theirs.step()
    method = Method(*map(as_numba_takes_it, tableau(solver.__name__)), 1e-1, (1e-1, 1e-1, 1e-1), np.inf)
    a, c, rows, stages = method.a, method.c, method.rows, method.stages
    h, rates, out = theirs.t - 0.3, np.full((rows.max() + 1, 4), np.nan), np.empty(4)
    step = Step(0.3, h, y0, np.empty(4), rates, out)
    for s in range(len(a)):
        combine(y0, h, a[s], rates, rows, s, out)
        rates[rows[s]] = matrix @ out + np.sin(0.3 + c[s] * h)
        if s == stages:
            np.testing.assert_allclose(out, theirs.y, rtol=1e-14)
            step.reached[:] = out
            error = error_of(step, method)
            scale = 0.1 + np.maximum(abs(y0), abs(theirs.y)) * 0.1
            own = theirs.K_extended if solver is DOP853 else theirs.K
            expected = theirs._estimate_error_norm(own[: stages + 1], h, scale)
            assert error == pytest.approx(expected, rel=1e-9)
    dense = theirs.dense_output()
    for theta in (0.1, 0.5, 0.93, 1.0):
        interpolated(theta, step, method, combine)
        np.testing.assert_allclose(out, dense(0.3 + theta * h), rtol=1e-13, atol=1e-14)


def test_the_numbers_of_dop853_are_those_of_scipy():
    a, c, estimates, *_ = tableau("DOP853")
    stages = DOP853.n_stages
    for own, theirs in (
        (a[:stages, :stages], DOP853.A),
        (a[stages, :stages], DOP853.B),
        (a[stages + 1 :], DOP853.A_EXTRA),
        (c, [*DOP853.C, 1.0, *DOP853.C_EXTRA]),
        (estimates, [DOP853.E5, DOP853.E3]),
        ([[row.get(k, 0.0) for k in range(len(c))] for row in dop853.D], DOP853.D),
    ):
        np.testing.assert_array_equal(own, theirs)
    assert tableau("DOP853").exponent == -1.0 / (DOP853.error_estimator_order + 1)


def test_rates_that_nothing_reads_again_make_room():
    for method, count in (("DOP853", 12), ("RK45", 6), ("RK23", 4), ("RK4", 4)):
        rows = tableau(method).rows
        assert rows.max() + 1 == count
        assert (rows == rows[0]).sum() == 1  # the rate of the start is that of every step that is made again


@pytest.mark.parametrize("method", ORDERS)
def test_no_rate_is_written_over_before_it_was_read_for_the_last_time(method):
    a, _, estimates, interpolant, rows, stages, *_ = tableau(method)
    held, error = {}, np.flatnonzero(estimates.any(axis=0))
    for s in range(len(rows)):
        read = np.concatenate([np.flatnonzero(a[s]), error if s == stages + 1 else []]).astype(int)
        assert all(held[rows[k]] == k for k in read)
        held[rows[s]] = s
    assert all(held[rows[k]] == k for k in (0, stages, *np.flatnonzero(interpolant.any(axis=1))))
