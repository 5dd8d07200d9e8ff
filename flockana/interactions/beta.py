"""Repulsion between an agent and the β-agent of an obstacle."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray
from flockana.interactions.pair_interaction import Tabulated, ensure_lengths, evaluate, one_by_one
from flockana.kernels import alpha as kernel
from flockana.kernels.integral_tables import integral_panels, on_panels, panel_edges
from flockana.kernels.pair_kernels import lift_scalar
from flockana.kernels.scalars import sigma_norm

_ADJACENCY_BETA = lift_scalar(kernel.adjacency_beta)
_PHI_BETA = lift_scalar(kernel.phi_beta)
_PSI_BETA = lift_scalar(kernel.psi_beta)


@dataclass(frozen=True)
class BetaInteraction(Tabulated):
    """Repulsion between an agent and the β-agent of an obstacle (Olfati-Saber 2006).

    Parameters
    ----------
    d : float
        Desired clearance d' from obstacles, in the user's length unit.
    r : float
        Range r' > d' of the neighbour query; the force ends at d' already.
    eps : float
        ε > 0 of the σ-norm.
    h : float
        Where the bump begins to fall, 0 < h < 1.
    unit : float
        ℓ > 0, the length that σ₁ counts in; 1 as printed (see `AlphaInteraction`).

    Examples
    --------
    >>> beta = BetaInteraction(d=4.2, r=5.04)
    >>> beta.phi_beta(beta.d_beta) == 0.0, beta.psi_beta(beta.d_beta)
    (True, 0.0)
    """

    d: float = 4.2
    r: float = 5.04
    eps: float = 0.1
    h: float = 0.9
    unit: float = 1.0

    derived_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {"par": ("phi_beta", "psi_beta", "adjacency")}
    units: ClassVar[Mapping[str, Powers]] = {"d": (1, 0), "r": (1, 0), "eps": (-2, 0), "unit": (1, 0)}

    def __post_init__(self) -> None:
        ensure_lengths(self, "r' = 1.2 d'")

    @cached_property
    def d_beta(self) -> float:
        """σ-norm ‖d'‖_σ of the clearance."""
        return float(sigma_norm(self.d * self.d, self.eps))

    @cached_property
    def r_beta(self) -> float:
        """σ-norm ‖r'‖_σ of the range."""
        return float(sigma_norm(self.r * self.r, self.eps))

    def _tabulate(self) -> tuple[FloatArray, FloatArray]:
        d_beta, knee, area = self.d_beta, self.h * self.d_beta, self.unit**2
        par = np.array([self.eps, self.h, d_beta, 0.0, area])
        edges = area * panel_edges(knee / area, d_beta / area, d_beta / area)
        panels = integral_panels(one_by_one(kernel.phi_beta, par), edges, anchor=edges[-1])
        par[kernel.BETA_OFFSET] = on_panels(knee, panels) - kernel.integral_beta(knee, par.tolist())
        return par, panels

    def phi_beta(self, z: Any) -> Any:
        """Return φ_β(z) = ρ_h(z/d_β)(σ₁((z − d_β)/ℓ²) − 1) ≤ 0."""
        return evaluate(_PHI_BETA, z, self.par)

    def psi_beta(self, z: Any) -> Any:
        """Return ψ_β(z) = ∫_{d_β}^{z} φ_β ≥ 0."""
        return evaluate(_PSI_BETA, z, self.par, self.panels)

    def adjacency(self, z: Any) -> Any:
        """Return the weight b_ik as a function of z = ‖q̂_ik − q_i‖_σ."""
        return evaluate(_ADJACENCY_BETA, z, self.par)
