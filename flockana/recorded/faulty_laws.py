"""Four implementations of Algorithm 2, each with a typical error of public code: an exercise for `compare`.

The functions are written as a student writes them, all pairs at once, and are no part of the library's laws. Their
recordings start alike and have 12 agents.
"""

from collections.abc import Callable, Mapping
from math import pi, sqrt
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray, ensure_known
from flockana.environment.targets import StaticTarget
from flockana.laws.olfati_saber import Algorithm2
from flockana.recorded.recording import Recording

D, R, EPS, H, A, B = 7.0, 8.4, 0.1, 0.2, 5.0, 5.0  # d, r, ε, h, a, b of the pair law
C1A, C2A, C1G, C2G = 30.0, 2.0 * sqrt(30.0), 1.1, 2.0 * sqrt(1.1)
GOAL = (10.0, 10.0)
_AGENTS, _END, _SAMPLES, _STEP = 12, 4.0, 201, 0.02

Acceleration = Callable[[FloatArray, FloatArray], Any]


def intended_law() -> Algorithm2:
    """Return the intended law of the four faulty programs."""
    return Algorithm2(target=StaticTarget(GOAL))


def _sigma_norm(s: FloatArray) -> Any:
    return (np.sqrt(1.0 + EPS * s**2) - 1.0) / EPS


def _phi(z: FloatArray) -> Any:
    return 0.5 * ((A + B) * z / np.sqrt(1.0 + z**2) + (A - B))


def _bump(z: FloatArray) -> FloatArray:
    falling_bump = 0.5 * (1.0 + np.cos(pi * (z - H) / (1.0 - H)))
    return np.where(z < H, 1.0, np.where(z < 1.0, falling_bump, 0.0))


def _pairs(q: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return q_j - q_i, its length, the weight a_ij and the action φ_α of all pairs; 0 for i = j."""
    x = q[None] - q[:, None]
    s = np.sqrt((x**2).sum(axis=2))
    r_alpha, d_alpha = _sigma_norm(np.array([R, D]))
    weight = _bump(_sigma_norm(s) / r_alpha)
    np.fill_diagonal(weight, 0.0)
    return x, s, weight, weight * _phi(_sigma_norm(s) - d_alpha)


def _code(*, per_axis: bool = False, consensus: float = C2A, bounded: bool = False) -> Acceleration:
    def code(q: FloatArray, p: FloatArray) -> Any:
        x, s, weight, action = _pairs(q)
        n = x / np.sqrt(1.0 + EPS * (x**2 if per_axis else s[:, :, None] ** 2))
        e = q - np.array(GOAL)
        pull = e / np.sqrt(1.0 + e**2) if bounded else e
        total: Any = C1A * (action[:, :, None] * n).sum(axis=1)
        total = total + consensus * (weight[:, :, None] * (p[None] - p[:, None])).sum(axis=1)
        return total - C1G * pull - C2G * p

    return code


# D has no fault of its own: it is stepped wrongly
CODES: Mapping[str, Acceleration] = {
    "A": _code(bounded=True),
    "B": _code(consensus=C1A),
    "C": _code(per_axis=True),
    "D": _code(),
}


def faulty_recording(name: str) -> Recording:
    """Return the recording of a faulty implementation, "A" to "D": positions and velocities every 0.02 time units."""
    code = CODES[ensure_known("implementation", name, CODES)]
    rng = np.random.default_rng(7)
    q = D * np.stack(np.meshgrid(np.arange(4.0), np.arange(3.0)), axis=2).reshape(-1, 2)
    q, p = q + rng.normal(0.0, 0.6, (_AGENTS, 2)), rng.normal(0.0, 1.0, (_AGENTS, 2))
    t: Any = _STEP * np.arange(_SAMPLES, dtype=np.float64)
    if name == "D":
        steps = [(q, p)]
        for _ in t[1:]:
            q, p = q + _STEP * p, p + _STEP * code(q, p)
            steps.append((q, p))
        positions, speeds = np.array(steps).swapaxes(0, 1)
        return Recording(t, positions, speeds, bound=1e-9, p_bound=1e-9, source="implementation D")
    from scipy.integrate import solve_ivp

    def rate(_: float, y: FloatArray) -> FloatArray:
        x, v = y.reshape(2, _AGENTS, 2)
        return np.concatenate([v.ravel(), code(x, v).ravel()])

    solution = solve_ivp(rate, (0.0, _END), np.concatenate([q.ravel(), p.ravel()]), t_eval=t, rtol=1e-9, atol=1e-9)
    states = solution.y.T.reshape(len(t), 2, _AGENTS, 2)
    return Recording(t, states[:, 0], states[:, 1], bound=1e-6, source=f"implementation {name}")
