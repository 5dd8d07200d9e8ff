"""Spring with drag, whose pull may be bounded: a force on a γ-agent with dynamics."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, sqrt
from typing import Any, ClassVar

import numpy as np

from flockana.base import value_checks
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, normalise


@dataclass(frozen=True)
class Spring:
    """Force f_r(q, p) = push − k x/√(1 + ‖x‖²/ℓ²) − b p, x = q − centre: spring of pull below kℓ, with drag.

    Parameters
    ----------
    centre : array_like, shape (m,)
        Where it pulls to.
    stiffness : float
        k; negative pushes away.
    damping : float
        b ≥ 0.
    push : array_like, shape (m,), or 0
        A constant acceleration.
    reach : float, optional
        ℓ > 0; without one the spring is linear.

    Examples
    --------
    >>> Spring((0.0, 0.0), 2.0)(np.array([3.0, 0.0]), np.array([0.0, 1.0])).tolist()
    [-6.0, 0.0]
    """

    centre: Any
    stiffness: float
    damping: float = 0.0
    push: Any = 0.0
    reach: float | None = None

    @property
    def feature(self) -> float:
        """Time scale of the spring's motion: the shorter of 1/√|k| and 1/b."""
        return min((1.0 / rate for rate in (sqrt(abs(self.stiffness)), self.damping) if rate > 0.0), default=inf)

    units: ClassVar[Mapping[str, Powers]] = {
        "centre": (1, 0),
        "stiffness": (0, -2),
        "damping": (0, -1),
        "push": (1, -2),
        "reach": (1, 0),
    }

    def __post_init__(self) -> None:
        m = value_checks.freeze_vector(self, "centre").size
        if np.isscalar(self.push) and self.push == 0:
            object.__setattr__(self, "push", np.zeros(m))
        value_checks.freeze_vector(self, "push", m)
        normalise(self, value_checks.ensure_finite_scalar, "stiffness")
        normalise(self, value_checks.ensure_nonnegative, "damping")
        if self.reach is not None:
            normalise(self, value_checks.ensure_positive, "reach")

    def __call__(self, q: FloatArray, p: FloatArray) -> FloatArray:
        """Return the acceleration at one position or at several (…, m)."""
        x = q - np.array(self.centre)
        if self.reach is not None:
            x = x / np.sqrt(1.0 + np.sum(x * x, axis=-1, keepdims=True) / self.reach**2)
        return np.array(self.push) - self.stiffness * x - self.damping * p
