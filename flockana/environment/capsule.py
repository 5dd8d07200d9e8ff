"""Capsule obstacle: all points within a radius of a line segment."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_positive, freeze_vector, normalise
from flockana.environment.obstacles import Obstacle
from flockana.jit import register_jitable
from flockana.kernels.obstacles import lift_obstacle, project_ball, turn_ball


@register_jitable
def _slide(q, p, par, foot, rate):  # type: ignore[no-untyped-def]
    """Write a capsule's nearest axis point to an agent, and its velocity, to arrays; par = (a, b, R)."""
    m, length2, axial_part, speed = q.size, 0.0, 0.0, 0.0
    for c in range(m):
        side = par[m + c] - par[c]
        length2 += side * side
        axial_part += side * (q[c] - par[c])
        speed += side * p[c]
    share = min(1.0, max(0.0, axial_part / length2))
    for c in range(m):
        side = par[m + c] - par[c]
        foot[c] = par[c] + share * side
        rate[c] = speed / length2 * side if 0.0 < share < 1.0 else 0.0


@register_jitable
def _onto_capsule(q, p, par, gap, rate):  # type: ignore[no-untyped-def]
    """Project onto the sphere about the closest point of the segment, which moves with the agent."""
    foot = np.empty(q.size)
    _slide(q, p, par, foot, rate)
    return project_ball(q, p, foot, par[2 * q.size], rate, gap, rate)


@register_jitable
def _turn_capsule(q, p, e, par, out):  # type: ignore[no-untyped-def]
    foot, p_foot, e_foot = np.empty(q.size), np.empty(q.size), np.empty(q.size)
    _slide(q, p, par, foot, p_foot)
    _slide(q, e, par, foot, e_foot)
    turn_ball(q, p, e, foot, par[2 * q.size], p_foot, e_foot, out)


_CAPSULE = lift_obstacle(_onto_capsule, _turn_capsule)


@dataclass(frozen=True)
class Capsule(Obstacle):
    """Obstacle of all points within `radius` of the segment from a to b.

    The velocity of its β-agents jumps where the straight part meets a cap, as the curvature does there.

    Parameters
    ----------
    a, b : array_like, shape (m,)
        Ends of the segment, two different points; m = 2 or 3.
    radius : float
        R > 0.

    Examples
    --------
    >>> agents = Capsule((0.0, 0.0), (4.0, 0.0), 1.0).beta_agents([[2.0, 3.0], [7.0, 0.0]], [[1.0, 1.0], [1.0, 1.0]])
    >>> agents.q.tolist(), agents.clearance.tolist()
    ([[2.0, 1.0], [5.0, 0.0]], [2.0, 2.0])
    """

    a: Any
    b: Any
    radius: float

    units: ClassVar[Mapping[str, Powers]] = {"a": (1, 0), "b": (1, 0), "radius": (1, 0)}

    kernels = _CAPSULE

    def __post_init__(self) -> None:
        a = freeze_vector(self, "a")
        b = freeze_vector(self, "b", a.size)
        if a.size == 1:
            raise ArgumentError(f"a = {self.a}: expected 2 or 3 components; on a line the obstacle is a Sphere")
        side = b - a
        if not float(side @ side) > 0.0:
            raise ArgumentError(f"a = {self.a} and b = {self.b}: expected two different points; a ball is a Sphere")
        normalise(self, ensure_positive, "radius")

    @property
    def par(self) -> FloatArray:
        """Segment ends a, b and radius R as one array, for compiled functions."""
        return np.array([*self.a, *self.b, self.radius])

    @property
    def ball(self) -> tuple[FloatArray, float]:
        """Bounding ball: (midpoint, half the length + R)."""
        a, b = np.array(self.a), np.array(self.b)
        return 0.5 * (a + b), 0.5 * float(np.linalg.norm(b - a)) * (1.0 + 1e-12) + self.radius
