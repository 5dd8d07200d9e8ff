"""Coupling to leaders: velocity matching within each leader's group, and pinned agents."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.environment.target import Harmonic, Target
from flockana.interactions.distance_functions import LawFunction
from flockana.interactions.pair_interaction import PairInteraction
from flockana.kernels.neighbours import pair_list
from flockana.laws.law_features import Feature, target_feature
from flockana.laws.law_matrices import block_diagonal
from flockana.laws.terms.term import Derivatives, Term


@dataclass(frozen=True)
class Leaders(Term):
    """u_i = k₂ Σ_{j∈N_i, l(j)=l(i)} a_ij (p_j − p_i) + h_i [c₁ (q_l − q_i) + c₂ (p_l − p_i)] + dp_l/dt, l = l(i).

    Its power is that in the frames of the leaders: −k₂ pᵀL̂p of each group, −c₂ Σ h_i ‖p_i − p_l‖², and, if
    accelerations are not told, −Σ (p_i − p_l)·dp_l/dt.
    """

    pair: PairInteraction
    damping: float
    leaders: tuple[Target, ...]
    group: tuple[int, ...]
    pinned: tuple[int, ...]
    pull: float
    drag: float
    feedforward: bool = True

    conservative: ClassVar[bool] = False  # a leader that moves drags and bends those at rest
    invariance = "none"

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Pair law whose adjacency couples the agents within each leader's group."""
        return (LawFunction("the net of each group", self.pair, 0.0, self.damping),)

    def features(self) -> tuple[Feature, ...]:
        """Return the narrowest features: those of each group's net, and of each leader's motion in time."""
        return (*super().features(), *map(target_feature, self.leaders))

    @cached_property
    def members(self) -> tuple[npt.NDArray[np.int64], ...]:
        """Indices of the agents that follow each leader."""
        return tuple(np.flatnonzero(np.array(self.group) == leader) for leader in range(len(self.leaders)))

    @cached_property
    def _pins(self) -> FloatArray:
        """Column vector h of shape (n, 1): 1 for pinned agents, 0 for the others."""
        pins = np.zeros((len(self.group), 1))
        pins[list(self.pinned)] = 1.0
        return pins

    @cached_property
    def _paths(self) -> tuple[Harmonic, ...]:
        return tuple(known_path(leader) for leader in self.leaders)

    def led(self, t: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return position, velocity and acceleration of each agent's leader, three arrays of shape (n, m)."""
        paths = zip(self.leaders, self._paths, strict=True)
        states = np.array([(leader.position(t), leader.rate(t), path.acceleration(t)) for leader, path in paths])
        q, p, a = states[list(self.group)].transpose(1, 0, 2)
        return q, p, a

    def check_dimension(self, m: int) -> None:  # noqa: D102
        for leader in self.leaders:
            if leader.dimension != m:
                raise ArgumentError(f"a leader has {leader.dimension} components but the agents have {m}: expected {m}")

    def check_agents(self, n: int) -> None:  # noqa: D102
        if len(self.group) != n:
            raise ArgumentError(f"group has {len(self.group)} entries but there are {n} agents: expected one for each")

    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:  # noqa: D102
        q_l, p_l, a_l = self.led(t)
        velocity_difference, power = p - p_l, 0.0
        for group in self.members:
            match_forces, dissipation = self.pair.forces(q[group], p[group], stiffness=0.0, damping=self.damping)
            u[group] += match_forces
            power -= self.damping * dissipation
        u -= self._pins * (self.pull * (q - q_l) + self.drag * velocity_difference)
        power -= self.drag * float(np.sum(self._pins * velocity_difference * velocity_difference))
        if not self.feedforward:
            return power - float(np.sum(velocity_difference * a_l))
        u += a_l
        return power

    def energy(self, t: float, q: FloatArray) -> float:  # noqa: D102
        return 0.5 * self.pull * float(np.sum(self._pins * (q - self.led(t)[0]) ** 2))

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:  # noqa: D102
        (i, j), group = pair_list(q, self.pair.range), np.array(self.group)
        is_same_group = group[i] == group[j]
        by_position, by_velocity = self.pair.jacobian(
            q, p, stiffness=0.0, damping=self.damping, pairs=[(i[is_same_group], j[is_same_group])]
        )
        pins = block_diagonal(self._pins[:, :, None] * np.eye(q.shape[1]))
        return by_position - self.pull * pins, by_velocity - self.drag * pins

    def hessian(self, t: float, q: FloatArray) -> FloatArray:  # noqa: D102
        return self.pull * self._pins[:, :, None] * np.eye(q.shape[1])


def known_path(leader: Any) -> Harmonic:
    """Return the harmonic path of a leader; raise unless it reports its true velocity."""
    path = leader.closed_path if isinstance(leader, Target) else None
    if path is None or path.factor != 1.0 or path.terms[4].any():
        raise ArgumentError(
            f"leader {leader!r}: expected a StaticTarget, LinearTarget, SineTarget or CircleTarget with its true "
            "velocity, whose acceleration is known"
        )
    return path
