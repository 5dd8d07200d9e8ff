"""First-order consensus: agents move towards heard neighbours, over any digraph."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray
from flockana.laws.first_order_law import VelocityLaw
from flockana.sources.yu_chen_cao_2010 import NetConsensus


@dataclass(frozen=True)
class AverageConsensus(VelocityLaw):
    """dq_i/dt = Σ_j a_ij (q_j − q_i): q' = −Lq, L the Laplacian of a digraph with weights; a law of first order.

    Parameters
    ----------
    weights : array_like or sparse array, shape (n, n)
        a_ij >= 0, with which agent i hears agent j (1/time); row i is what i hears.

    Raises
    ------
    ArgumentError
        On weights that are no square array of numbers >= 0 with 0 on the diagonal.

    Examples
    --------
    Agent 0 leads, agent 1 hears it:

    >>> AverageConsensus([[0.0, 0.0], [2.0, 0.0]]).velocity(0.0, np.array([[0.0], [1.0]])).tolist()
    [[0.0], [-2.0]]
    """

    weights: Any

    references: ClassVar[tuple[str, ...]] = ("olfati-saber-murray-2004",)
    units: ClassVar[Mapping[str, Powers]] = {"weights": (0, -1)}
    functions = ()  # its weights do not depend on distances

    def __post_init__(self) -> None:
        object.__setattr__(self, "weights", NetConsensus(self.weights).weights)

    @cached_property
    def laplacian(self) -> FloatArray:
        """Laplacian L = diag(Σ_j a_ij) − A, shape (n, n)."""
        return NetConsensus(self.weights).laplacian

    def check_agents(self, n: int) -> None:  # noqa: D102
        NetConsensus(self.weights).check_agents(n)

    def velocity(self, t: float, q: FloatArray) -> FloatArray:  # noqa: D102
        return -self.laplacian @ q

    def slopes(self, t: float, q: FloatArray) -> Any:
        """Return the Jacobian of q' = −Lq: −L for each component of space, sparse."""
        from scipy.sparse import csr_array, eye_array, kron

        return -csr_array(kron(csr_array(self.laplacian), eye_array(q.shape[1]), format="csr"))

    def acceleration(self, t: float, q: FloatArray) -> FloatArray:
        """Return L²q, the rate of the velocities along the motion."""
        return np.asarray(self.laplacian @ (self.laplacian @ q))
