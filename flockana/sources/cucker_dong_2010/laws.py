"""Law of Cucker and Smale with a repulsion proportional to the velocity spread."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_kind, ensure_nonnegative, ensure_positive, normalise
from flockana.interactions.distance_functions import LawFunction
from flockana.interactions.weights import RationalWeight
from flockana.laws.law import Law


@dataclass(frozen=True)
class CuckerDong(Law):
    """u_i = Σ_j a(s_ij) (p_j − p_i) + V Σ_j f(s_ij) (q_i − q_j), f(s) = k δ³/(s² − δ²)², V² = Σ‖p_i − p̄‖².

    No pair crosses the distance δ. Momentum is conserved, no energy is known; what falls is V + ½ Σ_{i<j} k δ³/(s_ij² −
    δ²), the `functional`.

    Parameters
    ----------
    weight : RationalWeight
        a(s) = K (1 + s²/ℓ²)^−β.
    repulsion : float
        k >= 0 (1/time); 0 leaves the law of Cucker and Smale.
    distance : float
        δ > 0.

    Examples
    --------
    >>> law = CuckerDong(RationalWeight(decay=0.0), repulsion=9.0, distance=1.0)
    >>> law.acceleration(0.0, [[0.0], [2.0]], [[3.0], [-3.0]]).round(12).tolist()
    [[-14.485281374239], [14.485281374239]]
    """

    weight: RationalWeight = field(default_factory=RationalWeight)
    repulsion: float = 1.0
    distance: float = 1.0

    references: ClassVar[tuple[str, ...]] = ("cucker-dong-2010",)
    units: ClassVar[Mapping[str, Powers]] = {"repulsion": (0, -1), "distance": (1, 0)}

    def __post_init__(self) -> None:
        ensure_kind("weight", self.weight, RationalWeight, "RationalWeight(strength, decay, length)")
        normalise(self, ensure_nonnegative, "repulsion")
        normalise(self, ensure_positive, "distance")

    @property
    def scales(self) -> Scales:
        """Length δ, and the time 1/K in which two near agents align."""
        return Scales(self.distance, 1.0 / self.weight.strength)

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Functions of the distance in the law: the alignment weight, and the repulsion with gain V."""
        return (LawFunction("the weight", self.weight, 0.0, 1.0), LawFunction("the repulsion", None, 1.0))

    @property
    def poles(self) -> tuple[float, ...]:
        """Distance δ, where the repulsion is infinite."""
        return (self.distance,) if self.repulsion > 0.0 else ()

    def check_start(self, q: FloatArray, p: FloatArray) -> None:
        """Raise if two agents are at the distance δ, where the repulsion is infinite."""
        super().check_start(q, p)
        for i, j in np.argwhere(np.triu(self._squares(q) == self.distance**2, 1))[:1] if self.repulsion else ():
            raise ArgumentError(f"agents {i} and {j} are {self.distance:g} apart: expected another distance than δ")

    @staticmethod
    def _squares(q: FloatArray) -> FloatArray:
        delta = q[:, None] - q[None]
        return np.asarray(np.einsum("ijc,ijc->ij", delta, delta))

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        squares, spread = self._squares(q), float(np.sqrt(np.sum((p - p.mean(axis=0)) ** 2)))
        weights = self.weight.adjacency(np.sqrt(squares))
        with np.errstate(divide="ignore"):
            push = spread * self.repulsion * self.distance**3 / (squares - self.distance**2) ** 2
        u = weights @ p - weights.sum(axis=1)[:, None] * p + push.sum(axis=1)[:, None] * q - push @ q
        return u, float("nan")

    def functional(self, q: FloatArray, p: FloatArray) -> float:
        """Return V + ½ Σ_{i<j} k δ³/(s_ij² − δ²), which never rises while all distances exceed δ."""
        squares = self._squares(q)[np.triu_indices(len(q), 1)]
        store = 0.5 * self.repulsion * self.distance**3 * float(np.sum(1.0 / (squares - self.distance**2)))
        return float(np.sqrt(np.sum((p - p.mean(axis=0)) ** 2))) + store
