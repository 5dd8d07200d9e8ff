"""Whether a dead-zone flock is held for ever in the basin of a strict minimum of its potential.

The argument is that of `flockana.theorems.basin`, with U = Σψ̄, whose Hessian has a finite Lipschitz constant only where
no pair comes to a kink of its force: the ends of the ramps, of the dead zone, and the range. So the windows in which it
is taken end before the first kink; a flock with printed jumps, whose contacts sit on them, is never held.

A map of semi-implicit Euler steps has an energy of its own. Where dt²Λ + 2 dt Γ < 4, with Λ and Γ the largest
eigenvalues of ∇²U and k₂ L̂, all modes z of the linearised map but the rigid ones have |z| < 1: they are the roots of
z² - (2 - dt²κ - dt γ) z + 1 - dt γ, with κ and γ the Rayleigh quotients of the mode. Below half of that bound H̄
never grows to more than six times itself on the way (measured, at random Λ and Γ), so that a tenth of the barrier is
allowed there.
"""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np

from flockana.base.checks import FloatArray
from flockana.equilibria.terminal import DENSE_LIMIT, rigid_motions
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.measures.nets import link_lengths, links
from flockana.theorems.basin import (
    ALONE,
    WINDOWS,
    Basin,
    barrier,
    connected_within,
    curvatures,
    gyration,
    kinetic,
    lipschitz_constant,
    third_derivative,
)
from flockana.theorems.rounding import EPS

_POINTS = 25  # of a difference quotient of the stiffness over the lengths that a pair may take
_CLEAR = 0.999  # of the way to the nearest kink: so wide the widest window is
_UNKNOWN = Basin(verb="held")


def hold(law: DeadZoneFlocking, q: FloatArray, p: FloatArray, dt: float | None = None) -> Basin:
    """The basin of the minimum beside a flock that meets no other; of the map of steps dt if given.

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
        return replace(ALONE, verb="held")
    if q.size > DENSE_LIMIT or law.k2 == 0.0:
        return _UNKNOWN
    curvature, stiffest = curvatures(law.interaction.hessian(q).toarray(), rigid_motions(q))
    if not curvature > 0.0:
        return _UNKNOWN
    force = _force(law, q, stiffest)
    distance = 2.0 * force / curvature
    nearer = law.interaction.r - sqrt(2.0) * distance  # links shorter than this are links at the minimum too
    if distance >= gyration(q) or not connected_within(q, nearer):
        return _UNKNOWN
    room = _CLEAR * _nearest_kink(law, q) / sqrt(2.0)
    windows = [*(w for w in law.interaction.d1 * WINDOWS if w < room), room]
    leaving = barrier(curvature, distance, windows, lambda window: _lipschitz(law, q, window))
    stability = 1.0 if dt is None else _stability(law, q, stiffest, dt)
    return Basin(kinetic(p) + force**2 / curvature, leaving, distance, curvature, stability, "held")


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
    """Lipschitz constant of ∇²U within a distance of q."""
    pairs = links(q, law.interaction.r)
    return lipschitz_constant(len(q), pairs, _third(law, link_lengths(q, pairs), sqrt(2.0) * window))


def _third(law: DeadZoneFlocking, lengths: FloatArray, slack: float) -> FloatArray:
    """Norm of the third derivative of each pair's potential, at worst over lengths within the slack."""
    if not lengths.size:
        return np.zeros(0)
    s = np.maximum(lengths + slack * np.linspace(-1.0, 1.0, _POINTS)[:, None], 1e-12 * law.interaction.d1)
    weight, slope = (x.reshape(s.shape) for x in _weights(law, s.ravel()))
    along, across = weight + 2.0 * s * s * slope, 2.0 * s * slope  # F', and (F' - F/s)/s
    noise = 16.0 * EPS * np.abs(along).max(axis=0) / np.diff(s, axis=0).max(axis=0)
    return third_derivative(s, along, across, least_step=0.0, noise=noise)


def _weights(law: DeadZoneFlocking, s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(F/s, its slope in s²) at distances s: what the kernels have of a pair, of agents on a line from the first."""
    line, others = np.concatenate([[0.0], s])[:, None], np.arange(1, s.size + 1, dtype=np.int32)
    weight, _, slope = law.interaction.kernels.terms(line, np.zeros_like(others), others, law.interaction.par)
    return weight, slope


def _stability(law: DeadZoneFlocking, q: FloatArray, stiffest: float, dt: float) -> float:
    """1 - (dt²Λ + 2 dt Γ)/2, positive where every mode of the map decays, with room."""
    m = q.shape[1]
    by_agent = law.interaction.laplacian(q).toarray()[::m, ::m]  # each component has the same
    dissipation = law.k2 * float(np.linalg.eigvalsh(by_agent)[-1])
    return 1.0 - 0.5 * (dt * dt * stiffest + 2.0 * dt * dissipation)
