"""Sums over agents and the obstacles of one kind: a template (`flockana.kernels.bound_templates`).

``pars[starts[k]:starts[k + 1]]`` are the parameters of obstacle k, ``balls[k]`` is (centre, radius) of a ball that
holds it: agents farther from the ball than the range cost one distance.
"""

import numpy as np

from flockana.jit import kernel, register_jitable
from flockana.kernels.alpha import adjacency_beta_slope, pair_beta, pair_beta_slope, psi_beta
from flockana.kernels.encounter_checks import SLACK
from flockana.kernels.obstacle_crossings import LOOKS, MARCHES, TOUCH, longest, out_of_reach, point_at, within_reach
from flockana.kernels.obstacle_terms import BETA, C1, C2, REACH, STARTS, bodies_of
from flockana.kernels.obstacles import no_turn as turn  # bound
from flockana.kernels.obstacles import project_nothing as project  # bound
from flockana.kernels.quintic_paths import reach_of
from flockana.kernels.scalars import sigma_norm


@kernel
def forces(q, p, bodies, beta, reach, gains, u):
    """Add c1 φ_β n̂_ik + c2 b_ik (p̂_ik − p_i) to u_i for every obstacle in reach; return Σ b_ik ⟨p_i, p̂_ik − p_i⟩."""
    (pars, starts, balls), (c1, c2), total = bodies, gains, 0.0
    n, m = q.shape
    x, v, gap, rate = np.empty(m), np.empty(m), np.empty(m), np.empty(m)  # no slices: a view costs as much as a sum
    near_agents, s2 = np.empty(n, np.int64), np.empty(n)
    for k in range(balls.shape[0]):
        par = pars[starts[k] : starts[k + 1]]
        for e in range(within_reach(q, balls, k, reach, s2, near_agents)):
            i = near_agents[e]
            for c in range(m):
                x[c], v[c] = q[i, c], p[i, c]
            clearance = project(x, v, par, gap, rate)
            if abs(clearance) >= reach:
                continue
            w, b = pair_beta(clearance * clearance, beta)
            for c in range(m):
                velocity_difference = rate[c] - p[i, c]
                u[i, c] += c1 * w * gap[c] + c2 * b * velocity_difference
                total += b * p[i, c] * velocity_difference
    return total


@kernel
def potential(q, bodies, beta, panels, reach):
    """Return the potential Σ ψ_β over agents and the obstacles of one kind."""
    (pars, starts, balls), total = bodies, 0.0
    n, m = q.shape
    x, zero_velocity, gap, rate = np.empty(m), np.zeros(m), np.empty(m), np.empty(m)
    near_agents, s2 = np.empty(n, np.int64), np.empty(n)
    for k in range(balls.shape[0]):
        par = pars[starts[k] : starts[k + 1]]
        for e in range(within_reach(q, balls, k, reach, s2, near_agents)):
            for c in range(m):
                x[c] = q[near_agents[e], c]
            clearance = project(x, zero_velocity, par, gap, rate)
            total += psi_beta(sigma_norm(clearance * clearance, beta[0]), beta, panels)
    return total


@kernel
def agents(q, p, par, gap, rate, clearance):
    """Fill arrays with the β-agents of one obstacle, one for every agent."""
    n, m = q.shape
    x, v, g, w = np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    for i in range(n):
        for c in range(m):
            x[c], v[c] = q[i, c], p[i, c]
        clearance[i] = project(x, v, par, g, w)
        for c in range(m):
            gap[i, c], rate[i, c] = g[c], w[c]


@kernel
def slopes(q, par, beta, reach, blocks):
    """Add the Hessian of one obstacle's potential ψ_β to every agent's m × m block."""
    # ∇ψ_β = −w (q̂ − q), so its derivative along e_c is w (e_c − D e_c) + 2 w' (q̂ − q)_c (q̂ − q), D = dq̂/dq
    n, m = q.shape
    axis, gap, rate = np.zeros(m), np.empty(m), np.empty(m)
    for i in range(n):
        for c in range(m):
            axis[c] = 1.0
            clearance = project(q[i], axis, par, gap, rate)
            if abs(clearance) < reach:
                w = pair_beta(clearance * clearance, beta)[0]
                slope = pair_beta_slope(clearance * clearance, beta)
                for e in range(m):
                    blocks[i, e, c] += w * (axis[e] - rate[e]) + 2.0 * slope * gap[c] * gap[e]
            axis[c] = 0.0


@kernel
def braking(q, p, par, beta, reach, by_position, by_velocity):
    """Add one obstacle's derivatives of b_ik (p̂_ik − p_i) by position and velocity to the agents' blocks."""
    # d(s²) = −2 (q̂ − q)·dq, since D (q̂ − q) = 0
    n, m = q.shape
    axis, gap, rate, projected, turn_rate = np.zeros(m), np.empty(m), np.empty(m), np.empty(m), np.empty(m)
    for i in range(n):
        clearance = project(q[i], p[i], par, gap, rate)
        if abs(clearance) >= reach:
            continue
        s2 = clearance * clearance
        b, slope = pair_beta(s2, beta)[1], adjacency_beta_slope(s2, beta)
        velocity_difference = rate - p[i]
        for c in range(m):
            axis[c] = 1.0
            project(q[i], axis, par, gap, projected)
            turn(q[i], p[i], axis, par, turn_rate)
            for e in range(m):
                by_velocity[i, e, c] += b * (projected[e] - axis[e])
                by_position[i, e, c] += b * turn_rate[e] - 2.0 * slope * velocity_difference[e] * gap[c]
            axis[c] = 0.0


@register_jitable
def _distance(q, par, room):
    """Return the distance of a position from an obstacle's surface; `room` is work space."""
    return abs(project(q, room[0], par, room[1], room[2]))


@kernel
def _visit(curve, edge, far, par, here, room):
    """Return the fraction of a step at which an agent is first well within the distance `edge`; 1 if never."""
    # The distance from an obstacle changes by no more than the way: so far beyond the edge may be gone safely.
    control_legs = 5.0 * (curve[1:] - curve[:-1])
    fastest, s = longest(control_legs), 0.0
    if fastest == 0.0:
        return 1.0
    for _ in range(MARCHES):
        point_at(curve, s, here)
        gap = _distance(here, par, room) - edge
        if gap <= TOUCH * edge:
            break
        s += gap / fastest
        if s >= 1.0:
            return 1.0
    rate = np.zeros((1, 3))
    point_at(control_legs, s, rate[0, : here.size])
    speed = longest(rate)
    final_share = min(1.0, s + far / speed) if speed > 0.0 else 1.0
    stop, nearest = s, np.inf
    for k in range(LOOKS):
        sample_share = s + (final_share - s) * k / (LOOKS - 1)
        point_at(curve, sample_share, here)
        distance = _distance(here, par, room)
        if distance < nearest:
            stop, nearest = sample_share, distance
    return 1.0 if s + SLACK * (stop - s) >= 1.0 or stop <= s else stop


@kernel
def guard(points, allowance, numbers, shell, far, most):
    """Return the fraction of a step, at most `most`, in which no agent skips an obstacle's surroundings.

    An agent, on a path with control points (n, 6, 3), may not pass the distance `shell`, nor go `far` within it.
    """
    pars, starts, balls = bodies_of(numbers)
    m = balls.shape[1] - 1
    point, workspace = np.empty(m), np.zeros((3, m))  # a place, and for the projection: rest, gap and rate
    begin, end = points[:, 0], points[:, 5]
    for i in range(points.shape[0]):
        path_reach, edge = reach_of(points[i]), shell + allowance[i]
        reach = path_reach + allowance[i]
        for k in range(balls.shape[0]):
            if out_of_reach(begin, i, balls, k, shell + reach):
                continue
            for c in range(m):
                point[c] = begin[i, c]
            par = pars[starts[k] : starts[k + 1]]
            edge_distance = _distance(point, par, workspace) - edge
            if edge_distance < 0.0:
                if path_reach > SLACK * far:
                    most = min(most, far / path_reach)
                continue
            if edge_distance >= reach:
                continue
            for c in range(m):
                point[c] = end[i, c]
            if path_reach <= far and _distance(point, par, workspace) < edge:
                continue  # the evaluation at the end of the step meets it
            most = min(most, _visit(points[i], edge, far, par, point, workspace))
    return most


@kernel
def act(t, x, v, u, numbers, panels, listed):
    """Add the forces of obstacles as a term of a law, and return their power."""
    law, reach, gains = numbers[BETA:STARTS], numbers[REACH], (numbers[C1], numbers[C2])
    return gains[1] * forces(x + listed.frame[0], v + listed.frame[1], bodies_of(numbers), law, reach, gains, u)


@kernel
def energy(t, x, v, numbers, panels, listed):
    """Return the energy c1 Σ ψ_β of the obstacle term."""
    positions = x + listed.frame[0]
    return numbers[C1] * potential(positions, bodies_of(numbers), numbers[BETA:STARTS], panels, numbers[REACH])
