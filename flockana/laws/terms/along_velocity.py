"""Forces along an agent's own velocity: drag slows the agent, speed control holds its speed."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.kernels import agent_terms as kernel
from flockana.kernels.listed_pairs import no_energy
from flockana.laws.terms.term import Term, TermKernel


@dataclass(frozen=True)
class AlongVelocity(Term):
    """u_i = (α − β‖p_i‖²) p_i: drag for α < 0, else thrust; β > 0 holds agents at the speed √(α/β).

    It has no potential. Its power is Σ (α − β‖p_i‖²)‖p_i‖² under an energy in the given frame, and
    Σ (α − β‖p_i‖²)⟨p_i, p_i − p_c⟩ under one in the moving frame, which of a drag −c p_i is −c Σ‖v_i‖². A drag takes
    energy always; a thrust adds some wherever ‖p_i‖² < α/β, so that no energy is sure to fall.
    """

    thrust: float
    brake: float = 0.0
    moving: bool = False

    idle: ClassVar[bool] = True
    functions = ()

    @property
    def centre_decouples(self) -> bool:
        """Whether shape and centre of mass decouple: true for plain drag, false for speed control."""
        return self.brake == 0.0

    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:  # noqa: D102
        return self.compiled(p.shape[1]).on_agents(t, q, p, u)

    def compiled(self, m: int) -> TermKernel:  # noqa: D102
        kernel_parameters = np.array([float(self.moving), self.thrust, self.brake])
        return TermKernel(kernel.act_along, no_energy, kernel_parameters, np.empty((0, 0)), 0.0)

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:  # noqa: D102
        factor = self.thrust - self.brake * np.einsum("ij,ij->i", p, p)
        by_velocity = factor[:, None, None] * np.eye(p.shape[1]) - 2.0 * self.brake * p[:, :, None] * p[:, None, :]
        return self.hessian(t, q), by_velocity
