"""Algorithms 1 and 2 of Olfati-Saber (2006), in one, two and three dimensions."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from flockana.checks import FloatArray, ensure_points, ensure_state
from flockana.environment.targets import Target
from flockana.errors import ArgumentError
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.law import Law

if TYPE_CHECKING:
    from scipy.sparse import csr_array


def _ensure(name: str, value: Any, cls: type) -> None:
    if not isinstance(value, cls):
        raise ArgumentError(f"{name} = {value!r}: expected {cls.__name__}(...)")


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

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """(u, dH_λ/dt) with dH_λ/dt = −c2γ‖v‖² − c2α vᵀL̂v, unchecked.

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
        u -= g.c1_gamma * (q - q_r) + g.c2_gamma * (p - p_r)
        v = moving_frame(p)
        return u, -g.c2_gamma * float(np.sum(v * v)) - g.c2_alpha * dissipation  # L̂ ignores the common velocity

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:
        """H_λ(x, v) = c1α V(x) + c1γ J(x) + K(v) in the moving frame, for every target, unchecked.

        Parameters
        ----------
        t : float
            Time (H_λ does not depend on it).
        q, p : ndarray, shape (n, m)
            Positions and velocities in any frame.
        """
        x, v = moving_frame(q), moving_frame(p)
        inertia, kinetic = 0.5 * float(np.sum(x * x)), 0.5 * float(np.sum(v * v))
        return self.gains.c1_alpha * self.alpha.potential_energy(q) + self.gains.c1_gamma * inertia + kinetic

    def structural_energy(self, q: Any, p: Any) -> float:
        """H_λ(x, v): the same as `energy`, which lives in the moving frame already.

        Parameters
        ----------
        q, p : array_like, shape (n, m)
            Positions and velocities in any frame.
        """
        q, p = ensure_state(q, p)
        return self.hamiltonian(0.0, q, p)

    def stiffness(self, q: Any) -> csr_array:
        """Hessian of U_λ: c1α ∇²V + c1γ I on deviations x (order of ``q.ravel()``), sparse.

        Parameters
        ----------
        q : array_like, shape (n, m)
            Positions.
        """
        from scipy.sparse import eye_array

        q = ensure_points("q", q)
        structural = self.gains.c1_alpha * self.alpha.hessian(q) + self.gains.c1_gamma * eye_array(q.size)
        hessian: csr_array = structural.tocsr()
        return hessian
