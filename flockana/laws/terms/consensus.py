"""Velocity consensus without forces, over a net different from the potential's."""

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from flockana.base.value_checks import FloatArray
from flockana.interactions.distance_functions import LawFunction
from flockana.interactions.pair_interaction import PairInteraction
from flockana.kernels.listed_pairs import no_energy
from flockana.laws.terms.pairs import PairTerm
from flockana.laws.terms.term import Derivatives, Term, TermKernel


@dataclass(frozen=True)
class Consensus(Term):
    """u_i = c Σ_j a_ij (p_j − p_i) with the adjacency of a pair interaction, without its forces.

    It has no potential, and takes energy: its power is −c pᵀL̂p, in every frame.
    """

    net: PairInteraction
    damping: float

    idle: ClassVar[bool] = True

    @cached_property
    def _pairs(self) -> PairTerm:
        return PairTerm(self.net, 0.0, self.damping)

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Net of the consensus, used for its adjacency only."""
        return (LawFunction("the consensus net", self.net, 0.0, self.damping),)

    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:  # noqa: D102
        return self._pairs.act(t, q, p, u)

    def compiled(self, m: int) -> TermKernel | None:  # noqa: D102
        form = self._pairs.compiled(m)
        return None if form is None else form._replace(energy=no_energy)

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:  # noqa: D102
        return self._pairs.derivatives(t, q, p)
