"""Formations by distances: agents without inertia that descend the squared errors of squared lengths."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_positive, normalise, per_agent
from flockana.laws.first_order_law import VelocityLaw
from flockana.measures.perception import ensure_in_flock, ensure_net


@dataclass(frozen=True)
class DistanceFormation(VelocityLaw):
    """dq_i/dt = k Σ_{j~i} (‖q_j − q_i‖² − d_ij²)(q_j − q_i) along the links of a given net: a law of first order.

    Parameters
    ----------
    edges : tuple of pairs of int
        The links, each once.
    lengths : float or sequence of float
        d_ij > 0, one for all links, or one for each in the order of `edges`.
    gain : float
        k > 0 (1/(length² time)).

    Raises
    ------
    ArgumentError
        On links that are no net, or lengths or a gain that are not positive.

    Examples
    --------
    >>> law = DistanceFormation(((0, 1),), 1.0)
    >>> law.velocity(0.0, np.array([[0.0], [2.0]])).tolist(), law.errors(np.array([[0.0], [2.0]])).tolist()
    ([[6.0], [-6.0]], [3.0])
    """

    edges: tuple[tuple[int, int], ...]
    lengths: float | tuple[float, ...] = 1.0
    gain: float = 1.0

    references: ClassVar[tuple[str, ...]] = ("krick-2009",)
    units: ClassVar[Mapping[str, Powers]] = {"lengths": (1, 0), "gain": (-2, -1)}
    functions = ()  # polynomials of positions, which steps of any length resolve

    def __post_init__(self) -> None:
        edges = list(self.edges) if isinstance(self.edges, Iterable) else self.edges
        object.__setattr__(self, "edges", ensure_net("edges", edges))  # sorted, and the lengths with them
        normalise(self, per_agent, "lengths")
        normalise(self, ensure_positive, "gain")
        if not self.edges:
            raise ArgumentError("edges = (): expected at least one link")
        if np.ndim(self.lengths) and np.size(self.lengths) != len(self.edges):
            raise ArgumentError(f"{np.size(self.lengths)} lengths of {len(self.edges)} links: expected one for each")
        if np.ndim(self.lengths):
            desired_lengths = {
                tuple(sorted(map(int, edge))): d for edge, d in zip(edges, np.ravel(self.lengths), strict=True)
            }
            object.__setattr__(self, "lengths", tuple(float(desired_lengths[edge]) for edge in self.edges))

    @property
    def scales(self) -> Scales:
        """Length and time scales: the largest length d, and the time 1/(k d²)."""
        d = float(np.max(self.lengths))
        return Scales(d, 1.0 / (self.gain * d * d))

    def check_agents(self, n: int) -> None:  # noqa: D102
        ensure_in_flock("edges", self.edges, n)

    def _links(self, q: FloatArray) -> tuple[Any, Any, FloatArray]:
        """Return the two agent indices of each link, and their position differences."""
        i, j = np.array(self.edges, dtype=np.int64).reshape(-1, 2).T
        return i, j, q[j] - q[i]

    def errors(self, q: FloatArray) -> FloatArray:
        """Return the error of each link's squared length, ‖q_j − q_i‖² − d_ij²."""
        z = self._links(q)[2]
        return np.asarray(np.einsum("ek,ek->e", z, z) - np.square(self.lengths))

    def rows(self, q: FloatArray) -> FloatArray:
        """Return the rigidity matrix R of shape (links, nm): the law is q' = −k Rᵀ errors."""
        i, j, z = self._links(q)
        full_matrix, agents = np.zeros((len(z), *q.shape)), np.arange(len(z))
        full_matrix[agents, j], full_matrix[agents, i] = z, -z
        return full_matrix.reshape(len(z), q.size)

    def velocity(self, t: float, q: FloatArray) -> FloatArray:  # noqa: D102
        (i, j, z), v = self._links(q), np.zeros_like(q)
        with np.errstate(over="ignore", invalid="ignore"):  # at a trial step far away, which is rejected
            pull = self.gain * (np.einsum("ek,ek->e", z, z) - np.square(self.lengths))[:, None] * z
            np.add.at(v, i, pull)
            np.add.at(v, j, -pull)
        return v

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Any) -> Mapping[str, Any]:  # noqa: D102
        largest = np.array([np.abs(self.errors(item)).max(initial=0.0) for item in q])
        return {"length_error": ("largest |‖q_j − q_i‖² − d²| of a link (length²)", largest, True)}
