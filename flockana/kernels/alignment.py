"""Velocity consensus alone, with any weight of the distance: sums over all pairs, or over those within a range.

A weight is a scalar function of the squared distance and of its parameters. What compiled integrators read is the
gain, whether it is divided by the number of agents, the range (infinite for all pairs) and the parameters.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import exp, log1p
from typing import Any

import numpy as np

from flockana.kernels.compiling import njit, register_jitable
from flockana.kernels.lift import lift_scalar, source_digest
from flockana.kernels.listed import CompiledFunction, term_functions

STRENGTH, LENGTH, DECAY = range(3)


@dataclass(frozen=True)
class WeightKernels:
    """What a weight has once it is compiled.

    Attributes
    ----------
    match : callable
        ``match(x, v, gain, r2, par, u)`` adds gain Σ a (v_j − v_i) over the pairs nearer than √r2, and returns the
        dissipation Σ a ‖v_j − v_i‖² over unordered ones.
    weight, slope : callable
        a and da/d(s²) over an array of squared distances.
    compiled : callable
        Force and energy for compiled integrators, compiled when first asked for.
    """

    match: Callable[..., float]
    weight: Callable[..., Any]
    slope: Callable[..., Any]
    compiled: Callable[[], tuple[CompiledFunction, CompiledFunction]]


def lift_weight(weight: Callable[..., float], slope: Callable[..., float]) -> WeightKernels:
    """Compile the sums of a weight a(s²) and its slope, two `register_jitable` functions of (s2, par).

    Parameters
    ----------
    weight, slope : callable
        a and da/d(s²).
    """
    digest = source_digest(weight, slope)

    @register_jitable
    def exchange(i, j, x, v, gain, r2, par, u):
        s2, slip2 = 0.0, 0.0
        for c in range(x.shape[1]):
            s2 += (x[j, c] - x[i, c]) ** 2
        if s2 >= r2:
            return 0.0
        a = weight(s2, par)
        for c in range(x.shape[1]):
            slip = v[j, c] - v[i, c]
            u[i, c] += gain * a * slip
            u[j, c] -= gain * a * slip
            slip2 += slip * slip
        return a * slip2

    @register_jitable
    def everywhere(x, v, gain, r2, par, u):
        total = 0.0 * digest
        for i in range(len(x)):
            for j in range(i + 1, len(x)):
                total += exchange(i, j, x, v, gain, r2, par, u)
        return total

    @njit(cache=True)
    def match(x, v, gain, r2, par, u):
        return everywhere(x, v, gain, r2, par, u)

    def act(t, x, v, u, frame, numbers, panels, first, second, size, order, near, room):
        gain, r2, par = numbers[0], numbers[2] * numbers[2], numbers[3:]
        if numbers[1] != 0.0:
            gain /= len(x)
        if np.isinf(r2):
            return -gain * everywhere(x, v, gain, r2, par, u)
        total = 0.0
        for k in range(size):
            total += exchange(np.int64(first[k]), np.int64(second[k]), x, v, gain, r2, par, u)
        return -gain * total

    @cache
    def compiled() -> tuple[CompiledFunction, CompiledFunction]:
        return term_functions(act, no_energy, allocates=False)

    return WeightKernels(match, lift_scalar(weight), lift_scalar(slope), compiled)


def no_energy(t, x, v, frame, numbers, panels, first, second, size, order, near, room):
    """Velocity consensus stores none."""
    return 0.0


@register_jitable
def rational(s2, par):
    """K (1 + s²/ℓ²)^−β, by the logarithm: no power of a number near 1 is rounded."""
    return par[STRENGTH] * exp(-par[DECAY] * log1p(s2 / (par[LENGTH] * par[LENGTH])))


@register_jitable
def rational_slope(s2, par):
    """−β/(ℓ² + s²) times the weight, its derivative in s²."""
    return -par[DECAY] / (par[LENGTH] * par[LENGTH] + s2) * rational(s2, par)
