"""Link term: a pair law on a fixed net of pairs, at any distance."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.interactions.distance_functions import LawFunction
from flockana.interactions.pair_interaction import PairInteraction
from flockana.laws.terms.term import Derivatives, Term, TermKernel


@dataclass(frozen=True)
class LinkTerm(Term):
    """u_i = c1 Σ_j w (q_j − q_i) + c2 Σ_j a (p_j − p_i) over the links {i, j} of a net, with the energy c1 Σ ψ."""

    pair: PairInteraction
    links: tuple[tuple[int, int], ...]
    stiffness: float
    damping: float

    @cached_property
    def _ends(self) -> tuple[np.ndarray, np.ndarray]:
        link_ends = np.array(self.links, dtype=np.int32).reshape(-1, 2)
        return np.ascontiguousarray(link_ends[:, 0]), np.ascontiguousarray(link_ends[:, 1])

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Pair law of the links."""
        return (LawFunction("the link potential", self.pair, self.stiffness, self.damping, edges=self.links),)

    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:  # noqa: D102
        par = self.pair.par
        force_kernel = self.pair.kernels.sums(q.shape[1], par.size).forces_of
        return -self.damping * float(force_kernel(q, p, *self._ends, par, self.stiffness, self.damping, u))

    def compiled(self, m: int) -> TermKernel:  # noqa: D102
        link_ends, sums = np.array(self.links, dtype=np.float64).ravel(), self.pair.kernels.sums(m, self.pair.par.size)
        kernel_parameters = np.concatenate([[self.stiffness, self.damping, len(self.links)], link_ends, self.pair.par])
        return TermKernel(sums.act_links, sums.energy_links, kernel_parameters, self.pair.panels, 0.0, numbered=True)

    def energy(self, t: float, q: FloatArray) -> float:  # noqa: D102
        return self.stiffness * float(self.pair.kernels.potential(q, *self._ends, self.pair.par, self.pair.panels))

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:  # noqa: D102
        return self.pair.jacobian(q, p, stiffness=self.stiffness, damping=self.damping, pairs=[self._ends])

    def hessian(self, t: float, q: FloatArray) -> Any:  # noqa: D102
        return self.stiffness * self.pair.hessian(q, pairs=[self._ends])
