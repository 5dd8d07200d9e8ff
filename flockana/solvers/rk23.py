"""Bogacki and Shampine's method of order 3, with scipy's coefficients."""

from flockana.solvers.scipy_solver import ScipyPair


class RK23(ScipyPair):
    """Bogacki and Shampine's method of order 3, compiled for compiled laws."""

    order = 3
