"""Explicit Euler steps of any continuous law."""

from dataclasses import dataclass

from flockana.laws.scheme import Scheme


@dataclass(frozen=True)
class ExplicitEuler(Scheme):
    """q' = q + dt p, p' = p + dt u(t, q, p): of first order, and unstable wherever a swing is not damped.

    Parameters
    ----------
    law, dt : Law, float
        As of every `Scheme`: the continuous law, and the step.

    Examples
    --------
    >>> import numpy as np
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> q, p, _, _ = ExplicitEuler(Algorithm1(), 0.5).step(0.0, np.zeros((1, 1)), np.ones((1, 1)), {})
    >>> float(q[0, 0]), float(p[0, 0])
    (0.5, 1.0)
    """

    position_factor = 0.0
