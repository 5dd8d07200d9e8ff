"""Scene of the player: frames, links, obstacles, targets and series, as header and arrays.

A source of a law with a world of its own names it in the `SCENE` of its scene module.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache, singledispatch
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.module_discovery import source_modules
from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.obstacles import Obstacle, Sphere, Wall
from flockana.player.run_codec import Packed, encode

SHOWN = (
    "connectivity",
    "coordination",
    "cohesion_radius",
    "normalised_deviation_energy",
    "normalised_velocity_mismatch",
    "min_distance",
    "heading_spread",
)  # metrics of the strip, of those that the law has
_FEATURES = 160  # samples of a series in a strip, beside those of least and greatest values
_OUTLINE = 90  # points about an obstacle that is neither ball nor wall
_CIRCLES = {
    2: (((1.0, 0.0), (0.0, 1.0)),),
    3: (
        ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
        *(((float(np.cos(a)), float(np.sin(a)), 0.0), (0.0, 0.0, 1.0)) for a in np.pi * np.arange(4) / 4.0),
    ),
}  # two axes of each, by dimension: the outline; the equator and four meridians
_FINE, _COARSE = 2.0**-13, 2.0**-6  # resolution of places and velocities in a page, as shares of their span
_EXTREME = 1e30  # beyond it a number is shown as if it were this


@dataclass(frozen=True)
class World:
    """Surroundings of the agents in the player's scene: links, obstacles, targets and alien agents."""

    # reach, length: Agents nearer than the first are linked, and the links coloured by their strain about the second
    reach: float | None = None
    length: float | None = None
    # shape (M, 2): links by frame, in place of those within reach; or of one frame for all
    edges: tuple[npt.NDArray[np.int64], ...] = ()
    stars: FloatArray | None = None  # stars, crosses: shape (T, K, m): targets and aliens by frame
    crosses: FloatArray | None = None
    solids: Sequence[Obstacle] = ()
    outlines: tuple[FloatArray, ...] = ()  # shape (V, m): closed lines: of other obstacles, and of a box
    beta: float = 0.0  # distance r' within which β-agents are shown
    groups: Sequence[int] = field(default=())  # colour of each agent by number; empty for one colour


@singledispatch
def world(law: Any, run: Trajectory, frames: npt.NDArray[np.intp]) -> World:
    """Return the surroundings of a run's agents; sources register their own in `SCENE`."""
    pair, target = law.pair, law.target
    return World(
        reach=finite_or_none(None if pair is None else pair.range),
        length=finite_or_none(None if pair is None else pair.length),
        stars=None if target is None else target_paths([target], run.t[frames]),
        solids=tuple(law.obstacles),
        beta=0.0 if law.obstacle_field is None else float(law.obstacle_field.beta.r),
    )


def scene(
    run: Trajectory,
    *,
    values: int = 240_000,
    exact: bool = True,
    title: str = "",
    marks: Iterable[tuple[float, str]] = (),
) -> bytes:
    """Return a run encoded as bytes in the format of the interactive player."""
    frames = kept(len(run.t), max(2, values // (2 * run.n * run.m)))
    _register_scenes()
    surroundings = world(run.law.continuous or run.law, run, frames)
    q, p = run.q[frames], run.p[frames]
    series = _series(run)
    samples = np.unique(
        [*kept(len(run.t), _FEATURES), *(pick_index(x) for *_, x in series for pick_index in (np.argmin, np.argmax))]
    )
    q_step, p_step = (0.0, 0.0) if exact else (_FINE * (np.ptp(q) or 1.0), _COARSE * (np.ptp(p) or 1.0))
    arrays = {"t": Packed(run.t[frames]), "q": Packed(q, float(q_step)), "p": Packed(p, float(p_step))}
    for name, marker_points in (("stars", surroundings.stars), ("crosses", surroundings.crosses)):
        if marker_points is not None:
            arrays[name] = Packed(marker_points, float(q_step))
    if surroundings.edges:
        arrays["edges"] = Packed(np.concatenate(surroundings.edges).reshape(-1, 2), 1.0)
    arrays["series_t"] = Packed(run.t[samples])
    for k, (*_, series_values) in enumerate(series):
        arrays[f"series_{k}"] = Packed(np.clip(series_values[samples], -_EXTREME, _EXTREME))
    header = {
        "n": run.n,
        "m": run.m,
        "title": title or f"{run.n} agents, {run.law.title}",
        "reach": surroundings.reach,
        "length": surroundings.length,
        "edge_counts": [len(pairs) for pairs in surroundings.edges],
        "solids": [_solid(solid) for solid in surroundings.solids],
        "outlines": [np.round(line, 6).tolist() for line in surroundings.outlines + outlines(surroundings.solids)],
        "beta": surroundings.beta,
        "groups": list(surroundings.groups),
        "series": [{"name": name, "label": label, "log": log} for name, label, log, _ in series],
        "marks": [{"t": float(time), "label": label} for time, label in marks],
    }
    return encode(header, arrays)


@cache
def _register_scenes() -> None:
    """Register the functions that return the surroundings of agents, for the laws of the sources."""
    for module in source_modules("scene"):
        for law, draw in module.SCENE.items():
            world.register(law, draw)


def kept(samples: int, most: int) -> npt.NDArray[np.intp]:
    """Return the indices of samples to keep: first, last, and others evenly between.

    Examples
    --------
    >>> kept(9, 4).tolist(), kept(3, 10).tolist()
    ([0, 3, 5, 8], [0, 1, 2])
    """
    return np.unique(np.rint(np.linspace(0, samples - 1, min(samples, most))).astype(np.intp))


def _series(run: Trajectory) -> list[tuple[str, str, bool, FloatArray]]:
    """Return (name, label, logarithmic, values) of each time series that the player shows as a curve."""
    rows = []
    energy = run.energy()
    if np.isfinite(energy).any():
        rows.append(("H", "energy H", False, energy))
        if "work" in run.extra:
            rows.append(("residual", "residual of the energy balance", False, run.energy_residual))
    for name in SHOWN:
        if name in run._metric_names:
            measure = run.measure(name)
            rows.append((name, measure.label, bool(measure.logarithmic), run.metric(name)))
    rows.append(("effort", "control effort: greatest ‖u‖", False, lengths(run.u).max(axis=1)))
    return [row for row in rows if np.isfinite(row[-1]).all()]  # a strip draws finite numbers only


def finite_or_none(value: Any) -> float | None:
    """Return a finite number as it is, None for anything else."""
    return float(value) if value is not None and np.ndim(value) == 0 and np.isfinite(value) else None


def target_paths(targets: Iterable[Any], times: FloatArray) -> FloatArray:
    """Return positions of targets, shape (T, K, m)."""
    return np.array([[target.position(t) for target in targets] for t in times.tolist()])


def _solid(solid: Obstacle) -> dict[str, Any]:
    if isinstance(solid, Sphere | Wall):
        return {"kind": type(solid).__name__.lower(), "par": solid.par.tolist()}
    return {"kind": "other"}


def outlines(solids: Iterable[Obstacle]) -> tuple[FloatArray, ...]:
    """Return closed outlines of obstacles other than balls and walls."""
    angles = np.linspace(0.0, 2.0 * np.pi, _OUTLINE, endpoint=False)
    lines = []
    for obstacle in solids:
        if isinstance(obstacle, Sphere | Wall) or not np.isfinite(obstacle.ball[1]):
            continue
        centre, radius = obstacle.ball
        for u, v in _CIRCLES.get(obstacle.dimension, ()):
            ring_points = centre + 1.001 * radius * (np.outer(np.cos(angles), u) + np.outer(np.sin(angles), v))
            lines.append(obstacle.beta_agents(ring_points, np.zeros_like(ring_points)).q)
    return tuple(lines)
