"""The parts of a dead-zone flock, and what is certain of them for ever: what holds one together, which of them part.

While no two parts meet, each has a centre of constant velocity and an energy H̄ of its own that does not rise. Two
things hold a part together:

* its energy: no pair's potential is negative, so at most M = ⌊H̄/ψ̄(r)⌋ of its pairs are ever out of range. If
  M < n - 1 it stays connected, for a cut leaves at least n - 1 pairs out of range; then the steps in the net from one
  agent to all others are at most n - 1 + M in number, as each step beyond the first leaves a pair out of range. So
  nobody gets farther from the centre than B = r (n - 1 + M)/n. With k₂ > 0 its velocities then match: the net's least
  eigenvalue but 0 stays above a positive number, so ∫K dt is finite, and dK/dt is bounded as no two agents come closer
  than an explicit distance (Barbalat's lemma).
* a strict minimum of its potential (`flockana.theorems.dead_zone.hold`): nobody then gets farther than now, but for the
  little way to it. That holds of a map of semi-implicit Euler steps as well, whose energy may rise.

Two parts never meet if their centres, at constant velocities, never come closer than r + B + B'. Of a map that is not
held this is said of the flow from its last state.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import floor, inf, sqrt

import numpy as np

from flockana.base.checks import FloatArray
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.measures.nets import components, links
from flockana.theorems.dead_zone.hold import Hold, hold
from flockana.theorems.limits import Certificate
from flockana.theorems.rounding import EPS

_WHOLE = 1e-12  # of a number of pairs, by which rounding may make it a whole one


@dataclass(frozen=True, eq=False)
class Part:
    """One component of the net at one instant, and what is certain of it while it meets no other.

    Parameters
    ----------
    law : DeadZoneFlocking
        The law.
    q, p : ndarray, shape (n, m)
        Positions and velocities of its agents.
    dt : float, optional
        Step of the map of semi-implicit Euler steps; by default the flow.
    """

    law: DeadZoneFlocking
    q: FloatArray
    p: FloatArray
    dt: float | None = None

    @property
    def size(self) -> int:
        """Number of its agents."""
        return len(self.q)

    @cached_property
    def mismatch(self) -> float:
        """K̃ = ½ Σ‖p_i − p̄‖²/n."""
        return 0.5 * float(np.sum((self.p - self.p.mean(axis=0)) ** 2)) / self.size

    @cached_property
    def hold(self) -> Hold:
        """How firmly a minimum holds it."""
        return hold(self.law, self.q, self.p, self.dt)

    @cached_property
    def _out_of_range(self) -> float:
        """H̄/ψ̄(r), the number of pairs that its energy can put out of range."""
        far = self.law.interaction.far_potential
        return self.law.hamiltonian(0.0, self.q, self.p) / far if far > 0.0 else inf

    @property
    def bond(self) -> Certificate:
        """Its energy is too small to break it up, and damping makes its velocities match: of the flow alone."""
        if self.size == 1:
            return Certificate(1.0, "one agent has one velocity")
        if self.dt is not None or self.law.k2 == 0.0:
            return Certificate(-1.0, "no energy holds it together")
        margin = max(-1.0, 1.0 - self._out_of_range / (self.size - 1.0))
        able = "too little to break it up for ever" if margin > 0.0 else "which might break it up"
        text = f"its energy can put {self._out_of_range:.3g} pairs out of range, {able}"
        return Certificate(margin, text, _WHOLE + self.size**2 * EPS)

    @property
    def settles(self) -> Certificate:
        """Its velocities will match: by the better of the two certificates."""
        return self.bond if self.bond.margin > 0.0 else self.hold.certificate

    @cached_property
    def radius(self) -> float:
        """How far from its centre an agent ever gets, at most; ∞ if it might break up."""
        if self.size == 1:
            return 0.0
        if self.hold.certificate.margin > 0.0:
            return float(np.linalg.norm(self.q - self.q.mean(axis=0), axis=1).max()) + self.hold.distance
        pairs, n = self._out_of_range * (1.0 + _WHOLE) + _WHOLE, self.size
        return self.law.interaction.r * (n - 1 + floor(pairs)) / n if pairs < n - 1 else inf


@dataclass(frozen=True, eq=False)
class Parts:
    """The components of a flock at one instant.

    Parameters
    ----------
    parts : tuple of Part
        They, the largest index of their agents last.
    r : float
        Interaction range.
    """

    parts: tuple[Part, ...]
    r: float

    @property
    def count(self) -> int:
        """How many there are."""
        return len(self.parts)

    @property
    def mismatch(self) -> float:
        """Largest K̃ of a part."""
        return max(part.mismatch for part in self.parts)

    @cached_property
    def drift(self) -> float:
        """K̃ of the centres, ½ Σ n_c‖v_c − v̄‖²/n: what is left of K̃ for ever if no two parts meet."""
        sizes, velocity = self._sizes, np.array([part.p.mean(axis=0) for part in self.parts])
        mean = np.average(velocity, axis=0, weights=sizes)
        return 0.5 * float(sizes @ np.sum((velocity - mean) ** 2, axis=1)) / float(sizes.sum())

    @property
    def apart(self) -> Certificate:
        """No two parts ever meet; the margin is by how much their ways clear r + B + B', over r."""
        margin, error = self._ways
        clear = margin > error
        return Certificate(float(np.clip(margin, -1.0, 1.0)), f"parts {'never' if clear else 'may'} meet", error)

    @cached_property
    def _ways(self) -> tuple[float, float]:
        """(clearance over r, its rounding): of lengths, and of the direction of the ways, as velocities are means."""
        if self.count == 1:
            return inf, EPS
        centre, velocity = (np.array([x.mean(axis=0) for x in xs]) for xs in zip(*self._states, strict=True))
        radius = np.array([part.radius for part in self.parts])
        a, b = np.triu_indices(self.count, 1)
        x, v = centre[b] - centre[a], velocity[b] - velocity[a]
        speed2 = np.sum(v**2, axis=1)
        turn = np.maximum(0.0, -np.sum(x * v, axis=1)) / np.where(speed2 > 0.0, speed2, 1.0)  # when they are closest
        nearest = np.linalg.norm(x + turn[:, None] * v, axis=1)
        blur = self._blur[a] + self._blur[b]
        turned = np.divide(4.0 * blur, np.sqrt(speed2), out=np.ones_like(blur), where=4.0 * blur < np.sqrt(speed2))
        bent = float((np.linalg.norm(x, axis=1) * np.where(blur > 0.0, turned, 0.0)).max())
        extent = max(float(np.abs(part.q).max()) for part in self.parts)
        n = float(self._sizes.max())
        error = (n + 16.0) * EPS * (extent + self.r) + bent
        return float((nearest - self.r - radius[a] - radius[b]).min()) / self.r, error / self.r

    @property
    def parting(self) -> bool:
        """Whether it is certain that they part."""
        return self.separation.margin > self.separation.error

    @cached_property
    def separation(self) -> Certificate:
        """No two parts ever meet, and their centres have different velocities: the flock grows beyond all bounds.

        The margin is the lesser of that of `apart` and of the drift over the square of the law's speed scale.
        """
        if self.count == 1:
            return Certificate(-1.0, "the flock is in one part")
        unit = self.parts[0].law.scales.speed
        blur, drift = 2.0 * float(self._blur.max()) / unit, self.drift / unit**2
        slip = 4.0 * blur * (sqrt(drift) + blur) + 64.0 * EPS * drift
        margin, error = min(self._ways, (drift, slip), key=lambda pair: pair[0] - pair[1])
        text = f"{self.count} {self.apart.text}, and their centres keep a K̃ of {self.drift:.4g}"
        return Certificate(float(np.clip(margin, -1.0, 1.0)), text, error)

    @cached_property
    def _blur(self) -> FloatArray:
        """Rounding of the velocity of each part's centre: of a mean, so none of one agent."""
        blur = [0.0 if part.size == 1 else (part.size + 2) * EPS * float(np.abs(part.p).max()) for part in self.parts]
        return np.array(blur)

    @property
    def _sizes(self) -> FloatArray:
        return np.array([part.size for part in self.parts], dtype=np.float64)

    @property
    def _states(self) -> list[tuple[FloatArray, FloatArray]]:
        return [(part.q, part.p) for part in self.parts]


def parts(q: FloatArray, p: FloatArray, law: DeadZoneFlocking, dt: float | None = None) -> Parts:
    """The components of the net at r.

    Examples
    --------
    >>> law, apart = DeadZoneFlocking(), np.array([[0.0], [16.0]])
    >>> parts(apart, np.array([[-1.0], [1.0]]), law).parting
    True
    >>> parts(apart, np.array([[1.0], [-1.0]]), law).parting
    False
    """
    label = components(len(q), links(q, law.interaction.r))
    groups = [np.flatnonzero(label == k) for k in range(int(label.max()) + 1)]
    return Parts(tuple(Part(law, q[g], p[g], dt) for g in groups), law.interaction.r)
