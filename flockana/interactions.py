"""Pair laws as frozen, validated parameters with their scalar functions, and what lifting gives each of them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property
from math import inf, sqrt
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from flockana.checks import FloatArray, ensure_finite_scalar, ensure_positive
from flockana.errors import ArgumentError
from flockana.kernels import alpha as kernel
from flockana.kernels.lift import PairKernels, lift, lift_scalar
from flockana.kernels.neighbours import pair_blocks
from flockana.kernels.scalars import bump, clenshaw, phi, phi_integral, sigma_norm
from flockana.kernels.tables import integral_panels, panel_edges

if TYPE_CHECKING:
    from scipy.sparse import csr_array

MAX_ASYMMETRY = 1e12  # of repulsion over attraction: beyond it φ(0) = 0 is lost in rounding

_SCALARS = {
    f.__name__: lift_scalar(f)
    for f in (
        bump,
        phi,
        sigma_norm,
        kernel.phi_alpha,
        kernel.psi_alpha,
        kernel.adjacency_alpha,
        kernel.phi_beta,
        kernel.psi_beta,
        kernel.adjacency_beta,
        kernel.phi_alpha_slope,
    )
}
_ALPHA = lift(kernel.pair_alpha, kernel.pair_alpha_slope, kernel.pair_alpha_potential)


@overload
def _evaluate(name: str, x: float, *parameters: Any) -> float: ...
@overload
def _evaluate(name: str, x: FloatArray, *parameters: Any) -> FloatArray: ...
def _evaluate(name: str, x: Any, *parameters: Any) -> Any:
    """Run a compiled scalar function over a scalar or an array of any shape."""
    values = np.asarray(x, dtype=np.float64)
    out = _SCALARS[name](values.ravel(), *parameters)
    return float(out[0]) if values.ndim == 0 else out.reshape(values.shape)


class PairInteraction(ABC):
    """What every pair law has once its scalar functions are given: sums over all pairs within its range.

    A subclass is a frozen dataclass that sets `range`, `kernels`, `par` and `panels`; pairs beyond the range have the
    constant potential `far_potential` and no force.
    """

    kernels: PairKernels

    @property
    @abstractmethod
    def range(self) -> float:
        """Euclidean distance from which on the pair force vanishes."""

    @property
    @abstractmethod
    def far_potential(self) -> float:
        """Potential of a pair beyond the range."""

    @property
    @abstractmethod
    def par(self) -> FloatArray:
        """Parameters in the order that the kernels read."""

    @property
    @abstractmethod
    def panels(self) -> FloatArray:
        """Chebyshev panels of the potential, or an empty (0, 0) array where it is in closed form."""

    def forces(self, q: FloatArray, p: FloatArray, *, stiffness: float, damping: float) -> tuple[FloatArray, float]:
        """Pair accelerations and their dissipation, unchecked (the integrators' inner loop).

        Parameters
        ----------
        q, p : ndarray, shape (n, m)
            Positions and velocities.
        stiffness, damping : float
            Gains c1 of the gradient term and c2 of the velocity-consensus term.

        Returns
        -------
        u : ndarray, shape (n, m)
            c1 Σ_j φ n_ij + c2 Σ_j a_ij (p_j − p_i).
        dissipation : float
            pᵀL̂p = ½ Σ over ordered pairs of a_ij ‖p_j − p_i‖².
        """
        u = np.zeros_like(q)
        dissipation = 0.0
        for i, j in pair_blocks(q, self.range):
            dissipation += self.kernels.forces(q, p, i, j, self.par, stiffness, damping, u)
        return u, dissipation

    def potential_energy(self, q: FloatArray) -> float:
        """V(q) = ½ Σ_i Σ_{j≠i} ψ: every pair once, those out of range included.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.
        """
        near, pairs = 0.0, 0
        for i, j in pair_blocks(q, self.range):
            near += self.kernels.potential(q, i, j, self.par, self.panels)
            pairs += i.size
        n = q.shape[0]
        return float(near + (n * (n - 1) // 2 - pairs) * self.far_potential)

    def hessian(self, q: FloatArray) -> csr_array:
        """∇²V(q), sparse and symmetric, in the order of ``q.ravel()``.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.

        Returns
        -------
        scipy.sparse.csr_array, shape (n m, n m)
        """
        return self._assemble(q, self._stiffness_blocks)

    def laplacian(self, q: FloatArray) -> csr_array:
        """L̂(q) = L ⊗ I_m with the weights a_ij, sparse, in the order of ``q.ravel()``.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.

        Returns
        -------
        scipy.sparse.csr_array, shape (n m, n m)
        """
        return self._assemble(q, lambda delta, terms: terms[1][:, None, None] * np.eye(delta.shape[1]))

    @staticmethod
    def _stiffness_blocks(delta: FloatArray, terms: FloatArray) -> FloatArray:
        # gradient of w(s²) Δ in Δ: w I + 2 w' ΔΔᵀ
        w, slope = terms[0][:, None, None], terms[2][:, None, None]
        blocks: FloatArray = w * np.eye(delta.shape[1]) + 2.0 * slope * delta[:, :, None] * delta[:, None, :]
        return blocks

    def _assemble(self, q: FloatArray, block_of: Any) -> csr_array:
        """Sum ±B over pairs: B on the two diagonal blocks, −B on the two others."""
        from scipy.sparse import coo_array

        n, m = q.shape
        axes = np.arange(m)
        rows, columns, values = [], [], []
        for i, j in pair_blocks(q, self.range):
            block = block_of(q[j] - q[i], self.kernels.terms(q, i, j, self.par))
            for a, b, sign in ((i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)):
                shape = (i.size, m, m)
                rows.append(np.broadcast_to((a[:, None] * m + axes)[:, :, None], shape).ravel())
                columns.append(np.broadcast_to((b[:, None] * m + axes)[:, None, :], shape).ravel())
                values.append((sign * block).ravel())
        entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
        return coo_array(entries, shape=(n * m, n * m)).tocsr()


@dataclass(frozen=True)
class AlphaInteraction(PairInteraction):
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

    Attributes
    ----------
    c : float
        |a − b|/√(4ab), which makes φ(0) = 0.
    d_alpha, r_alpha : float
        σ-norms of d and r.
    kappa : float
        r/d.
    c_star : float
        ψ_α(0), the energy of a coincident pair.

    Raises
    ------
    ArgumentError
        If a parameter is outside the range above.

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

    kernels = _ALPHA

    def __post_init__(self) -> None:
        for name in ("d", "r", "eps", "a", "b"):
            object.__setattr__(self, name, ensure_positive(name, getattr(self, name)))
        object.__setattr__(self, "h", _ensure_bump_start(self.h))
        if self.r <= self.d:
            raise ArgumentError(f"r = {self.r:g} and d = {self.d:g}: expected r > d; the paper takes r = 1.2 d")
        if self.a > self.b:
            raise ArgumentError(f"a = {self.a:g} and b = {self.b:g}: expected a <= b (attraction at most repulsion)")
        if self.b > MAX_ASYMMETRY * self.a:
            raise ArgumentError(f"a = {self.a:g} and b = {self.b:g}: expected b <= {MAX_ASYMMETRY:g} a")
        _ensure_resolved(self)

    @cached_property
    def c(self) -> float:
        """|a − b|/√(4ab)."""
        return (self.b - self.a) / (2.0 * sqrt(self.a) * sqrt(self.b))

    @cached_property
    def d_alpha(self) -> float:
        """‖d‖_σ."""
        return float(sigma_norm(self.d * self.d, self.eps))

    @cached_property
    def r_alpha(self) -> float:
        """‖r‖_σ."""
        return float(sigma_norm(self.r * self.r, self.eps))

    @cached_property
    def kappa(self) -> float:
        """Ratio r/d."""
        return self.r / self.d

    @cached_property
    def c_star(self) -> float:
        """ψ_α(0)."""
        return float(self.psi_alpha(0.0))

    @property
    def range(self) -> float:
        """The interaction range r."""
        return self.r

    @property
    def far_potential(self) -> float:
        """ψ_α(r_α)."""
        return float(self.par[8])

    @cached_property
    def _parts(self) -> tuple[FloatArray, FloatArray]:
        """(par, panels): ψ_α(d_α) = 0 fixes the constants of the closed piece and of the taper."""
        d_alpha, r_alpha, knee = self.d_alpha, self.r_alpha, self.h * self.r_alpha
        par = np.array([self.eps, self.h, self.a, self.b, self.c, d_alpha, r_alpha, 0.0, 0.0])

        def taper(z: FloatArray) -> FloatArray:
            rho = 0.5 * (1.0 + np.cos(np.pi * (z / r_alpha - self.h) / (1.0 - self.h)))
            action = np.array([phi(s, self.a, self.b, self.c) for s in z - d_alpha])
            tapered: FloatArray = rho * action
            return tapered

        edges = panel_edges(knee, r_alpha, d_alpha - self.c)
        if knee < d_alpha:  # d_α lies on the taper: make it an edge, where ψ vanishes exactly
            edges = np.unique(np.append(edges, d_alpha))
        panels = integral_panels(taper, edges, value_at_right=0.0)
        at_knee = phi_integral(knee - d_alpha, self.a, self.b, self.c)
        left_end = clenshaw(knee, panels)
        if knee < d_alpha:
            shift = -clenshaw(d_alpha, panels)
            par[7] = left_end + shift - at_knee
        else:
            shift = at_knee - left_end
        panels[:, 2] += shift
        par[8] = shift
        for array in (par, panels):
            array.setflags(write=False)
        return par, panels

    @property
    def par(self) -> FloatArray:
        """(ε, h, a, b, c, d_α, r_α, constant of ψ_α where ρ_h = 1, ψ_α(r_α))."""
        return self._parts[0]

    @property
    def panels(self) -> FloatArray:
        """Chebyshev panels of ψ_α on [h r_α, r_α]."""
        return self._parts[1]

    def sigma_norm(self, x: Any) -> Any:
        """‖x‖_σ = (√(1 + ε x²) − 1)/ε of a Euclidean length.

        Parameters
        ----------
        x : float or ndarray
            Euclidean lengths.
        """
        with np.errstate(over="ignore"):
            return _evaluate("sigma_norm", np.square(np.asarray(x, dtype=np.float64)), self.eps)

    def bump(self, z: Any) -> Any:
        """ρ_h(z).

        Parameters
        ----------
        z : float or ndarray
            Arguments; 0 outside [0, 1].
        """
        return _evaluate("bump", z, self.h)

    def phi(self, s: Any) -> Any:
        """φ(s) = ½[(a+b) σ₁(s+c) + (a−b)].

        Parameters
        ----------
        s : float or ndarray
            Differences of σ-norms.
        """
        return _evaluate("phi", s, self.a, self.b, self.c)

    def phi_alpha(self, z: Any) -> Any:
        """φ_α(z) = ρ_h(z/r_α) φ(z − d_α): negative repels.

        Parameters
        ----------
        z : float or ndarray
            σ-norms.
        """
        return _evaluate("phi_alpha", z, self.par)

    def phi_alpha_slope(self, z: Any) -> Any:
        """dφ_α/dz, the stiffness of a link at its length.

        Parameters
        ----------
        z : float or ndarray
            σ-norms.
        """
        return _evaluate("phi_alpha_slope", z, self.par)

    def psi_alpha(self, z: Any) -> Any:
        """ψ_α(z) = ∫_{d_α}^{z} φ_α, to 1e-13 c* absolute.

        Parameters
        ----------
        z : float or ndarray
            σ-norms.
        """
        return _evaluate("psi_alpha", z, self.par, self.panels)

    def adjacency(self, z: Any) -> Any:
        """a_ij as a function of z = ‖q_j − q_i‖_σ.

        Parameters
        ----------
        z : float or ndarray
            σ-norms.
        """
        return _evaluate("adjacency_alpha", z, self.par)


@dataclass(frozen=True)
class BetaInteraction:
    """The repulsion between an agent and the β-agent of an obstacle (Olfati-Saber 2006).

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

    Attributes
    ----------
    d_beta, r_beta : float
        σ-norms of d and r.

    Raises
    ------
    ArgumentError
        If a parameter is outside the range above.

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

    def __post_init__(self) -> None:
        for name in ("d", "r", "eps"):
            object.__setattr__(self, name, ensure_positive(name, getattr(self, name)))
        object.__setattr__(self, "h", _ensure_bump_start(self.h))
        if self.r <= self.d:
            raise ArgumentError(f"r = {self.r:g} and d = {self.d:g}: expected r > d; the paper takes r' = 1.2 d'")
        _ensure_resolved(self)

    @cached_property
    def d_beta(self) -> float:
        """‖d'‖_σ."""
        return float(sigma_norm(self.d * self.d, self.eps))

    @cached_property
    def r_beta(self) -> float:
        """‖r'‖_σ."""
        return float(sigma_norm(self.r * self.r, self.eps))

    @cached_property
    def _parts(self) -> tuple[FloatArray, FloatArray]:
        d_beta, knee = self.d_beta, self.h * self.d_beta
        par = np.array([self.eps, self.h, d_beta, 0.0])

        def taper(z: FloatArray) -> FloatArray:
            rho = 0.5 * (1.0 + np.cos(np.pi * (z / d_beta - self.h) / (1.0 - self.h)))
            return rho * ((z - d_beta) / np.sqrt(1.0 + (z - d_beta) ** 2) - 1.0)

        panels = integral_panels(taper, panel_edges(knee, d_beta, d_beta), value_at_right=0.0)
        par[3] = clenshaw(knee, panels) - (sigma_norm((knee - d_beta) ** 2, 1.0) - knee)
        for array in (par, panels):
            array.setflags(write=False)
        return par, panels

    @property
    def par(self) -> FloatArray:
        """(ε, h, d_β, constant of ψ_β where ρ_h = 1)."""
        return self._parts[0]

    @property
    def panels(self) -> FloatArray:
        """Chebyshev panels of ψ_β on [h d_β, d_β]."""
        return self._parts[1]

    def phi_beta(self, z: Any) -> Any:
        """φ_β(z) = ρ_h(z/d_β)(σ₁(z − d_β) − 1) ≤ 0.

        Parameters
        ----------
        z : float or ndarray
            σ-norms.
        """
        return _evaluate("phi_beta", z, self.par)

    def psi_beta(self, z: Any) -> Any:
        """ψ_β(z) = ∫_{d_β}^{z} φ_β ≥ 0.

        Parameters
        ----------
        z : float or ndarray
            σ-norms.
        """
        return _evaluate("psi_beta", z, self.par, self.panels)

    def adjacency(self, z: Any) -> Any:
        """b_ik as a function of z = ‖q̂_ik − q_i‖_σ.

        Parameters
        ----------
        z : float or ndarray
            σ-norms.
        """
        return _evaluate("adjacency_beta", z, self.par)


@dataclass(frozen=True)
class Gains:
    """Gains of the α-, β- and γ-terms: c1 of positions, c2 of velocities, all >= 0.

    The paper prints none; the defaults keep c1γ small beside c1α, because a strong γ-agent squeezes the flock until
    agents coincide (erratum E11).

    Parameters
    ----------
    c1_alpha, c2_alpha : float
        Gradient and velocity consensus among agents.
    c1_beta, c2_beta : float
        Repulsion and damping at obstacles.
    c1_gamma, c2_gamma : float
        Navigational feedback to the γ-agent.

    Examples
    --------
    >>> Gains(c1_alpha=1.0).c1_alpha
    1.0
    """

    c1_alpha: float = 30.0
    c2_alpha: float = 2.0 * sqrt(30.0)
    c1_beta: float = 1500.0
    c2_beta: float = 2.0 * sqrt(1500.0)
    c1_gamma: float = 1.1
    c2_gamma: float = 2.0 * sqrt(1.1)

    def __post_init__(self) -> None:
        for name in self.__dataclass_fields__:
            value = ensure_finite_scalar(name, getattr(self, name))
            if value < 0.0:
                raise ArgumentError(f"{name} = {value:g}: expected a gain >= 0; a negative one feeds energy in")
            object.__setattr__(self, name, value)


def _ensure_resolved(interaction: AlphaInteraction | BetaInteraction) -> None:
    """Raise where the parameters are so extreme that d and r have no σ-norms apart from 0, ∞ and each other."""
    d, r, eps = interaction.d, interaction.r, interaction.eps
    near, far = sigma_norm(d * d, eps), sigma_norm(r * r, eps)
    if not (0.0 < near < far < inf and eps * r * r < inf):
        raise ArgumentError(
            f"d = {d:g}, r = {r:g}, eps = {eps:g}: their σ-norms are {near:g} and {far:g}; "
            "expected 0 < d_sigma < r_sigma, all finite: choose another length unit"
        )


def _ensure_bump_start(h: Any) -> float:
    start = ensure_finite_scalar("h", h)
    if not 0.0 < start < 1.0:
        raise ArgumentError(f"h = {start:g}: expected 0 < h < 1; at h = 1 the bump jumps (erratum E10)")
    return start
