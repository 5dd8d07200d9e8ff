"""R² notebook's variant of Algorithms 1 and 2: close pairs repel each other tenfold.

The notebook multiplies q_j − q_i by 10 where it is shorter than 0.05, after the σ-norm has been taken: φ_α and a_ij
keep their values and only n_ij becomes σ_ε(10 (q_j − q_i)). The force then jumps at that distance.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_kind, ensure_positive, normalise
from flockana.interactions import AlphaInteraction
from flockana.interactions.distance_functions import DistanceFunction, InnerValues, LawFunction
from flockana.kernels.neighbours import pair_blocks
from flockana.laws.gain_laws import GainedLaw
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.laws.terms.term import Term

MIN_DISTANCE, FACTOR = 0.05, 10.0


@dataclass(frozen=True)
class Push(DistanceFunction):
    """Extra repulsion of close pairs, added to φ_α n_ij within its own range."""

    alpha: AlphaInteraction
    min_distance: float
    factor: float

    @property
    def range(self) -> float:
        """Distance below which the extra repulsion acts."""
        return self.min_distance

    @property
    def feature(self) -> float:
        """Range of the extra repulsion, which falls linearly to 0 with the distance."""
        return self.min_distance

    def inner(self, s2: FloatArray) -> InnerValues:  # noqa: D102
        eps, factor, phi = self.alpha.eps, self.factor, self.alpha.phi_alpha(self.alpha.sigma_norm(np.sqrt(s2)))
        weight = phi * (factor / np.sqrt(1.0 + eps * factor**2 * s2) - 1.0 / np.sqrt(1.0 + eps * s2))
        return weight, np.zeros_like(s2), np.full_like(s2, np.nan), np.zeros_like(s2)


def extra_push(alpha: AlphaInteraction, q: FloatArray, *, min_distance: float, factor: float) -> FloatArray:
    """Return the extra repulsion of each pair closer than min_distance, shape (n, m); it sums to 0."""
    f, push = np.zeros_like(q), Push(alpha, min_distance, factor)
    for i, j in pair_blocks(q, min_distance):
        if not i.size:
            continue
        delta = q[j] - q[i]
        weight = push.inner(np.sum(delta**2, axis=1))[0]
        np.add.at(f, i, weight[:, None] * delta)
        np.subtract.at(f, j, weight[:, None] * delta)
    return f


@dataclass(frozen=True)
class PushTerm(Term):
    """Term of the extra repulsion, which has no potential and no energy."""

    alpha: AlphaInteraction
    stiffness: float
    min_distance: float
    factor: float

    conservative = False

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Extra repulsion of close pairs as a function of their distance."""
        return (LawFunction("the push", Push(self.alpha, self.min_distance, self.factor), self.stiffness),)

    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:  # noqa: D102
        f = self.stiffness * extra_push(self.alpha, q, min_distance=self.min_distance, factor=self.factor)
        u += f
        return float(np.sum(f * p))  # the same in the moving frame, for the pushes cancel

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return zero outside the extra repulsion's range; raise inside."""
        if any(i.size for i, _ in pair_blocks(q, self.min_distance)):
            raise ArgumentError(
                f"agents are closer than min_distance = {self.min_distance:g}: expected them farther apart, where the "
                "push does not act; it has no derivatives here"
            )
        return self.hessian(t, q), self.hessian(t, q)


class _Pushed(GainedLaw):
    """Mixin of the two laws with extra repulsion: its two parameters, their checks, and its term."""

    min_distance: float
    factor: float

    units: ClassVar[Mapping[str, Powers]] = {"min_distance": (1, 0)}
    references: ClassVar[tuple[str, ...]] = ("notebook-r2", "olfati-saber-2006")

    def __post_init__(self) -> None:
        super().__post_init__()
        ensure_kind("alpha", self.alpha, AlphaInteraction, "AlphaInteraction(...), whose action the push multiplies")
        normalise(self, ensure_positive, "min_distance", "factor")
        if self.factor < 1.0:
            raise ArgumentError(f"factor = {self.factor:g}: expected at least 1; a smaller one is no push")

    @property
    def surfaces(self) -> tuple[Any, ...]:
        """Switching distances of the law, and the range of the extra repulsion."""
        return (self.min_distance, *super().surfaces)

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Terms of the law, and the extra repulsion."""
        push = PushTerm(self.alpha, self.gains.c1_alpha, self.min_distance, self.factor)
        return (*super().terms, push)  # type: ignore[safe-super]  # those of the law beside it


@dataclass(frozen=True)
class PushedAlgorithm1(_Pushed, Algorithm1):
    """Algorithm 1 with the notebook's extra repulsion; `energy` stays H, whose rate gains the repulsion's power.

    dH/dt = −c2α pᵀL̂p + Σ⟨f_i, p_i⟩ with f the extra force, in closed form. `stiffness` is that of Algorithm 1, exact
    wherever no pair is closer than `min_distance`.
    """

    min_distance: float = MIN_DISTANCE
    factor: float = FACTOR


@dataclass(frozen=True)
class PushedAlgorithm2(_Pushed, Algorithm2):
    """Algorithm 2 with the notebook's extra repulsion; `energy` stays H_λ, whose rate gains the repulsion's power."""

    min_distance: float = MIN_DISTANCE
    factor: float = FACTOR
