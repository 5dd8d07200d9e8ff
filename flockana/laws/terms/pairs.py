"""The pair term: a gradient of pair potentials and velocity consensus, in one sum over neighbours."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.interactions.distance_functions import LawFunction
from flockana.interactions.pair_interaction import PairInteraction
from flockana.kernels.listed_pairs import listed_numbers
from flockana.laws.terms.term import Derivatives, Term, TermKernel


def ensure_apart(q: FloatArray, why: str = "the pair force has no limit there") -> None:
    """Raise if two agents coincide; the error says why they may not."""
    order = np.lexsort(q.T)
    coincident_pairs = np.flatnonzero((q[order][1:] == q[order][:-1]).all(axis=1))
    if coincident_pairs.size:
        i, j = sorted(int(k) for k in order[coincident_pairs[0] : coincident_pairs[0] + 2])
        raise ArgumentError(f"agents {i} and {j} coincide: {why}; expected distinct positions")


_SUMS = ("forces", "potential_energy")  # as every pair law has them, from its scalar functions


@dataclass(frozen=True)
class PairTerm(Term):
    """u_i = c1 Σ_j φ n_ij + c2 Σ_j a_ij (p_j − p_i), with the energy c1 V and the power −c2 pᵀL̂p.

    Parameters
    ----------
    pair : PairInteraction
        The pair law.
    stiffness, damping : float
        Gains c1 and c2.

    Examples
    --------
    >>> import numpy as np
    >>> from flockana.interactions import AlphaInteraction
    >>> u = np.zeros((2, 1))
    >>> power = PairTerm(AlphaInteraction(), 1.0, 1.0).act(0.0, np.array([[0.0], [8.0]]), np.zeros((2, 1)), u)
    >>> power == 0.0, bool(u[0, 0] == -u[1, 0] > 0.0)
    (True, True)
    """

    pair: PairInteraction
    stiffness: float
    damping: float

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Functions of the distance of two agents in the pair term: the pair law, with its gains c1 and c2."""
        return (LawFunction("the pair law", self.pair, self.stiffness, self.damping),)

    def check_start(self, q: FloatArray) -> None:
        """Raise if two agents coincide and their force has no limit."""
        if not self.pair.coincidence:
            ensure_apart(q)

    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:  # noqa: D102
        _, dissipation = self.pair.forces(q, p, stiffness=self.stiffness, damping=self.damping, out=u)
        return -self.damping * dissipation

    def compiled(self, m: int) -> TermKernel | None:  # noqa: D102
        pair = self.pair
        if not (
            np.isfinite(pair.range)
            and all(getattr(type(pair), name) is getattr(PairInteraction, name) for name in _SUMS)
        ):
            return None
        kernel_parameters = listed_numbers(self.stiffness, self.damping, pair.range, pair.far_potential, pair.par)
        sums = pair.kernels.sums(m, pair.par.size)
        return TermKernel(sums.act, sums.energy, kernel_parameters, pair.panels, pair.range)

    def energy(self, t: float, q: FloatArray) -> float:  # noqa: D102
        return self.stiffness * self.pair.potential_energy(q)

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:  # noqa: D102
        return self.pair.jacobian(q, p, stiffness=self.stiffness, damping=self.damping)

    def hessian(self, t: float, q: FloatArray) -> Any:  # noqa: D102
        return self.stiffness * self.pair.hessian(q)
