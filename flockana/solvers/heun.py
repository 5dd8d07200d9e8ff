"""Heun's method."""

from flockana.solvers.fixed_steps import FixedStep


class Heun(FixedStep):
    """Heun's method of order 2; with additive white noise a weak method of order 2."""

    order = 2
    order_of_wrapped = 2
    takes_noise = True
    a = ((), (1.0,))
    b = (0.5, 0.5)
