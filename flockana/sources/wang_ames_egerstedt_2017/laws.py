"""Safety filter: the least change of inputs that keeps agents apart, by control barrier functions of pairs."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_kind, ensure_positive, normalise
from flockana.laws.law import Law
from flockana.laws.wrapper_base import Wrapper, WrappingLaw


@dataclass(frozen=True)
class SafetyFilter(WrappingLaw):
    """Law whose inputs are changed by the least Σ‖Δu_i‖² under which h_ij' >= −γ h_ij³ for each pair.

    h_ij = √(2c(r − D)) + r', r the distance of the pair and c = 2α the most by which two agents can brake; h > 0 says
    that braking keeps them D apart. Two agents have the change in closed form, more by a least-squares problem over
    all pairs, which takes long for more than some tens of agents. The inputs themselves are not limited.

    Parameters
    ----------
    law : Law
        Continuous law of second order.
    distance : float
        D > 0, which pairs keep.
    acceleration_limit : float
        α > 0, with which an agent can brake.
    gain : float
        γ > 0 (time/length²), how fast h may fall.

    Raises
    ------
    ArgumentError
        On numbers that are not positive, or a law with a past, a clock or noise.

    Examples
    --------
    Two agents at rest at the distance 3 are pulled together; none of it is changed as long as h is large:

    >>> import flockana as fl
    >>> law = SafetyFilter(fl.NetConsensus([[0, 1], [1, 0]]), distance=1.0, acceleration_limit=1.0)
    >>> law.acceleration(0.0, [[0.0], [3.0]], [[0.0], [0.0]]).tolist()
    [[3.0], [-3.0]]
    >>> law.acceleration(0.0, [[0.0], [3.0]], [[1.4], [-1.4]]).round(3).tolist()
    [[-0.99], [0.99]]
    """

    law: Law
    distance: float
    acceleration_limit: float = 1.0
    gain: float = 1.0

    references: ClassVar[tuple[str, ...]] = ("wang-ames-egerstedt-2017",)
    units: ClassVar[Mapping[str, Powers]] = {"distance": (1, 0), "acceleration_limit": (1, -2), "gain": (-2, 1)}

    def __post_init__(self) -> None:
        ensure_kind("law", self.law, Law, "a continuous law of second order such as Algorithm1()")
        if isinstance(self.law, Wrapper):
            raise ArgumentError(f"law is a {self.law.title}: expected the law without delays, clocks, noise and limits")
        normalise(self, ensure_positive, "distance", "acceleration_limit", "gain")

    def check_start(self, q: FloatArray, p: FloatArray) -> None:  # noqa: D102
        super().check_start(q, p)
        i, j = np.triu_indices(len(q), 1)
        if (same := np.flatnonzero((q[i] == q[j]).all(axis=1))).size:
            raise ArgumentError(f"agents {i[same[0]]} and {j[same[0]]} are at one place: expected distinct places")

    def barriers(self, q: FloatArray, p: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return h, unit vectors from j to i, and lower bounds of u_i − u_j along them, for pairs i < j."""
        (i, j), c = np.triu_indices(len(q), 1), 2.0 * self.acceleration_limit
        x, v = q[i] - q[j], p[i] - p[j]
        r = np.linalg.norm(x, axis=1)
        with np.errstate(invalid="ignore"):  # at one place there is no way apart
            directions = x / r[:, None]
        speed = np.sum(directions * v, axis=1)
        s = np.sqrt(2.0 * c * np.maximum(r - self.distance, 0.0))
        with np.errstate(divide="ignore", invalid="ignore"):  # below h = 0 they brake as at it
            rate = np.where((s > 0.0) & (speed > -s), c * speed / s, -c)
            turning_rate = np.maximum(np.sum(v * v, axis=1) - speed**2, 0.0) / r
        h = s + speed
        return h, directions, -self.gain * h**3 - rate - turning_rate

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        u = self.law.flow(t, q, p)[0]
        i, j = np.triu_indices(len(q), 1)
        _, along, lower_bounds = self.barriers(q, p)
        lack = lower_bounds - np.sum(along * (u[i] - u[j]), axis=1)
        if (lack <= 0.0).all():
            return u, float("nan")
        if np.isnan(lack).any():  # two agents at one place
            return np.full_like(u, np.nan), float("nan")
        if len(q) == 2:
            return u + 0.5 * lack[0] * np.stack([along[0], -along[0]]), float("nan")
        is_asking = np.isfinite(lack)
        return u + _least_change(along[is_asking], (i[is_asking], j[is_asking]), lack[is_asking], q.shape), float("nan")


def _least_change(along: FloatArray, pairs: Any, lack: FloatArray, shape: tuple[int, ...]) -> FloatArray:
    """Return the smallest input changes x with along · (x_i − x_j) >= lack per pair (Lawson and Hanson)."""
    from scipy.optimize import nnls

    rows, unit = np.zeros((len(lack), *shape)), float(lack.max())
    k = np.arange(len(lack))
    rows[k, pairs[0]], rows[k, pairs[1]] = along, -along
    stacked_rows = np.vstack([rows.reshape(len(lack), -1).T, lack / unit])
    aim = np.zeros(len(stacked_rows))
    aim[-1] = 1.0
    residual = stacked_rows @ nnls(stacked_rows, aim)[0] - aim
    return np.asarray(-unit * residual[:-1].reshape(shape) / residual[-1])
