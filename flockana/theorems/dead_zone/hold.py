"""Whether a dead-zone flock is held for ever in the basin of a strict minimum of its potential.

The argument is that of `flockana.theorems.olfati_saber.attraction`: H̄ = U + K never rises, and U = Σψ̄ is strictly
convex about a minimum x*, off the rigid motions, as far as the Lipschitz constant of its Hessian carries. That constant
is finite only where no pair comes to a kink of its force: the ends of the ramps, of the dead zone, and the range. So
the windows in which it is taken end before the first kink; a flock with printed jumps, whose contacts sit on them, is
never held.

A map of semi-implicit Euler steps has an energy of its own. Where dt²Λ + 2 dt Γ < 4, with Λ and Γ the largest
eigenvalues of ∇²U and k₂ L̂, all modes z of the linearised map but the rigid ones have |z| < 1: they are the roots of
z² - (2 - dt²κ - dt γ) z + 1 - dt γ, with κ and γ the Rayleigh quotients of the mode. Below half of that bound H̄
never grows to more than six times itself on the way (measured, at random Λ and Γ), so that a tenth of the barrier is
allowed there.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from flockana.base.checks import FloatArray
from flockana.equilibria.terminal import DENSE_LIMIT, rigid_motions
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.measures.nets import components, link_lengths, links
from flockana.theorems.limits import Certificate
from flockana.theorems.olfati_saber.attraction import WINDOWS, barrier, gyration, kinetic, weight_at_both_ends
from flockana.theorems.rounding import EPS

_POINTS = 25  # of a difference quotient of the stiffness over the lengths that a pair may take
_SAFETY = 1.25  # on that quotient
_CLEAR = 0.999  # of the way to the nearest kink: so wide the widest window is
_GROWTH = 10.0  # that is allowed to the energy of a map


@dataclass(frozen=True)
class Hold:
    """How firmly a flock is held by the minimum beside it.

    Attributes
    ----------
    excess, barrier : float
        Energy above the minimum at most (∞ where none is known), and energy that leaving takes at least.
    distance : float
        How far from here, over all coordinates and but for rigid motions, the flock ever gets while it is held.
    stability : float
        1 - (dt²Λ + 2 dt Γ)/2 of a map, at most 1; 1 of the flow.
    """

    excess: float
    barrier: float
    distance: float
    stability: float = 1.0

    @property
    def certificate(self) -> Certificate:
        """The energy above the minimum is less than the barrier; for a map, a tenth of it."""
        if not self.barrier > 0.0:
            return Certificate(-1.0, "it is not known to be held by a minimum")
        if self.stability <= 0.0:
            return Certificate(max(-1.0, self.stability), "the step is too long for the stiffness of its contacts")
        ratio = self.excess / self.barrier * (_GROWTH if self.stability < 1.0 else 1.0)
        held = "held by a strict minimum for ever" if ratio < 1.0 else "near a minimum, with energy enough to leave"
        text = f"it is {held}: {self.excess:.2g} above it, where leaving takes {self.barrier:.2g} at least"
        return Certificate(max(-1.0, min(1.0 - ratio, self.stability)), text)


_NOTHING = Hold(inf, 0.0, inf)


def hold(law: DeadZoneFlocking, q: FloatArray, p: FloatArray, dt: float | None = None) -> Hold:
    """Measure whether a flock by itself is held for ever; one agent always is.

    Examples
    --------
    Two agents at their contact, and two that have more energy than it takes to leave it:

    >>> law, q = DeadZoneFlocking(), np.array([[0.0], [3.49973]])
    >>> hold(law, q, 0.0 * q).certificate.margin > 0.9
    True
    >>> hold(law, q, np.array([[0.1], [-0.1]])).certificate.margin
    -1.0
    """
    if len(q) == 1:
        return Hold(0.0, inf, 0.0)
    if q.size > DENSE_LIMIT or law.k2 == 0.0:
        return _NOTHING
    stiffness = law.interaction.hessian(q).toarray()
    curvature, stiffest = _curvatures(stiffness, q)
    if not curvature > 0.0:
        return _NOTHING
    force = _force(law, q, stiffest)
    distance = 2.0 * force / curvature
    nearer = law.interaction.r - sqrt(2.0) * distance  # links shorter than this are links at the minimum too
    if distance >= gyration(q) or nearer <= 0.0 or components(len(q), links(q, nearer)).any():
        return _NOTHING
    room = _CLEAR * _nearest_kink(law, q) / sqrt(2.0)
    windows = [*(w for w in law.interaction.d1 * WINDOWS if w < room), room]
    leaving = barrier(curvature, distance, windows, lambda window: _lipschitz(law, q, window))
    excess = kinetic(p) + force**2 / curvature
    away = distance + 2.0 * sqrt(excess / curvature)
    return Hold(excess, leaving, away, 1.0 if dt is None else _stability(law, q, stiffest, dt))


def _curvatures(stiffness: FloatArray, q: FloatArray) -> tuple[float, float]:
    """(λ off the rigid motions less its rounding, largest eigenvalue)."""
    rigid = rigid_motions(q)
    free = np.linalg.svd(rigid, full_matrices=True)[0][:, rigid.shape[1] :]
    if free.shape[1] == 0:
        return float("nan"), 0.0
    values = np.linalg.eigvalsh(free.T @ (stiffness @ free))
    largest = float(np.abs(values).max())
    return float(values[0]) - 64.0 * q.size * EPS * largest, largest


def _force(law: DeadZoneFlocking, q: FloatArray, stiffest: float) -> float:
    """|∇U| over all coordinates, with the rounding of its sums, and of the lengths that they are made of, added."""
    pair, pairs = law.interaction, links(q, law.interaction.r)
    pulls = np.abs(pair.force(link_lengths(q, pairs)))
    most = float(np.bincount(pairs.ravel(), weights=np.repeat(pulls, 2), minlength=1).max())
    rounding = (len(q) + 16.0) * EPS * (most + stiffest * pair.r)
    u = law.flow(0.0, q, np.zeros_like(q))[0]
    return float(np.linalg.norm(u)) + sqrt(q.size) * rounding


def _nearest_kink(law: DeadZoneFlocking, q: FloatArray) -> float:
    """How far the nearest pair is from a distance at which the force or its slope jumps."""
    pair = law.interaction
    kinks = [pair.d1 - pair.ramp, pair.d1]
    if pair.d2 < pair.r:
        kinks += [pair.d2, pair.d2 + pair.ramp]
    if pair.d2 < pair.r or pair.k1 > 0.0:
        kinks.append(pair.r)
    i, j = np.triu_indices(len(q), 1)
    lengths = np.linalg.norm(q[j] - q[i], axis=1)
    return float(np.abs(lengths[:, None] - np.array(kinks)).min())


def _lipschitz(law: DeadZoneFlocking, q: FloatArray, window: float) -> float:
    """Lipschitz constant of ∇²U within a distance of q, as `flockana.theorems.olfati_saber.attraction` has it."""
    slack = sqrt(2.0) * window
    pairs = links(q, law.interaction.r)
    if not len(pairs):
        return 0.0
    return sqrt(2.0) * weight_at_both_ends(len(q), pairs, _third(law, link_lengths(q, pairs), slack))


def _third(law: DeadZoneFlocking, lengths: FloatArray, slack: float) -> FloatArray:
    """Norm of the third derivative of each pair's potential, at worst over lengths within the slack."""
    s = np.maximum(lengths[:, None] + slack * np.linspace(-1.0, 1.0, _POINTS), 1e-12 * law.interaction.d1)
    weight, slope = (x.reshape(s.shape) for x in _weights(law, s.ravel()))
    along, across = weight + 2.0 * s * s * slope, 2.0 * s * slope  # F', and (F' - F/s)/s
    step = np.diff(s, axis=1)
    change = np.divide(np.abs(np.diff(along, axis=1)), step, out=np.zeros_like(step), where=step > 0.0)
    noise = 16.0 * EPS * np.abs(along).max(axis=1) / step.max(axis=1)
    norm: FloatArray = _SAFETY * change.max(axis=1) + noise + 2.0 / sqrt(3.0) * np.abs(across).max(axis=1)
    return norm


def _weights(law: DeadZoneFlocking, s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(F/s, its slope in s²) at distances s: what the kernels have of a pair, of agents on a line from the first."""
    line, others = np.concatenate([[0.0], s])[:, None], np.arange(1, s.size + 1, dtype=np.int32)
    weight, _, slope = law.interaction.kernels.terms(line, np.zeros_like(others), others, law.interaction.par)
    return weight, slope


def _stability(law: DeadZoneFlocking, q: FloatArray, stiffest: float, dt: float) -> float:
    """1 - (dt²Λ + 2 dt Γ)/2, positive where every mode of the map decays, with room."""
    dissipation = law.k2 * float(np.linalg.eigvalsh(law.interaction.laplacian(q).toarray())[-1])
    return 1.0 - 0.5 * (dt * dt * stiffest + 2.0 * dt * dissipation)
