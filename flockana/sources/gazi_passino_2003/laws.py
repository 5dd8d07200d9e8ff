"""Swarm of Gazi and Passino: first-order agents with linear attraction and Gaussian repulsion."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp, inf, sqrt
from typing import Any, ClassVar

import numpy as np

from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_positive, normalise
from flockana.interactions.distance_functions import DistanceFunction, InnerValues, LawFunction
from flockana.laws.first_order_law import VelocityLaw


@dataclass(frozen=True)
class GaussianRepulsion(DistanceFunction):
    """Repulsion b s exp(−s²/c) at the distance s, largest at √(c/2).

    Parameters
    ----------
    strength : float
        b > 0 (1/time, of a law of first order).
    c : float
        c > 0 (length²).
    """

    strength: float
    c: float

    range = inf
    proofs: ClassVar[Mapping[str, str]] = {"smooth": "s times an exponential of s² is analytic"}
    units: ClassVar[Mapping[str, Powers]] = {"strength": (0, -1), "c": (2, 0)}

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "strength", "c")

    @property
    def feature(self) -> float:
        """Distance of the largest repulsion."""
        return sqrt(0.5 * self.c)

    def inner(self, s2: FloatArray) -> InnerValues:  # noqa: D102
        with np.errstate(under="ignore"):
            push = self.strength * np.exp(-s2 / self.c)
        return -push, 0.0 * push, push / self.c, 0.0 * push


@dataclass(frozen=True)
class GaziPassino(VelocityLaw):
    """dq_i/dt = Σ_j (a − b exp(−‖q_j − q_i‖²/c)) (q_j − q_i): a law of first order.

    Two agents rest √(c ln(b/a)) apart if b > a.

    Parameters
    ----------
    attraction, repulsion : float
        a > 0 and b > 0 (1/time).
    c : float
        c > 0 (length²).

    Raises
    ------
    ArgumentError
        On a parameter that is not positive.

    Examples
    --------
    >>> law = GaziPassino(1.0, 20.0, 0.2)
    >>> round(law.radius, 6), law.velocity(0.0, np.array([[0.0], [10.0]])).tolist()
    (3.836037, [[10.0], [-10.0]])
    """

    attraction: float = 1.0
    repulsion: float = 20.0
    c: float = 0.2

    references: ClassVar[tuple[str, ...]] = ("gazi-passino-2003",)
    units: ClassVar[Mapping[str, Powers]] = {"attraction": (0, -1), "repulsion": (0, -1), "c": (2, 0)}

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "attraction", "repulsion", "c")

    @property
    def scales(self) -> Scales:
        """Scales of the law: length √(c/2), at which repulsion is largest, and time 1/a."""
        return Scales(sqrt(0.5 * self.c), 1.0 / self.attraction)

    @property
    def radius(self) -> float:
        """Ultimate bound (b/a) √(c/2) e^−½ of the distances from the centroid."""
        return self.repulsion / self.attraction * sqrt(0.5 * self.c) * exp(-0.5)

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Repulsion function; the attraction is linear."""
        return (LawFunction("the repulsion", GaussianRepulsion(self.repulsion, self.c), 1.0),)

    def _pulls(self, q: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return, for all pairs, q_j − q_i, its factor w = a − b exp(−s²/c), and the derivative of w by s²."""
        away = q[None] - q[:, None]
        push, _, weight_slope, _ = GaussianRepulsion(self.repulsion, self.c).inner(np.einsum("ijk,ijk->ij", away, away))
        return away, self.attraction + push, weight_slope

    def velocity(self, t: float, q: FloatArray) -> FloatArray:  # noqa: D102
        displacement, pull, _ = self._pulls(q)
        return np.asarray(np.einsum("ij,ijk->ik", pull, displacement))

    def slopes(self, t: float, q: FloatArray) -> Any:
        """Return the Jacobian of the velocities by positions, of blocks w 1 + 2 w' (q_j − q_i)(q_j − q_i)ᵀ."""
        from scipy.sparse import csr_array

        (n, m), (away, pull, bend) = q.shape, self._pulls(q)
        blocks = pull[:, :, None, None] * np.eye(m) + 2.0 * bend[:, :, None, None] * away[..., None] * away[:, :, None]
        agents = np.arange(n)
        blocks[agents, agents] = 0.0
        blocks[agents, agents] = -blocks.sum(axis=1)
        return csr_array(blocks.swapaxes(1, 2).reshape(n * m, n * m))
