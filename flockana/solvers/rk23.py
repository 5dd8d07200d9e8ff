"""Bogacki and Shampine's method of order 3, with scipy's coefficients."""

from flockana.solvers.scipy_solver import ScipyPair


class RK23(ScipyPair):
    """Bogacki and Shampine's method of order 3: compiled where the law is."""

    order = 3
