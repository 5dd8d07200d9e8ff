"""A slab |x| <= h across the plane, with agents on either side: a toy of one file."""

from dataclasses import dataclass

import numpy as np

from flockana.environment.obstacles import Obstacle
from flockana.jit import register_jitable
from flockana.kernels.obstacles import lift_obstacle, no_turn


@register_jitable
def onto_slab(q, p, par, gap, rate):
    """The nearer face; par = (m, h)."""
    side = 1.0 if q[0] >= 0.0 else -1.0
    for c in range(q.size):
        gap[c], rate[c] = 0.0, p[c]
    gap[0] = side * par[1] - q[0]
    rate[0] = 0.0
    return abs(q[0]) - par[1]


@dataclass(frozen=True)
class ToySlab(Obstacle):
    """|x| <= h."""

    h: float = 1.0
    m: int = 2

    kernels = lift_obstacle(onto_slab, no_turn)

    @property
    def dimension(self):
        return self.m

    @property
    def par(self):
        return np.array([float(self.m), self.h])

    @property
    def ball(self):
        return np.zeros(self.m), np.inf
