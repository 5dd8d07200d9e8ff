"""Drawing of obstacles of any kind through their closest points.

The closest-point map of a convex solid takes any closed curve (or surface) around it onto its whole boundary, so the
bounding ball's points trace the outline. An unbounded solid is traced as far as the view reaches.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon

from flockana.base.argument_kinds import check_kinds
from flockana.base.value_checks import FloatArray
from flockana.environment import Obstacle
from flockana.plots.palette import FAINT, MUTED
from flockana.plots.style import ensure_axes, finish

_ROUND = 720  # points of an outline in the plane: corners are met exactly, arcs to 4e-5 of their radius
_MESH = 19, 37  # of a surface in space
_OUTSIDE = 1.001  # the tracing ball must lie outside
_BEYOND = 4.0  # how far an unbounded obstacle is traced, in radii of the view


@check_kinds
def obstacles(items: Iterable[Obstacle], *, ax: Axes | None = None, view: Any = None) -> Axes:
    """Draw obstacles: solid in the plane, as wire meshes in space, as intervals on a line.

    Parameters
    ----------
    items : iterable of Obstacle
        All of one dimension.
    view : array_like, shape (k, m), optional
        Points that are in view; an unbounded obstacle is drawn about them, by default about the origin.
    """
    solids = tuple(items)
    axes = ensure_axes(ax, m=solids[0].dimension if solids else 2)
    for obstacle in solids:
        _draw(axes, obstacle, np.zeros((1, obstacle.dimension)) if view is None else np.asarray(view, dtype=np.float64))
    if ax is None and axes.name != "3d":
        axes.autoscale_view()  # patches do not move the limits by themselves
        axes.set_aspect("equal", adjustable="datalim")
        finish(axes, "x (length)", "y (length)")
    return axes  # the stubs have no three-dimensional axes


def bounds(items: Iterable[Obstacle]) -> FloatArray:
    """Return corners of the bounding boxes of the bounded obstacles, shape (2 K, m)."""
    solids = tuple(items)
    balls = [obstacle.ball for obstacle in solids if np.isfinite(obstacle.ball[1])]
    corners = [centre + side * radius for centre, radius in balls for side in (-1.0, 1.0)]
    return np.array(corners).reshape(-1, solids[0].dimension)


def _draw(ax: Any, solid: Obstacle, view: FloatArray) -> None:
    centre, radius = solid.ball
    bounded = bool(np.isfinite(radius))
    if not bounded:
        centre = 0.5 * (view.min(axis=0) + view.max(axis=0))
        radius = _BEYOND * max(1.0, float(np.linalg.norm(view - centre, axis=1).max()))
    if solid.dimension == 3:
        turn, tilt = np.linspace(0.0, 2.0 * np.pi, _MESH[1]), np.linspace(0.0, np.pi, _MESH[0])[:, None]
        ball = np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), np.cos(tilt) + 0.0 * turn], axis=2)
        traced, is_inside = _nearest_points(solid, centre + _OUTSIDE * radius * ball.reshape(-1, 3))
        traced[is_inside] = np.nan  # of an unbounded solid only its surface shows
        ax.plot_wireframe(*traced.T.reshape(3, *_MESH), color=MUTED, linewidth=0.4, rstride=2, cstride=3)
        return
    if solid.dimension == 1:
        ends, _ = _nearest_points(solid, centre + _OUTSIDE * radius * np.array([[-1.0], [1.0]]))
        corners = np.array([[x, y] for x, y in zip(ends[[0, 1, 1, 0], 0], (-0.3, -0.3, 0.3, 0.3), strict=True)])
    else:
        angle = np.linspace(0.0, 2.0 * np.pi, _ROUND, endpoint=False)
        disc = np.column_stack([np.cos(angle), np.sin(angle)])
        corners, _ = _nearest_points(solid, centre + _OUTSIDE * radius * disc)
    patch = Polygon(corners, closed=True, facecolor=FAINT, edgecolor=MUTED, linewidth=0.8, zorder=1)
    (ax.add_patch if bounded else ax.add_artist)(patch)  # an artist does not widen the view


def _nearest_points(solid: Obstacle, around: FloatArray) -> tuple[FloatArray, Any]:
    """Return the point of a solid obstacle nearest to each given point, and whether the given point is inside."""
    foot = solid.beta_agents(around, np.zeros_like(around))
    is_inside = foot.clearance <= 0.0
    return np.where(is_inside[:, None], around, foot.q), is_inside
