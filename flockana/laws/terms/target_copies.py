"""Navigational feedback to copies of the γ-agent, one for each agent."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.environment.gamma_agent_copies import Copies
from flockana.interactions import Gains
from flockana.interactions.gains import weighted
from flockana.laws.law_features import Feature, target_feature
from flockana.laws.terms.term import Term


@dataclass(frozen=True)
class CopiesTerm(Term):
    """u_i = −c1γ (q_i − q_r^i) − c2γ (p_i − p_r^i), (q_r^i, p_r^i) the copy of agent i.

    Its energy is ½ Σ c1γ_i ‖q_i − q_r^i‖² in the given frame, and what it adds to dH/dt is
    −Σ c2γ_i ⟨p_i, p_i − p_r^i⟩ − Σ c1γ_i ⟨q_i − q_r^i, p_r^i⟩.
    """

    copies: Copies
    gains: Gains

    invariance = "none"
    functions = ()

    def features(self) -> tuple[Feature, ...]:
        """Return the shortest time scale of the γ-agent copies' motion, as a feature in time."""
        return (target_feature(self.copies),)

    def check_dimension(self, m: int) -> None:  # noqa: D102
        if self.copies.shape[1] != m:
            raise ArgumentError(f"the copies have {self.copies.shape[1]} components but the agents have {m}")

    def check_agents(self, n: int) -> None:  # noqa: D102
        self.gains.check_agents(n)
        if self.copies.shape[0] != n:
            raise ArgumentError(f"there are {self.copies.shape[0]} copies and {n} agents: expected one copy each")

    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:  # noqa: D102
        q_r, p_r = self.copies.state(t)
        pull, drag = self.gains.pull * (q - q_r), self.gains.drag * (p - p_r)
        u -= pull + drag
        return -float(np.sum(drag * p) + np.sum(pull * p_r))

    def energy(self, t: float, q: FloatArray) -> float:  # noqa: D102
        return 0.5 * weighted(self.gains.c1_gamma, np.sum((q - self.copies.state(t)[0]) ** 2, axis=1))

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray]:  # noqa: D102
        return -self.hessian(t, q), -self._blocks(self.gains.drag, q)

    def hessian(self, t: float, q: FloatArray) -> FloatArray:  # noqa: D102
        return self._blocks(self.gains.pull, q)

    @staticmethod
    def _blocks(gain: Any, q: FloatArray) -> FloatArray:
        n, m = q.shape
        return np.broadcast_to(np.reshape(gain, (-1, 1, 1)) * np.eye(m), (n, m, m)).copy()
