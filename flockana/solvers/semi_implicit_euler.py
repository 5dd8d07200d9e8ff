"""The semi-implicit Euler method: velocities first, then positions."""

from flockana.solvers.fixed_steps import FixedStep


class SemiImplicitEuler(FixedStep):
    """Semi-implicit Euler steps p' = p + dt u(t, q, p), q' = q + dt p', for sources that print a step only.

    Of order 1. As a map, where the law jumps it neither sees the jump nor resolves it, and where the law holds a pair
    at a jump it chatters about it (erratum L7).

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> import numpy as np
    >>> euler = SemiImplicitEuler(Algorithm1(), dt=0.01)
    >>> q, p, _, _ = euler.step(0.0, np.array([[0.0], [8.0]]), np.zeros((2, 1)), {})
    >>> bool(q[0, 0] == 0.01 * p[0, 0] > 0.0)
    True
    """

    order = 1
    position_factor = 1.0
