"""Weights of velocity consensus as functions of distance, and their sums (`flockana.kernels.weight_sums`)."""

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, inf, log1p
from typing import Any

from flockana.jit import Kernel, register_jitable
from flockana.kernels.bound_templates import bound
from flockana.kernels.pair_kernels import lift_scalar

STRENGTH, LENGTH, DECAY = range(3)


@dataclass(frozen=True)
class WeightKernels:
    """Compiled functions of a velocity-consensus weight a(s²) and its slope."""

    of_square: Kernel  # a(s²) of its parameters
    weight: Callable[..., Any]  # a over an array of squared distances
    slope: Callable[..., Any]  # da/d(s²) over such an array

    @property
    def match(self) -> Callable[..., float]:
        """``match(x, v, gain, r2, par, u)``: add velocity consensus over pairs nearer than √r2 to u."""
        return self._sums.match

    @property
    def act(self) -> Kernel:
        """Velocity consensus over pairs as a compiled term of a law."""
        return self._sums.act

    @property
    def _sums(self) -> Any:
        return bound("flockana.kernels.weight_sums", weight=self.of_square)


def lift_weight(weight: Callable[..., float], slope: Callable[..., float]) -> WeightKernels:
    """Return the sums of a weight a(s²) and its slope, two `register_jitable` functions of (s2, par)."""
    return WeightKernels(weight, lift_scalar(weight), lift_scalar(slope))  # type: ignore[arg-type]


@register_jitable
def rational(s2, par):
    """Return the rational weight K (1 + s²/ℓ²)^−β, computed by the logarithm."""
    return par[STRENGTH] * exp(-par[DECAY] * log1p(s2 / (par[LENGTH] * par[LENGTH])))


@register_jitable
def rational_slope(s2, par):
    """Return the rational weight's derivative by s², −β/(ℓ² + s²) times the weight."""
    return -par[DECAY] / (par[LENGTH] * par[LENGTH] + s2) * rational(s2, par)


@register_jitable
def singular(s2, par):
    """Return the singular weight K (ℓ/s)^α; infinite at distance 0."""
    return par[STRENGTH] * (s2 / (par[LENGTH] * par[LENGTH])) ** (-0.5 * par[DECAY]) if s2 > 0.0 else inf


@register_jitable
def singular_slope(s2, par):
    """Return the singular weight's derivative by s², −α/(2 s²) times the weight."""
    return -0.5 * par[DECAY] / s2 * singular(s2, par) if s2 > 0.0 else -inf
