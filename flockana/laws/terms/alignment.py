"""The alignment term: velocity consensus alone, with any weight of the distance, near or far."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.interactions.distance_functions import LawFunction
from flockana.interactions.pair_interaction import pair_matrix
from flockana.interactions.weights import Weight
from flockana.kernels.listed_pairs import no_energy
from flockana.laws.terms.pairs import ensure_apart
from flockana.laws.terms.term import Derivatives, Term, TermKernel


@dataclass(frozen=True)
class AlignmentTerm(Term):
    """u_i = g Σ_j a(‖q_j − q_i‖) (p_j − p_i), with no energy and the power −g Σ_{i<j} a_ij ‖p_j − p_i‖².

    Parameters
    ----------
    weight : Weight
        a; a weight of infinite range couples all pairs, at a cost that grows as n².
    gain : float
        g >= 0.
    mean : bool
        Whether the sum is divided by the number of agents.

    Examples
    --------
    >>> from flockana.interactions.weights import RationalWeight
    >>> u = np.zeros((2, 1))
    >>> AlignmentTerm(RationalWeight(2.0, 1.0)).act(0.0, np.array([[0.0], [1.0]]), np.array([[0.0], [3.0]]), u)
    -9.0
    >>> u.tolist()
    [[3.0], [-3.0]]
    """

    weight: Weight
    gain: float = 1.0
    mean: bool = False

    idle: ClassVar[bool] = True

    def _gain(self, n: int) -> float:
        """Return the gain g, divided by n if the consensus is a mean."""
        return self.gain / n if self.mean else self.gain

    @property
    def functions(self) -> tuple[LawFunction, ...]:
        """Weight function of the alignment."""
        return (LawFunction("the alignment weight", self.weight, 0.0, self.gain, mean=self.mean),)

    def check_start(self, q: FloatArray) -> None:
        """Raise if two agents coincide at a pole of the weight."""
        if not self.weight.coincidence:
            ensure_apart(q, "the alignment weight has a pole there")

    def act(self, t: float, q: FloatArray, p: FloatArray, u: FloatArray) -> float:  # noqa: D102
        gain, r = self._gain(len(q)), self.weight.range
        return -gain * self.weight.kernels.match(q, p, gain, r * r, self.weight.par, u)

    def compiled(self, m: int) -> TermKernel | None:  # noqa: D102
        r = self.weight.range
        numbers = np.concatenate([[self.gain, float(self.mean), r], self.weight.par])
        return TermKernel(self.weight.kernels.act, no_energy, numbers, np.empty((0, 0)), r if np.isfinite(r) else 0.0)

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:  # noqa: D102
        (n, m), kernels, gain = q.shape, self.weight.kernels, self._gain(len(q))
        i, j = np.triu_indices(n, 1)
        delta, slip = q[j] - q[i], p[j] - p[i]
        s2 = np.einsum("kc,kc->k", delta, delta)
        near = s2 < self.weight.range**2
        i, j, delta, slip, s2 = i[near], j[near], delta[near], slip[near], s2[near]
        pull = gain * kernels.weight(s2, self.weight.par)[:, None, None] * np.eye(m)
        bend = 2.0 * gain * kernels.slope(s2, self.weight.par)[:, None, None] * slip[:, :, None] * delta[:, None, :]
        return pair_matrix(i, j, -bend, n), pair_matrix(i, j, -pull, n)
