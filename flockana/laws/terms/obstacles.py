"""β-term: repulsion from obstacles and damping of motion towards them."""

from collections.abc import Iterable
from dataclasses import dataclass

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.environment.beta_agents import ObstacleField, check_free
from flockana.environment.obstacles import Obstacle
from flockana.interactions import BetaInteraction
from flockana.kernels.obstacle_terms import body_numbers
from flockana.laws.law_features import Feature
from flockana.laws.terms.term import Invariance, Term, TermKernel

_SUMS = ("kinds", "forces", "potential_energy")  # as every field has them, from its obstacles' kernels


def ensure_one_dimension(obstacles: Iterable[Obstacle], m: int, whose: str) -> None:
    """Raise unless every obstacle has dimension m; `whose` names the owner of m in the error message."""
    for k, obstacle in enumerate(obstacles):
        if obstacle.dimension != m:
            raise ArgumentError(
                f"obstacles[{k}] = {obstacle} has {obstacle.dimension} components but {whose} {m}: "
                "expected equal dimensions"
            )


@dataclass(frozen=True)
class ObstacleTerm(Term):
    """u_i^β = c1β Σ_k φ_β n̂_ik + c2β Σ_k b_ik (p̂_ik − p_i), with the energy c1β ΣΣ ψ_β.

    Parameters
    ----------
    field : ObstacleField
        The obstacles with their interaction.
    stiffness, damping : float
        Gains c1β and c2β.

    Examples
    --------
    >>> import numpy as np
    >>> from flockana.environment.obstacles import Wall
    >>> from flockana.interactions import BetaInteraction
    >>> term = ObstacleTerm(ObstacleField((Wall((0.0, 0.0), (0.0, 1.0)),), BetaInteraction()), 1.0, 1.0)
    >>> term.energy(0.0, np.array([[0.0, 9.0]])) == 0.0 < term.energy(0.0, np.array([[0.0, 2.0]]))
    True
    """

    field: ObstacleField
    stiffness: float
    damping: float

    functions = ()

    def features(self) -> tuple[Feature, ...]:
        """Return as a feature the layer around obstacles in which repulsion and braking fall to 0."""
        is_beta = type(self.field.beta) is BetaInteraction
        return (Feature("the obstacles' repulsion", "agents", self.field.beta.d if is_beta else None),)

    @property
    def invariance(self) -> Invariance:
        """Motions that leave the energy unchanged: with obstacles, rotations about the target."""
        return "rotations about the target" if self.field.obstacles else "rigid motions"

    def check_dimension(self, m: int) -> None:  # noqa: D102
        ensure_one_dimension(self.field.obstacles, m, "the agents have")

    def check_start(self, q: FloatArray) -> None:
        """Raise if an agent starts inside or on an obstacle."""
        check_free(q, self.field.obstacles)

    def compiled(self, m: int) -> tuple[TermKernel, ...] | None:
        """Return the obstacle term in compiled form, one kernel per kind of obstacle; None without one."""
        if not all(getattr(type(self.field), name) is getattr(ObstacleField, name) for name in _SUMS):
            return None
        beta, kernels = self.field.beta, []
        for kind in self.field.kinds:
            kernel_parameters = body_numbers(beta.r, self.stiffness, self.damping, beta.par, *kind.arrays)
            kernels.append(TermKernel(kind.kernels.act, kind.kernels.energy, kernel_parameters, beta.panels, 0.0))
        return tuple(kernels)

    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:  # noqa: D102
        return self.damping * self.field.forces(q, p, u, stiffness=self.stiffness, damping=self.damping)

    def energy(self, t: float, q: FloatArray) -> float:  # noqa: D102
        return self.stiffness * self.field.potential_energy(q)

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:  # noqa: D102
        by_position, by_velocity = self.field.braking_blocks(q, p)
        return self.damping * by_position - self.stiffness * self.field.hessian_blocks(q), self.damping * by_velocity

    def hessian(self, t: float, q: FloatArray) -> FloatArray:  # noqa: D102
        return self.stiffness * self.field.hessian_blocks(q)
