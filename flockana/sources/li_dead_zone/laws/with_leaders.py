"""Dead-zone law with leaders, which the paper's text mentions and its equation (9) lacks."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_index, ensure_kind, normalise
from flockana.interactions.gains import ensure_gain
from flockana.laws.law import Arrays
from flockana.laws.sum_of_terms import SumOfTerms
from flockana.laws.terms.leaders import Leaders, known_path
from flockana.laws.terms.pairs import PairTerm
from flockana.laws.terms.term import Term
from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.dead_zone import contact_scales


@dataclass(frozen=True)
class LedDeadZoneFlocking(SumOfTerms):
    """Dead-zone law (9) with several leaders and pinned agents, as in section IV of the paper (erratum L9).

    u_i = Σ_{j∈N_i} [f(ρ_ij) n_ij + k₁ (q_j − q_i)] + k₂ Σ_{j∈N_i, l(j)=l(i)} (p_j − p_i)
    + h_i [c₁ (q_l − q_i) + c₂ (p_l − p_i)] + dp_l/dt: all neighbours keep their distances, velocities match among the
    agents of one leader l(i), a pinned agent (h_i = 1) feels its leader's place and velocity, and every agent knows
    its leader's acceleration. The paper prints none of the three terms; this is our reading of its words.

    The energy is that in the frames of the leaders, ½ Σ ‖p_i − p_l‖² + Σ_{i<j} ψ(min(ρ_ij, r)) + ½ c₁ Σ h_i
    ‖q_i − q_l‖². With one leader, or several of one velocity, it never rises; else agents of different leaders that
    are neighbours exchange the power −Σ_i f_i·p_l, f_i the pair force on i.

    Parameters
    ----------
    interaction : DeadZoneInteraction
        The pair law, with a ramp.
    k2 : float
        Gain k₂ ≥ 0 of velocity consensus within a group.
    leaders : tuple of Target
        One or more static, linear, sine or circle targets that say their true velocity.
    group : sequence of int
        The number l(i) of each agent's leader, from 0.
    pinned : sequence of int
        The agents that feel their leader.
    c1, c2 : float
        Gains ≥ 0 of the pinned.
    feedforward : bool
        Whether the leaders' accelerations are known to their agents, as the paper assumes.

    Raises
    ------
    ArgumentError
        On an interaction without a ramp, a negative gain, no leader or one of unknown acceleration, or a number in
        `group` or `pinned` that there is none of.

    Examples
    --------
    Two agents that follow different leaders do not match:

    >>> from flockana.environment.targets import LinearTarget
    >>> leaders = LinearTarget((0.0, 0.0), (1.0, 0.0)), LinearTarget((8.0, 0.0), (-1.0, 0.0))
    >>> law = LedDeadZoneFlocking(DeadZoneInteraction(k1=0.0), leaders=leaders, group=(0, 1))
    >>> law.acceleration(0.0, [[0.0, 0.0], [8.0, 0.0]], [[1.0, 0.0], [-1.0, 0.0]]).tolist()
    [[0.0, 0.0], [0.0, 0.0]]
    """

    interaction: DeadZoneInteraction = field(default_factory=DeadZoneInteraction)
    k2: float = 1.0
    leaders: Any = ()
    group: Any = ()
    pinned: Any = ()
    c1: float = 1.0
    c2: float = 2.0
    feedforward: bool = True

    units: ClassVar[Mapping[str, Powers]] = {"k2": (0, -1), "c1": (0, -2), "c2": (0, -1)}
    references = ("li-dead-zone",)

    def __post_init__(self) -> None:
        ensure_kind("interaction", self.interaction, DeadZoneInteraction, "DeadZoneInteraction(...)")
        if self.interaction.ramp == 0.0:
            raise ArgumentError("interaction.ramp = 0: expected a ramp such as 0.25; only DeadZoneFlocking takes jumps")
        normalise(self, ensure_gain, "k2", "c1", "c2")
        leaders = tuple(self.leaders) if isinstance(self.leaders, Iterable) else ()
        if not leaders:
            raise ArgumentError(f"leaders = {self.leaders!r}: expected one or more, such as (LinearTarget(...),)")
        object.__setattr__(self, "leaders", leaders)
        for leader in self.leaders:
            known_path(leader)
        self._freeze_numbers("group", len(self.leaders), "the number of a leader")
        self._freeze_numbers("pinned", len(self.group), "an agent")

    def _freeze_numbers(self, name: str, count: int, what: str) -> None:
        value = getattr(self, name)
        if isinstance(value, str | bytes) or not isinstance(value, Iterable):
            raise ArgumentError(f"{name} = {value!r}: expected a sequence of whole numbers, such as (0, 1)")
        object.__setattr__(self, name, tuple(ensure_index(f"{name} has", item, count, what) for item in value))

    @property
    def scales(self) -> Scales:
        """Length and time scales of `DeadZoneFlocking`."""
        return contact_scales(self.interaction)

    @cached_property
    def ties(self) -> Leaders:
        """Term that couples agents to their leaders."""
        tie_parameters = (self.leaders, self.group, self.pinned, self.c1, self.c2, self.feedforward)
        return Leaders(self.interaction, self.k2, *tie_parameters)

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Terms: the pair forces without consensus, and the coupling to leaders."""
        return PairTerm(self.interaction, 1.0, 0.0), self.ties

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        u = np.zeros(q.shape)
        self.terms[0].act(t, q, p, u)
        exchanged_power = -float(np.sum(u * self.ties.led(t)[1]))
        return u, exchanged_power + self.ties.act(t, q, p, u)

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:  # noqa: D102
        return self.potential_energy(t, q) + 0.5 * float(np.sum((p - self.ties.led(t)[1]) ** 2))

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Arrays) -> Mapping[str, Any]:  # noqa: D102
        led = [self.ties.led(float(time)) for time in t]
        distance, slip = (
            np.array([np.linalg.norm(own_p - item[k], axis=1).max() for own_p, item in zip(state, led, strict=True)])
            for k, state in enumerate((q, p))
        )
        return {
            "leader_distance": ("largest distance of an agent from its leader", distance),
            "leader_slip": ("largest difference of velocity from one's leader", slip),
        }
