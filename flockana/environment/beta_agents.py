"""Sums over the β-agents of several obstacles, and checks of starts among them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.environment.obstacles import Obstacle
from flockana.interactions import BetaInteraction
from flockana.kernels.obstacles import ObstacleKernels

_PUSHES = 100  # rounds of looking for a free point near an agent that starts inside
_OUTWARD = 1e-6  # how far beyond the surface a push ends, relative to its length


class Kind(NamedTuple):
    """Obstacles of one shape, such as spheres, as arrays for compiled sums over β-agents."""

    kernels: ObstacleKernels
    arrays: tuple[FloatArray, Any, FloatArray]  # parameters, where those of each obstacle start, and bounding balls


class BetaLinks(NamedTuple):
    """Pairs of an agent and a β-agent within range r'.

    `agent` and `obstacle` are index arrays (L,); `q`, `p` (L, m) are the β-agents' positions and velocities, and
    `distance` (L,) the distances ‖q̂_ik − q_i‖.
    """

    agent: Any
    obstacle: Any
    q: FloatArray
    p: FloatArray
    distance: FloatArray


@dataclass(frozen=True)
class ObstacleField:
    """Obstacles together with their β-interaction."""

    obstacles: tuple[Obstacle, ...]  # any kinds, of one dimension; they may overlap
    beta: BetaInteraction  # clearance d', range r'

    @cached_property
    def kinds(self) -> tuple[Kind, ...]:
        """Obstacles grouped by kind."""
        obstacles_by_kind: dict[int, list[Obstacle]] = {}
        for obstacle in self.obstacles:
            obstacles_by_kind.setdefault(id(obstacle.kernels), []).append(obstacle)
        kinds = []
        for group in obstacles_by_kind.values():
            pars = [obstacle.par for obstacle in group]
            starts = np.concatenate([[0], np.cumsum([par.size for par in pars])]).astype(np.int64)
            balls = np.array([[*centre, radius] for centre, radius in (obstacle.ball for obstacle in group)])
            kinds.append(Kind(group[0].kernels, (np.concatenate(pars), starts, balls)))
        return tuple(kinds)

    def forces(self, q: FloatArray, p: FloatArray, u: FloatArray, *, stiffness: float, damping: float) -> float:
        """Add the forces of all β-agents, c1 Σ_k φ_β n̂_ik + c2 Σ_k b_ik (p̂_ik − p_i), to u in place, unchecked."""
        power, par, reach = 0.0, self.beta.par, self.beta.r
        for kernels, arrays in self.kinds:
            power += kernels.forces(q, p, arrays, par, reach, (stiffness, damping), u)
        return power

    def potential_energy(self, q: FloatArray) -> float:
        """Return the obstacles' potential Σ_i Σ_k ψ_β(‖q̂_ik − q_i‖_σ), unchecked."""
        total, par, panels, reach = 0.0, self.beta.par, self.beta.panels, self.beta.r
        for kernels, arrays in self.kinds:
            total += kernels.potential(q, arrays, par, panels, reach)
        return total

    def hessian_blocks(self, q: FloatArray) -> FloatArray:
        """Return the diagonal blocks (n, m, m) of the Hessian of `potential_energy`; the others vanish."""
        n, m = q.shape
        blocks = np.zeros((n, m, m))
        for obstacle in self.obstacles:
            obstacle.kernels.slopes(q, obstacle.par, self.beta.par, self.beta.r, blocks)
        return blocks

    def braking_blocks(self, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return derivatives of Σ_k b_ik (p̂_ik − p_i) in q_i and in p_i: diagonal blocks (n, m, m)."""
        n, m = q.shape
        by_position, by_velocity = np.zeros((n, m, m)), np.zeros((n, m, m))
        for obstacle in self.obstacles:
            if not obstacle.kernels.turns and p.any():
                raise ArgumentError(
                    f"{obstacle}: its kind does not say how β-agents turn, which the Jacobian needs where agents move: "
                    "hand lift_obstacle(...) a turn (no_turn for flat faces)"
                )
            obstacle.kernels.braking(q, p, obstacle.par, self.beta.par, self.beta.r, by_position, by_velocity)
        return by_position, by_velocity

    def links(self, q: FloatArray, p: FloatArray) -> BetaLinks:
        """Return the obstacles k with ‖q̂_ik − q_i‖ < r' of every agent i."""
        links_by_obstacle = []
        for k, obstacle in enumerate(self.obstacles):
            agents = obstacle.beta_agents(q, p)
            distance = np.abs(agents.clearance)
            near = np.flatnonzero(distance < self.beta.r)
            links_by_obstacle.append((near, np.full(near.size, k), agents.q[near], agents.p[near], distance[near]))
        no_links = np.empty(0, np.int64), np.empty(0, np.int64), q[:0], p[:0], np.empty(0)
        return BetaLinks(*map(np.concatenate, zip(no_links, *links_by_obstacle, strict=True)))


class InsideObstacleError(ArgumentError):
    """Exception for a start inside or on an obstacle, where no run may begin."""


def check_free(q: FloatArray, obstacles: Sequence[Obstacle]) -> None:
    """Raise if an agent is inside or on an obstacle; the error names the first one."""
    is_inside = np.array([obstacle.contains(q) for obstacle in obstacles]).reshape(len(obstacles), len(q))
    agents = np.flatnonzero(is_inside.any(axis=0))
    if agents.size == 0:
        return
    i = int(agents[0])
    obstacle_indices = np.flatnonzero(is_inside[:, i]).tolist()
    place_text = " and ".join(f"obstacles[{k}] = {obstacles[k]}" for k in obstacle_indices)
    count_text = f" ({agents.size} agents do)" if agents.size > 1 else ""
    free_point = _free_point(q[i], obstacles)
    remedy = ", and no free point was found by pushing it out of all obstacles: move the agent or an obstacle"
    if free_point is not None:
        remedy = f": expected every agent outside; {free_point.tolist()} is free"
    raise InsideObstacleError(f"agent {i} at {q[i].tolist()} starts inside {place_text}{count_text}{remedy}")


def _free_point(point: FloatArray, obstacles: Sequence[Obstacle]) -> FloatArray | None:
    """Return a point moved out of all obstacles."""
    candidate = point[None, :].copy()
    for _ in range(_PUSHES):
        depth = [float(obstacle.clearance(candidate)[0]) for obstacle in obstacles]
        k = int(np.argmin(depth))
        if depth[k] > 0.0:
            return candidate[0]
        foot = obstacles[k].beta_agents(candidate, np.zeros_like(candidate)).q
        step = foot - candidate
        if np.isfinite(step).all() and step.any():
            candidate = foot + _OUTWARD * step
        else:  # at a centre, or on the surface: any direction will do
            candidate[0, 0] += max(abs(depth[k]), 1e-6 * float(np.abs(candidate).max()), 1e-9)
    return None
