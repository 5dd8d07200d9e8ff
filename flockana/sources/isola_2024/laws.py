"""MSN project's discretisation of Algorithms 1 and 2, a map rather than an integrator."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.units import Powers
from flockana.base.value_checks import (
    FloatArray,
    ensure_finite_scalar,
    ensure_flag,
    ensure_kind,
    ensure_positive,
    normalise,
)
from flockana.interactions import AlphaInteraction, Gains
from flockana.kernels.neighbours import pair_list
from flockana.laws.discrete import DiscreteLaw, States
from flockana.laws.law import Arrays
from flockana.laws.olfati_saber import Algorithm1, Algorithm2, ensure_one_gain
from flockana.sources.isola_2024.kernels import advance_alpha, neighbour_lists

if TYPE_CHECKING:
    from control import StateSpace

PRINTED = 1.5  # q + (p + u dt) dt + ½ u dt² = q + p dt + (3/2) u dt² (erratum E9)
CONSTANT_ACCELERATION = 0.5


@dataclass(frozen=True)
class MSNDiscretisation(DiscreteLaw):
    """p' = p + u dt, q' = q + p dt + f u dt², agent by agent or all at once (the MSN project's iteration).

    As the project wrote it, agents move one after the other and each sees those before it already moved, so action
    and reaction differ within a step; f is 3/2, which moves each agent by u dt² too far (E9). Neighbours are those of
    the end of the previous iteration, and the γ-agent has already moved on to the end of this one. The project sums
    in single precision, which is not imitated.
    """

    law: Algorithm1 | Algorithm2
    dt: float
    in_place: bool = True
    position_factor: float = PRINTED

    units: ClassVar[Mapping[str, Powers]] = {"dt": (0, 1)}
    references = ("isola-2024", "olfati-saber-2006")

    def __post_init__(self) -> None:
        if type(self.law) not in (Algorithm1, Algorithm2):
            raise ArgumentError(f"law = {format_value(self.law)}: expected Algorithm1(...) or Algorithm2(...) itself")
        ensure_kind("alpha", self.alpha, AlphaInteraction, "AlphaInteraction(...), whose sums are compiled")
        if self.target is not None:
            ensure_one_gain(self.law.gains)
        normalise(self, ensure_flag, "in_place")
        normalise(self, ensure_positive, "dt")
        normalise(self, ensure_finite_scalar, "position_factor")

    @property
    def alpha(self) -> AlphaInteraction:
        """Pair interaction of the discretised law."""
        return self.law.alpha  # type: ignore[return-value]  # checked when made

    @property
    def gains(self) -> Gains:
        """Gains of the discretised law."""
        return self.law.gains

    def centre_system(self) -> "StateSpace | None":
        """Return the map of the centre of mass from (q_r, p_r) to q_c as a `control.StateSpace`."""
        # Exact if all agents move at once; agent by agent, action and reaction differ within a step, and the sum over
        # agents obeys no equation of its own.
        if self.target is None:
            return None
        import control

        h, f, c1, c2 = self.dt, self.position_factor, self.gains.c1_gamma, self.gains.c2_gamma
        push = np.array([f * h * h, h])  # what one u does to (q, p)
        feedback: FloatArray = np.array([c1, c2])
        a = np.array([[1.0, h], [0.0, 1.0]]) - np.outer(push, feedback)
        b = np.outer(push, feedback)
        # the γ-agent has moved on to the end of the step: its input acts at once on the state that is put out
        return control.StateSpace(a, b, a[:1], b[:1], h, inputs=["q_r", "p_r"], outputs="q_c", states=["q", "p"])

    def step(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays) -> States:
        """Return positions, velocities, inputs and unchanged memory after one iteration, unchecked."""
        next_time, h = t + self.dt, self.dt
        if not self.in_place:
            u, _ = self.law.flow(next_time, q, p)
            return q + p * h + self.position_factor * u * h * h, p + u * h, u, memory
        q, p, u = q.copy(), p.copy(), np.empty_like(q)
        g, zero_vector = self.gains, np.zeros(q.shape[1])
        q_r, p_r = (zero_vector, zero_vector) if self.target is None else self.target.state(next_time)
        goal = (0.0, 0.0, q_r, p_r) if self.target is None else (g.c1_gamma, g.c2_gamma, q_r, p_r)
        # the project links agents at exactly r, which the strict neighbour search leaves out
        lists = neighbour_lists(len(q), *pair_list(q, np.nextafter(self.alpha.r, np.inf)))
        advance_alpha(q, p, u, lists, self.alpha.par, (g.c1_alpha, g.c2_alpha), goal, h, self.position_factor)
        return q, p, u, memory
