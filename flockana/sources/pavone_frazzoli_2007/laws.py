"""Linear cyclic pursuit: each agent moves towards the next one, rotated by an offset angle."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, radians, sin
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.base.value_checks import ComplexArray, FloatArray, ensure_finite_scalar, ensure_positive, normalise
from flockana.laws.first_order_law import VelocityLaw


@dataclass(frozen=True)
class CyclicPursuit(VelocityLaw):
    """dq_i/dt = k R(θ) (q_{i+1} − q_i) in the plane, the last agent pursuing the first: a law of first order.

    Agents meet if |θ| < 180°/n, circle if |θ| = 180°/n, and spread beyond.

    Parameters
    ----------
    gain : float
        k > 0 (1/time).
    angle : float
        θ, by which the line of sight is turned, in degrees from −180 to 180. Theorems take it for the decimal that it
        prints as.

    Raises
    ------
    ArgumentError
        On a gain that is not positive, another angle, one agent, or a space other than the plane.

    Examples
    --------
    >>> CyclicPursuit(2.0, 90.0).velocity(0.0, np.array([[0.0, 0.0], [1.0, 0.0]])).round(12).tolist()
    [[0.0, 2.0], [-0.0, -2.0]]
    """

    gain: float = 1.0
    angle: float = 0.0

    references: ClassVar[tuple[str, ...]] = ("pavone-frazzoli-2007",)
    units: ClassVar[Mapping[str, Powers]] = {"gain": (0, -1)}
    functions = ()  # it depends on no distance

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "gain")
        normalise(self, ensure_finite_scalar, "angle")
        if abs(self.angle) > 180.0:
            raise ArgumentError(f"angle = {self.angle:g}: expected degrees from -180 to 180")

    def check_dimension(self, m: int) -> None:  # noqa: D102
        if m != 2:
            raise ArgumentError(f"m = {m}: cyclic pursuit turns lines of sight in the plane; expected m = 2")

    def check_agents(self, n: int) -> None:  # noqa: D102
        if n < 2:
            raise ArgumentError(f"n = {n}: expected at least two agents, each of which pursues the next")

    @property
    def _turn(self) -> FloatArray:
        c, s = cos(radians(self.angle)), sin(radians(self.angle))
        return self.gain * np.array([[c, -s], [s, c]])

    def velocity(self, t: float, q: FloatArray) -> FloatArray:  # noqa: D102
        return np.asarray((np.roll(q, -1, axis=0) - q) @ self._turn.T)

    def slopes(self, t: float, q: FloatArray) -> Any:
        """Return the Jacobian of the law, (S − 1) ⊗ k R(θ), sparse, S the shift to the next agent."""
        from scipy.sparse import csr_array, kron

        return csr_array(kron(np.roll(np.eye(len(q)), 1, axis=1) - np.eye(len(q)), self._turn))

    def eigenvalues(self, n: int) -> ComplexArray:
        """Return λ_j = k e^{iθ} (e^{2πij/n} − 1), j = 0 … n − 1; with their conjugates all 2n poles."""
        half = np.pi * np.arange(n) / n
        return np.asarray(2.0 * self.gain * np.sin(half) * np.exp(1j * (radians(self.angle) + half + 0.5 * np.pi)))
