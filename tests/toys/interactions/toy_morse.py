"""A Morse pair potential, cut off at a range: a toy of one file."""

from dataclasses import dataclass
from math import exp, sqrt

import numpy as np

from flockana.interactions.pair_interaction import PairInteraction
from flockana.jit import register_jitable
from flockana.kernels.pair_kernels import lift


@register_jitable
def pair(s2, par):
    """(w, a): weight of the force along q_j − q_i, and 1 for a neighbour; par = (depth, width, d, r)."""
    if s2 >= par[3] ** 2:
        return 0.0, 0.0
    x = sqrt(s2)
    e = exp(-par[1] * (x - par[2]))
    return 2.0 * par[0] * par[1] * e * (1.0 - e) / max(x, 1e-300), 1.0


@register_jitable
def slope(s2, par):
    """dw/d(s²)."""
    if s2 >= par[3] ** 2:
        return 0.0
    x = sqrt(s2)
    e = exp(-par[1] * (x - par[2]))
    force = 2.0 * par[0] * par[1] * e * (1.0 - e)
    stiffness = 2.0 * par[0] * par[1] ** 2 * e * (2.0 * e - 1.0)
    return 0.5 * (stiffness / x - force / x**2) / x


@register_jitable
def potential(s2, par, panels):
    """D (1 − e)² up to r, constant beyond."""
    x = min(sqrt(s2), par[3])
    return par[0] * (1.0 - exp(-par[1] * (x - par[2]))) ** 2


@dataclass(frozen=True)
class ToyMorse(PairInteraction):
    """D (1 − exp(−a (x − d)))² for x < r."""

    depth: float = 2.0
    width: float = 1.0
    d: float = 3.0
    r: float = 5.0

    kernels = lift(pair, slope, potential)

    @property
    def range(self):
        return self.r

    @property
    def length(self):
        return self.d

    @property
    def strength(self):
        return 0.5 * self.depth * self.width

    @property
    def far_potential(self):
        return float(self.energy(self.r))

    @property
    def par(self):
        return np.array([self.depth, self.width, self.d, self.r])

    @property
    def panels(self):
        return np.empty((0, 0))
