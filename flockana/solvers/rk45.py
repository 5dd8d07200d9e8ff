"""Dormand and Prince's method of order 5, with scipy's coefficients."""

from flockana.solvers.scipy_solver import ScipyPair


class RK45(ScipyPair):
    """Dormand and Prince's method of order 5, compiled for compiled laws."""

    order = 5
