"""Directed edges of the minimal model, with their weights and lengths."""

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray, PerAgent
from flockana.sources.jond_2025.interactions.zones import Table


class EdgeData(NamedTuple):
    """Weights and spacings of the directed edges, arrays of shape (M,)."""

    head: npt.NDArray[np.int64]
    tail: npt.NDArray[np.int64]
    mu: FloatArray
    rho: FloatArray
    align: FloatArray


def weighed_edges(law: Any, head: npt.NDArray[np.int64], tail: npt.NDArray[np.int64]) -> EdgeData:
    """Return the weights and spacings of edges from the parameters of a `MinimalFlocking`."""

    def of_agent(value: PerAgent) -> Any:
        return value if isinstance(value, float) else np.array(value)[head]

    def of_pair(value: Table) -> FloatArray:
        return np.full(head.size, value) if isinstance(value, float) else np.array(value)[head, tail]

    if law.spacing is not None:
        rho = of_agent(law.spacing)
    else:
        count = np.bincount(head)[head]
        rho = count if law.beta is None else of_agent(law.beta) * of_agent(law.radius) * count
    align_weights = of_pair(law.sigma)
    if law.normalised:
        total = np.bincount(head, align_weights)[head]
        align_weights = np.divide(align_weights, total, out=np.zeros_like(align_weights), where=total > 0.0)
    return EdgeData(head, tail, of_pair(law.mu), np.full(head.size, rho, dtype=np.float64), align_weights)
