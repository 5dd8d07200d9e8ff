"""A user's own code of Algorithm 2 in numpy, with the errors that public implementations have."""

import numpy as np
from scipy.integrate import solve_ivp

import flockana as fl

N = 16
LAW = fl.Algorithm2(target=fl.StaticTarget((12.0, 12.0)))
Q0 = fl.lattice.triangular(N, 7.0) + np.random.default_rng(0).normal(0.0, 0.5, (N, 2))
P0 = np.random.default_rng(1).normal(0.0, 1.0, (N, 2))
D, R, EPS, H, A, B = 7.0, 8.4, 0.1, 0.2, 5.0, 5.0
C1A, C2A, C1G, C2G = 30.0, 2.0 * np.sqrt(30.0), 1.1, 2.0 * np.sqrt(1.1)


def own_acceleration(q, p, *, pull_per_axis=False, c2a=C2A):
    """Algorithm 2 as a user writes it, all pairs at once."""

    def norm(s):
        return (np.sqrt(1.0 + EPS * s**2) - 1.0) / EPS

    x, s = q[None] - q[:, None], np.linalg.norm(q[None] - q[:, None], axis=2)
    z = norm(s) / norm(R)
    bump = np.where(z < H, 1.0, np.where(z < 1.0, 0.5 * (1.0 + np.cos(np.pi * (z - H) / (1.0 - H))), 0.0))
    y = norm(s) - norm(D) + abs(A - B) / np.sqrt(4.0 * A * B)
    phi = bump * 0.5 * ((A + B) * y / np.sqrt(1.0 + y**2) + A - B)
    n = x / np.sqrt(1.0 + EPS * (s**2)[:, :, None])
    np.fill_diagonal(bump, 0.0)
    np.fill_diagonal(phi, 0.0)
    u = C1A * (phi[:, :, None] * n).sum(axis=1) + c2a * (bump[:, :, None] * (p[None] - p[:, None])).sum(axis=1)
    e = q - np.array([12.0, 12.0])
    return u - C1G * (e / np.sqrt(1.0 + e**2) if pull_per_axis else e) - C2G * p


def own_run(t, *, rtol=1e-8, **faults):
    """The user's run by RK45 of scipy: positions and velocities at some times."""

    def rate(_, y):
        q, p = y.reshape(2, N, 2)
        return np.concatenate([p.ravel(), own_acceleration(q, p, **faults).ravel()])

    start = np.concatenate([Q0.ravel(), P0.ravel()])
    done = solve_ivp(rate, (t[0], t[-1]), start, t_eval=t, method="RK45", rtol=rtol, atol=1e-8)
    states = done.y.T.reshape(len(t), 2, N, 2)
    return states[:, 0], states[:, 1]
