"""Linear consensus laws: agents move towards heard positions and velocities, over any digraph."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_nonnegative, ensure_numbers, normalise
from flockana.laws.wrapper_base import HearingLaw

_WANTED = "a square array of weights a_ij >= 0, with which agent i hears agent j"


def ensure_weights(name: str, value: Any) -> tuple[tuple[float, ...], ...]:
    """Return the weights of a digraph as rows of numbers, with 0 on the diagonal."""
    weights = ensure_numbers(name, value.toarray() if hasattr(value, "toarray") else value, _WANTED)
    if weights.ndim != 2 or weights.shape[0] != weights.shape[1] or not weights.size:
        raise ArgumentError(f"{name} has shape {weights.shape}: expected {_WANTED}")
    is_invalid = ~np.isfinite(weights) | (weights < 0.0)
    if is_invalid.any():
        i, j = np.argwhere(is_invalid)[0].tolist()
        raise ArgumentError(f"{name}[{i}, {j}] = {weights[i, j]:g}: expected {_WANTED}")
    if np.diag(weights).any():
        i = int(np.diag(weights).nonzero()[0][0])
        raise ArgumentError(f"{name}[{i}, {i}] = {weights[i, i]:g}: expected 0, as no agent hears itself")
    return tuple(map(tuple, weights.tolist()))


@dataclass(frozen=True)
class NetConsensus(HearingLaw):
    """u_i = Σ_j a_ij (α (q_j − q_i) + β (p_j − p_i)): u = −L(αq + βp), L the Laplacian of a digraph with weights.

    On a symmetric net the energy is ½ α Σ_{i<j} a_ij ‖q_j − q_i‖² + ½ Σ ‖p_i − p̄‖²; on others none is known.

    Parameters
    ----------
    weights : array_like or sparse array, shape (n, n)
        a_ij >= 0, with which agent i hears agent j, pure numbers; row i is what i hears.
    position, velocity : float
        α >= 0 (1/time²) and β >= 0 (1/time).

    Raises
    ------
    ArgumentError
        On weights that are no square array of numbers >= 0 with 0 on the diagonal, or negative gains.

    Examples
    --------
    Agent 0 leads, agent 1 hears it:

    >>> law = NetConsensus([[0.0, 0.0], [1.0, 0.0]], position=2.0, velocity=3.0)
    >>> law.acceleration(0.0, [[0.0], [1.0]], [[0.0], [1.0]]).tolist()
    [[0.0], [-5.0]]
    """

    weights: Any
    position: float = 1.0
    velocity: float = 1.0

    references: ClassVar[tuple[str, ...]] = ("ren-atkins-2007",)
    units: ClassVar[Mapping[str, Powers]] = {"position": (0, -2), "velocity": (0, -1)}
    functions = ()  # its weights do not depend on distances

    def __post_init__(self) -> None:
        normalise(self, ensure_weights, "weights")
        normalise(self, ensure_nonnegative, "position", "velocity")

    @cached_property
    def laplacian(self) -> FloatArray:
        """Laplacian L = diag(Σ_j a_ij) − A, shape (n, n): row i for what agent i hears."""
        weights = np.array(self.weights)
        return np.asarray(np.diag(weights.sum(axis=1)) - weights)

    @cached_property
    def symmetric(self) -> bool:
        """Whether all pairs hear each other with equal weights."""
        weights = np.array(self.weights)
        return bool((weights == weights.T).all())

    @property
    def conservative(self) -> bool:
        """Whether the net is symmetric, so that the resting force is a gradient."""
        return self.symmetric

    def check_agents(self, n: int) -> None:  # noqa: D102
        if n != len(self.weights):
            raise ArgumentError(f"weights are of {len(self.weights)} agents and the state is of {n}: expected one net")

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        u = -self.laplacian @ (self.position * q + self.velocity * p)
        rate = -self.velocity * float(np.sum(p * (self.laplacian @ p))) if self.symmetric else float("nan")
        return u, rate

    def heard_input(  # noqa: D102
        self, own: tuple[FloatArray, FloatArray], heard: tuple[FloatArray, FloatArray], linked: Any
    ) -> FloatArray:
        weights = np.array(self.weights) if linked is None else np.where(linked, self.weights, 0.0)
        q, p = (neighbour_state - agent_state[:, None] for agent_state, neighbour_state in zip(own, heard, strict=True))
        return np.einsum("ij,ijk->ik", weights, self.position * q + self.velocity * p)

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:  # noqa: D102
        if not self.symmetric:
            return float("nan")
        v = p - p.mean(axis=0)
        return 0.5 * self.position * float(np.sum(q * (self.laplacian @ q))) + 0.5 * float(np.sum(v * v))

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Any:
        """Return ∂u/∂q = −αL and ∂u/∂p = −βL for each component of space, sparse."""
        from scipy.sparse import csr_array, eye_array, kron

        full_matrix = csr_array(kron(csr_array(self.laplacian), eye_array(q.shape[1]), format="csr"))
        return -self.position * full_matrix, -self.velocity * full_matrix
