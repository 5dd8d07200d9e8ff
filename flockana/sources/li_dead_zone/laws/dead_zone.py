"""Dead-zone law of Li, Yuan and Liu: forces act only outside a band of distances."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_kind, ensure_state, normalise
from flockana.interactions.gains import ensure_gain
from flockana.laws.discrete import IndexArray
from flockana.laws.jump_laws import Margins, Pieces, SwitchedLaw
from flockana.laws.law import Arrays, Block
from flockana.laws.sum_of_terms import SumOfTerms
from flockana.laws.terms.pairs import PairTerm
from flockana.laws.terms.term import Term
from flockana.laws.usual_laws import Candidate
from flockana.measures.nets import links
from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.kernels.pair import ATTRACTION, DEAD, OUT, zone_forces, zone_margins, zones
from flockana.sources.li_dead_zone.kernels.steps import semi_implicit_steps

SLIDES = 1e-6  # of d1: a pair driven back from both sides that swings no farther than this counts as held


@dataclass(frozen=True)
class DeadZoneFlocking(SumOfTerms, SwitchedLaw):
    """u_i = Σ_{j∈N_i} [f(ρ_ij) n_ij + k₁ (q_j − q_i) + k₂ (p_j − p_i)], eq. (9) made definite (errata L1, L2).

    N_i are the agents closer than r, a_ij = 1 for them. No leader appears; momentum is conserved, and energy is
    measured in the frame of the centre of mass. The right-hand side jumps where a pair comes into range, and, if the
    interaction has no ramp, at both ends of the dead zone: then `simulate` locates every switch, and ends the run with
    a message where a pair is held at one (`SwitchedLaw`). With a ramp no surface can hold a pair, and the steps of the
    adaptive solvers shorten at r by themselves.

    Parameters
    ----------
    interaction : DeadZoneInteraction
        The pair law; its `ramp` decides between the printed jumps (0) and a steep rise (default).
    k2 : float
        Gain k₂ ≥ 0 of velocity consensus.

    Examples
    --------
    Nothing but k₁ acts within the dead zone, and two agents too near repel each other:

    >>> law = DeadZoneFlocking(DeadZoneInteraction(k1=0.0))
    >>> law.acceleration(0.0, [[0.0, 0.0], [8.0, 0.0]], [[0.0, 0.0], [0.0, 0.0]]).tolist()
    [[0.0, 0.0], [0.0, 0.0]]
    >>> bool(law.acceleration(0.0, [[0.0, 0.0], [2.0, 0.0]], [[0.0, 0.0], [0.0, 0.0]])[0, 0] < 0.0)
    True
    """

    interaction: DeadZoneInteraction = field(default_factory=DeadZoneInteraction)
    k2: float = 1.0

    units: ClassVar[Mapping[str, Powers]] = {"k2": (0, -1)}
    references = ("li-dead-zone",)
    moving = True
    slide = ": the force of one zone drives them into the other and back; give the interaction a ramp to go on"

    def __post_init__(self) -> None:
        ensure_kind("interaction", self.interaction, DeadZoneInteraction, "DeadZoneInteraction(...)")
        normalise(self, ensure_gain, "k2")

    @property
    def scales(self) -> Scales:
        """Length d₁, and the time in which the contact force moves an agent by d₁."""
        return contact_scales(self.interaction)

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Pair forces and consensus, with the saturated energy, which falls at k₂ pᵀL̂p (erratum L5)."""
        return (PairTerm(self.interaction, 1.0, self.k2),)

    def literal_energy(self, q: Any, p: Any) -> float:
        """Return the energy of neighbours only, which jumps by ψ(r) when a pair comes into range (erratum L5)."""
        q, p = ensure_state(q, p)
        n = len(q)
        distant_count = n * (n - 1) // 2 - len(links(q, self.interaction.r))
        return self.hamiltonian(0.0, q, p) - distant_count * self.interaction.far_potential

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Arrays) -> Mapping[str, tuple[str, Any]]:  # noqa: D102
        def literal() -> FloatArray:
            return np.array([self.literal_energy(x, v) for x, v in zip(q, p, strict=True)])

        return {"literal_energy": ("H of neighbours only", literal)}

    def semi_implicit(
        self, q: FloatArray, p: FloatArray, dt: float, steps: int, wanted: IndexArray | None = None
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return positions and velocities after, and inputs before, each kept semi-implicit Euler step.

        Parameters
        ----------
        steps : int
            How many; after the last that is wanted none is made.
        wanted : ndarray of int, shape (S,), optional
            The steps to keep, numbered from 1, rising; by default all of them.
        """
        rows = np.arange(1, steps + 1) if wanted is None else wanted
        return semi_implicit_steps(q, p, self.interaction.par, self.k2, dt, rows)

    def block(self, solver: Any) -> Block | None:
        """Return a function that makes semi-implicit Euler steps; None for other solvers and for subclasses."""
        is_plain = type(self) is DeadZoneFlocking and type(self.interaction) is DeadZoneInteraction
        if not is_plain or solver.position_factor != 1.0:
            return None
        return lambda times, q, p, wanted: self.semi_implicit(q, p, solver.dt, len(times), wanted)

    @property
    def located(self) -> bool:
        """Whether the force jumps at the dead zone (no ramp), so that switches must be located."""
        return self.interaction.ramp == 0.0

    def pieces(self, q: FloatArray) -> Pieces:
        """Return the zone of every pair: 0 repulsion, 1 dead zone, 2 attraction, 3 out of range."""
        return zones(q, self.interaction.par)

    def piece_flow(self, pieces: Pieces, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        u = np.zeros_like(q)
        return u, -self.k2 * zone_forces(q, p, pieces, self.interaction.par, self.k2, u)

    def margins(self, pieces: Pieces, q: FloatArray) -> Margins:  # noqa: D102
        return Margins(*zone_margins(q, pieces, self.interaction.par))

    def crossed(self, pieces: Pieces, margins: Margins) -> Pieces:  # noqa: D102
        step = np.where(margins.inside < 0.0, np.where(margins.upper, 1, -1), 0)
        next_pieces = pieces + step
        if self.interaction.d2 >= self.interaction.r:  # there is no zone of attraction
            next_pieces = np.where(next_pieces == ATTRACTION, np.where(step > 0, OUT, DEAD), next_pieces)
        return next_pieces.astype(np.int8)

    def held_speed(self, push: float) -> float:  # noqa: D102
        return float(np.sqrt(2.0 * SLIDES * self.interaction.d1 * push))


def contact_scales(interaction: DeadZoneInteraction) -> Scales:
    """Return d₁, and the time in which the contact force moves an agent by d₁."""
    return Scales(interaction.d1, float(np.sqrt(interaction.d1 / interaction.contact_force)))


CANDIDATES = {"dead-zone": Candidate(DeadZoneFlocking)}
