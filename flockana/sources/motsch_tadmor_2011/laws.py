"""Law of Motsch and Tadmor: velocity consensus normalised by each agent's own sum of influences."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_kind, ensure_positive, normalise
from flockana.interactions.distance_functions import LawFunction
from flockana.interactions.weights import RationalWeight
from flockana.laws.law import Law


@dataclass(frozen=True)
class MotschTadmor(Law):
    """u_i = α Σ_j a_ij (p_j − p_i), a_ij = φ(‖q_j − q_i‖)/Σ_k φ(‖q_k − q_i‖), φ(s) = (1 + s²/ℓ²)^−β.

    The sum over k includes i itself: the a_ij of an agent sum to 1. They are not symmetric, momentum is not kept, and
    no energy is known.

    Parameters
    ----------
    weight : RationalWeight
        φ, with its strength 1: of an influence only the ratio to others counts.
    gain : float
        α > 0 (1/time).

    Raises
    ------
    ArgumentError
        On a gain that is not positive, or another weight.

    Examples
    --------
    Two agents 1 apart have φ = 1/2, and hear each other with 1/3:

    >>> law = MotschTadmor(RationalWeight(decay=1.0), gain=3.0)
    >>> law.acceleration(0.0, [[0.0], [1.0]], [[0.0], [2.0]]).round(12).tolist()
    [[2.0], [-2.0]]
    """

    weight: RationalWeight = field(default_factory=RationalWeight)
    gain: float = 1.0

    references: ClassVar[tuple[str, ...]] = ("motsch-tadmor-2011",)
    units: ClassVar[Mapping[str, Powers]] = {"gain": (0, -1)}

    def __post_init__(self) -> None:
        ensure_kind("weight", self.weight, RationalWeight, "RationalWeight(strength, decay, length)")
        normalise(self, ensure_positive, "gain")

    @property
    def scales(self) -> Scales:
        """Length ℓ, and the time 1/α in which an agent aligns with heard neighbours."""
        return Scales(self.weight.length, 1.0 / self.gain)

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Influence of one agent on another as a function of their distance."""
        return (LawFunction("the influence", self.weight, 0.0, self.gain, mean=True),)

    def influences(self, q: FloatArray) -> FloatArray:
        """Return the normalised influences a_ij, shape (n, n), whose rows sum to 1, a_ii included."""
        phi = self.weight.adjacency(np.linalg.norm(q[:, None] - q[None], axis=2))
        return np.asarray(phi / phi.sum(axis=1, keepdims=True))

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        return self.gain * (self.influences(q) @ p - p), float("nan")

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:  # noqa: D102
        return float("nan")

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Any) -> Mapping[str, Any]:  # noqa: D102
        return {
            "position_diameter": ("largest ‖q_j − q_i‖ (length)", diameters(q)),
            "velocity_diameter": ("largest ‖p_j − p_i‖ (length/time)", diameters(p)),
        }


def diameters(x: FloatArray) -> FloatArray:
    """Return the largest distance of two agents at each sample of x, shape (T, n, m)."""
    from scipy.spatial.distance import pdist

    return np.array([pdist(item).max(initial=0.0) for item in x])
