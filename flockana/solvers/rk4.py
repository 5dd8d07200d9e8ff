"""The classical Runge-Kutta method."""

from flockana.solvers.fixed_steps import FixedStep


class RK4(FixedStep):
    """Classical Runge-Kutta method of order 4."""

    order = 4
    order_of_wrapped = 4
    a = ((), (0.5,), (0.0, 0.5), (0.0, 0.0, 1.0))
    b = (1 / 6, 1 / 3, 1 / 3, 1 / 6)
