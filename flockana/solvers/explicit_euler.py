"""The explicit Euler method."""

from flockana.solvers.fixed_steps import FixedStep


class ExplicitEuler(FixedStep):
    """Explicit Euler steps q' = q + dt p, p' = p + dt u(t, q, p), of order 1; unstable for undamped oscillations.

    Examples
    --------
    >>> import numpy as np
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> q, p, _, _ = ExplicitEuler(Algorithm1(), 0.5).step(0.0, np.zeros((1, 1)), np.ones((1, 1)), {})
    >>> float(q[0, 0]), float(p[0, 0])
    (0.5, 1.0)
    """

    order = 1
    position_factor = 0.0
