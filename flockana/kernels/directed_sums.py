"""α-forces on directed nets: each agent has its own range, and may see ahead only."""

from math import sqrt

import numpy as np

from flockana.jit import kernel
from flockana.kernels.agent_sums import square_between
from flockana.kernels.alpha import EPS, R_ALPHA, H, pair_alpha
from flockana.kernels.scalars import sigma_norm, taper


@kernel
def sight(q, p, i, j, s2, reach2, width, slow2, h):
    """Return the visibility of agent j for agent i, 0 to 1: by range and by cone, with the bump of the angle's 1 − cos.

    `width` is 1 − cos of half the angle of view; 2 is all round. An agent much slower than √slow2 looks all round.
    """
    if s2 >= reach2:
        return 0.0
    if width >= 2.0:
        return 1.0
    forward_part, speed2 = 0.0, 0.0
    for c in range(q.shape[1]):
        forward_part += (q[j, c] - q[i, c]) * p[i, c]
        speed2 += p[i, c] ** 2
    norms = sqrt(s2) * sqrt(speed2)  # of roots: the product of squares may underflow
    if norms == 0.0:
        return 1.0
    cone = taper(max(0.0, 1.0 - forward_part / norms) / width, h)
    return (slow2 + speed2 * cone) / (slow2 + speed2)


@kernel
def directed_forces(q, p, pairs, reach, par, gains, view, u):
    """Add w_ij (c1 s_ij (q_j − q_i) + c2 a_ij (p_j − p_i)) to u_i, with the bump of its range and its `sight` w_ij.

    `pairs` are unordered, two arrays, and at least all within the largest range; `gains` are (c1, c2), and `view` is
    (width, slow2) of `sight`.
    """
    (first_agents, second_agents), (c1, c2), (width, slow2) = pairs, gains, view
    n, own_par = reach.size, par.copy()
    sigma = np.empty(n)
    for i in range(n):
        sigma[i] = sigma_norm(reach[i] * reach[i], par[EPS])
    for k in range(first_agents.size):
        for direction in range(2):
            i, j = (first_agents[k], second_agents[k]) if direction == 0 else (second_agents[k], first_agents[k])
            s2 = square_between(q, i, j)
            sight_weight = sight(q, p, i, j, s2, reach[i] * reach[i], width, slow2, par[H])
            if sight_weight == 0.0:
                continue
            own_par[R_ALPHA] = sigma[i]
            stress, adjacency = pair_alpha(s2, own_par)
            pull, drag = c1 * stress * sight_weight, c2 * adjacency * sight_weight
            for c in range(q.shape[1]):
                u[i, c] += pull * (q[j, c] - q[i, c]) + drag * (p[j, c] - p[i, c])


@kernel
def seen_edges(q, p, first, second, reach, width, slow2, h, least):
    """Return (head, tail) of the directed edges among given pairs: head sees tail above the least visibility."""
    head, tail, count = np.empty(2 * first.size, np.int64), np.empty(2 * first.size, np.int64), 0
    for k in range(first.size):
        s2 = square_between(q, first[k], second[k])
        for direction in range(2):
            i, j = (first[k], second[k]) if direction == 0 else (second[k], first[k])
            if sight(q, p, i, j, s2, reach[i] * reach[i], width, slow2, h) > least:
                head[count], tail[count] = i, j
                count += 1
    return head[:count], tail[:count]
