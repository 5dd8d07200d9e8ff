"""Weights of velocity consensus as functions of the distance."""

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import expm1, inf, log, sqrt
from typing import Any, ClassVar

import numpy as np

from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_nonnegative, ensure_positive, normalise
from flockana.interactions.distance_functions import DistanceFunction, InnerValues, SlopeBound
from flockana.kernels.alignment import WeightKernels, lift_weight, rational, rational_slope, singular, singular_slope


class Weight(DistanceFunction):
    """Adjacency a(s) without a force; a frozen dataclass with `kernels`, `par` and, if finite, `range`."""

    kernels: ClassVar[WeightKernels]
    derived_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {"kernels": ("__call__", "adjacency")}

    @property
    @abstractmethod
    def par(self) -> FloatArray:
        """Weight's parameters in the order in which its compiled functions read them."""

    @property
    def range(self) -> float:
        """Distance beyond which the weight is 0; infinite by default."""
        return inf

    def inner(self, s2: FloatArray) -> InnerValues:  # noqa: D102
        zero_terms = np.zeros_like(s2)
        return zero_terms, self.kernels.weight(s2, self.par), zero_terms, self.kernels.slope(s2, self.par)

    def __call__(self, distance: Any) -> Any:
        """Return the weight at some distances, a scalar or an array."""
        return self.adjacency(distance)


_RATIONAL = lift_weight(rational, rational_slope)


@dataclass(frozen=True)
class RationalWeight(Weight):
    """Weight a(s) = K (1 + s²/ℓ²)^−β of Cucker and Smale, with K = K′/σ^2β and ℓ = σ in their symbols.

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
    proofs: ClassVar[Mapping[str, str]] = {"smooth": "a power of 1 + s²/ℓ² > 0 is analytic"} | dict.fromkeys(
        ("weight", "inside"), "K > 0 times a positive power"
    )
    units: ClassVar[Mapping[str, Powers]] = {"strength": (0, -1), "length": (1, 0)}

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "strength", "length")
        normalise(self, ensure_nonnegative, "decay")

    @property
    def feature(self) -> float:
        """Distance at which the weight has fallen by half, ℓ √(2^(1/β) − 1); infinite for a constant."""
        return self.length * sqrt(expm1(log(2.0) / self.decay)) if self.decay > 1e-3 else inf

    def slopes(self, parts: int = 64) -> tuple[SlopeBound, ...]:
        """Return bounds of |da/ds|, which peaks at ℓ/√(2β + 1), on geometric parts of all lengths.

        Parameters
        ----------
        parts : int
            How many, within 2⁻²⁰ ℓ and 2²⁰ ℓ; two more reach to 0 and to infinity.
        """
        top = self.length / sqrt(2.0 * self.decay + 1.0)
        edges = np.concatenate([[0.0], np.unique([top, *np.geomspace(2.0**-20, 2.0**20, parts + 1) * self.length])])
        adjacency_slopes = np.abs(self.values(edges).adjacency_slope) * (1.0 + 1e-12)
        bounds = np.where(edges[:-1] < top, adjacency_slopes[1:], adjacency_slopes[:-1])
        inner = [SlopeBound(*row) for row in zip(edges[:-1], edges[1:], np.zeros(len(bounds)), bounds, strict=True)]
        return (*inner, SlopeBound(float(edges[-1]), inf, 0.0, float(adjacency_slopes[-1])))

    @cached_property
    def par(self) -> FloatArray:
        """Parameters K, ℓ, β."""
        return np.array([self.strength, self.length, self.decay])


_SINGULAR = lift_weight(singular, singular_slope)


@dataclass(frozen=True)
class SingularWeight(Weight):
    """Weight a(s) = K (ℓ/s)^α with a pole at distance 0, where no two agents may start.

    Parameters
    ----------
    strength : float
        K > 0, the weight at distance ℓ (1/time).
    decay : float
        α > 0.
    length : float
        ℓ > 0.

    Examples
    --------
    >>> SingularWeight(2.0, decay=0.5)(4.0)
    1.0
    """

    strength: float = 1.0
    decay: float = 1.0
    length: float = 1.0

    coincidence = False
    kernels: ClassVar[WeightKernels] = _SINGULAR
    proofs: ClassVar[Mapping[str, str]] = {"smooth": "a power of s is analytic at s > 0; at 0 it has a pole"} | (
        dict.fromkeys(("weight", "inside"), "K > 0 times a power of ℓ/s > 0")
    )
    units: ClassVar[Mapping[str, Powers]] = {"strength": (0, -1), "length": (1, 0)}

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "strength", "decay", "length")

    def slopes(self, parts: int = 64) -> tuple[SlopeBound, ...]:
        """Return bounds of the decreasing |da/ds| on geometric parts of all lengths; infinite on the part at 0.

        Parameters
        ----------
        parts : int
            How many, within 2⁻²⁰ ℓ and 2²⁰ ℓ; two more reach to 0 and to infinity.
        """
        edges = np.geomspace(2.0**-20, 2.0**20, parts + 1) * self.length
        adjacency_slopes = np.abs(self.values(edges).adjacency_slope) * (1.0 + 1e-12)
        rows = zip([0.0, *edges], [*edges, inf], [inf, *adjacency_slopes], strict=True)
        return tuple(SlopeBound(float(left), float(right), 0.0, float(slope)) for left, right, slope in rows)

    @cached_property
    def par(self) -> FloatArray:
        """Parameters K, ℓ, α."""
        return np.array([self.strength, self.length, self.decay])
