"""One step of the sequential map of agents, each using the already moved positions."""

import numpy as np

from flockana.jit import kernel
from flockana.kernels.agent_sums import square_between
from flockana.kernels.alpha import pair_alpha


@kernel
def neighbour_lists(n, first, second):
    """Return (start, neighbour): the neighbours of i are neighbour[start[i]:start[i + 1]], in pair order."""
    start = np.zeros(n + 1, np.int64)
    for k in range(first.size):
        start[first[k] + 1] += 1
        start[second[k] + 1] += 1
    for i in range(n):
        start[i + 1] += start[i]
    fill_positions = start[:-1].copy()
    neighbour = np.empty(2 * first.size, np.int32)
    for k in range(first.size):
        i, j = first[k], second[k]
        neighbour[fill_positions[i]] = j
        neighbour[fill_positions[j]] = i
        fill_positions[i] += 1
        fill_positions[j] += 1
    return start, neighbour


@kernel
def advance_alpha(q, p, u, near, par, gains, goal, dt, position_factor):
    """Overwrite q, p, u agent by agent: u_i from the current state, then q_i and p_i."""
    m, (start, neighbour), (c1, c2), (pull, drag, q_r, p_r) = q.shape[1], near, gains, goal
    total = np.empty(m)
    for i in range(q.shape[0]):
        for c in range(m):
            total[c] = -pull * (q[i, c] - q_r[c]) - drag * (p[i, c] - p_r[c])
        for k in range(start[i], start[i + 1]):
            j = neighbour[k]
            s2 = square_between(q, i, j)
            w, rho = pair_alpha(s2, par)
            for c in range(m):
                total[c] += c1 * w * (q[j, c] - q[i, c]) + c2 * rho * (p[j, c] - p[i, c])
        for c in range(m):
            u[i, c] = total[c]
            q[i, c] += p[i, c] * dt + position_factor * total[c] * dt * dt
            p[i, c] += total[c] * dt
