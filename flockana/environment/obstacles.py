"""Obstacles and their β-agents: base class, spheres and walls.

An obstacle is a closed convex solid. Of an agent outside it the β-agent is the closest point q̂ of the solid, and it
moves at p̂ = dq̂/dt. The closest-point map of a convex solid is the gradient of a convex function and contracts, so
its derivative D (p̂ = D p) is symmetric with 0 ≤ D ≤ I wherever it exists: ⟨p, p̂ − p⟩ ≤ 0 outside every obstacle,
and D (q̂ − q) = 0. A wall has D = P, a sphere D = μP with P the projection on the tangent space.

A new kind is one file: a frozen dataclass with its parameters, a bounding ball, and `kernels` lifted from one scalar
function, with a second one for Jacobians at moving agents (see `flockana.kernels.obstacles`); laws and measures take it
as it is.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot, inf
from typing import Any, ClassVar, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError
from flockana.base.short_repr import ShortRepr
from flockana.base.units import Powers
from flockana.base.value_checks import (
    FloatArray,
    ensure_points,
    ensure_positive,
    ensure_state,
    freeze_vector,
    normalise,
)
from flockana.jit import register_jitable
from flockana.kernels.obstacles import ObstacleKernels, lift_obstacle, no_turn, project_ball, turn_ball


class BetaAgents(NamedTuple):
    """β-agents of one obstacle, one per agent: positions (n, m), velocities (n, m), signed clearances (n,)."""

    q: FloatArray
    p: FloatArray
    clearance: FloatArray


class Obstacle(ShortRepr, ABC):
    """Base class of convex obstacles: frozen dataclasses with `par`, `ball` and `kernels`.

    Inside the solid (where a law must not be started) q̂ stays the closest point of the boundary.
    """

    kernels: ObstacleKernels
    derived_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {"kernels": ("beta_agents", "clearance", "contains")}

    @property
    @abstractmethod
    def par(self) -> FloatArray:
        """Parameters of the obstacle as an array, in the order that compiled functions read them."""

    @property
    @abstractmethod
    def ball(self) -> tuple[FloatArray, float]:
        """Return (centre, radius) of a bounding ball; the radius is infinite without one."""

    @property
    def dimension(self) -> int:
        """Dimension m of the space."""
        return int(self.ball[0].size)

    def _project(self, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return (gaps q̂ − q, velocities of the β-agents, clearances), unchecked."""
        gap, rate, clearance = np.empty_like(q), np.empty_like(q), np.empty(len(q))
        self.kernels.agents(q, p, self.par, gap, rate, clearance)
        return gap, rate, clearance

    def beta_agents(self, q: Any, p: Any) -> BetaAgents:
        """Return each agent's β-agent on this obstacle, near or far.

        Raises
        ------
        ArgumentError
            On bad arrays, or agents of another dimension than the obstacle's.
        """
        q, p = ensure_state(q, p)
        if self.dimension != q.shape[1]:
            raise ArgumentError(
                f"the obstacle = {self} has {self.dimension} components but the agents have {q.shape[1]}: "
                "expected equal dimensions"
            )
        gap, rate, clearance = self._project(q, p)
        return BetaAgents(q + gap, rate, clearance)

    def clearance(self, q: Any) -> FloatArray:
        """Return signed distances of points from the surface, negative inside, shape (n,)."""
        q = ensure_points("q", q)
        return self.beta_agents(q, np.zeros_like(q)).clearance

    def contains(self, q: Any) -> npt.NDArray[np.bool_]:
        """Return which points lie inside or on the surface, shape (n,)."""
        return self.clearance(q) <= 0.0


@register_jitable
def _onto_sphere(q, p, par, gap, rate):  # type: ignore[no-untyped-def]
    """Project onto a sphere: q̂ = μq + (1 − μ)y, p̂ = μPp with μ = R/‖q − y‖."""
    for c in range(q.size):  # no slices: a view costs as much as all else
        rate[c] = 0.0
    return project_ball(q, p, par, par[q.size], rate, gap, rate)


@register_jitable
def _turn_sphere(q, p, e, par, out):  # type: ignore[no-untyped-def]
    zero_velocity = np.zeros(q.size)
    turn_ball(q, p, e, par[:-1], par[-1], zero_velocity, zero_velocity, out)


@register_jitable
def _onto_wall(q, p, par, gap, rate):  # type: ignore[no-untyped-def]
    """Project onto a wall: q̂ = Pq + (I − P)y, p̂ = Pp with P = I − aaᵀ; par = (y, a)."""
    m, offset, speed = q.size, 0.0, 0.0
    for c in range(m):
        offset += par[m + c] * (q[c] - par[c])
        speed += par[m + c] * p[c]
    for c in range(m):
        gap[c] = -offset * par[m + c]
        rate[c] = p[c] - speed * par[m + c]
    return offset


_SPHERE, _WALL = lift_obstacle(_onto_sphere, _turn_sphere), lift_obstacle(_onto_wall, no_turn)


@dataclass(frozen=True)
class Sphere(Obstacle):
    """Ball obstacle: a disc in the plane, an interval on the line (Olfati-Saber 2006).

    Parameters
    ----------
    centre : array_like, shape (m,)
        y.
    radius : float
        R > 0.

    Examples
    --------
    >>> agents = Sphere((0.0, 0.0), 2.0).beta_agents([[4.0, 0.0]], [[1.0, 1.0]])
    >>> agents.q.tolist(), agents.p.tolist(), agents.clearance.tolist()
    ([[2.0, 0.0]], [[0.0, 0.5]], [2.0])
    """

    centre: Any
    radius: float

    units: ClassVar[Mapping[str, Powers]] = {"centre": (1, 0), "radius": (1, 0)}

    kernels = _SPHERE

    def __post_init__(self) -> None:
        freeze_vector(self, "centre")
        normalise(self, ensure_positive, "radius")

    @property
    def par(self) -> FloatArray:
        """Centre y and radius R of the sphere as one array, for compiled functions."""
        return np.array([*self.centre, self.radius])

    @property
    def ball(self) -> tuple[FloatArray, float]:
        """Bounding ball of a spherical obstacle, (centre y, radius R)."""
        return np.array(self.centre), self.radius


@dataclass(frozen=True)
class Wall(Obstacle):
    """Half-space obstacle behind a hyperplane, in any dimension (Olfati-Saber 2006).

    Parameters
    ----------
    point : array_like, shape (m,)
        y, any point of the hyperplane.
    normal : array_like, shape (m,)
        Direction of the normal a, towards the free side; its length does not matter.

    Examples
    --------
    >>> agents = Wall((0.0, 0.0), (0.0, 2.0)).beta_agents([[4.0, 3.0]], [[1.0, 1.0]])
    >>> agents.q.tolist(), agents.p.tolist(), agents.clearance.tolist()
    ([[4.0, 0.0]], [[1.0, 0.0]], [3.0])
    """

    point: Any
    normal: Any

    units: ClassVar[Mapping[str, Powers]] = {"point": (1, 0)}

    kernels = _WALL

    def __post_init__(self) -> None:
        normal = freeze_vector(self, "normal", freeze_vector(self, "point").size)
        if not normal.any():
            raise ArgumentError(f"normal = {self.normal}: expected a vector that is not zero, towards the free side")

    @property
    def par(self) -> FloatArray:
        """Point y and unit normal a of the wall as one array, for compiled functions."""
        normal = np.array(self.normal) / max(map(abs, self.normal))
        return np.concatenate([self.point, normal / hypot(*normal)])

    @property
    def ball(self) -> tuple[FloatArray, float]:
        """Bounding ball of a wall, with centre y and infinite radius."""
        return np.array(self.point), inf
