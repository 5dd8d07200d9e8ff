"""Algorithm 3 of Olfati-Saber (2006): flocking with a γ-agent among obstacles."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import ensure_kind
from flockana.environment.beta_agents import ObstacleField
from flockana.environment.obstacles import Obstacle
from flockana.environment.target import Target
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains, PairInteraction
from flockana.interactions.gains import GainsField
from flockana.laws.gain_laws import GainedLaw
from flockana.laws.terms.navigation import Navigation
from flockana.laws.terms.obstacles import ObstacleTerm, ensure_one_dimension
from flockana.laws.terms.term import Term


def ensure_obstacles(given: Any) -> tuple[Obstacle, ...]:
    """Return obstacles as a tuple; raise on entries that are not obstacles."""
    if not isinstance(given, Iterable) or getattr(given, "ndim", 1) == 0:  # numpy's numbers are iterable by type alone
        raise ArgumentError(f"obstacles = {format_value(given)}: expected a sequence such as (Sphere((5, 0), 1),)")
    obstacles = tuple(given)
    for k, obstacle in enumerate(obstacles):
        ensure_kind(f"obstacles[{k}]", obstacle, Obstacle, "an obstacle such as Sphere((5, 0), 1)")
    return obstacles


@dataclass(frozen=True)
class Algorithm3(GainedLaw):
    """u_i = u_i^α + u_i^β + u_i^γ: Algorithm 1, repulsion from obstacles, a bounded pull to the γ-agent.

    u_i^β = c1β Σ_k φ_β(‖q̂_ik−q_i‖_σ) n̂_ik + c2β Σ_k b_ik (p̂_ik − p_i) and
    u_i^γ = −c1γ ℓ σ₁((q_i − q_r)/ℓ) − c2γ (p_i − p_r)   (Olfati-Saber 2006), where ℓ = alpha.unit is 1 as printed.

    Parameters
    ----------
    gains : Gains or mapping of str to float
        All six are used.
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

    alpha: PairInteraction = field(default_factory=AlphaInteraction)
    gains: GainsField = field(default_factory=Gains)  # type: ignore[assignment]
    target: Target = None  # type: ignore[assignment]  # no default makes sense: checked below
    beta: BetaInteraction = field(default_factory=BetaInteraction)
    obstacles: tuple[Obstacle, ...] = ()

    references = ("olfati-saber-2006",)

    def __post_init__(self) -> None:
        super().__post_init__()
        ensure_kind("beta", self.beta, BetaInteraction, "BetaInteraction(...)")
        obstacles = ensure_obstacles(self.obstacles)
        object.__setattr__(self, "obstacles", obstacles)
        ensure_one_dimension(obstacles, self.target.dimension, "the target has")

    @cached_property
    def obstacle_field(self) -> ObstacleField:
        """The obstacles with their interaction: sums over β-agents."""
        return ObstacleField(self.obstacles, self.beta)

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Terms with the energy c1α V + c1β ΣΣ ψ_β + c1γ Σ ℓ²(√(1 + ‖q_i − q_r‖²/ℓ²) − 1) + ½ Σ‖p_i‖² (E2)."""
        repulsion = ObstacleTerm(self.obstacle_field, self.gains.c1_beta, self.gains.c2_beta)
        return self.pair_term, repulsion, Navigation(self.target, self.gains, self.alpha.bend_length)
