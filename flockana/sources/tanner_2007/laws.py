"""Laws of Tanner, Jadbabaie and Pappas: potentials and velocity consensus along a fixed or proximity net."""

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import sqrt
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_kind, ensure_positive, normalise
from flockana.interactions.distance_functions import LawFunction, Within
from flockana.laws.jump_laws import Margins, Pieces, SwitchedLaw
from flockana.laws.law import Law
from flockana.laws.terms.pairs import ensure_apart
from flockana.laws.terms.term import Derivatives
from flockana.measures.centre_frame import moving_frame
from flockana.measures.perception import ensure_in_flock, ensure_net
from flockana.sources.tanner_2007.interactions import LogPotential, net_derivatives, net_forces

_NEAR, _FAR = 0, 1
Ends = tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]


class _MatchingLaw(Law):
    """Base class of laws with potentials and consensus along a net, with scales."""

    potential: LogPotential
    k2: float

    references: ClassVar[tuple[str, ...]] = ("tanner-2007",)
    centre_decouples = True

    def __post_init__(self) -> None:
        ensure_kind("potential", self.potential, LogPotential, "LogPotential(strength, d)")
        normalise(self, ensure_positive, "k2")

    @property
    def scales(self) -> Scales:
        """Length and time scales d and d/√k."""
        return Scales(self.potential.d, self.potential.d / sqrt(self.potential.strength))

    @abstractmethod
    def _ends(self, q: FloatArray) -> Ends:
        """Return the index pairs (i, j) along which forces act."""

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        u = np.zeros(q.shape)
        return u, net_forces(self.potential, self.k2, q, p, *self._ends(q), u)

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:
        return net_derivatives(self.potential, self.k2, q, *self._ends(q))


@dataclass(frozen=True)
class FixedNetFlocking(_MatchingLaw):
    """u_i = −k₂ Σ_{j~i} (p_i − p_j) − Σ_{j~i} ∇V_ij along the edges of a given net, whatever the distances.

    Its energy is that in the frame of the centre of mass, ½ Σ‖p_i − p̄‖² + Σ over edges of V, and falls by
    k₂ Σ over edges of ‖p_j − p_i‖². Agents that no edge joins do not feel each other, and may meet.

    Parameters
    ----------
    edges : tuple of pairs of int
        The net, each edge once.
    potential : LogPotential
        V.
    k2 : float
        k₂ > 0; the paper has 1.

    Examples
    --------
    >>> law = FixedNetFlocking(edges=((0, 1),))
    >>> law.acceleration(0.0, [[0.0], [1.0], [1.0]], [[0.0], [3.0], [0.0]]).tolist()
    [[3.0], [-3.0], [0.0]]
    """

    edges: tuple[tuple[int, int], ...]
    potential: LogPotential = field(default_factory=LogPotential)
    k2: float = 1.0

    units: ClassVar[Mapping[str, Powers]] = {"k2": (0, -1)}

    def __post_init__(self) -> None:
        normalise(self, ensure_net, "edges")
        super().__post_init__()

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Potential of linked pairs as a function of their distance, with adjacency 1."""
        return (LawFunction("the link potential", self.potential, 1.0, self.k2, edges=self.edges),)

    @cached_property
    def _joined(self) -> Ends:
        i, j = np.array(self.edges, dtype=np.int64).reshape(-1, 2).T
        return i, j

    def _ends(self, q: FloatArray) -> Ends:
        return self._joined

    def check_agents(self, n: int) -> None:  # noqa: D102
        ensure_in_flock("edges", self.edges, n)

    def check_start(self, q: FloatArray, p: FloatArray) -> None:  # noqa: D102
        super().check_start(q, p)
        i, j = self._joined
        for a in np.flatnonzero((q[i] == q[j]).all(axis=1)):
            raise ArgumentError(f"agents {i[a]} and {j[a]} are joined and coincide: expected distinct positions")

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:  # noqa: D102
        i, j = self._joined
        delta, v = q[j] - q[i], moving_frame(p)
        return float(np.sum(self.potential.energy(np.linalg.norm(delta, axis=1)))) + 0.5 * float(np.sum(v * v))


@dataclass(frozen=True)
class ProximityFlocking(_MatchingLaw, SwitchedLaw):
    """Law of `FixedNetFlocking` on the net of all pairs nearer than R, beyond which V is constant.

    Where a pair comes within R its pull and its share of the consensus begin at once: the right-hand side jumps, and
    solutions are Filippov's. `simulate` stops at each switch. The jump is a pull, and consensus vanishes along a pair
    that neither approaches nor recedes: what drives a pair in from outside drives it in from inside, more so. No pair
    is held at R by itself; several at once may be, which is reported as for every switched law.

    Parameters
    ----------
    potential : LogPotential
        V below R.
    r : float
        R > d, from which on there is neither pull nor consensus.
    k2 : float
        k₂ > 0; the paper has 1.

    Examples
    --------
    >>> law = ProximityFlocking(r=2.0)
    >>> law.acceleration(0.0, [[0.0], [1.0], [4.0]], [[0.0], [3.0], [0.0]]).tolist()
    [[3.0], [-3.0], [0.0]]
    """

    potential: LogPotential = field(default_factory=LogPotential)
    r: float = 1.6
    k2: float = 1.0

    units: ClassVar[Mapping[str, Powers]] = {"r": (1, 0), "k2": (0, -1)}
    located = True  # the force always jumps
    slide = " = R: each side drives them into the other"

    def __post_init__(self) -> None:
        super().__post_init__()
        normalise(self, ensure_positive, "r")
        if self.r <= self.potential.d:
            raise ArgumentError(f"r = {self.r:g}: expected more than d = {self.potential.d:g}, where V is least")

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Potential of pairs within R, with adjacency 1."""
        return (LawFunction("the pair potential", Within(self.potential, self.r), 1.0, self.k2),)

    @property
    def surfaces(self) -> tuple[float, ...]:
        """Switching distance of the force: the range R."""
        return (self.r,)

    def check_start(self, q: FloatArray, p: FloatArray) -> None:  # noqa: D102
        super().check_start(q, p)
        ensure_apart(q, "the force of the logarithmic potential is infinite there")

    def pieces(self, q: FloatArray) -> Pieces:
        """Return the branch of the force for every pair: 0 within distance R, 1 beyond."""
        return np.where(_distances(q) < self.r, _NEAR, _FAR).astype(np.int8)

    def piece_flow(self, pieces: Pieces, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        u = np.zeros(q.shape)
        return u, net_forces(self.potential, self.k2, q, p, *_pairs_within(pieces, len(q)), u)

    def _ends(self, q: FloatArray) -> Ends:
        return _pairs_within(self.pieces(q), len(q))

    def margins(self, pieces: Pieces, q: FloatArray) -> Margins:  # noqa: D102
        range_margin = self.r - _distances(q)
        return Margins(np.where(pieces == _NEAR, range_margin, -range_margin), pieces == _NEAR)

    def crossed(self, pieces: Pieces, margins: Margins) -> Pieces:  # noqa: D102
        return np.where(margins.inside < 0.0, _NEAR + _FAR - pieces, pieces).astype(np.int8)

    def held_speed(self, push: float) -> float:  # noqa: D102
        return 1e-9 * self.scales.speed

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:  # noqa: D102
        s, v = np.minimum(_distances(q), self.r), moving_frame(p)
        return float(np.sum(self.potential.energy(s))) + 0.5 * float(np.sum(v * v))


def _pairs_within(pieces: Pieces, n: int) -> Ends:
    """Return the index pairs (i, j) marked as nearer than the range R."""
    i, j = np.triu_indices(n, 1)
    is_near = pieces == _NEAR
    return i[is_near], j[is_near]


def _distances(q: FloatArray) -> FloatArray:
    """Return the distance of every pair i < j, in the order of `numpy.triu_indices`."""
    i, j = np.triu_indices(len(q), 1)
    return np.sqrt(np.sum((q[j] - q[i]) ** 2, axis=1))
