"""Dead-zone pair law: repulsion near, attraction far, no force between."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from math import asinh, exp, inf, sinh, sqrt
from typing import Any, ClassVar, NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_finite_scalar, ensure_nonnegative, ensure_positive, normalise
from flockana.interactions.pair_interaction import PairInteraction, Tabulated, evaluate
from flockana.kernels.integral_tables import integral_panels, on_panels
from flockana.kernels.pair_kernels import lift, lift_scalar
from flockana.sources.li_dead_zone.kernels import pair as kernel

_ACTION = lift_scalar(kernel.action)
_FORCE = lift_scalar(kernel.force)
_POTENTIAL = lift_scalar(kernel.potential)
_DEAD_ZONE = lift(
    kernel.pair_dead_zone,
    kernel.pair_dead_zone_slope,
    kernel.pair_dead_zone_potential,
    kernel.pair_dead_zone_adjacency_slope,
)


class Jump(NamedTuple):
    """Jump of the pair force at a distance, with its values on both sides."""

    where: str
    distance: float
    below: float
    above: float


@dataclass(frozen=True)
class DeadZoneInteraction(Tabulated, PairInteraction):
    """The dead-zone pair law of Li, Yuan and Liu, eq. (7)-(9), with gaps filled (errata L1-L3).

    The force along the line from i to j is F(ρ) = f(ρ) ρ/√(1 + ηρ²) + k₁ρ within r and 0 beyond, with
    f = −(2k_r/ρ² + k_δ) below d₁ = r_b − δ, 0 on [d₁, d₂ = r_b + δ] and 2k_r/(r_d − ρ)² + k_δ above: negative repels.
    Its potential is unbounded at 0, but only as −2k_r ln ρ.

    The paper gives r, δ and k_δ; the rest is ours. The defaults put contacts at d₁ = 3.5, so that 50 agents fit within
    r of their centre.

    Parameters
    ----------
    r : float
        Interaction range, in the user's length unit; a pair at r exactly does not interact.
    r_b : float
        Middle of the dead zone, the paper's balance distance.
    delta : float
        Half its width δ, 0 < δ < r_b. With r_b + δ ≥ r only k₁ attracts.
    r_d : float
        Pole of the attraction, r_d > r, or the force would be infinite within reach.
    k_r, k_delta : float
        Strength of the force: k_r > 0 and k_δ ≥ 0.
    eta : float
        η ≥ 0: n_ij = (q_j − q_i)/√(1 + η‖q_j − q_i‖²) is no unit vector.
    k1 : float
        Gain k₁ ≥ 0 of the linear pull among neighbours; it grows with their number and compresses the flock.
    ramp : float
        Length over which the force rises from 0 beside the dead zone. 0 gives the printed jumps; at r the force jumps
        in either case.

    Examples
    --------
    >>> pair = DeadZoneInteraction()
    >>> pair.d1, pair.d2, pair.force([3.5, 8.0, 15.0]).round(12).tolist()
    (3.5, 12.5, [-0.035, -0.08, 0.0])
    >>> [round(float(energy), 3) for energy in pair.energy([1e-3, 3.5, 8.0, 15.0, 99.0])]
    [2926.738, 0.061, 0.32, 5.589, 5.589]
    """

    r: float = 15.0
    r_b: float = 8.0
    delta: float = 4.5
    r_d: float = 40.0
    k_r: float = 200.0
    k_delta: float = 1.3
    eta: float = 1.0
    k1: float = 0.01
    ramp: float = 0.25

    kernels = _DEAD_ZONE
    derived_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {"kernels": ("action", "force", "energy", "values")}
    units: ClassVar[Mapping[str, Powers]] = dict.fromkeys(("r", "r_b", "delta", "r_d", "ramp"), (1, 0)) | {
        "k_r": (2, -2),
        "k_delta": (0, -2),
        "eta": (-2, 0),
        "k1": (0, -2),
    }
    coincidence = False  # the repulsion is infinite at 0

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "r", "r_b", "delta", "r_d", "k_r")
        normalise(self, ensure_nonnegative, "k_delta", "eta", "k1", "ramp")
        if self.delta >= self.r_b:
            raise ArgumentError(
                f"delta = {self.delta:g} and r_b = {self.r_b:g}: expected delta < r_b, or nothing repels (d1 <= 0)"
            )
        if self.r_d <= self.r:
            raise ArgumentError(
                f"r_d = {self.r_d:g} and r = {self.r:g}: expected r_d > r, or the attraction has its pole within range"
            )
        if self.d1 >= self.r:
            raise ArgumentError(
                f"r_b - delta = {self.d1:g} and r = {self.r:g}: expected the dead zone to begin below r"
            )
        if self.ramp >= self.d1:
            raise ArgumentError(f"ramp = {self.ramp:g}: expected less than r_b - delta = {self.d1:g}, such as 0.25")

    @property
    def d1(self) -> float:
        """Lattice constant r_b − δ, where repulsion ends."""
        return self.r_b - self.delta

    @property
    def d2(self) -> float:
        """Distance r_b + δ, where attraction begins."""
        return self.r_b + self.delta

    @property
    def contact_force(self) -> float:
        """Scale of forces: |F| at d₁ without the ramp, (2k_r/d₁² + k_δ) d₁/√(1 + ηd₁²)."""
        return (2.0 * self.k_r / self.d1**2 + self.k_delta) * self.d1 / sqrt(1.0 + self.eta * self.d1**2)

    @property
    def range(self) -> float:
        """The interaction range r."""
        return self.r

    @property
    def length(self) -> float:
        """Lattice constant d₁, the distance of agents in contact."""
        return self.d1

    @property
    def bond_range(self) -> float:
        """Distance d₁ below which a pair is in contact; pairs beyond have no preferred length."""
        return self.d1

    @property
    def surfaces(self) -> tuple[float, ...]:
        """Distances at which the force changes its form: ends of the dead zone, and the range."""
        return tuple(sorted({self.d1, min(self.d2, self.r), self.r}))

    @property
    def seams(self) -> tuple[float, ...]:
        """Distances at which the force changes its formula: ends of dead zone and ramps, and the range."""
        edges = {self.d1 - self.ramp, self.d1, self.d2, self.d2 + self.ramp}
        return tuple(sorted({self.r, *(s for s in edges if s < self.r)}))

    @property
    def feature(self) -> float:
        """Narrowest length of the force, the range d₁ of repulsion; zone ends are watched as `surfaces`."""
        return self.d1

    @property
    def strength(self) -> float:
        """Unit of force: `contact_force`, the force at the end of repulsion."""
        return self.contact_force

    @cached_property
    def far_potential(self) -> float:
        """Potential of a pair out of range, ψ(r) + ½ k₁ r²: continuous at r (erratum L5)."""
        return float(_POTENTIAL(np.array([self.r]), self.par, self.panels)[0])

    def _tabulate(self) -> tuple[FloatArray, FloatArray]:
        """Return kernel parameters, and Chebyshev series of the potential ψ on its ramps within range."""
        edges = self.d1, self.d2, self.r, self.r_d
        par = np.array([self.eta, self.k_r, self.k_delta, self.k1, *edges, self.ramp, 0.0, 0.0])
        panels = np.zeros((0, 0))
        if self.ramp > 0.0:
            free = par.copy()
            free[3] = 0.0

            def ramped(s: FloatArray) -> FloatArray:
                return _FORCE(s, free)

            # F is analytic within each ramp: repulsion's pole at 0 is farther from [d1 - ramp, d1] than d1 - ramp, and
            # narrow panels near it keep the series short
            inner = self.d1 - _fractions(self.ramp, self.d1)[::-1]
            panels = integral_panels(ramped, inner, anchor=self.d1)
            par[kernel.INNER] = on_panels(inner[0], panels)
            if self.d2 < self.r:
                end = min(self.d2 + self.ramp, self.r)
                # beyond r the kernel's force is 0, and at r the rule would meet that jump: stop just short of it
                span = np.array([self.d2, end])
                free[6] = inf
                outer = integral_panels(ramped, span, anchor=self.d2)
                outer[:, 2] -= on_panels(self.d2, outer)
                par[kernel.OUTER] = on_panels(end, outer)
                panels = np.vstack([panels, outer])
        return par, panels

    def action(self, s: Any) -> Any:
        """Return the scalar force f(ρ), the paper's φ_z without direction; negative values repel."""
        return evaluate(_ACTION, s, self.par)

    def jumps(self) -> tuple[Jump, ...]:
        """Return the jumps of the pair force F = dψ/dρ: at r, and without a ramp at d₁ and d₂."""
        jumps = []
        for name, distance in (("d1", self.d1), ("d2", self.d2), ("r", self.r)):
            value_below, above = _FORCE(np.nextafter(distance, [0.0, inf]), self.par).tolist()
            if distance <= self.r and not np.isclose(value_below, above, rtol=1e-9, atol=1e-9 * self.contact_force):
                jumps.append(Jump(name, distance, value_below, above))
        return tuple(jumps)

    def least_distance(self, energy: float) -> float:
        """Return a lower bound of all distances in a flock with at most a given energy.

        For η > 0 and no ramp 1/(√η sinh(H/2k_r + asinh(1/(√η d₁)))), for η = 0 d₁ exp(−H/2k_r): positive, but
        exponentially small. k_δ is left out, and the ramp is taken as if all of it were free of force.

        Parameters
        ----------
        energy : float
            An upper bound of the energy, such as H̄(0).

        Examples
        --------
        >>> round(DeadZoneInteraction(ramp=0.0).least_distance(400.0), 3)
        0.601
        """
        share, b = ensure_finite_scalar("energy", energy) / (2.0 * self.k_r), self.d1 - self.ramp
        if self.eta == 0.0:
            return b * exp(-share)
        root = sqrt(self.eta)
        argument = share + asinh(1.0 / (root * b))
        # sinh overflows beyond 710; there it is half the exponential
        return 1.0 / (root * sinh(argument)) if argument < 700.0 else 2.0 * exp(-argument) / root


def _fractions(ramp: float, d1: float) -> FloatArray:
    """Return Chebyshev panel ends as distances inwards from d₁, 0 to `ramp`, finer towards the pole at 0."""
    marks, left = [0.0], d1
    while left - (d1 - ramp) > 0.5 * left:
        left *= 0.5
        marks.append(d1 - left)
    return np.array([*marks, ramp])
