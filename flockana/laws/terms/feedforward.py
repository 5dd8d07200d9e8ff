"""Feedforward of the γ-agent's acceleration to every agent, needed to follow a varying velocity."""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.environment.target import Harmonic, Target
from flockana.kernels import agent_terms as kernel
from flockana.kernels.listed_pairs import no_energy
from flockana.laws.law_features import Feature, target_feature
from flockana.laws.terms.term import Term, TermKernel


@dataclass(frozen=True)
class TargetFeedforward(Term):
    """u_i = d²q_r/dt², the same for all agents.

    It moves the centre of mass alone: its power is 0 under an energy in the moving frame, and Σ⟨p_i, d²q_r/dt²⟩ under
    one in the given frame.
    """

    target: Target
    moving: bool = False

    conservative: ClassVar[bool] = False  # it pushes agents at rest, and is no gradient of the energy
    functions = ()

    def features(self) -> tuple[Feature, ...]:
        """Return the narrowest feature in time of the γ-agent's motion."""
        return (target_feature(self.target),)

    @cached_property
    def path(self) -> Harmonic:
        """The γ-agent's path in closed form."""
        path = self.target.closed_path
        assert path is not None  # as every law that has this term makes sure
        return path

    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:  # noqa: D102
        return self.compiled(p.shape[1]).on_agents(t, q, p, u)

    def compiled(self, m: int) -> TermKernel:  # noqa: D102
        kernel_parameters = np.concatenate([[float(self.moving), self.path.omega], self.path.terms.ravel()])
        return TermKernel(kernel.act_all, no_energy, kernel_parameters, np.empty((0, 0)), 0.0)

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:  # noqa: D102
        return self.hessian(t, q), self.hessian(t, q)
