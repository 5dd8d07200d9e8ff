"""Potential of Tanner, Jadbabaie and Pappas: infinite at contact, least at d, defined at every distance."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import exp, expm1, inf
from typing import Any, ClassVar

import numpy as np

from flockana.base.checks import FloatArray, ensure_positive, normalise
from flockana.base.units import Powers
from flockana.interactions.pair import pair_matrix


@dataclass(frozen=True)
class LogPotential:
    """Potential V(s) = k (d²/s² − 1 + log(s²/d²)) >= 0, zero at s = d alone and infinite at s = 0.

    Parameters
    ----------
    strength : float
        k > 0 (length²/time²).
    d : float
        d > 0, the distance at which it is least.

    Examples
    --------
    >>> potential = LogPotential(2.0, 3.0)
    >>> float(potential.energy(9.0)), float(potential.weight(9.0))
    (0.0, 0.0)
    """

    strength: float = 1.0
    d: float = 1.0

    units: ClassVar[Mapping[str, Powers]] = {"strength": (2, -2), "d": (1, 0)}

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "strength", "d")

    def energy(self, s2: Any) -> Any:
        """Return V at a squared distance.

        Parameters
        ----------
        s2 : float or ndarray
            Squared distances > 0.
        """
        x = self.d**2 / np.asarray(s2)
        return self.strength * (x - 1.0 - np.log(x))

    def weight(self, s2: Any) -> Any:
        """Return V′(s)/s at a squared distance: agent i is pulled by this times q_j − q_i.

        Parameters
        ----------
        s2 : float or ndarray
            Squared distances > 0.
        """
        return 2.0 * self.strength * (1.0 - self.d**2 / s2) / s2

    def weight_slope(self, s2: Any) -> Any:
        """Return the derivative of `weight` by the squared distance.

        Parameters
        ----------
        s2 : float or ndarray
            Squared distances > 0.
        """
        return 2.0 * self.strength * (2.0 * self.d**2 / s2 - 1.0) / s2**2

    def nearest(self, energy: float) -> float:
        """Return the distance below d at which V has this value.

        Parameters
        ----------
        energy : float
            >= 0.

        Examples
        --------
        >>> potential = LogPotential(2.0, 3.0)
        >>> round(potential.nearest(float(potential.energy(1.0))), 12)
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
    delta, slip = q[j] - q[i], p[j] - p[i]
    pull = potential.weight(np.einsum("kc,kc->k", delta, delta))[:, None] * delta + damping * slip
    np.add.at(u, i, pull)
    np.subtract.at(u, j, pull)
    return -damping * float(np.sum(slip * slip))


def net_derivatives(potential: LogPotential, damping: float, q: FloatArray, i: Any, j: Any) -> tuple[Any, Any]:
    """Return (∂u/∂q, ∂u/∂p) of the forces along given edges, sparse."""
    (n, m), delta = q.shape, q[j] - q[i]
    s2 = np.einsum("kc,kc->k", delta, delta)
    bend = 2.0 * potential.weight_slope(s2)[:, None, None] * delta[:, :, None] * delta[:, None, :]
    stiff = potential.weight(s2)[:, None, None] * np.eye(m) + bend
    drag = np.broadcast_to(damping * np.eye(m), stiff.shape)
    return -pair_matrix(i, j, stiff, n), -pair_matrix(i, j, drag, n)
