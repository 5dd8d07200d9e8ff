"""Algorithm 2's acceleration in plain numpy, twice: agent by agent, and all pairs at once."""

from __future__ import annotations

from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray


def _bump(a: Any, z: FloatArray) -> FloatArray:
    x = z / a.r_alpha
    taper = 0.5 * (1.0 + np.cos(np.pi * (x - a.h) / (1.0 - a.h)))
    rho: FloatArray = np.where(x < a.h, 1.0, np.where(x < 1.0, taper, 0.0))
    return rho


def _phi(a: Any, z: FloatArray) -> FloatArray:
    s = z - a.d_alpha + a.c
    phi: FloatArray = 0.5 * ((a.a + a.b) * s / np.sqrt(1.0 + s**2) + (a.a - a.b))
    return phi


def _sigma_norm(a: Any, s2: FloatArray) -> FloatArray:
    z: FloatArray = (np.sqrt(1.0 + a.eps * s2) - 1.0) / a.eps
    return z


def by_agents(law: Any, q: FloatArray, p: FloatArray) -> FloatArray:
    """One agent after the other in vectorised numpy: how the sources' notebooks compute u.

    Parameters
    ----------
    law : Algorithm2
        With its target at rest at the origin.
    q, p : ndarray, shape (n, m)
        Positions and velocities.
    """
    a, g = law.alpha, law.gains
    u = -g.c1_gamma * q - g.c2_gamma * p
    for i in range(len(q)):
        delta, relative = np.delete(q - q[i], i, axis=0), np.delete(p - p[i], i, axis=0)
        z = _sigma_norm(a, np.sum(delta**2, axis=1))
        rho = _bump(a, z)
        near = rho > 0.0
        delta, relative, z, rho = delta[near], relative[near], z[near], rho[near]
        n_ij = delta / np.sqrt(1.0 + a.eps * np.sum(delta**2, axis=1, keepdims=True))
        u[i] += g.c1_alpha * (rho * _phi(a, z)) @ n_ij + g.c2_alpha * rho @ relative
    return u


def by_all_pairs(law: Any, q: FloatArray, p: FloatArray) -> FloatArray:
    """All n × n differences at once, by broadcasting: how the fastest public code computes u.

    Parameters
    ----------
    law : Algorithm2
        With its target at rest at the origin.
    q, p : ndarray, shape (n, m)
        Positions and velocities.
    """
    a, g = law.alpha, law.gains
    delta, relative = q[None, :, :] - q[:, None, :], p[None, :, :] - p[:, None, :]
    s2 = np.sum(delta**2, axis=2)
    z = _sigma_norm(a, s2)
    adjacency = _bump(a, z)  # of an agent and itself too, whose differences are 0
    n_ij = delta / np.sqrt(1.0 + a.eps * s2)[:, :, None]
    pull = np.sum((adjacency * _phi(a, z))[:, :, None] * n_ij, axis=1)
    consensus = np.sum(adjacency[:, :, None] * relative, axis=1)
    u: FloatArray = g.c1_alpha * pull + g.c2_alpha * consensus - g.c1_gamma * q - g.c2_gamma * p
    return u
