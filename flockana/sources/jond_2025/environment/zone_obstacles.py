"""Obstacles of zone-based flocking: simple polygons and the walls of a box.

Discs and balls are `flockana.environment.obstacles.Sphere`. A `SimplePolygon` need not be convex, so it has no
β-agents and is no `Obstacle` of Algorithm 3.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import lazy_loader
import numpy as np

from flockana.base.checks import FloatArray, ensure_points, freeze_vector
from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.environment.obstacles import Sphere, ensure_corners

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
        corners = ensure_corners(self.vertices)
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
        ways = shapely.linestrings(np.stack([start, end], axis=1))
        least = np.minimum(shapely.distance(self._shape.boundary, ways), np.minimum(first, last))
        deepest = 0.5 * (first + last - np.linalg.norm(end - start, axis=1))
        met = shapely.intersects(self._shape, ways) | (first < 0.0) | (last < 0.0)
        return np.where(met, np.minimum(least, deepest), least)

    def enclosing_circle(self) -> Sphere:
        """Return the smallest enclosing disc, the buffer zone of the conventional method."""
        circle = shapely.minimum_bounding_circle(self._shape)
        centre = (circle.centroid.x, circle.centroid.y)
        return Sphere(centre, float(np.linalg.norm(np.array(self.vertices) - centre, axis=1).max()))


def _in_parts(function: Any, *rows: FloatArray) -> FloatArray:
    """Return a function of many rows, evaluated some at a time: shapely makes an object of each."""
    parts = [function(*(each[k : k + _ROWS] for each in rows)) for k in range(0, len(rows[0]), _ROWS)]
    return np.concatenate([np.empty(0), *parts])


def ball_clearance_along(ball: Sphere, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return least signed distances from a ball along straight paths, exact, shape (N,)."""
    way, away = end - start, np.array(ball.centre) - start
    length2 = np.sum(way**2, axis=1)
    share = np.divide(np.sum(way * away, axis=1), length2, out=np.zeros(len(way)), where=length2 > 0.0)
    nearest = np.clip(share, 0.0, 1.0)[:, None] * way - away
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
        """Return distances of points from the nearest wall; negative outside the box.

        On a straight way it is least at one of the ends.
        """
        q = ensure_points("q", q)
        return np.minimum(q - np.array(self.low), np.array(self.high) - q).min(axis=1)
