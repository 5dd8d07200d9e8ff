"""Algorithm 3 of Olfati-Saber (2006): flocking with a γ-agent among obstacles."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.checks import FloatArray, ensure_points
from flockana.base.errors import ArgumentError
from flockana.base.scales import Scales
from flockana.environment.beta import ObstacleField, check_free
from flockana.environment.obstacles import Obstacle
from flockana.environment.targets import Target
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains
from flockana.interactions.gains import weighted
from flockana.laws.law import Law, block_diagonal
from flockana.laws.olfati_saber import alpha_scales

if TYPE_CHECKING:
    from scipy.sparse import sparray


@dataclass(frozen=True)
class Algorithm3(Law):
    """u_i = u_i^α + u_i^β + u_i^γ: Algorithm 1, repulsion from obstacles, a bounded pull to the γ-agent.

    u_i^β = c1β Σ_k φ_β(‖q̂_ik−q_i‖_σ) n̂_ik + c2β Σ_k b_ik (p̂_ik − p_i) and
    u_i^γ = −c1γ ℓ σ₁((q_i − q_r)/ℓ) − c2γ (p_i − p_r)   (Olfati-Saber 2006), where ℓ = alpha.unit is 1 as printed.

    Parameters
    ----------
    alpha : AlphaInteraction
        The pair law.
    gains : Gains
        All six are used.
    target : Target
        The γ-agent.
    beta : BetaInteraction
        The law between an agent and its β-agents.
    obstacles : sequence of Obstacle
        Spheres, walls and other convex solids, of the target's dimension; they may overlap. None is allowed.

    Raises
    ------
    ArgumentError
        If no target is given, or something among the obstacles is none or has another dimension than the target.

    Examples
    --------
    An agent at rest, closer to a wall than d', is pushed off it:

    >>> from flockana.environment.obstacles import Wall
    >>> from flockana.environment.targets import StaticTarget
    >>> law = Algorithm3(target=StaticTarget((0.0, 2.0)), obstacles=[Wall((0.0, 0.0), (0.0, 1.0))])
    >>> u = law.acceleration(0.0, [[0.0, 2.0]], [[0.0, 0.0]])
    >>> float(u[0, 0]), bool(u[0, 1] > 0.0)
    (0.0, True)
    """

    alpha: AlphaInteraction = field(default_factory=AlphaInteraction)
    gains: Gains = field(default_factory=Gains)
    target: Target = None  # type: ignore[assignment]  # no default makes sense: checked below
    beta: BetaInteraction = field(default_factory=BetaInteraction)
    obstacles: tuple[Obstacle, ...] = ()

    references = ("olfati-saber-2006",)

    def __post_init__(self) -> None:
        for name, cls in (("alpha", AlphaInteraction), ("gains", Gains), ("beta", BetaInteraction)):
            if not isinstance(getattr(self, name), cls):
                raise ArgumentError(f"{name} = {getattr(self, name)!r}: expected {cls.__name__}(...)")
        if not isinstance(self.target, Target):
            raise ArgumentError(f"target = {self.target!r}: expected a γ-agent such as StaticTarget((0.0, 0.0))")
        if not isinstance(self.obstacles, Iterable):
            raise ArgumentError(f"obstacles = {self.obstacles!r}: expected a sequence such as (Sphere((5, 0), 1),)")
        obstacles = tuple(self.obstacles)
        for k, obstacle in enumerate(obstacles):
            if not isinstance(obstacle, Obstacle):
                raise ArgumentError(f"obstacles[{k}] = {obstacle!r}: expected an obstacle such as Sphere((5, 0), 1)")
        object.__setattr__(self, "obstacles", obstacles)
        self._check_obstacles(self.target.dimension, "the target has")

    @property
    def scales(self) -> Scales:  # noqa: D102
        return alpha_scales(self.alpha, self.gains)

    @cached_property
    def obstacle_field(self) -> ObstacleField:
        """The obstacles with their interaction: sums over β-agents."""
        return ObstacleField(self.obstacles, self.beta)

    def _check_obstacles(self, m: int, whose: str) -> None:
        for k, obstacle in enumerate(self.obstacles):
            if obstacle.dimension != m:
                raise ArgumentError(
                    f"obstacles[{k}] = {obstacle} has {obstacle.dimension} components but {whose} {m}: "
                    "expected equal dimensions"
                )

    def check_dimension(self, m: int) -> None:
        """Raise unless the γ-agent and every obstacle live in m dimensions.

        Parameters
        ----------
        m : int
            Dimension of the flock.
        """
        self._check_obstacles(m, "the agents have")
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

    def check_start(self, q: FloatArray, p: FloatArray) -> None:
        """Raise if an agent starts inside or on an obstacle.

        Parameters
        ----------
        q, p : ndarray, shape (n, m)
            Initial positions and velocities.
        """
        super().check_start(q, p)
        check_free(q, self.obstacles)

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """(u, dH/dt), for every γ-agent, consistent or not, unchecked.

        dH/dt = −c2α pᵀL̂p + c2β ΣΣ b_ik ⟨p_i, p̂_ik − p_i⟩ − c2γ Σ⟨p_i, p_i − p_r⟩ − c1γ Σ⟨ℓ σ₁((q_i − q_r)/ℓ), dq_r/dt⟩:
        the force knows the p_r that it is told, the potential moves with the true dq_r/dt.

        Parameters
        ----------
        t : float
            Time.
        q, p : ndarray, shape (n, m)
            Positions and velocities.
        """
        g = self.gains
        u, dissipation = self.alpha.forces(q, p, stiffness=g.c1_alpha, damping=g.c2_alpha)
        braking = self.obstacle_field.forces(q, p, u, stiffness=g.c1_beta, damping=g.c2_beta)
        q_r, p_r = self.target.state(t)
        x = q - q_r
        pull = x / self._bend(x)[:, None]
        slip = p - p_r
        pulled, rate = g.pull * pull, self.target.rate(t)
        u -= pulled + g.drag * slip
        if g.per_agent:
            drag, carried = float(np.vdot(g.drag * p, slip)), float(pulled.sum(axis=0) @ rate)
        else:
            drag, carried = g.c2_gamma * float(np.vdot(p, slip)), g.c1_gamma * float(pull.sum(axis=0) @ rate)
        return u, g.c2_beta * braking - g.c2_alpha * dissipation - drag - carried

    def _bend(self, x: FloatArray) -> FloatArray:
        """√(1 + ‖x_i‖²/ℓ²), by which σ₁ bends the pull of each agent, shape (n,)."""
        bend: FloatArray = np.sqrt(1.0 + np.einsum("ij,ij->i", x, x) / self.alpha.unit**2)
        return bend

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:
        """H = c1α V + c1β ΣΣ ψ_β + c1γ Σ ℓ²(√(1 + ‖q_i − q_r‖²/ℓ²) − 1) + ½ Σ‖p_i‖², unchecked.

        V counts every pair once; the slides print both (E2).

        Parameters
        ----------
        t : float
            Time: the γ-agent moves.
        q, p : ndarray, shape (n, m)
            Positions and velocities.
        """
        g, x = self.gains, q - self.target.state(t)[0]
        x2 = np.einsum("ij,ij->i", x, x)
        attraction = weighted(g.c1_gamma, x2 / (self._bend(x) + 1.0))  # √(1 + x²) − 1 without its cancellation
        potential = g.c1_alpha * self.alpha.potential_energy(q) + g.c1_beta * self.obstacle_field.potential_energy(q)
        return potential + attraction + 0.5 * float(np.sum(p * p))

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[sparray, sparray]:
        """(∂u/∂q, ∂u/∂p) with the β-agents moving as the agents do, sparse, unchecked.

        ∂u/∂q is minus `stiffness` but for what moving agents add: c2α Σ_j (p_j − p_i) ∂a_ij/∂q and
        c2β Σ_k ∂[b_ik (p̂_ik − p_i)]/∂q_i.

        Parameters
        ----------
        t : float
            Time.
        q, p : ndarray, shape (n, m)
            Positions and velocities.
        """
        g = self.gains
        pairs = self.alpha.jacobian(q, p, stiffness=g.c1_alpha, damping=g.c2_alpha)
        braking = self.obstacle_field.braking_blocks(q, p)
        pull, drag = self.target_derivatives(t, q)
        by_position = g.c2_beta * braking[0] - g.c1_beta * self.obstacle_field.hessian_blocks(q) - pull
        return pairs[0] + block_diagonal(by_position), pairs[1] + block_diagonal(g.c2_beta * braking[1] - drag)

    def target_derivatives(self, t: float, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """(∂u_i/∂q_r, ∂u_i/∂p_r), two arrays of blocks (n, m, m), unchecked: c1γ times the derivative of σ₁, c2γ I.

        Parameters
        ----------
        t : float
            Time.
        q : ndarray, shape (n, m)
            Positions.
        """
        g, x = self.gains, q - self.target.state(t)[0]
        root, x = self._bend(x)[:, None, None], x / self.alpha.unit
        pull = np.eye(q.shape[1]) / root - x[:, :, None] * x[:, None, :] / root**3
        drag = np.broadcast_to(np.eye(q.shape[1]), pull.shape)
        return np.reshape(g.pull, (-1, 1, 1)) * pull, np.reshape(g.drag, (-1, 1, 1)) * drag

    def stiffness(self, q: Any, t: float = 0.0) -> sparray:
        """Hessian of the potential, α-, β- and γ-part, in the order of ``q.ravel()``, sparse.

        Parameters
        ----------
        q : array_like, shape (n, m)
            Positions.
        t : float
            When: the γ-agent may move.
        """
        q = ensure_points("q", q)
        self.check_dimension(q.shape[1])
        self.check_agents(len(q))
        own = self.gains.c1_beta * self.obstacle_field.hessian_blocks(q) + self.target_derivatives(t, q)[0]
        hessian: sparray = self.gains.c1_alpha * self.alpha.hessian(q) + block_diagonal(own)
        return hessian
