"""Velocity consensus by powers of the differences, over an undirected net."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_positive, normalise
from flockana.interactions.pair_interaction import pair_matrix
from flockana.laws.law import Law
from flockana.measures.perception import ensure_in_flock, ensure_net


@dataclass(frozen=True)
class FiniteTimeAlignment(Law):
    """u_i = a s Σ_j sig((p_j − p_i)/s)^α over links {i, j}, sig(x)^α = sign(x) |x|^α for each component.

    Momentum is conserved; the energy is ½ Σ‖p_i − p̄‖², which falls. For α < 1 velocities agree in a finite time, and
    the law has no derivative where two linked agents have an equal component of velocity: at rest it is not linearised,
    and adaptive steps become very short once velocities agree; end a run by then, or take fixed ones.

    Parameters
    ----------
    links : tuple of (int, int)
        Pairs of agents that hear each other.
    gain : float
        a > 0 (1/time).
    exponent : float
        0 < α <= 1; 1 is the linear law.
    speed : float
        s > 0 (length/time), the difference that is answered as by the linear law.

    Raises
    ------
    ArgumentError
        On numbers that are not positive, an exponent above 1, or links that are no net.

    Examples
    --------
    >>> law = FiniteTimeAlignment(((0, 1),))
    >>> law.acceleration(0.0, [[0.0], [1.0]], [[0.0], [4.0]]).tolist()
    [[2.0], [-2.0]]
    """

    links: tuple[tuple[int, int], ...]
    gain: float = 1.0
    exponent: float = 0.5
    speed: float = 1.0

    references: ClassVar[tuple[str, ...]] = ("wang-xiao-2010",)
    units: ClassVar[Mapping[str, Powers]] = {"gain": (0, -1), "speed": (1, -1)}
    functions = ()  # the net does not depend on distances

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "gain", "exponent", "speed")
        normalise(self, ensure_net, "links")
        if self.exponent > 1.0:
            raise ArgumentError(f"exponent = {self.exponent:g}: expected 0 < exponent <= 1; 1 is the linear law")

    @property
    def scales(self) -> Scales:
        """Time scale 1/a, and length scale s/a."""
        return Scales(self.speed / self.gain, 1.0 / self.gain)

    def check_agents(self, n: int) -> None:  # noqa: D102
        ensure_in_flock("links", self.links, n)

    def _ends(self) -> Any:
        return np.array(self.links, dtype=np.int64).reshape(-1, 2).T

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        (i, j), u = self._ends(), np.zeros(q.shape)
        slip = p[j] - p[i]
        pull = self.gain * self.speed * np.sign(slip) * np.abs(slip / self.speed) ** self.exponent
        np.add.at(u, i, pull)
        np.subtract.at(u, j, pull)
        return u, -float(np.sum(pull * slip))

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:  # noqa: D102
        v = p - p.mean(axis=0)
        return 0.5 * float(np.sum(v * v))

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Any:
        """Return 0 and ∂u/∂p, sparse; raise for α < 1 if two linked agents share a velocity component."""
        from scipy.sparse import csr_array

        i, j = self._ends()
        speed_ratios = np.abs(p[j] - p[i]) / self.speed
        if self.exponent < 1.0 and (zero_entries := np.argwhere(speed_ratios == 0.0)).size:
            one, other = self.links[zero_entries[0, 0]]
            raise ArgumentError(
                f"FiniteTimeAlignment has no derivative at this state: the linked agents {one} and {other} have an "
                f"equal component of velocity, where the slope of |x|^{self.exponent:g} is infinite; expected "
                "velocities that differ along each link in each component, or exponent=1"
            )
        slope = self.gain * self.exponent * speed_ratios ** (self.exponent - 1.0)
        return csr_array((q.size, q.size)), -pair_matrix(i, j, slope[:, :, None] * np.eye(q.shape[1]), len(q))
