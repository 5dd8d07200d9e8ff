"""Polygons in the plane; convex ones have β-agents."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import inf, sqrt
from typing import Any, ClassVar

import lazy_loader
import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_points
from flockana.environment.obstacles import Obstacle, Sphere
from flockana.jit import register_jitable
from flockana.kernels.obstacles import lift_obstacle, no_turn

shapely = lazy_loader.load("shapely")

_ROWS = 2**16  # points and ways at once


@dataclass(frozen=True)
class SimplePolygon:
    """Polygon in the plane whose boundary does not cross itself; may be concave.

    Parameters
    ----------
    vertices : array_like, shape (V, 2)
        Corners in order, either way round; V >= 3.

    Raises
    ------
    ArgumentError
        If the corners are fewer than three, not in the plane, or the boundary meets itself (where is said).

    Examples
    --------
    >>> arrow = SimplePolygon([(0.0, 0.0), (4.0, 2.0), (0.0, 4.0), (2.0, 2.0)])
    >>> arrow.clearance([[0.0, 2.0], [5.0, 2.0], [3.5, 2.0]]).round(3).tolist()
    [1.414, 1.0, -0.224]
    """

    vertices: Any

    units: ClassVar[Mapping[str, Powers]] = {"vertices": (1, 0)}

    def __post_init__(self) -> None:
        corners = ensure_points("vertices", self.vertices)
        if corners.shape[0] < 3 or corners.shape[1] != 2:
            raise ArgumentError(f"vertices have shape {corners.shape}: expected (V, 2) with V >= 3")
        shape = shapely.Polygon(corners)
        if not shape.is_valid or not shape.area > 0.0:
            reason = shapely.is_valid_reason(shape) if not shape.is_valid else "no area"
            raise ArgumentError(
                f"vertices = {corners.tolist()}: expected a boundary that does not meet itself and encloses an area, "
                f"found {reason}; give the corners in order around the polygon, each once"
            )
        object.__setattr__(self, "vertices", tuple(map(tuple, corners.tolist())))

    @cached_property
    def _shape(self) -> Any:
        shape = shapely.Polygon(self.vertices)
        shapely.prepare(shape)
        return shape

    @property
    def edges(self) -> FloatArray:
        """Edges as rows (x0, y0, x1, y1), shape (V, 4)."""
        corners = np.array(self.vertices)
        return np.hstack([corners, np.roll(corners, -1, axis=0)])

    def clearance(self, q: Any) -> FloatArray:
        """Return signed distances of points from the boundary, negative inside, shape (N,)."""
        q = ensure_points("q", q)
        if q.shape[1] != 2:
            raise ArgumentError(f"q has shape {q.shape}: expected (N, 2), points of the plane of {self}")
        return _in_parts(self._signed, q)

    def _signed(self, q: FloatArray) -> FloatArray:
        points = shapely.points(q)
        distance = shapely.distance(self._shape.boundary, points)
        return np.where(shapely.contains(self._shape, points), -distance, distance)

    def clearance_along(
        self, start: FloatArray, end: FloatArray, ends: tuple[FloatArray, FloatArray] | None = None
    ) -> FloatArray:
        """Return lower bounds of the signed distance along straight paths, exact outside, shape (N,).

        Where a way enters, the signed distance s changes by at most the way travelled: s >= (s_a + s_b − length)/2.

        Parameters
        ----------
        start, end : ndarray, shape (N, 2)
            Ends of the ways.
        ends : tuple of ndarray, shapes (N,), optional
            Signed distances of both, where they are known already.
        """
        ends = (self.clearance(start), self.clearance(end)) if ends is None else ends
        return _in_parts(self._signed_along, start, end, *ends)

    def _signed_along(self, start: FloatArray, end: FloatArray, first: FloatArray, last: FloatArray) -> FloatArray:
        line_strings = shapely.linestrings(np.stack([start, end], axis=1))
        distances = np.minimum(shapely.distance(self._shape.boundary, line_strings), np.minimum(first, last))
        depth_bound = 0.5 * (first + last - np.linalg.norm(end - start, axis=1))
        is_met = shapely.intersects(self._shape, line_strings) | (first < 0.0) | (last < 0.0)
        return np.where(is_met, np.minimum(distances, depth_bound), distances)

    def enclosing_circle(self) -> Sphere:
        """Return the smallest disc that encloses the polygon."""
        circle = shapely.minimum_bounding_circle(self._shape)
        centre = (circle.centroid.x, circle.centroid.y)
        return Sphere(centre, float(np.linalg.norm(np.array(self.vertices) - centre, axis=1).max()))


def _in_parts(function: Any, *rows: FloatArray) -> FloatArray:
    """Return the values of a function on many rows of arguments, in blocks to limit memory."""
    parts = [function(*(row[k : k + _ROWS] for row in rows)) for k in range(0, len(rows[0]), _ROWS)]
    return np.concatenate([np.empty(0), *parts])


@register_jitable
def _onto_polygon(q, p, par, gap, rate):  # type: ignore[no-untyped-def]
    """Project onto the closest edge; the β-agent slides along an edge and rests at a corner; par = vertices."""
    least_square, is_inside, count = inf, True, par.size // 2
    for k in range(count):
        x0, y0 = par[2 * k], par[2 * k + 1]
        x1, y1 = par[2 * ((k + 1) % count)], par[2 * ((k + 1) % count) + 1]
        sx, sy, ex, ey = x1 - x0, y1 - y0, q[0] - x0, q[1] - y0
        if sx * ey - sy * ex < 0.0:
            is_inside = False
        length2 = sx * sx + sy * sy
        edge_share = (sx * ex + sy * ey) / length2
        share = min(1.0, max(0.0, edge_share))
        gx, gy = share * sx - ex, share * sy - ey
        s2 = gx * gx + gy * gy
        if s2 < least_square:
            least_square = s2
            gap[0], gap[1] = gx, gy
            speed = (sx * p[0] + sy * p[1]) / length2 if 0.0 < edge_share < 1.0 else 0.0
            rate[0], rate[1] = speed * sx, speed * sy
    return -sqrt(least_square) if is_inside else sqrt(least_square)


_POLYGON = lift_obstacle(_onto_polygon, no_turn)


@dataclass(frozen=True)
class Polygon(Obstacle, SimplePolygon):
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

    kernels = _POLYGON

    def __post_init__(self) -> None:
        SimplePolygon.__post_init__(self)
        sides = self.edges[:, 2:] - self.edges[:, :2]
        next_sides = np.roll(sides, -1, axis=0)
        turns = sides[:, 0] * next_sides[:, 1] - sides[:, 1] * next_sides[:, 0]
        if not (np.all(turns > 0.0) or np.all(turns < 0.0)):
            raise ArgumentError(
                f"vertices = {[list(corner) for corner in self.vertices]}: expected the corners of a strictly convex "
                "polygon in order; build another shape from several convex obstacles"
            )

    @property
    def par(self) -> FloatArray:
        """Vertices of the polygon as one array, counter-clockwise."""
        return np.array(self.vertices if self._shape.exterior.is_ccw else self.vertices[::-1]).ravel()

    @property
    def ball(self) -> tuple[FloatArray, float]:
        """Bounding ball of the polygon: (mean of the vertices, distance of the farthest one)."""
        corners = np.array(self.vertices)
        centre = corners.mean(axis=0)
        return centre, float(np.linalg.norm(corners - centre, axis=1).max()) * (1.0 + 1e-12)
