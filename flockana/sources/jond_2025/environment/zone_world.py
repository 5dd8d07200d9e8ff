"""Surroundings of zone-based flocking: obstacles, a box, and aliens that pursue agents."""

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError
from flockana.base.short_repr import ShortRepr
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_kind, ensure_positive, freeze_vector, normalise
from flockana.environment.obstacles import Sphere
from flockana.environment.polygon import SimplePolygon
from flockana.sources.jond_2025.environment.zone_obstacles import Box, ball_clearance_along
from flockana.sources.jond_2025.kernels.zones import World


@dataclass(frozen=True)
class Alien(ShortRepr):
    """Agent outside the flock that pursues the nearest flock agent it detects, and otherwise rests.

    The paper gives the range of detection, 9 m, and that it is trapped in a triangle; speed and triangle are ours.

    Parameters
    ----------
    start : array_like, shape (m,)
        Where it begins.
    territory : SimplePolygon, optional
        What it cannot leave (m = 2); by default it goes anywhere.
    detection : float
        Range of detection.
    speed : float
        Of its pursuit. A step is not shortened when the prey is nearer than it.

    Examples
    --------
    >>> Alien((15.0, 30.0), SimplePolygon([(8.0, 22.0), (24.0, 24.0), (14.0, 42.0)])).speed
    1.5
    """

    start: Any
    territory: SimplePolygon | None = None
    _: KW_ONLY
    detection: float = 9.0
    speed: float = 1.5

    units: ClassVar[Mapping[str, Powers]] = {"start": (1, 0), "detection": (1, 0), "speed": (1, -1)}

    def __post_init__(self) -> None:
        start = freeze_vector(self, "start")
        normalise(self, ensure_positive, "detection", "speed")
        if self.territory is None:
            return
        if not isinstance(self.territory, SimplePolygon) or start.size != 2:
            raise ArgumentError(f"territory = {self.territory!r}: expected a SimplePolygon, and an alien in the plane")
        if self.territory.clearance(start[None])[0] > 0.0:
            raise ArgumentError(f"start = {self.start}: expected a point of the alien's territory {self.territory}")


@dataclass(frozen=True)
class ZoneWorld(ShortRepr):
    """Obstacles, a box and aliens; empty by default.

    Parameters
    ----------
    obstacles : sequence of SimplePolygon and Sphere
        Solids at rest; polygons in the plane only.
    box : Box, optional
        Walls around all.
    aliens : sequence of Alien
        Hunters.

    Examples
    --------
    >>> ZoneWorld(box=Box((0.0, 0.0), (50.0, 50.0))).dimension
    2
    """

    obstacles: tuple[SimplePolygon | Sphere, ...] = ()
    box: Box | None = None
    aliens: tuple[Alien, ...] = ()

    def __post_init__(self) -> None:
        kinds: tuple[tuple[str, Any], ...] = (("obstacles", (SimplePolygon, Sphere)), ("aliens", Alien))
        for name, kind in kinds:
            items = getattr(self, name)
            if not isinstance(items, tuple | list) or not all(isinstance(item, kind) for item in items):
                expected = "SimplePolygon or Sphere" if name == "obstacles" else "Alien"
                raise ArgumentError(f"{name} = {items!r}: expected a sequence of {expected}")
            object.__setattr__(self, name, tuple(items))
        ensure_kind("box", self.box, (Box, type(None)), "a Box")
        if len(set(self._dimensions())) > 1:
            raise ArgumentError(f"{self}: expected obstacles, box and aliens of one dimension")

    def _dimensions(self) -> list[int]:
        dimensions = [2 if isinstance(o, SimplePolygon) else o.dimension for o in self.obstacles]
        return dimensions + [len(a.start) for a in self.aliens] + ([] if self.box is None else [len(self.box.low)])

    @property
    def dimension(self) -> int | None:
        """Return the dimension m, or None for an empty world."""
        return next(iter(self._dimensions()), None)

    @property
    def alien_starts(self) -> FloatArray:
        """Return the starts of the aliens, shape (K, m); (0, 0) without any."""
        return np.array([alien.start for alien in self.aliens]) if self.aliens else np.empty((0, 0))

    def arrays(self, m: int, *, buffer: bool = False) -> World:
        """Return obstacles, box and aliens as arrays for the compiled step of zone-based flocking.

        Parameters
        ----------
        buffer : bool
            Give every polygon as the smallest disc that holds it.
        """
        solids = [o.enclosing_circle() if buffer and isinstance(o, SimplePolygon) else o for o in self.obstacles]
        edges, starts = _chained([o.edges for o in solids if isinstance(o, SimplePolygon)])
        territory, territory_starts = _chained(
            [np.empty((0, 4)) if a.territory is None else a.territory.edges for a in self.aliens]
        )
        balls = [[*o.centre, o.radius] for o in solids if isinstance(o, Sphere)]
        box = [[-np.inf] * m, [np.inf] * m] if self.box is None else [self.box.low, self.box.high]
        return World(
            edges,
            starts,
            np.array(balls).reshape(-1, m + 1),
            np.array(box),
            territory,
            territory_starts,
            np.array([a.detection for a in self.aliens]),
            np.array([a.speed for a in self.aliens]),
        )

    def clearance(self, q: FloatArray) -> FloatArray:
        """Return signed distances from all obstacles at samples, and lower bounds between consecutive ones."""
        return np.min([o.clearance(q) for o in self.obstacles] or [np.full(len(q), np.inf)], axis=0)

    def clearances(self, q: FloatArray, taken: npt.NDArray[np.int64]) -> tuple[FloatArray, FloatArray]:
        """Return signed distances from all obstacles at samples, and lower bounds over the given intervals.

        Each obstacle is measured once at each sample. The bound is exact outside the obstacles. Shapes (T, n), (K, n).

        Parameters
        ----------
        taken : ndarray of int, shape (K,)
            Samples from which a way leads to the next one.
        """
        flat_positions, start, end = (x.reshape(-1, q.shape[2]) for x in (q, q[taken], q[taken + 1]))
        at, way_clearance = np.full(q.shape[:2], np.inf), np.full((len(taken), q.shape[1]), np.inf)
        for o in self.obstacles:
            rows = o.clearance(flat_positions).reshape(at.shape)
            if isinstance(o, Sphere):
                bound = ball_clearance_along(o, start, end)
            else:
                bound = o.clearance_along(start, end, (rows[taken].ravel(), rows[taken + 1].ravel()))
            at, way_clearance = np.minimum(at, rows), np.minimum(way_clearance, bound.reshape(way_clearance.shape))
        return at, way_clearance

    def check_start(self, q: FloatArray) -> None:
        """Raise if an agent begins outside the box, in an obstacle, or at an alien."""
        if self.box is not None and (box_clearance := self.box.clearance(q)).min() < 0.0:
            i = int(np.argmin(box_clearance))
            raise ArgumentError(f"q[{i}] = {q[i]}: expected a point of {self.box}")
        for k, obstacle in enumerate(self.obstacles):
            if (start_clearances := obstacle.clearance(q)).min() <= 0.0:
                i = int(np.argmin(start_clearances))
                raise ArgumentError(f"q[{i}] = {q[i]}: expected a point outside obstacle {k}, {obstacle}")
        for k, alien in enumerate(self.aliens):
            apart = np.linalg.norm(q - np.array(alien.start), axis=1)
            if apart.min() == 0.0:
                raise ArgumentError(
                    f"q[{int(np.argmin(apart))}] is where alien {k} begins, {alien.start}: expected agents apart from "
                    "it, since there is no direction to flee in"
                )


def _chained(parts: list[FloatArray]) -> tuple[FloatArray, Any]:
    """Return arrays stacked by rows, and the start index of each array in the stack."""
    return np.vstack([np.empty((0, 4)), *parts]), np.cumsum([0, *(len(part) for part in parts)])
