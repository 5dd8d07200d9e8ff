"""The laws again, from the formulas alone: plain numpy, one agent at a time, nothing shared with the kernels.

Slow on purpose: no neighbour search, no Newton's third law, no closed form of ψ_α.
"""

from dataclasses import dataclass

import numpy as np

from tests.reference.energies import psi_alpha


@dataclass(frozen=True)
class Pair:
    """Parameters of the α-pair law, with the paper's values."""

    d: float = 7.0
    r: float = 8.4
    eps: float = 0.1
    h: float = 0.2
    a: float = 5.0
    b: float = 5.0

    @property
    def c(self):
        return abs(self.a - self.b) / np.sqrt(4.0 * self.a * self.b)

    @property
    def d_alpha(self):
        return sigma_norm(np.array([self.d]), self.eps)

    @property
    def r_alpha(self):
        return sigma_norm(np.array([self.r]), self.eps)


def sigma_norm(z, eps):
    """(√(1 + ε‖z‖²) − 1)/ε over the last axis, by log1p and expm1: another road to the same accuracy."""
    return np.expm1(0.5 * np.log1p(eps * np.sum(z * z, axis=-1))) / eps


def sigma_gradient(z, eps):
    return z / np.sqrt(1.0 + eps * np.sum(z * z, axis=-1, keepdims=True))


def bump(z, h):
    taper = 0.5 * (1.0 + np.cos(np.pi * (z - h) / (1.0 - h)))
    return np.where((z >= 0) & (z < h), 1.0, np.where((z >= h) & (z <= 1.0), taper, 0.0))


def phi(s, pair):
    x = s + pair.c
    return 0.5 * ((pair.a + pair.b) * x / np.sqrt(1.0 + x * x) + (pair.a - pair.b))


def phi_alpha(z, pair):
    return bump(z / pair.r_alpha, pair.h) * phi(z - pair.d_alpha, pair)


def acceleration(q, p, pair, c1, c2):
    """u of Algorithm 1, agent by agent."""
    u = np.zeros_like(q)
    for i in range(len(q)):
        delta = np.delete(q - q[i], i, axis=0)
        near = np.sqrt(np.sum(delta * delta, axis=1)) < pair.r
        delta, dp = delta[near], np.delete(p - p[i], i, axis=0)[near]
        z = sigma_norm(delta, pair.eps)
        a = bump(z / pair.r_alpha, pair.h)
        u[i] = c1 * (phi_alpha(z, pair)[:, None] * sigma_gradient(delta, pair.eps)).sum(axis=0)
        u[i] += c2 * (a[:, None] * dp).sum(axis=0)
    return u


def potential(q, pair):
    """V = ½ Σ_i Σ_{j≠i} ψ_α, non-neighbours included."""
    squares = np.concatenate([np.sum(np.delete(q - q[i], i, axis=0) ** 2, axis=1) for i in range(len(q))])
    near = squares < pair.r**2
    return 0.5 * (psi_alpha(squares[near], pair).sum() + np.sum(~near) * psi_alpha(np.array([pair.r**2]), pair)[0])


def dissipation(q, p, pair):
    """½ Σ over ordered pairs a_ij ‖p_j − p_i‖² = pᵀL̂p, through the Laplacian's rows."""
    total = 0.0
    for i in range(len(q)):
        delta = np.delete(q - q[i], i, axis=0)
        a = bump(sigma_norm(delta, pair.eps) / pair.r_alpha, pair.h)
        total += 0.5 * np.sum(a[:, None] * np.delete(p - p[i], i, axis=0) ** 2)
    return total


def links(q, r):
    """Unordered pairs closer than r."""
    n = len(q)
    return [(i, j) for i in range(n) for j in range(i + 1, n) if np.sqrt(np.sum((q[j] - q[i]) ** 2)) < r]
