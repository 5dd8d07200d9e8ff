"""The law: velocities are averaged with weights that fall with distance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from flockana import Law
from flockana.base.value_checks import FloatArray, ensure_positive


@dataclass(frozen=True)
class CuckerSmale(Law):
    """u_i = Σ_j a_ij (p_j − p_i) with a_ij = (g/n) (1 + ‖q_j − q_i‖²)^−β   (Cucker and Smale 2007).

    Parameters
    ----------
    strength : float
        g > 0, per unit of time.
    decay : float
        β > 0.
    """

    strength: float = 1.0
    decay: float = 0.4

    def __post_init__(self) -> None:
        for name in ("strength", "decay"):
            object.__setattr__(self, name, ensure_positive(name, getattr(self, name)))

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """(u, dK/dt) with dK/dt = −½ Σ_i Σ_j a_ij ‖p_j − p_i‖²."""
        s2 = np.sum((q[None] - q[:, None]) ** 2, axis=2)
        a = self.strength / len(q) * (1.0 + s2) ** -self.decay
        slip = p[None] - p[:, None]
        return np.einsum("ij,ijk->ik", a, slip), -0.5 * float(np.sum(a * np.sum(slip**2, axis=2)))

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:
        """K = ½ Σ ‖p_i − p_c‖², the velocity mismatch."""
        return 0.5 * float(np.sum((p - p.mean(axis=0)) ** 2))
