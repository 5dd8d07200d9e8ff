"""Functions of the distance of two agents (force, potential, adjacency) with a common interface.

A function has an `energy`, a `force` = −dV/ds (positive repels), an `adjacency` a_ij by which velocities are averaged,
and a `range` beyond which two agents do not feel each other; what it lacks is 0.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import inf, isfinite
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from flockana.base.function_facts import Fact, PairFacts
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import FloatArray
from flockana.kernels.neighbours import pair_blocks

PROVED = ("smooth", "weight", "inside")  # facts that a function without a formula may name a proof of
Part = Literal["force", "adjacency"]
Edges = tuple[tuple[int, int], ...]
InnerValues = tuple[FloatArray, FloatArray, FloatArray, FloatArray]  # w, a, dw/d(s²), da/d(s²)
_BESIDE = 1e-12  # relative: how far from a seam both sides are read
_CHANGED = 1e-6  # relative: a change that is no rounding
_SMALL = 1e-9  # of the largest value: a change that may be rounding of the parameters
_POINTS = 33  # distances at which the largest values are looked for
_AT = 1e-9  # relative: distances that count as equal


class Corner(NamedTuple):
    """Distance at which a force or an adjacency jumps, or bends (its slope jumps), with values on both sides."""

    distance: float
    part: Part
    kind: Literal["jump", "kink"]
    below: float  # value, or slope by the distance, just below; the force is −dV/ds
    above: float

    def __str__(self) -> str:
        part_text = f"the {self.part}" if self.kind == "jump" else f"the slope of the {self.part}"
        is_known = self.below == self.below and self.above == self.above  # a law may tell where alone
        sides = f", from {self.below:.6g} to {self.above:.6g}" if is_known else ""
        return f"{part_text} jumps at s = {self.distance:.6g}{sides}"


class PairCorner(NamedTuple):
    """Pair of agents at a distance where a force or an adjacency of the law jumps or bends."""

    i: int
    j: int
    distance: float
    name: str  # of the function, in words
    corner: Corner


class SlopeBound(NamedTuple):
    """Bounds of |dF/ds| of force and |da/ds| of adjacency between two distances; infinite if unknown."""

    left: float
    right: float
    force: float
    adjacency: float


class Values(NamedTuple):
    """Force and adjacency with their slopes by the distance, at some distances."""

    force: FloatArray
    adjacency: FloatArray
    force_slope: FloatArray
    adjacency_slope: FloatArray


class DistanceFunction(ShortRepr, ABC):
    """Function of the distance of two agents: a potential with its force, an adjacency, or both."""

    proofs: ClassVar[Mapping[str, str]] = {}  # of facts about all distances, by name: smooth, weight, inside

    @property
    @abstractmethod
    def range(self) -> float:
        """Distance beyond which force and adjacency are 0, in the user's unit; infinite if there is none."""

    @abstractmethod
    def inner(self, s2: FloatArray) -> InnerValues:
        """Return the force weight w, the adjacency a and their slopes by s² within the range; force w (q_j − q_i).

        Parameters
        ----------
        s2 : ndarray, shape (L,)
            Squared distances.
        """

    @property
    def coincidence(self) -> bool:
        """Whether two agents may coincide; False where the function has no limit at distance 0."""
        return True

    @property
    def faults(self) -> tuple[str, ...]:
        """Properties that theorems ask for and the function lacks (C¹, smooth end), each in words."""
        return ()

    @property
    def facts(self) -> PairFacts:
        """Properties of the function over all distances, such as smoothness, each met, unmet or assumed."""
        answers = {name: Fact("assumed", f"{type(self).__name__} names no proof of it") for name in PROVED}
        answers |= {name: Fact("met", text) for name, text in self.proofs.items()}
        if self.faults:
            answers["smooth"] = Fact("unmet", "; ".join(self.faults))
        unknown = (-inf, inf)
        return PairFacts(answers["smooth"], answers["weight"], answers["inside"], unknown, unknown, unknown)

    @property
    def seams(self) -> tuple[float, ...]:
        """Distances at which the formula of force or adjacency may change; by default the range."""
        return (self.range,) if isfinite(self.range) else ()

    @property
    def feature(self) -> float | None:
        """Length of the narrowest rise and fall of force or adjacency; None if unknown."""
        return None

    def slopes(self, parts: int = 64) -> tuple[SlopeBound, ...] | None:
        """Return bounds of the slopes of force and adjacency on parts of the range; None if unknown.

        Parameters
        ----------
        parts : int
            How many, about.
        """
        return None

    def values(self, s: Any) -> Values:
        """Return force, adjacency and their slopes at distances, 0 beyond the range.

        Parameters
        ----------
        s : array_like
            Distances.
        """
        s = np.atleast_1d(np.asarray(s, dtype=np.float64))
        in_range = s < self.range
        with np.errstate(all="ignore"):  # NaN or infinite where there is no limit
            w, a, weight_slope, adjacency_slope = self.inner(np.where(in_range, s, 0.0).ravel() ** 2)
            rows = (-w * s.ravel(), a, -(w + 2.0 * s.ravel() ** 2 * weight_slope), 2.0 * s.ravel() * adjacency_slope)
            return Values(*(np.where(in_range, row.reshape(s.shape), 0.0) for row in rows))

    def energy(self, s: Any) -> Any:
        """Return the potential V at distances; 0 without one.

        Parameters
        ----------
        s : float or array_like
            Distances; beyond the range V is constant.

        Returns
        -------
        float or ndarray
            Of unit length²/time², or length² where the gain c1 (1/time²) carries the time.
        """
        return 0.0 if np.ndim(s) == 0 else np.zeros(np.shape(s))

    def force(self, s: Any) -> Any:
        """Return the force −dV/ds between two agents along their line: positive repels, negative attracts.

        Parameters
        ----------
        s : float or array_like
            Distances; 0 beyond the range.

        Returns
        -------
        float or ndarray
            Of unit length/time², or length where the gain c1 carries the time.
        """
        return shaped(self.values(s).force, s)

    def adjacency(self, s: Any) -> Any:
        """Return the adjacency a_ij, the weight of velocity averaging; 0 without one.

        Parameters
        ----------
        s : float or array_like
            Distances; 0 beyond the range.

        Returns
        -------
        float or ndarray
            A pure number, or of unit 1/time where no gain c2 stands before it.
        """
        return shaped(self.values(s).adjacency, s)

    @cached_property
    def corners(self) -> tuple[Corner, ...]:
        """Distances at which force or adjacency jump or bend, the range included.

        Examples
        --------
        >>> from flockana.interactions import pair_law
        >>> for corner in pair_law("(s - d)**2/2", adjacency=1, range=2.0, length=1.0).corners:
        ...     print(corner)
        the force jumps at s = 2, from -1 to 0
        the adjacency jumps at s = 2, from 1 to 0
        """
        seams = np.array([s for s in self.seams if 0.0 < s < inf])
        return tuple(self._corners_at(seams)) if seams.size else ()

    def _corners_at(self, seams: FloatArray) -> Iterator[Corner]:
        usual = self.values(seams.max() * np.arange(1, _POINTS) / _POINTS)
        sides = [self.values(seams * side) for side in (1.0 - _BESIDE, 1.0 + _BESIDE)]
        parts: tuple[tuple[Part, int], ...] = (("force", 0), ("adjacency", 1))
        for k, seam in enumerate(seams):
            for part, row in parts:
                (value_below, value_above), (left, right) = (
                    (float(sides[0][at][k]), float(sides[1][at][k])) for at in (row, row + 2)
                )
                tolerance = 4.0 * seam * _BESIDE * (abs(left) + abs(right))  # a root has steep slopes and no jump
                if _differ(value_below, value_above, usual[row]) and not abs(value_above - value_below) <= tolerance:
                    yield Corner(float(seam), part, "jump", value_below, value_above)
                elif _differ(left, right, usual[row + 2]):
                    yield Corner(float(seam), part, "kink", left, right)


def _differ(below: float, above: float, usual: FloatArray) -> bool:
    """Return whether values on both sides of a distance differ beyond rounding; unknown values do not."""
    threshold = max(_CHANGED * max(abs(below), abs(above)), _SMALL * np.abs(usual[np.isfinite(usual)]).max(initial=0.0))
    return not abs(below - above) <= threshold and not (np.isnan(below) and np.isnan(above))


def shaped(values: FloatArray, s: Any) -> Any:
    """Return an array of values as a float if the distance is a number, else in the shape of the distances."""
    return float(values[0]) if np.ndim(s) == 0 else values.reshape(np.shape(s))


@dataclass(frozen=True)
class LawFunction:
    """Function of the distance in a law, with its gains and the pairs on which it acts."""

    name: str  # in words, such as "pair law"
    function: DistanceFunction | None  # None if the law does not say what it reads
    stiffness: float = 0.0  # gain before the force; 0 where only the adjacency is read
    damping: float = 0.0  # gain before the adjacency
    edges: Edges | None = None  # pairs that are joined at every distance; None for all pairs within the range
    listeners: tuple[int, ...] | None = None  # agents that feel it; None for all
    mean: bool = False  # whether the gains are divided by the number of agents

    @property
    def has_pole(self) -> bool:
        """Whether the function has no limit at distance 0, for some pair of agents that it couples."""
        return self.function is not None and self.edges is None and not self.function.coincidence

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Distances at which the force or adjacency jumps or bends, of those that the law's gains use."""
        if self.function is None:
            return ()
        gains = {"force": self.stiffness, "adjacency": self.damping}
        return tuple(corner for corner in self.function.corners if gains[corner.part] != 0.0)

    def pairs_at_corners(self, q: FloatArray, tolerance: float = _AT) -> Iterator[PairCorner]:
        """Yield the pairs of agents at a distance where the force or adjacency jumps or bends."""
        corners = self.corners
        if not corners:
            return
        reach = max(corner.distance for corner in corners) * (1.0 + 2.0 * tolerance)
        blocks = (
            pair_blocks(q, reach) if self.edges is None else [np.array(self.edges, dtype=np.int32).reshape(-1, 2).T]
        )
        for i, j in blocks:
            distances = np.sqrt(np.sum((q[j] - q[i]) ** 2, axis=1))
            for corner in corners:
                for k in np.flatnonzero(np.abs(distances - corner.distance) <= tolerance * corner.distance):
                    if self.listeners is None or {int(i[k]), int(j[k])} & {*self.listeners}:
                        yield PairCorner(int(i[k]), int(j[k]), float(distances[k]), self.name, corner)


@dataclass(frozen=True)
class Within(DistanceFunction):
    """Function that is cut off at a distance, where force and adjacency fall to 0."""

    function: DistanceFunction
    reach: float

    @property
    def range(self) -> float:  # noqa: D102
        return min(self.reach, self.function.range)

    @property
    def feature(self) -> float | None:  # noqa: D102
        inner = self.function.feature
        return None if inner is None else min(inner, self.range)

    def energy(self, s: Any) -> Any:  # noqa: D102
        return self.function.energy(np.minimum(s, self.range))

    def inner(self, s2: FloatArray) -> InnerValues:  # noqa: D102
        return self.function.inner(s2)


@dataclass(frozen=True)
class UnknownEdges(DistanceFunction):
    """Distances at which an unknown force begins, ends or jumps."""

    distances: tuple[float, ...]

    @property
    def range(self) -> float:  # noqa: D102
        return max(self.distances, default=0.0)

    def inner(self, s2: FloatArray) -> InnerValues:  # noqa: D102
        no_values = np.full_like(s2, np.nan)
        return no_values, no_values, no_values, no_values

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Jumps of the force of unknown height, one at each distance."""
        return tuple(Corner(s, "force", "jump", np.nan, np.nan) for s in self.distances)
