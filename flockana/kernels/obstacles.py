"""Compiled sums over agents and obstacles of one kind, from the kind's closest-point map.

An obstacle kind is one scalar function, ``project(q, p, par, gap, rate) -> clearance``: it writes the gap q̂ − q from
the agent to its β-agent and the β-agent's velocity dq̂/dt into the last two arguments, and returns the signed distance
to the boundary, negative inside. The gap, not q̂, is what it gives: q̂ − q would cancel near the surface.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt
from types import ModuleType
from typing import Any

import numpy as np

from flockana.jit import Kernel, register_jitable
from flockana.kernels.bound_templates import bound


@dataclass(frozen=True)
class ObstacleKernels:
    """Compiled sums over agents and the obstacles of one kind (`flockana.kernels.obstacle_sums`)."""

    project: Kernel  # the closest-point map
    turn: Kernel | None  # how p̂ turns as an agent moves; without it `braking` is right where p = 0 alone

    @property
    def turns(self) -> bool:
        """Whether the obstacle kind defines how the velocity p̂ of a β-agent changes with position."""
        return self.turn is not None

    @property
    def sums(self) -> ModuleType:
        """Return the module of the compiled sums over agents and obstacles of one kind."""
        return bound("flockana.kernels.obstacle_sums", project=self.project, turn=self.turn or no_turn)

    def __getattr__(self, name: str) -> Any:
        """Return a compiled sum by its name: forces, potential, agents, slopes, braking, act, energy, guard."""
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self.sums, name)


@register_jitable
def no_turn(q, p, e, par, out):
    """Write zeros, the rotation rate of p̂ on a flat face."""
    out[:] = 0.0


@register_jitable
def project_nothing(q, p, par, gap, rate):
    """Return infinity, the distance from an absent obstacle."""
    return np.inf


def lift_obstacle(project: Callable[..., float], turn: Callable[..., None] | None = None) -> ObstacleKernels:
    """Return the sums of an obstacle kind given by its closest-point map."""
    return ObstacleKernels(project, turn)  # type: ignore[arg-type]


@register_jitable
def project_ball(q, p, centre, radius, along, gap, rate):
    """Write the β-agent on a sphere about `centre`, which moves at `along`; also for rims of other bodies.

    `along` must be tangent to the sphere at the agent's foot (or zero); of `centre` the first m components are read.
    """
    s2, radial = 0.0, 0.0
    for c in range(q.size):
        s2 += (q[c] - centre[c]) ** 2
        radial += (q[c] - centre[c]) * p[c]
    distance = sqrt(s2)
    if distance == 0.0:  # the centre has no closest point
        for c in range(q.size):
            gap[c], rate[c] = np.nan, np.nan
        return -radius
    mu = radius / distance
    for c in range(q.size):
        a = (q[c] - centre[c]) / distance
        gap[c] = (radius - distance) * a
        rate[c] = along[c] + mu * (p[c] - along[c] - radial / distance * a)
    return distance - radius


@register_jitable
def turn_ball(q, p, e, centre, radius, p_centre, e_centre, out):
    """Write the turning rate of the velocity on a sphere, as the agent moves along e and the centre along e_centre.

    −(μ/ρ) [⟨a,e⟩ Pp + ⟨a,p⟩ Pe + a ⟨Pe,p⟩], symmetric in p and e, both relative to the centre; ⟨a,p⟩ sees no centre
    that moves tangentially.
    """
    s2 = 0.0
    for c in range(q.size):
        s2 += (q[c] - centre[c]) ** 2
    distance = sqrt(s2)
    ap, ae, pe = 0.0, 0.0, 0.0
    for c in range(q.size):
        a, velocity_difference, step = (q[c] - centre[c]) / distance, p[c] - p_centre[c], e[c] - e_centre[c]
        ap += a * velocity_difference
        ae += a * step
        pe += velocity_difference * step
    for c in range(q.size):
        a, velocity_difference, step = (q[c] - centre[c]) / distance, p[c] - p_centre[c], e[c] - e_centre[c]
        turning_rate = ae * (velocity_difference - ap * a) + ap * (step - ae * a) + (pe - ap * ae) * a
        out[c] = -radius / s2 * turning_rate
