"""The coefficients of the explicit Runge-Kutta methods, as `flockana.kernels.runge_kutta` reads them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numpy.polynomial import polynomial

from flockana.kernels import dop853

FloatArray = npt.NDArray[np.float64]
IndexArray = npt.NDArray[np.int64]


class Tableau(NamedTuple):
    """Coefficients (A, C, E, P) of a method, where rates are kept, stages of a step, and exponent of the error.

    The power is 0 for a method of fixed steps. Stage s is kept in row `rows[s]`: a rate that nothing reads again gives
    its place to a later one, which at a million agents is a hundred megabytes.
    """

    a: FloatArray
    c: FloatArray
    estimates: FloatArray
    interpolant: FloatArray
    rows: IndexArray
    stages: int
    exponent: float


@cache
def tableau(method: str) -> Tableau:
    """Return the coefficients of DOP853, RK45, RK23 or RK4.

    Examples
    --------
    >>> classical = tableau("RK4")
    >>> classical.a[4].tolist() == [1 / 6, 1 / 3, 1 / 3, 1 / 6, 0.0]
    True
    """
    if method == "RK4":
        a = np.zeros((5, 5))
        a[1, 0], a[2, 1], a[3, 2] = 0.5, 0.5, 1.0
        a[4, :4] = np.array([1.0, 2.0, 2.0, 1.0]) / 6.0
        c, estimates, interpolant = np.array([0.0, 0.5, 0.5, 1.0, 1.0]), np.zeros((1, 5)), np.zeros((5, 1))
        return Tableau(a, c, estimates, interpolant, _rows(a, estimates, interpolant), 4, 0.0)
    if method == "DOP853":
        return _dop853()
    import scipy.integrate

    solver = getattr(scipy.integrate, method)
    stages = solver.n_stages
    a = np.zeros((stages + 1, stages + 1))
    a[:stages, : solver.A.shape[1]], a[stages, :stages] = solver.A, solver.B
    exponent = -1.0 / (solver.error_estimator_order + 1)
    estimates, interpolant = solver.E[None].copy(), solver.P.copy()
    rows = _rows(a, estimates, interpolant)
    return Tableau(a, np.append(solver.C, 1.0), estimates, interpolant, rows, stages, exponent)


def _dop853() -> Tableau:
    """DOP853, its interpolant in powers of θ: as published it goes by θ and 1 − θ in turns."""
    stages, count = dop853.STAGES, len(dop853.C)
    a, estimates = _filled(dop853.A, count), _filled((dop853.E5, dop853.E3), stages + 1)
    whole, first, last = a[stages], np.eye(count)[0], np.eye(count)[stages]
    rows = np.vstack([whole, first - whole, 2.0 * whole - (first + last), _filled(dop853.D, count)])
    interpolant, ways = np.zeros((count, len(rows))), ((0.0, 1.0), (1.0, -1.0))
    power = np.ones(1)
    for k, row in enumerate(rows):
        power = np.asarray(polynomial.polymul(power, ways[k % 2]), dtype=np.float64)
        interpolant[:, : len(power) - 1] += np.outer(row, power[1:])
    kept, exponent = _rows(a, estimates, interpolant), -1.0 / (dop853.ORDER + 1)
    return Tableau(a, np.array(dop853.C), estimates, interpolant, kept, stages, exponent)


def _filled(rows: Sequence[Mapping[int, float]], count: int) -> FloatArray:
    """Return rows of `count` numbers from their nonzero entries."""
    return np.array([[row.get(k, 0.0) for k in range(count)] for row in rows])


def _rows(a: FloatArray, estimates: FloatArray, interpolant: FloatArray) -> IndexArray:
    """Return a place for each stage's rate, reusing that of a rate which no later stage reads."""
    count, stages = len(a), estimates.shape[1] - 1
    last = [int(np.flatnonzero(a[:, s]).max(initial=s)) for s in range(count)]
    for s in range(stages + 1):
        if estimates[:, s].any():
            last[s] = max(last[s], stages + 1)  # the error is estimated before the interpolant's own stages
    for s in (0, stages, *np.flatnonzero(interpolant.any(axis=1))):
        last[s] = count
    rows = list[int]()
    for s in range(count):
        taken = {rows[k] for k in range(s) if last[k] > s}
        rows.append(min(set(range(count)) - taken))
    return np.array(rows)
