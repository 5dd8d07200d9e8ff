"""The minimal flocking model of the bearing-distance paper: perceived edges, and sums over them.

An edge is (j, i): j is seen, i sees it. Here `tail` holds the j and `head` the i.
"""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.jit import kernel
from flockana.kernels.agent_sums import square_between
from flockana.kernels.neighbours import DENSE_MAX, FloatArray, pair_blocks

AT_ONCE = DENSE_MAX  # up to so many agents `semi_implicit_steps` is the same to the bit: pairs come in the same order
_SLACK = 1.0 + 1e-12  # the search is strict and the radius closed: a few roundings more than R, and the filter decides


class EqualEdges(NamedTuple):
    """Parameters of a law whose edges depend only on the perceiving agent's radius and spacing.

    `shared`: the spacing is β_i r_i |N_i|; `normalised`: the alignment weights of an agent sum to 1.
    """

    radius: FloatArray
    spacing: FloatArray
    shared: bool
    mu: float
    sigma: float
    normalised: bool


@kernel
def _directed(q, first, second, square):
    """Return (head, tail) of the directed edges among given pairs: an agent sees within its closed radius R_i."""
    head, tail = np.empty(2 * first.size, np.int64), np.empty(2 * first.size, np.int64)
    count = 0
    for k in range(first.size):
        i, j = first[k], second[k]
        s2 = square_between(q, i, j)
        if s2 <= square[i]:
            head[count], tail[count] = i, j
            count += 1
        if s2 <= square[j]:
            head[count], tail[count] = j, i
            count += 1
    return head[:count], tail[:count]


def perceived_edges(q: FloatArray, radius: FloatArray) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
    """Return (head, tail) of every directed edge: agent head[e] perceives agent tail[e] within its own radius."""
    reach, squared_radii = float(radius.max()) * _SLACK, radius * radius
    parts = [_directed(q, i, j, squared_radii) for i, j in pair_blocks(q, reach)]
    if len(parts) == 1:
        return parts[0]
    return np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])


@kernel
def edge_forces(q, p, head, tail, mu, rho, align, u):
    """Add μ (1 − ρ/‖x‖) x + a (p_j − p_i) of each edge, x = q_j − q_i, to u_i; return Σ a ‖p_j − p_i‖² over edges."""
    # coincident agents have no bearing: their edge contributes the alignment only
    dissipated_power = 0.0
    m = q.shape[1]
    for e in range(head.size):
        i, j = head[e], tail[e]
        s2, v2 = 0.0, 0.0
        for c in range(m):
            s2 += (q[j, c] - q[i, c]) ** 2
            v2 += (p[j, c] - p[i, c]) ** 2
        w = mu[e] * (1.0 - rho[e] / np.sqrt(s2)) if s2 > 0.0 else 0.0
        for c in range(m):
            u[i, c] += w * (q[j, c] - q[i, c]) + align[e] * (p[j, c] - p[i, c])
        dissipated_power += align[e] * v2
    return dissipated_power


@kernel
def _count(q, first, second, square, count):
    """Count the agents perceived by each agent, among some pairs."""
    for k in range(first.size):
        i, j = np.uint64(first[k]), np.uint64(second[k])
        s2 = square_between(q, i, j)
        count[i] += s2 <= square[i]
        count[j] += s2 <= square[j]


@kernel
def _pull(q, p, first, second, square, mu, rho, align, u):
    """Add spring and alignment forces among given pairs to `u`, by the perceiving agent's weights and lengths."""
    m = q.shape[1]
    for k in range(first.size):
        i, j = np.uint64(first[k]), np.uint64(second[k])
        s2 = square_between(q, i, j)
        s = np.sqrt(s2)
        for direction in range(2):
            head, tail = (i, j) if direction == 0 else (j, i)
            if s2 <= square[head]:
                w = mu * (1.0 - rho[head] / s) if s2 > 0.0 else 0.0
                for c in range(m):
                    u[head, c] += w * (q[tail, c] - q[head, c]) + align[head] * (p[tail, c] - p[head, c])


def perceived_forces(q: FloatArray, p: FloatArray, edges: EqualEdges, u: FloatArray) -> None:
    """Add to u the sum of `edge_forces` over `perceived_edges` of equal weights, without listing the edges."""
    radius, spacing, is_shared, mu, sigma, is_normalised = edges
    reach, squared_radii, count = float(radius.max()) * _SLACK, radius * radius, np.zeros(len(q), np.int64)
    parts = [(i.copy(), j.copy()) for i, j in pair_blocks(q, reach)]
    if is_shared or is_normalised:
        for i, j in parts:
            _count(q, i, j, squared_radii, count)
    total = sigma * count if is_normalised else np.ones(len(q))
    align_weights = np.divide(sigma, total, out=np.zeros(len(q)), where=total > 0.0)
    rho = spacing * count if is_shared else spacing
    for i, j in parts:
        _pull(q, p, i, j, squared_radii, mu, rho, align_weights, u)


@kernel
def _squares(x, j, s2):
    """Return squared distances of all agents from agent j; coordinates (m, n)."""
    s2[:] = 0.0
    for c in range(x.shape[0]):
        coordinate, neighbour_coordinate = x[c], x[c, j]
        for i in range(s2.size):
            s2[i] += (neighbour_coordinate - coordinate[i]) ** 2


@kernel
def _numbers(x, square, s2, count):
    """Return the number of agents perceived by each agent."""
    count[:] = -1.0  # not oneself
    for j in range(s2.size):
        _squares(x, j, s2)
        for i in range(s2.size):
            count[i] += 1.0 if s2[i] <= square[i] else 0.0


@kernel
def _springs(s2, mu, rho, w):
    """Write the spring factors μ (1 − ρ_i/‖q_j − q_i‖) of all agents i towards one agent j to `w`."""
    for i in range(s2.size):
        stretch = mu * (1.0 - rho[i] / np.sqrt(s2[i]))
        w[i] = stretch if s2[i] > 0.0 else 0.0


@kernel
def _pull_along(here, there, now, then, s2, square, w, align, u):
    """Add one component of the force of one agent on all agents that perceive that agent to `u`."""
    for i in range(u.size):
        force = w[i] * (there - here[i]) + align[i] * (then - now[i])
        u[i] += force if s2[i] <= square[i] else 0.0


@kernel
def _pull_all(x, v, square, mu, rho, align, s2, w, u):
    """Write the sums of spring and alignment forces of all pairs to `u`, one perceived agent at a time."""
    # in the order in which `_pull` adds to each agent's sum; loops over agents are compiled to SIMD
    u[:] = 0.0
    for j in range(s2.size):
        _squares(x, j, s2)
        _springs(s2, mu, rho, w)
        for c in range(x.shape[0]):
            _pull_along(x[c], x[c, j], v[c], v[c, j], s2, square, w, align, u[c])


@kernel
def _many_steps(x, v, square, edges, dt, steps):
    m, n = x.shape
    _, spacing, is_shared, mu, sigma, is_normalised = edges
    qs, ps, us = np.empty((steps, n, m)), np.empty((steps, n, m)), np.empty((steps, n, m))
    count, s2, w, u = np.empty(n), np.empty(n), np.empty(n), np.empty((m, n))
    rho, align_weights = spacing.copy(), np.full(n, sigma)
    for k in range(steps):
        if is_shared or is_normalised:
            _numbers(x, square, s2, count)
        for i in range(n):
            if is_shared:
                rho[i] = spacing[i] * count[i]
            if is_normalised:
                total = sigma * count[i]
                align_weights[i] = sigma / total if total > 0.0 else 0.0
        _pull_all(x, v, square, mu, rho, align_weights, s2, w, u)
        for i in range(n):
            for c in range(m):
                v[c, i] += dt * u[c, i]
                x[c, i] += dt * v[c, i]
                qs[k, i, c], ps[k, i, c], us[k, i, c] = x[c, i], v[c, i], u[c, i]
    return qs, ps, us


def semi_implicit_steps(
    q: FloatArray, p: FloatArray, edges: EqualEdges, dt: float, steps: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return semi-implicit Euler steps of few agents: q, p after each and u before, (steps, n, m)."""
    reach = float(edges.radius.max()) * _SLACK
    # where r² under- or overflows the strict search finds fewer pairs than the filter
    squared_radii = np.minimum(edges.radius * edges.radius, np.nextafter(max(reach * reach, 5e-324), 0.0))
    x, v = q.T.copy(), p.T.copy()
    step_series: tuple[FloatArray, FloatArray, FloatArray] = _many_steps(x, v, squared_radii, edges, dt, steps)
    return step_series
