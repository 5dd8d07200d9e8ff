"""Algorithms 1 and 2 of Olfati-Saber (2006), in one, two and three dimensions."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from flockana.base.checks import FloatArray, ensure_points, ensure_state
from flockana.base.errors import ArgumentError
from flockana.base.scales import Scales
from flockana.environment.targets import Target
from flockana.interactions import AlphaInteraction, Gains
from flockana.interactions.gains import weighted
from flockana.laws.law import Law, block_diagonal

if TYPE_CHECKING:
    from scipy.sparse import csr_array, sparray


def _ensure(name: str, value: Any, cls: type) -> None:
    if not isinstance(value, cls):
        raise ArgumentError(f"{name} = {value!r}: expected {cls.__name__}(...)")


def ensure_one_gain(gains: Gains) -> None:
    """Raise on per-agent gains, for what needs the split into a shape and a centre of mass.

    Parameters
    ----------
    gains : Gains
        Gains of Algorithm 2.

    Raises
    ------
    ArgumentError
        If c1γ or c2γ is given agent by agent.

    Examples
    --------
    >>> ensure_one_gain(Gains())
    """
    if gains.per_agent:
        raise ArgumentError(
            "c1_gamma or c2_gamma is given per agent: expected one of each, or the shape does not separate from the "
            "centre of mass; find_equilibrium and the stability functions take both kinds"
        )


def alpha_scales(alpha: AlphaInteraction, gains: Gains) -> Scales:
    """d, and the time in which the law's leading term moves an agent by d: of c1α, or else of c1γ, c2α or c2γ.

    Parameters
    ----------
    alpha : AlphaInteraction
        The pair law.
    gains : Gains
        Gains of Algorithm 1, 2 or 3.

    Examples
    --------
    >>> alpha_scales(AlphaInteraction(d=4.0, r=5.0), Gains(c1_alpha=0.0, c1_gamma=0.25))
    Scales(length=4.0, time=2.0)
    """
    rates = (
        np.sqrt(gains.c1_alpha * alpha.strength / alpha.d),
        np.sqrt(np.max(gains.c1_gamma)),
        gains.c2_alpha,
        np.max(gains.c2_gamma),
    )
    return Scales(alpha.d, 1.0 / float(next((rate for rate in rates if rate > 0.0), 1.0)))


def moving_frame(x: FloatArray) -> FloatArray:
    """Deviations from the mean over agents, x_i − x_c.

    Parameters
    ----------
    x : ndarray, shape (n, m)
        Positions or velocities.
    """
    deviations: FloatArray = x - x.mean(axis=0)
    return deviations


@dataclass(frozen=True)
class Algorithm1(Law):
    """u_i = c1α Σ_j φ_α(‖q_j−q_i‖_σ) n_ij + c2α Σ_j a_ij (p_j − p_i)   (Olfati-Saber 2006, eq. (23), (24)).

    Parameters
    ----------
    alpha : AlphaInteraction
        The pair law.
    gains : Gains
        Only c1_alpha and c2_alpha are used.

    Examples
    --------
    Two agents farther apart than d attract each other:

    >>> law = Algorithm1()
    >>> u = law.acceleration(0.0, [[0.0, 0.0], [8.0, 0.0]], [[0.0, 0.0], [0.0, 0.0]])
    >>> bool(u[0, 0] > 0.0), float(u.sum())
    (True, 0.0)
    """

    alpha: AlphaInteraction = field(default_factory=AlphaInteraction)
    gains: Gains = field(default_factory=Gains)

    references: ClassVar[tuple[str, ...]] = ("olfati-saber-2006",)

    def __post_init__(self) -> None:
        _ensure("alpha", self.alpha, AlphaInteraction)
        _ensure("gains", self.gains, Gains)

    @property
    def scales(self) -> Scales:  # noqa: D102
        return alpha_scales(self.alpha, replace(self.gains, c1_gamma=0.0, c2_gamma=0.0))

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """(u, dH/dt) with dH/dt = −c2α pᵀL̂p, unchecked.

        Parameters
        ----------
        t : float
            Time (the law does not depend on it).
        q, p : ndarray, shape (n, m)
            Positions and velocities.
        """
        c1, c2 = self.gains.c1_alpha, self.gains.c2_alpha
        u, dissipation = self.alpha.forces(q, p, stiffness=c1, damping=c2)
        return u, -c2 * dissipation

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:
        """H(q, p) = c1α V(q) + ½ Σ‖p_i‖² in the given frame (with the ½ that the slides omit: E1), unchecked.

        Parameters
        ----------
        t : float
            Time (H does not depend on it).
        q, p : ndarray, shape (n, m)
            Positions and velocities.
        """
        return self.gains.c1_alpha * self.alpha.potential_energy(q) + 0.5 * float(np.sum(p * p))

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[csr_array, csr_array]:
        """(∂u/∂q, ∂u/∂p) = (−c1α ∇²V + c2α Σ_j (p_j − p_i) ∂a_ij/∂q, −c2α L̂), sparse, unchecked.

        Parameters
        ----------
        t : float
            Time (the law does not depend on it).
        q, p : ndarray, shape (n, m)
            Positions and velocities.
        """
        return self.alpha.jacobian(q, p, stiffness=self.gains.c1_alpha, damping=self.gains.c2_alpha)

    def structural_energy(self, q: Any, p: Any) -> float:
        """H(x, v) = c1α V(x) + K(v), the energy in the frame that moves with the centre of mass.

        Parameters
        ----------
        q, p : array_like, shape (n, m)
            Positions and velocities in any frame.
        """
        q, p = ensure_state(q, p)
        return self.hamiltonian(0.0, q, moving_frame(p))

    def stiffness(self, q: Any) -> csr_array:
        """Hessian of the structural potential, c1α ∇²V (order of ``q.ravel()``), sparse.

        Parameters
        ----------
        q : array_like, shape (n, m)
            Positions.
        """
        hessian: csr_array = self.gains.c1_alpha * self.alpha.hessian(ensure_points("q", q))
        return hessian


@dataclass(frozen=True)
class Algorithm2(Law):
    """Algorithm 1 − c1γ (q_i − q_r) − c2γ (p_i − p_r): flocking with a γ-agent   (Olfati-Saber 2006, eq. (25), (26)).

    Parameters
    ----------
    alpha : AlphaInteraction
        The pair law.
    gains : Gains
        c1 and c2 of α and γ are used.
    target : Target
        The γ-agent.

    Raises
    ------
    ArgumentError
        If no target is given.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> law = Algorithm2(gains=Gains(c1_gamma=1.0), target=StaticTarget((10.0, 0.0)))
    >>> law.acceleration(0.0, [[0.0, 0.0]], [[0.0, 0.0]]).tolist()
    [[10.0, 0.0]]
    """

    alpha: AlphaInteraction = field(default_factory=AlphaInteraction)
    gains: Gains = field(default_factory=Gains)
    target: Target = None  # type: ignore[assignment]  # no default makes sense: checked below

    references: ClassVar[tuple[str, ...]] = ("olfati-saber-2006",)

    def __post_init__(self) -> None:
        _ensure("alpha", self.alpha, AlphaInteraction)
        _ensure("gains", self.gains, Gains)
        if not isinstance(self.target, Target):
            raise ArgumentError(f"target = {self.target!r}: expected a γ-agent such as StaticTarget((0.0, 0.0))")

    @property
    def scales(self) -> Scales:  # noqa: D102
        return alpha_scales(self.alpha, self.gains)

    def check_dimension(self, m: int) -> None:
        """Raise unless the γ-agent lives in m dimensions.

        Parameters
        ----------
        m : int
            Dimension of the flock.
        """
        if self.target.dimension != m:
            raise ArgumentError(
                f"the target has {self.target.dimension} components but the agents have {m}: expected equal dimensions"
            )

    def check_agents(self, n: int) -> None:
        """Raise unless per-agent gains are as many as the agents.

        Parameters
        ----------
        n : int
            Number of agents.
        """
        self.gains.check_agents(n)

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """(u, dH_λ/dt) with dH_λ/dt = −c2γ‖v‖² − c2α vᵀL̂v, unchecked.

        With per-agent gains (u, dH/dt), dH/dt = −c2α pᵀL̂p − Σ c2γ_i ⟨p_i, p_i − p_r⟩ − Σ c1γ_i ⟨q_i − q_r, dq_r/dt⟩.

        Parameters
        ----------
        t : float
            Time.
        q, p : ndarray, shape (n, m)
            Positions and velocities.
        """
        g = self.gains
        u, dissipation = self.alpha.forces(q, p, stiffness=g.c1_alpha, damping=g.c2_alpha)
        q_r, p_r = self.target.state(t)
        pull, slip = g.pull * (q - q_r), p - p_r
        u -= pull + g.drag * slip
        if g.per_agent:
            power = float(np.vdot(g.drag * p, slip)) + float(pull.sum(axis=0) @ self.target.rate(t))
            return u, -g.c2_alpha * dissipation - power
        v = moving_frame(p)
        return u, -g.c2_gamma * float(np.sum(v * v)) - g.c2_alpha * dissipation  # L̂ ignores the common velocity

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:
        """H_λ(x, v) = c1α V(x) + c1γ J(x) + K(v) in the moving frame, for every target, unchecked.

        With per-agent gains the flock's shape does not separate from its centre, and no frame but the given one will
        do for every target: H(t, q, p) = c1α V(q) + ½ Σ c1γ_i ‖q_i − q_r‖² + ½ Σ‖p_i‖², as under Algorithm 3.

        Parameters
        ----------
        t : float
            Time (H_λ does not depend on it).
        q, p : ndarray, shape (n, m)
            Positions and velocities in any frame.
        """
        if self.gains.per_agent:
            off = q - self.target.state(t)[0]
            attraction = weighted(self.gains.c1_gamma, 0.5 * np.einsum("ij,ij->i", off, off))
            potential = self.gains.c1_alpha * self.alpha.potential_energy(q) + attraction
            return float(potential + 0.5 * float(np.sum(p * p)))
        x, v = moving_frame(q), moving_frame(p)
        inertia, kinetic = 0.5 * float(np.sum(x * x)), 0.5 * float(np.sum(v * v))
        return float(self.gains.c1_alpha * self.alpha.potential_energy(q) + self.gains.c1_gamma * inertia + kinetic)

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[sparray, sparray]:
        """(∂u/∂q, ∂u/∂p): those of Algorithm 1 less diag(c1γ) and diag(c2γ), sparse, unchecked.

        Parameters
        ----------
        t : float
            Time (they do not depend on it).
        q, p : ndarray, shape (n, m)
            Positions and velocities.
        """
        pairs = self.alpha.jacobian(q, p, stiffness=self.gains.c1_alpha, damping=self.gains.c2_alpha)
        own = self.target_derivatives(t, q)
        return pairs[0] - block_diagonal(own[0]), pairs[1] - block_diagonal(own[1])

    def target_derivatives(self, t: float, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(∂u_i/∂q_r, ∂u_i/∂p_r), two arrays of blocks (n, m, m), unchecked.

        Parameters
        ----------
        t : float
            Time (they do not depend on it).
        q : ndarray, shape (n, m)
            Positions.
        """
        g, blocks = self.gains, np.broadcast_to(np.eye(q.shape[1]), (*q.shape, q.shape[1]))
        return np.reshape(g.pull, (-1, 1, 1)) * blocks, np.reshape(g.drag, (-1, 1, 1)) * blocks

    def structural_energy(self, q: Any, p: Any) -> float:
        """H_λ(x, v): the same as `energy`, which lives in the moving frame already.

        Parameters
        ----------
        q, p : array_like, shape (n, m)
            Positions and velocities in any frame.

        Raises
        ------
        ArgumentError
            With per-agent gains, under which the shape has no energy of its own.
        """
        q, p = ensure_state(q, p)
        ensure_one_gain(self.gains)
        return self.hamiltonian(0.0, q, p)

    def stiffness(self, q: Any) -> csr_array:
        """Hessian of U_λ: c1α ∇²V + c1γ I on deviations x (order of ``q.ravel()``), sparse; diag(c1γ_i) per agent.

        Parameters
        ----------
        q : array_like, shape (n, m)
            Positions.
        """
        from scipy.sparse import diags_array

        q = ensure_points("q", q)
        self.check_agents(len(q))
        own = np.broadcast_to(self.gains.pull, q.shape).ravel()
        structural = self.gains.c1_alpha * self.alpha.hessian(q) + diags_array(own)
        hessian: csr_array = structural.tocsr()
        return hessian
