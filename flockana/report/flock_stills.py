"""Snapshots of a flock as SVG in the page's colours, for print and without scripts."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.environment import Obstacle, Sphere, Wall
from flockana.measures.nets import link_lengths, links
from flockana.player.scene import World, outlines, world

_SIZE = 400.0
_TURN, _TILT = 0.6, 0.5  # of a flock in space, as the player first shows it
_NEAR = 0.1  # of strain, within which a link counts as being of its length
_MOST = 500  # links of a still: a lattice of 150 has 400, and more of them are one blot


def stills(run: Trajectory, times: Sequence[float]) -> str:
    """Return snapshots of a run at the samples nearest to some times, side by side on one scale, as HTML."""
    samples = np.array([int(np.argmin(np.abs(run.t - time))) for time in times])
    around = world(run.law.continuous or run.law, run, samples)
    places = [_project(run.q[k]) for k in samples]
    others = [_project(x[j]) for x in (around.stars, around.crosses) if x is not None for j in range(len(samples))]
    spheres = [obstacle for obstacle in around.solids if isinstance(obstacle, Sphere)]
    balls = [_project(np.array([sphere.centre])) + d * sphere.radius for sphere in spheres for d in (-1, 1)]
    wires = around.outlines + outlines(around.solids)
    lines = [_project(line) for line in wires]
    every = np.concatenate([*places, *others, *balls, *lines])
    low, span = every.min(axis=0), float(np.ptp(every, axis=0).max()) or 1.0
    scale = 0.92 * _SIZE / span
    height = max(60.0, scale * float(np.ptp(every[:, 1])) + 0.08 * _SIZE)

    def put(points: FloatArray) -> FloatArray:
        points_drawn = 0.04 * _SIZE + scale * (points - low)
        return np.column_stack([points_drawn[:, 0], height - points_drawn[:, 1]])

    parts = []
    for j, k in enumerate(samples.tolist()):
        label = f"t = {run.t[k]:.4g}"
        inner = (
            _world(around.solids, wires, put, scale, height)
            + _walls(around.solids, run.q, put)
            + _links(around, run.q[k], j, put)
            + _dots(put(places[j]), min(70.0 / np.sqrt(run.n), 0.4 * (around.length or around.reach or np.inf) * scale))
        )
        for kind, marks in (("star", around.stars), ("cross", around.crosses)):
            if marks is not None and marks[j].size:
                inner += "".join(_mark(kind, *at) for at in put(_project(marks[j])).tolist())
        image = f'<svg viewBox="0 0 {_SIZE:g} {height:.0f}" role="img" aria-label="The flock at {label}">{inner}</svg>'
        parts.append(f'<div class="still"><p class="axis">{label}</p>{image}</div>')
    return f'<div class="panels">{"".join(parts)}</div>'


def still(run: Trajectory, time: float) -> str:
    """Return a snapshot of a run at the sample nearest to a time as one SVG, on its own scale."""
    text, end = stills(run, [time]), "</svg>"
    return text[text.index("<svg ") : text.index(end) + len(end)]


def _project(points: FloatArray) -> FloatArray:
    """Project points for drawing: line points to one height, space points from the player's first view."""
    if points.shape[1] == 1:
        return np.column_stack([points, np.zeros(len(points))])
    if points.shape[1] == 3:
        x, y, z = points.T
        horizontal, deep = np.cos(_TURN) * x - np.sin(_TURN) * y, np.sin(_TURN) * x + np.cos(_TURN) * y
        return np.column_stack([horizontal, np.sin(_TILT) * deep + np.cos(_TILT) * z])
    return points


def _dots(points: FloatArray, size: float) -> str:
    path = "".join(f"M{x:.0f} {y:.0f}h0" for x, y in points.tolist())
    return f'<path class="agents" stroke-width="{np.clip(size, 2.0, 10.0):.1f}" d="{path}"/>'


def _links(around: World, q: FloatArray, j: int, put: Any) -> str:
    """Return links of the net as SVG in three colours: shorter than desired, about as desired, longer."""
    kinds: Any
    if around.edges:
        pairs: Any = around.edges[j if len(around.edges) > 1 else 0]
        kinds = np.zeros(len(pairs))
    elif around.reach and len(q) > 1:
        pairs = links(q, around.reach)
        strain = link_lengths(q, pairs) / around.length - 1.0 if around.length else np.zeros(len(pairs))
        kinds = np.sign(np.where(np.abs(strain) < _NEAR, 0.0, strain))
    else:
        return ""
    if not 0 < len(pairs) <= _MOST:
        return ""
    points, text = put(_project(q)), ""
    for kind, name in ((-1, "short"), (1, "long"), (0, "even")):
        a, b = (points[pairs[kinds == kind, c]] for c in (0, 1))
        path = "".join(f"M{x:.0f} {y:.0f}L{u:.0f} {v:.0f}" for x, y, u, v in np.hstack([a, b]).tolist())
        text += f'<path class="link {name}" d="{path}"/>' if path else ""
    return text


def _world(solids: Sequence[Obstacle], wires: Sequence[FloatArray], put: Any, scale: float, height: float) -> str:
    text = ""
    for obstacle in solids:
        if isinstance(obstacle, Sphere):
            x, y = put(_project(np.array([obstacle.centre])))[0]
            text += f'<circle class="solid" cx="{x:.0f}" cy="{y:.0f}" r="{scale * obstacle.radius:.1f}"/>'
        elif isinstance(obstacle, Wall) and obstacle.dimension == 2:
            x, y = put(np.array([obstacle.par[:2]]))[0]
            a, b = obstacle.par[2:]
            far_distance = 4.0 * (_SIZE + height)
            corners = [(x - b * far_distance, y - a * far_distance), (x + b * far_distance, y + a * far_distance)]
            corners += [(u - a * far_distance, v + b * far_distance) for u, v in reversed(corners)]
            text += f'<polygon class="solid" points="{_points(corners)}"/>'
    for line in wires:
        kind = "solid" if len(line) != 4 and line.shape[1] == 2 else "box"
        text += f'<polygon class="{kind}" points="{_points(put(_project(line)).tolist())}"/>'
    return text


def _walls(solids: Sequence[Obstacle], q: FloatArray, put: Any) -> str:
    """Return SVG grid lines for each plane wall in space, about the projection of the run's centre onto it."""
    walls = [obstacle for obstacle in solids if isinstance(obstacle, Wall) and obstacle.dimension == 3]
    if not walls:
        return ""
    path, low, high = "", q.min(axis=(0, 1)), q.max(axis=(0, 1))
    for wall in walls:
        y, a = wall.par[:3], wall.par[3:]
        foot = 0.5 * (low + high) - ((0.5 * (low + high) - y) @ a) * a
        u = np.cross(a, np.eye(3)[np.argmin(np.abs(a))])
        axes = 0.6 * float((high - low).max()) * np.array([u / np.linalg.norm(u), np.cross(a, u) / np.linalg.norm(u)])
        for k in np.linspace(-1.0, 1.0, 5):
            for line_ends in (((k, -1.0), (k, 1.0)), ((-1.0, k), (1.0, k))):
                (x0, y0), (x1, y1) = put(_project(foot + np.array(line_ends) @ axes)).tolist()
                path += f"M{x0:.0f} {y0:.0f}L{x1:.0f} {y1:.0f}"
    return f'<path class="box" d="{path}"/>'


def _points(corners: Any) -> str:
    return " ".join(f"{x:.0f},{y:.0f}" for x, y in corners)


def _mark(kind: str, x: float, y: float) -> str:
    if kind == "cross":
        return f'<path class="alien" d="M{x - 6:.0f} {y - 6:.0f}l12 12m0-12l-12 12"/>'
    turns = np.pi * np.arange(10) / 5.0 - np.pi / 2.0
    radii = np.where(np.arange(10) % 2, 4.0, 10.0)
    corners = np.column_stack([x + radii * np.cos(turns), y + radii * np.sin(turns)])
    return f'<polygon class="target" points="{_points(corners.tolist())}"/>'
