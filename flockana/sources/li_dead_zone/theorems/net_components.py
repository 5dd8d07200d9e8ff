"""Components of a dead-zone flock's net, with proofs of which stay together or separate.

While no two components meet, each has a centre of constant velocity and an energy H̄ of its own that does not rise. Two
things keep a component together:

* its energy: no pair's potential is negative, so at most M = ⌊H̄/ψ̄(r)⌋ of its pairs are ever out of range. If
  M < n - 1 it stays connected, for a cut leaves at least n - 1 pairs out of range; then the steps in the net from one
  agent to all others are at most n - 1 + M in number, as each step beyond the first leaves a pair out of range. So
  nobody gets farther from the centre than B = r (n - 1 + M)/n. With k₂ > 0 its velocities then match: the net's least
  eigenvalue but 0 stays above a positive number, so ∫K dt is finite, and dK/dt is bounded as no two agents come closer
  than an explicit distance (Barbalat's lemma).
* a strict minimum of its potential (`local_basin`): nobody then gets farther than now, but for
  the little way to it. That holds of a map of semi-implicit Euler steps as well, whose energy may rise.

Two components never meet if their centres, at constant velocities, never come closer than r + B + B'. Of a map that
is not held this is said of the flow from its last state.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import floor, inf, sqrt

import numpy as np
import numpy.typing as npt

from flockana.measures.nets import components, links
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.li_dead_zone.theorems.local_basin import hold
from flockana.theorems.energy_basins import Basin
from flockana.theorems.theorem_toolkit import EPS, Certificate, FloatArray

_WHOLE = 1e-12  # of a number of pairs, by which rounding may make it a whole one


@dataclass(frozen=True, eq=False)
class Component:
    """Connected component of the net at one instant, with certificates valid while no others come into range."""

    law: DeadZoneFlocking
    q: FloatArray
    p: FloatArray
    dt: float | None = None
    off: float = 0.0
    p_off: float = 0.0
    energy_off: float = 0.0

    @property
    def size(self) -> int:
        """Number of agents in the component."""
        return len(self.q)

    @cached_property
    def mismatch(self) -> float:
        """Velocity mismatch K̃ = ½ Σ‖p_i − p̄‖²/n of the component."""
        return 0.5 * float(np.sum((self.p - self.p.mean(axis=0)) ** 2)) / self.size

    @cached_property
    def basin(self) -> Basin:
        """Basin of the potential's minimum near the component."""
        return hold(self.law, self.q, self.p, self.dt, off=self.off, p_off=self.p_off)

    @cached_property
    def _out_of_range(self) -> float:
        """Upper bound H̄/ψ̄(r) of the number of pairs that the energy can drive out of range."""
        far_energy = self.law.interaction.far_potential
        energy: float = self.law.hamiltonian(0.0, self.q, self.p) + self.energy_off
        return energy / far_energy if far_energy > 0.0 else inf

    @property
    def bond(self) -> Certificate:
        """Certificate by energy that the component stays connected and its velocities match; for flows only."""
        if self.size == 1:
            return Certificate(1.0, "one agent has one velocity")
        if self.dt is not None or self.law.k2 == 0.0:
            return Certificate(-1.0, "no energy holds it together")
        margin = max(-1.0, 1.0 - self._out_of_range / (self.size - 1.0))
        energy_text = "too few to break it up" if margin > 0.0 else "which might break it up"
        text = f"its energy can put {self._out_of_range:.3g} pairs out of range, {energy_text}"
        return Certificate(margin, text, _WHOLE + self.size**2 * EPS)

    @property
    def settles(self) -> Certificate:
        """Certificate, by energy or by a basin, that the component's velocities match in the limit."""
        return self.bond if self.bond.certain else self.basin.certificate

    @cached_property
    def radius(self) -> float:
        """Upper bound of any agent's distance from the component's centre at all times; ∞ if it might split."""
        if self.size == 1:
            return 0.0
        if self.basin.certificate.certain:
            radius = float(np.linalg.norm(self.q - self.q.mean(axis=0), axis=1).max())
            return radius + 2.0 * self.off + self.basin.reach
        pairs, n = self._out_of_range * (1.0 + _WHOLE) + _WHOLE, self.size
        return self.law.interaction.r * (n - 1 + floor(pairs)) / n if pairs < n - 1 else inf


@dataclass(frozen=True, eq=False)
class Components:
    """Connected components of a flock's net at one instant."""

    members: tuple[Component, ...]
    r: float

    @property
    def count(self) -> int:
        """Number of components."""
        return len(self.members)

    @property
    def mismatch(self) -> float:
        """Largest velocity mismatch K̃ within any component."""
        return max(component.mismatch for component in self.members)

    @cached_property
    def drift(self) -> float:
        """Mismatch K̃ of the centres, ½ Σ n_c‖v_c − v̄‖²/n, the limit of K̃ if no two components meet."""
        agent_counts, velocity = self._sizes, np.array([component.p.mean(axis=0) for component in self.members])
        mean = np.average(velocity, axis=0, weights=agent_counts)
        return 0.5 * float(agent_counts @ np.sum((velocity - mean) ** 2, axis=1)) / float(agent_counts.sum())

    @property
    def apart(self) -> Certificate:
        """Certificate that no two components ever meet, with the clearance of their paths as margin."""
        margin, error = self._clearance
        clear = margin > error
        return Certificate(float(np.clip(margin, -1.0, 1.0)), f"components {'never' if clear else 'may'} meet", error)

    @cached_property
    def _clearance(self) -> tuple[float, float]:
        """Return the least clearance of two centres' paths beyond r, and its rounding error."""
        if self.count == 1:
            return inf, EPS
        centre, velocity = (np.array([getattr(c, x).mean(axis=0) for c in self.members]) for x in "qp")
        radius = np.array([component.radius for component in self.members])
        a, b = np.triu_indices(self.count, 1)
        x, v = centre[b] - centre[a], velocity[b] - velocity[a]
        speed2 = np.sum(v**2, axis=1)
        when = np.maximum(0.0, -np.sum(x * v, axis=1)) / np.where(speed2 > 0.0, speed2, 1.0)
        nearest = np.linalg.norm(x + when[:, None] * v, axis=1)
        blur = self._velocity_error[a] + self._velocity_error[b]
        turned = np.divide(4.0 * blur, np.sqrt(speed2), out=np.ones_like(blur), where=4.0 * blur < np.sqrt(speed2))
        bent = float((np.linalg.norm(x, axis=1) * np.where(blur > 0.0, turned, 0.0)).max())
        extent = max(float(np.abs(component.q).max()) for component in self.members)
        n = float(self._sizes.max())
        off = max(component.off for component in self.members)
        error = (n + 16.0) * EPS * (extent + self.r) + bent + 2.0 * off
        return float((nearest - self.r - radius[a] - radius[b]).min()) / self.r, error / self.r

    @cached_property
    def separation(self) -> Certificate:
        """Certificate that no two components ever meet, and that their centres move apart without bound."""
        # The margin is the lesser of that of `apart` and of the drift over the square of the law's speed scale.
        if self.count == 1:
            return Certificate(-1.0, "the flock is one component")
        unit = self.members[0].law.scales.speed
        speed_error, drift = 2.0 * float(self._velocity_error.max()) / unit, self.drift / unit**2
        drift_error = 4.0 * speed_error * (sqrt(drift) + speed_error) + 64.0 * EPS * drift
        margin, error = min(self._clearance, (drift, drift_error), key=lambda pair: pair[0] - pair[1])
        text = f"{self.count} {self.apart.text}, and their centres keep a K̃ of {self.drift:.4g}"
        return Certificate(float(np.clip(margin, -1.0, 1.0)), text, error)

    @cached_property
    def _velocity_error(self) -> FloatArray:
        """Return the rounding error of the velocity of each component's centre."""
        rounding = [(c.size + 2) * EPS * float(np.abs(c.p).max()) if c.size > 1 else 0.0 for c in self.members]
        return np.array([c.p_off + own_rounding for c, own_rounding in zip(self.members, rounding, strict=True)])

    @property
    def _sizes(self) -> FloatArray:
        return np.array([component.size for component in self.members], dtype=np.float64)


def components_of(
    q: FloatArray,
    p: FloatArray,
    law: DeadZoneFlocking,
    dt: float | None = None,
    *,
    off: float = 0.0,
    p_off: float = 0.0,
    energy_off: Callable[[npt.NDArray[np.intp]], float] = lambda agents: 0.0,
) -> Components:
    """Return the connected components of the net of pairs within range r."""
    label = components(len(q), links(q, law.interaction.r))
    groups = [np.flatnonzero(label == k) for k in range(int(label.max()) + 1)]
    members = (Component(law, q[g], p[g], dt, off, p_off, energy_off(g)) for g in groups)
    return Components(tuple(members), law.interaction.r)
