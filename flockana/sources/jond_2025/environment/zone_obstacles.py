"""Walls of a box as obstacles of zone-based flocking."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_points, freeze_vector
from flockana.environment.obstacles import Sphere


def ball_clearance_along(ball: Sphere, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return least signed distances from a ball along straight paths, exact, shape (N,)."""
    direction, away = end - start, np.array(ball.centre) - start
    length2 = np.sum(direction**2, axis=1)
    share = np.divide(np.sum(direction * away, axis=1), length2, out=np.zeros(len(direction)), where=length2 > 0.0)
    nearest = np.clip(share, 0.0, 1.0)[:, None] * direction - away
    return np.linalg.norm(nearest, axis=1) - ball.radius


@dataclass(frozen=True)
class Box:
    """Box low <= q <= high, whose walls agents must not cross.

    Parameters
    ----------
    low, high : array_like, shape (m,)
        Opposite corners.

    Examples
    --------
    >>> Box((0.0, 0.0), (50.0, 50.0)).clearance([[1.0, 30.0], [51.0, 3.0]]).tolist()
    [1.0, -1.0]
    """

    low: Any
    high: Any

    units: ClassVar[Mapping[str, Powers]] = {"low": (1, 0), "high": (1, 0)}

    def __post_init__(self) -> None:
        low = freeze_vector(self, "low")
        high = freeze_vector(self, "high", low.size)
        if not (low < high).all():
            raise ArgumentError(f"low = {low.tolist()}, high = {high.tolist()}: expected low < high on every axis")

    def clearance(self, q: Any) -> FloatArray:
        """Return distances of points from the nearest wall; negative outside the box."""
        q = ensure_points("q", q)
        return np.minimum(q - np.array(self.low), np.array(self.high) - q).min(axis=1)
