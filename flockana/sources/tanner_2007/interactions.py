"""Potential of Tanner, Jadbabaie and Pappas: infinite at contact, least at d, defined at every distance."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp, expm1, inf
from typing import Any, ClassVar

import numpy as np

from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_positive, normalise
from flockana.interactions.distance_functions import DistanceFunction, InnerValues
from flockana.interactions.pair_interaction import pair_matrix


@dataclass(frozen=True)
class LogPotential(DistanceFunction):
    """Potential V(s) = k (d²/s² − 1 + log(s²/d²)) >= 0, zero only at s = d and infinite at s = 0.

    Parameters
    ----------
    strength : float
        k > 0 (length²/time²).
    d : float
        d > 0, the distance at which it is least.

    Examples
    --------
    >>> potential = LogPotential(2.0, 3.0)
    >>> potential.energy(3.0), potential.force(3.0) == 0.0
    (0.0, True)
    """

    strength: float = 1.0
    d: float = 1.0

    units: ClassVar[Mapping[str, Powers]] = {"strength": (2, -2), "d": (1, 0)}
    proofs: ClassVar[Mapping[str, str]] = {"smooth": "V is analytic at s > 0"} | dict.fromkeys(
        ("weight", "inside"), "the adjacency is 1"
    )

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "strength", "d")

    @property
    def range(self) -> float:
        """Infinite range, as the potential is defined at every distance."""
        return inf

    @property
    def feature(self) -> float:
        """Length d of repulsion; the attraction beyond has no end."""
        return self.d

    def energy(self, s: Any) -> Any:
        """Return the potential V at given distances > 0."""
        x = self.d**2 / np.square(np.asarray(s, dtype=np.float64))
        values = self.strength * (x - 1.0 - np.log(x))
        return float(values) if np.ndim(s) == 0 else values

    def inner(self, s2: FloatArray) -> InnerValues:
        """Return V′(s)/s and the adjacency 1 of a pair, and the derivatives of each by squared distance.

        Parameters
        ----------
        s2 : ndarray, shape (L,)
            Squared distances > 0.
        """
        rest, one = self.d**2 / s2, np.ones_like(s2)
        return 2.0 * self.strength * (1.0 - rest) / s2, one, 2.0 * self.strength * (2.0 * rest - 1.0) / s2**2, 0.0 * one

    def nearest(self, energy: float) -> float:
        """Return the distance below d at which the potential V has a given value.

        Parameters
        ----------
        energy : float
            >= 0.

        Examples
        --------
        >>> potential = LogPotential(2.0, 3.0)
        >>> round(potential.nearest(potential.energy(1.0)), 12)
        1.0
        >>> round((3.0 - potential.nearest(4e-18)) / 3.0, 15)  # V is about 2 k (s/d - 1)² there
        1e-09
        """
        from scipy.optimize import brentq

        level = energy / self.strength
        if not 0.0 < level < inf:
            return self.d if level <= 0.0 else 0.0
        top = max(2.0 * level + 8.0, 8.0)  # x − 1 − log x >= x/2 − 1 >= level there
        w = float(brentq(lambda w: _height(w) - level, 0.0, np.log(top), xtol=1e-300, rtol=1e-14))
        return self.d * exp(-0.5 * w)


def _height(w: float) -> float:
    """Return e^w − 1 − w for w >= 0, accurate to a few roundings."""
    return 0.5 * w * w * (1.0 + w / 3.0 * (1.0 + w / 4.0)) if w < 1e-4 else expm1(w) - w


def net_forces(
    potential: LogPotential, damping: float, q: FloatArray, p: FloatArray, i: Any, j: Any, u: FloatArray
) -> float:
    """Add the forces along given edges to u, unchecked, and return their power −k₂ Σ ‖p_j − p_i‖²."""
    delta, velocity_difference = q[j] - q[i], p[j] - p[i]
    pull = potential.inner(np.einsum("kc,kc->k", delta, delta))[0][:, None] * delta + damping * velocity_difference
    np.add.at(u, i, pull)
    np.subtract.at(u, j, pull)
    return -damping * float(np.sum(velocity_difference * velocity_difference))


def net_derivatives(potential: LogPotential, damping: float, q: FloatArray, i: Any, j: Any) -> tuple[Any, Any]:
    """Return (∂u/∂q, ∂u/∂p) of the forces along given edges, sparse."""
    (n, m), delta = q.shape, q[j] - q[i]
    stress, _, slope, _ = potential.inner(np.einsum("kc,kc->k", delta, delta))
    slope_terms = 2.0 * slope[:, None, None] * delta[:, :, None] * delta[:, None, :]
    stiffness_terms = stress[:, None, None] * np.eye(m) + slope_terms
    drag = np.broadcast_to(damping * np.eye(m), stiffness_terms.shape)
    return -pair_matrix(i, j, stiffness_terms, n), -pair_matrix(i, j, drag, n)
