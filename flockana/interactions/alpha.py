"""The α-pair law among agents."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.function_facts import Fact, PairFacts
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_positive, normalise
from flockana.interactions.distance_functions import SlopeBound
from flockana.interactions.pair_interaction import PairInteraction, Tabulated, ensure_lengths, evaluate, one_by_one
from flockana.kernels import alpha as kernel
from flockana.kernels.integral_tables import integral_panels, on_panels, panel_edges
from flockana.kernels.pair_kernels import lift, lift_scalar
from flockana.kernels.scalars import bump, phi, phi_integral, sigma_norm

_STRENGTH_GRID = 2049
_PROOFS = ("σ₁ is analytic, and ρ_h is C¹ with ρ_h(1) = ρ_h'(1) = 0", "ρ_h >= 0", "ρ_h(z) > 0 for z < 1")
MAX_ASYMMETRY = 1e12  # of repulsion over attraction: beyond it φ(0) = 0 is lost in rounding

_ADJACENCY_ALPHA = lift_scalar(kernel.adjacency_alpha)
_BUMP = lift_scalar(bump)
_PHI = lift_scalar(phi)
_PHI_ALPHA = lift_scalar(kernel.phi_alpha)
_PHI_ALPHA_SLOPE = lift_scalar(kernel.phi_alpha_slope)
_PSI_ALPHA = lift_scalar(kernel.psi_alpha)
_SIGMA_NORM = lift_scalar(sigma_norm)
_PARTS = kernel.stress_alpha, kernel.pair_alpha_slope, kernel.pair_alpha_potential, kernel.pair_alpha_adjacency_slope
_ALPHA = lift(*_PARTS, norm=kernel.norm_alpha)


def slopes_within(law: AlphaInteraction, r: float, parts: int) -> tuple[SlopeBound, ...]:
    """Return bounds of the slopes of force and adjacency by distance, for an α-pair law with bump end r.

    On each part z, φ and dz/ds rise, the bump and d²z/ds² fall, and φ′ and the bump's slope have one summit.
    """
    s = r * np.arange(parts + 1) / parts
    z, end, root = law.sigma_norm(s), float(law.sigma_norm(r)), np.sqrt(1.0 + law.eps * s * s)
    x, place = (z - law.d_alpha) / law.unit**2 + law.c, (z / end - law.h) / (1.0 - law.h)
    phi = np.abs(law.phi(z - law.d_alpha))
    maximum = np.maximum(phi[1:], phi[:-1])
    rise = 0.5 * (law.a + law.b) / law.unit**2 * (1.0 + np.clip(0.0, x[:-1], x[1:]) ** 2) ** -1.5
    fall = 0.5 * np.pi / (1.0 - law.h) / end * np.sin(np.pi * np.clip(0.5, *np.clip((place[:-1], place[1:]), 0.0, 1.0)))
    norm_slopes, bump = (s / root)[1:], law.bump(z[:-1] / end)
    force = bump * (rise * norm_slopes**2 + maximum / root[:-1] ** 3) + fall * maximum * norm_slopes**2
    rows = zip(s[:-1], s[1:], (1.0 + 1e-12) * force, (1.0 + 1e-12) * fall * norm_slopes, strict=True)
    return tuple(SlopeBound(*map(float, row)) for row in rows)


@dataclass(frozen=True)
class AlphaInteraction(Tabulated, PairInteraction):
    """The α-pair law of Olfati-Saber (2006): action φ_α, potential ψ_α, adjacency a_ij.

    Parameters
    ----------
    d : float
        Desired distance between neighbours, in the user's length unit.
    r : float
        Interaction range, r > d; the ratio is κ = r/d.
    eps : float
        ε > 0 of the σ-norm.
    h : float
        Where the bump ρ_h begins to fall, 0 < h < 1.
    a, b : float
        Strength of attraction and of repulsion, 0 < a ≤ b.
    unit : float
        ℓ > 0, the length that σ₁ counts in. The source's lengths are pure numbers, and its φ takes the square of a
        length for one: ℓ = 1 is the printed law, and with ℓ the same law in any length unit (`flockana.rescale`).

    Examples
    --------
    >>> alpha = AlphaInteraction(d=7.0, r=8.4)
    >>> round(alpha.c_star, 12), round(alpha.psi_alpha(alpha.r_alpha), 12)
    (52.383811786645, 0.735901134262)
    >>> alpha.phi_alpha(alpha.d_alpha)
    0.0
    """

    d: float = 7.0
    r: float = 8.4
    eps: float = 0.1
    h: float = 0.2
    a: float = 5.0
    b: float = 5.0
    unit: float = 1.0

    kernels = _ALPHA
    derived_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {
        "kernels": ("sigma_norm", "bump", "phi", "phi_alpha", "phi_alpha_slope", "psi_alpha", "adjacency", "c_star")
    }
    units: ClassVar[Mapping[str, Powers]] = {"d": (1, 0), "r": (1, 0), "eps": (-2, 0), "unit": (1, 0)}

    def __post_init__(self) -> None:
        ensure_lengths(self, "r = 1.2 d")
        normalise(self, ensure_positive, "a", "b")
        if self.a > self.b:
            raise ArgumentError(f"a = {self.a:g} and b = {self.b:g}: expected a <= b (attraction at most repulsion)")
        if self.b > MAX_ASYMMETRY * self.a:
            raise ArgumentError(f"a = {self.a:g} and b = {self.b:g}: expected b <= {MAX_ASYMMETRY:g} a")

    @cached_property
    def c(self) -> float:
        """Shift c = |a − b|/√(4ab), which makes φ(0) = 0."""
        return (self.b - self.a) / (2.0 * sqrt(self.a) * sqrt(self.b))

    @cached_property
    def d_alpha(self) -> float:
        """σ-norm ‖d‖_σ of the desired distance."""
        return float(sigma_norm(self.d * self.d, self.eps))

    @cached_property
    def r_alpha(self) -> float:
        """σ-norm ‖r‖_σ of the range."""
        return float(sigma_norm(self.r * self.r, self.eps))

    @cached_property
    def kappa(self) -> float:
        """Ratio κ = r/d of interaction range and desired distance."""
        return self.r / self.d

    @cached_property
    def c_star(self) -> float:
        """Energy of a coincident pair, ψ_α(0)."""
        return float(self.psi_alpha(0.0))

    @property
    def facts(self) -> PairFacts:
        """Facts proved of φ_α for all parameters."""
        if type(self) is not AlphaInteraction:
            return super().facts
        smooth_fact, weight, inside = (Fact("met", text) for text in _PROOFS)
        return PairFacts(smooth_fact, weight, inside, (0.0, 0.0), (self.c_star, self.c_star), (0.0, 0.0), (self.d,))

    @property
    def range(self) -> float:
        """The interaction range r."""
        return self.r

    @property
    def far_potential(self) -> float:
        """Far potential ψ_α(r_α) of a pair out of range."""
        return float(self.par[kernel.FAR])

    @property
    def length(self) -> float:
        """The desired distance d."""
        return self.d

    @property
    def bend_length(self) -> float:
        """Length ℓ of the bounded pull σ₁(x/ℓ) to a γ-agent."""
        return self.unit

    @property
    def feature(self) -> float:
        """Length of the narrowest feature of the pair force: the desired distance d."""
        return self.d

    def slopes(self, parts: int = 64) -> tuple[SlopeBound, ...]:
        """Return bounds of the slopes |dF/ds| of force and |da/ds| of adjacency on equal parts of the range.

        Parameters
        ----------
        parts : int
            How many.
        """
        return slopes_within(self, self.r, parts)

    @cached_property
    def strength(self) -> float:
        """Largest |φ_α(‖x‖_σ)| x/√(1 + εx²) up to r, within 1e-6."""
        distances = np.linspace(0.0, self.r, _STRENGTH_GRID)
        forces = self.phi_alpha(self.sigma_norm(distances)) * distances / np.sqrt(1.0 + self.eps * distances**2)
        return float(np.abs(forces).max())

    def _tabulate(self) -> tuple[FloatArray, FloatArray]:
        """Return kernel parameters, and Chebyshev panels of ψ_α with constants that make ψ_α(d_α) = 0."""
        d_alpha, r_alpha, knee, area = self.d_alpha, self.r_alpha, self.h * self.r_alpha, self.unit**2
        par = np.array([self.eps, self.h, self.a, self.b, self.c, d_alpha, r_alpha, 0.0, 0.0, area])
        action = one_by_one(kernel.phi_alpha, par)
        edges = area * panel_edges(knee / area, r_alpha / area, d_alpha / area - self.c)
        doublings = d_alpha * (1.0 + 2.0 ** np.arange(max(0.0, np.ceil(np.log2(r_alpha / d_alpha)))))
        marks = np.append(d_alpha, doublings)  # between them ψ grows by a few times only, from 0 and from at most c*
        edges = np.unique(np.concatenate([edges, marks[(marks > knee) & (marks < r_alpha)]]))
        knee_energy = area * phi_integral((knee - d_alpha) / area, self.a, self.b, self.c)
        if knee < d_alpha:  # d_α lies on the taper: ψ vanishes there, exactly
            panels = integral_panels(action, edges, anchor=d_alpha)
            panels[np.searchsorted(edges, d_alpha), 2] -= on_panels(d_alpha, panels)
            par[kernel.OFFSET] = on_panels(knee, panels) - knee_energy
        else:
            panels = integral_panels(action, edges, anchor=edges[0], value=knee_energy)
        par[kernel.FAR] = on_panels(r_alpha, panels)
        return par, panels

    def sigma_norm(self, x: Any) -> Any:
        """Return ‖x‖_σ = (√(1 + ε x²) − 1)/ε of a Euclidean length.

        Parameters
        ----------
        x : float or ndarray
            Euclidean lengths.
        """
        with np.errstate(over="ignore"):
            return evaluate(_SIGMA_NORM, np.square(np.asarray(x, dtype=np.float64)), self.eps)

    def bump(self, z: Any) -> Any:
        """Return the bump function ρ_h(z).

        Parameters
        ----------
        z : float or ndarray
            Arguments; 0 outside [0, 1].
        """
        return evaluate(_BUMP, z, self.h)

    def phi(self, s: Any) -> Any:
        """Return φ(s) = ½[(a+b) σ₁(s/ℓ² + c) + (a−b)].

        Parameters
        ----------
        s : float or ndarray
            Differences of σ-norms.
        """
        return evaluate(_PHI, np.asarray(s, dtype=np.float64) / self.unit**2, self.a, self.b, self.c)

    def phi_alpha(self, z: Any) -> Any:
        """Return φ_α(z) = ρ_h(z/r_α) φ(z − d_α); negative repels."""
        return evaluate(_PHI_ALPHA, z, self.par)

    def phi_alpha_slope(self, z: Any) -> Any:
        """Return dφ_α/dz, the stiffness of a link of σ-length z."""
        return evaluate(_PHI_ALPHA_SLOPE, z, self.par)

    def psi_alpha(self, z: Any) -> Any:
        """Return ψ_α(z) = ∫_{d_α}^{z} φ_α, with error 1e-13 c*, or rounding of the value where that is larger."""
        return evaluate(_PSI_ALPHA, z, self.par, self.panels)

    def adjacency(self, z: Any) -> Any:
        """Return a_ij as a function of the σ-norm z = ‖q_j − q_i‖_σ, as in the source."""
        return evaluate(_ADJACENCY_ALPHA, z, self.par)
