"""Convex polygon obstacles in the plane."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, sqrt
from typing import Any, ClassVar

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.environment.obstacles import Obstacle, ensure_corners
from flockana.jit import register_jitable
from flockana.kernels.obstacles import lift_obstacle, no_turn


@register_jitable
def _onto_polygon(q, p, par, gap, rate):  # type: ignore[no-untyped-def]
    """Project onto the closest edge; the β-agent slides along an edge and rests at a corner; par = vertices."""
    best, inside, count = inf, True, par.size // 2
    for k in range(count):
        x0, y0 = par[2 * k], par[2 * k + 1]
        x1, y1 = par[2 * ((k + 1) % count)], par[2 * ((k + 1) % count) + 1]
        sx, sy, ex, ey = x1 - x0, y1 - y0, q[0] - x0, q[1] - y0
        if sx * ey - sy * ex < 0.0:
            inside = False
        length2 = sx * sx + sy * sy
        along = (sx * ex + sy * ey) / length2
        share = min(1.0, max(0.0, along))
        gx, gy = share * sx - ex, share * sy - ey
        s2 = gx * gx + gy * gy
        if s2 < best:
            best = s2
            gap[0], gap[1] = gx, gy
            speed = (sx * p[0] + sy * p[1]) / length2 if 0.0 < along < 1.0 else 0.0
            rate[0], rate[1] = speed * sx, speed * sy
    return -sqrt(best) if inside else sqrt(best)


_POLYGON = lift_obstacle(_onto_polygon, no_turn)


@dataclass(frozen=True)
class Polygon(Obstacle):
    """Convex polygon; its β-agent's velocity jumps where a corner takes over from an edge.

    Parameters
    ----------
    vertices : array_like, shape (V, 2)
        Corners in order, either way round; V >= 3, strictly convex.

    Raises
    ------
    ArgumentError
        If the corners are fewer than three, not in the plane, or not those of a strictly convex polygon in order.

    Examples
    --------
    >>> square = Polygon([(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)])
    >>> square.clearance([[1.0, 3.0], [5.0, 6.0], [1.0, 1.5]]).tolist()
    [1.0, 5.0, -0.5]
    """

    vertices: Any

    units: ClassVar[Mapping[str, Powers]] = {"vertices": (1, 0)}

    kernels = _POLYGON

    def __post_init__(self) -> None:
        corners = ensure_corners(self.vertices)
        sides = np.roll(corners, -1, axis=0) - corners
        after = np.roll(sides, -1, axis=0)
        turns = np.arctan2(sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0], np.sum(sides * after, axis=1))
        # strictly convex and once round: every turn to the same side, and one full turn in all
        if not (np.all(turns > 0.0) or np.all(turns < 0.0)) or abs(abs(turns.sum()) - 2.0 * np.pi) > 1e-6:
            raise ArgumentError(
                f"vertices = {corners.tolist()}: expected the corners of a strictly convex polygon in order; "
                "build another shape from several convex obstacles"
            )
        object.__setattr__(self, "vertices", tuple(map(tuple, corners.tolist())))

    @property
    def par(self) -> FloatArray:
        """Vertices, counter-clockwise."""
        corners = np.array(self.vertices)
        (x, y), (u, v) = np.diff(corners[:3], axis=0)
        turn = x * v - y * u
        return np.ascontiguousarray(corners if turn > 0.0 else corners[::-1]).ravel()

    @property
    def ball(self) -> tuple[FloatArray, float]:
        """Bounding ball: (mean of the vertices, distance of the farthest)."""
        corners = np.array(self.vertices)
        centre = corners.mean(axis=0)
        return centre, float(np.linalg.norm(corners - centre, axis=1).max()) * (1.0 + 1e-12)
