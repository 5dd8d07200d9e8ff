"""Link-keeping flocking: a potential unbounded at the range, after Ji and Egerstedt and Zavlanos et al."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from typing import ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_nonnegative, ensure_positive, normalise
from flockana.interactions.formula import FormulaInteraction
from flockana.laws.sum_of_terms import SumOfTerms
from flockana.laws.terms.fixed_links import LinkTerm
from flockana.laws.terms.term import Term
from flockana.measures.perception import ensure_in_flock, ensure_net


@dataclass(frozen=True)
class LinkKeeping(SumOfTerms):
    """u_i = −Σ_j ∇_i ψ(‖q_j − q_i‖) + c Σ_j (p_j − p_i) over links {i, j}, with ψ(s) = k s²/(r − s).

    The tension is that of Ji and Egerstedt (2007), the second-order law that of Zavlanos, Jadbabaie and Pappas (2007).
    Both let links arise, with hysteresis; here the net is given and does not change. H = Σ ψ + ½ Σ‖p_i‖².

    Parameters
    ----------
    links : tuple of (int, int)
        Pairs of agents that are linked at all times.
    r : float
        Length that no link reaches.
    k, c : float
        Strength of the tension, and gain of the velocity differences.

    Examples
    --------
    >>> law = LinkKeeping(((0, 1),), r=2.0)
    >>> law.acceleration(0.0, [[0.0], [1.0], [5.0]], [[0.0], [0.0], [0.0]]).ravel().tolist()
    [3.0, -3.0, 0.0]
    """

    links: tuple[tuple[int, int], ...]
    r: float = 1.0
    k: float = 1.0
    c: float = 1.0

    references: ClassVar[tuple[str, ...]] = ("ji-egerstedt-2007", "zavlanos-2007")
    units: ClassVar[Mapping[str, Powers]] = {"r": (1, 0), "k": (1, -2), "c": (0, -1)}
    surfaces = ()  # no force begins or ends at a distance
    pair = None  # the net and not the distance decides which agents interact
    lattice = None  # links have no preferred length

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "r", "k")
        normalise(self, ensure_nonnegative, "c")
        normalise(self, ensure_net, "links")

    @cached_property
    def tension(self) -> FormulaInteraction:
        """Pair interaction of links: the potential ψ(s) = k s²/(r − s), with adjacency 1."""
        return FormulaInteraction(
            "k*s**2/(r - s)", adjacency_formula="1", r=self.r, d=0.5 * self.r, parameters=(("k", self.k),)
        )

    @cached_property
    def terms(self) -> tuple[Term, ...]:
        """Terms of the law: the forces along its links."""
        return (LinkTerm(self.tension, self.links, 1.0, self.c),)

    @property
    def scales(self) -> Scales:
        """Length r, and the time in which k moves an agent by r."""
        return Scales(self.r, sqrt(self.r / self.k))

    @property
    def poles(self) -> tuple[float, ...]:
        """Distances at which the potential is infinite: r, which no link may reach."""
        return (self.r,)

    @property
    def pole_pairs(self) -> tuple[tuple[int, int], ...]:
        """Pairs of linked agents, whose potential is infinite at the distance r."""
        return self.links

    def check_agents(self, n: int) -> None:
        """Raise if a link names an agent outside the flock."""
        ensure_in_flock("links", self.links, n)

    def check_start(self, q: FloatArray, p: FloatArray) -> None:
        """Raise unless every link is shorter than r, where the potential is infinite."""
        super().check_start(q, p)
        for (i, j), distance in zip(self.links, self.lengths(q), strict=True):
            if distance >= self.r:
                raise ArgumentError(f"link ({i}, {j}) is {distance:g} long: expected links shorter than r = {self.r:g}")

    def lengths(self, q: FloatArray) -> FloatArray:
        """Return the length of each link."""
        link_ends = np.array(self.links, dtype=np.int64).reshape(-1, 2)
        return np.linalg.norm(q[link_ends[:, 1]] - q[link_ends[:, 0]], axis=1)

    def longest(self, energy: float) -> float:
        """Return the length s < r at which one link stores all the energy: k s²/(r − s) = H.

        Parameters
        ----------
        energy : float
            H, the energy of the flock.
        """
        root = sqrt(energy * energy + 4.0 * self.k * energy * self.r)
        return 2.0 * energy * self.r / (energy + root) if energy > 0.0 else 0.0
