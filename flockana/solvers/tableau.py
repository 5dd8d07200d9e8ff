"""Coefficients of explicit Runge-Kutta methods, in the layout of `flockana.kernels.runge_kutta`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IndexArray = npt.NDArray[np.int64]


class Tableau(NamedTuple):
    """Runge-Kutta coefficients A, C, E, P, with storage rows of rates, stages, error exponent, position factor.

    The exponent is 0 for a method of fixed steps. Stage s is kept in row `rows[s]`: a rate that nothing reads again
    gives its place to a later one, which at a million agents is a hundred megabytes. `lead` f adds f h² u to the
    positions of a method with one stage, whose velocities they so lead.
    """

    a: FloatArray
    c: FloatArray
    estimates: FloatArray
    interpolant: FloatArray
    rows: IndexArray
    stages: int
    exponent: float
    lead: float = 0.0


def tableau_of_pair(
    a: Sequence[Sequence[float]],
    b: Sequence[float],
    error: Sequence[float],
    error_order: int,
    interpolant: Sequence[Sequence[float]] | None,
) -> Tableau:
    """Return the tableau of an adaptive pair."""
    full_tableau, (stages, estimates) = _square(a, b), (len(b), np.array([error], dtype=np.float64))
    powers = _hermite(full_tableau[stages]) if interpolant is None else np.array(interpolant, dtype=np.float64)
    rows, exponent = shared_rows(full_tableau, estimates, powers), -1.0 / (error_order + 1)
    return Tableau(full_tableau, _times(full_tableau), estimates, powers, rows, stages, exponent)


def tableau_of_steps(a: Sequence[Sequence[float]], b: Sequence[float], lead: float) -> Tableau:
    """Return the tableau of a method of fixed steps.

    Examples
    --------
    >>> tableau_of_steps(((), (0.5,)), (0.0, 1.0), 0.0).c.tolist()
    [0.0, 0.5, 1.0]
    """
    full_tableau, count = _square(a, b), len(b) + 1
    estimates, interpolant = np.zeros((1, count)), np.zeros((count, 1))
    rows = shared_rows(full_tableau, estimates, interpolant)
    return Tableau(full_tableau, _times(full_tableau), estimates, interpolant, rows, len(b), 0.0, lead)


def _square(a: Sequence[Sequence[float]], b: Sequence[float]) -> FloatArray:
    """Return the coefficients of a Runge-Kutta method as one square matrix, the weights b in its last row."""
    full_tableau = np.zeros((len(b) + 1, len(b) + 1))
    for s, row in enumerate([*a, b]):
        full_tableau[s, : len(row)] = row
    return full_tableau


def _times(whole: FloatArray) -> FloatArray:
    """Return the stage times of a Runge-Kutta method as fractions of the step, exactly 1 at its end."""
    return np.append(whole[:-1].sum(axis=1), 1.0)


def _hermite(weights: FloatArray) -> FloatArray:
    """Return coefficients in powers of θ of the cubic through states and rates at both ends of a step."""
    powers = np.outer(weights, (0.0, 3.0, -2.0))
    powers[0] += (1.0, -2.0, 1.0)
    powers[-1] += (0.0, -1.0, 1.0)
    return powers


def shared_rows(a: FloatArray, estimates: FloatArray, interpolant: FloatArray) -> IndexArray:
    """Return a storage row for each stage's rate, reusing rows of rates no longer needed."""
    count, stages = len(a), estimates.shape[1] - 1
    last_rows = [int(np.flatnonzero(a[:, s]).max(initial=s)) for s in range(count)]
    for s in range(stages + 1):
        if estimates[:, s].any():
            last_rows[s] = max(last_rows[s], stages + 1)  # the error is estimated before the interpolant's own stages
    for s in (0, stages, *np.flatnonzero(interpolant.any(axis=1))):
        last_rows[s] = count
    rows = list[int]()
    for s in range(count):
        rows_used = {rows[k] for k in range(s) if last_rows[k] > s}
        rows.append(min(set(range(count)) - rows_used))
    return np.array(rows)
