"""Explicit Euler steps of any continuous law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from flockana.base.checks import FloatArray
from flockana.laws.scheme import Scheme


@dataclass(frozen=True)
class ExplicitEuler(Scheme):
    """q' = q + dt p, p' = p + dt u(t, q, p): of first order, and unstable wherever a swing is not damped.

    Parameters
    ----------
    law : Law
        The continuous law.
    dt : float
        Step.

    Raises
    ------
    ArgumentError
        If the law is no continuous one, or the step not positive.

    Examples
    --------
    >>> import numpy as np
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> q, p, _, _ = ExplicitEuler(Algorithm1(), 0.5).step(0.0, np.zeros((1, 1)), np.ones((1, 1)), {})
    >>> float(q[0, 0]), float(p[0, 0])
    (0.5, 1.0)
    """

    position_factor = 0.0

    def step(  # noqa: D102
        self, t: float, q: FloatArray, p: FloatArray, memory: Mapping[str, FloatArray]
    ) -> tuple[FloatArray, FloatArray, FloatArray, Mapping[str, FloatArray]]:
        u = self.law.flow(t, q, p)[0]
        return q + self.dt * p, p + self.dt * u, u, memory
