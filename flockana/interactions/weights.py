"""Weights of velocity consensus as functions of the distance."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Any, ClassVar

import numpy as np

from flockana.base.checks import FloatArray, ensure_nonnegative, ensure_positive, normalise
from flockana.base.facts import Fact
from flockana.base.units import Powers
from flockana.interactions.pair import evaluate
from flockana.kernels.alignment import WeightKernels, lift_weight, rational, rational_slope


class Weight(ABC):
    """Weight a(s) of the distance; a subclass is a frozen dataclass with `kernels`, `par` and, if finite, `range`."""

    kernels: ClassVar[WeightKernels]
    proof: ClassVar[str] = ""  # that it is nowhere negative
    derived_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {"kernels": ("__call__",)}

    @property
    @abstractmethod
    def par(self) -> FloatArray:
        """Parameters in the order that the kernels read."""

    @property
    def range(self) -> float:
        """Distance beyond which the weight is 0; infinite by default."""
        return inf

    @property
    def sign(self) -> Fact:
        """Fact whether the weight is nonnegative at every distance; assumed, unless `proof` says why."""
        return Fact("met", self.proof) if self.proof else Fact("assumed", f"{type(self).__name__} names no proof of it")

    def __call__(self, distance: Any) -> Any:
        """Return the weight at some distances, a scalar or an array."""
        s = np.asarray(distance, dtype=np.float64)
        values = np.where(s < self.range, evaluate(self.kernels.weight, s * s, self.par), 0.0)
        return float(values) if s.ndim == 0 else values


_RATIONAL = lift_weight(rational, rational_slope)


@dataclass(frozen=True)
class RationalWeight(Weight):
    """Weight a(s) = K (1 + s²/ℓ²)^−β of Cucker and Smale, written K′/(σ² + s²)^β there: ℓ = σ, K = K′/σ^2β.

    Parameters
    ----------
    strength : float
        K > 0, the weight at distance 0 (1/time).
    decay : float
        β >= 0; 0 is the constant weight.
    length : float
        ℓ > 0.

    Examples
    --------
    >>> RationalWeight(2.0, 1.0)(1.0)
    1.0
    """

    strength: float = 1.0
    decay: float = 0.5
    length: float = 1.0

    kernels: ClassVar[WeightKernels] = _RATIONAL
    proof: ClassVar[str] = "K > 0 times a positive power"
    units: ClassVar[Mapping[str, Powers]] = {"strength": (0, -1), "length": (1, 0)}

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "strength", "length")
        normalise(self, ensure_nonnegative, "decay")

    @cached_property
    def par(self) -> FloatArray:
        """Parameters K, ℓ, β."""
        return np.array([self.strength, self.length, self.decay])
