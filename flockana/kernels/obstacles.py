"""From the closest-point map of one convex obstacle to sums over all agents and obstacles of its kind.

An obstacle kind is one scalar function, ``project(q, p, par, gap, rate) -> clearance``: it writes the gap q̂ − q from
the agent to its β-agent and the β-agent's velocity dq̂/dt into the last two arguments, and returns the signed distance
to the boundary, negative inside. The gap, not q̂, is what it gives: q̂ − q would cancel near the surface.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import sqrt

import numpy as np

from flockana.kernels.alpha import BETA_AREA, D_BETA, EPS, H, pair_beta, psi_beta
from flockana.kernels.bodies import Bodies, lift_bodies
from flockana.kernels.compiling import njit, register_jitable
from flockana.kernels.lift import source_digest
from flockana.kernels.scalars import bump, bump_slope, sigma_1, sigma_norm
from flockana.kernels.shells import lift_shells, within_reach


@dataclass(frozen=True)
class ObstacleKernels:
    """Compiled sums over agents and the obstacles of one kind.

    ``pars[starts[k]:starts[k + 1]]`` are the parameters of obstacle k, ``balls[k]`` is (centre, radius) of a ball
    that holds it: agents farther from the ball than the range cost one distance.

    Attributes
    ----------
    forces : callable
        ``forces(q, p, pars, starts, balls, beta, reach, c1, c2, u)`` adds c1 φ_β n̂_ik + c2 b_ik (p̂_ik − p_i) to u_i
        for every obstacle within reach, and returns Σ b_ik ⟨p_i, p̂_ik − p_i⟩.
    potential : callable
        ``potential(q, pars, starts, balls, beta, panels, reach)`` returns Σ ψ_β.
    agents : callable
        ``agents(q, p, par, gap, rate, clearance)`` fills the arrays for one obstacle and every agent.
    slopes : callable
        ``slopes(q, par, beta, reach, blocks)`` adds the Hessian block of ψ_β of one obstacle to every agent's.
    braking : callable
        ``braking(q, p, par, beta, reach, by_position, by_velocity)`` adds the derivatives of b_ik (p̂_ik − p_i) of one
        obstacle to every agent's blocks.
    share : callable
        ``share(points, allowance, pars, starts, balls, shell, far, share)`` returns how much of a step may be taken so
        that no agent leaps over the distance `shell` (`lift_shells`).
    bodies : Bodies
        Forces, potential and guard for compiled integrators (`flockana.kernels.bodies`).
    turns : bool
        Whether the kind says how p̂ turns as an agent moves; if not, `braking` is right where p = 0 alone.
    """

    forces: Callable[..., float]
    potential: Callable[..., float]
    agents: Callable[..., None]
    slopes: Callable[..., None]
    braking: Callable[..., None]
    share: Callable[..., float]
    bodies: Bodies
    turns: bool


@register_jitable
def adjacency_beta_slope(s2, par):
    """d(b_ik)/d(s²)."""
    z = sigma_norm(s2, par[EPS])
    return 0.5 * bump_slope(z / par[D_BETA], par[H]) / (par[D_BETA] * sqrt(1.0 + par[EPS] * s2))


@register_jitable
def pair_beta_slope(s2, par):
    """d/d(s²) of the weight of q̂_ik − q_i, what the Hessian of ψ_β needs beside the weight itself."""
    eps, h, d_beta, area = par[EPS], par[H], par[D_BETA], par[BETA_AREA]
    z, g = sigma_norm(s2, eps), 1.0 + eps * s2
    s, x = (z - d_beta) / area, z / d_beta
    phi = bump(x, h) * (sigma_1(s) - 1.0)
    slope = bump_slope(x, h) / d_beta * (sigma_1(s) - 1.0) + bump(x, h) / area / sqrt(1.0 + s * s) ** 3
    return 0.5 * (slope - eps * phi / sqrt(g)) / g


@register_jitable
def no_turn(q, p, e, par, out):
    """Flat faces: p̂ = Dp with a constant D."""
    out[:] = 0.0


def lift_obstacle(project: Callable[..., float], turn: Callable[..., None] | None = None) -> ObstacleKernels:
    """Compile the sums of an obstacle kind given by its closest-point map.

    Parameters
    ----------
    project : callable
        ``project(q, p, par, gap, rate) -> clearance``, a `register_jitable` function of one agent.
    turn : callable, optional
        ``turn(q, p, e, par, out)`` writes the derivative of dq̂/dt in q along e, at fixed p, into out: `no_turn` for
        flat faces. Only the Jacobian of a law at moving agents needs it.

    Returns
    -------
    ObstacleKernels
    """
    turns, turned = turn is not None, no_turn if turn is None else turn
    digest = source_digest(project, turned, pair_beta, lift_obstacle)

    @njit(cache=True)
    def forces(q, p, pars, starts, balls, beta, reach, c1, c2, u):
        total = 0.0 * digest
        n, m = q.shape
        x, v, gap, rate = np.empty(m), np.empty(m), np.empty(m), np.empty(m)  # no slices: a view costs as much as a sum
        near, s2 = np.empty(n, np.int64), np.empty(n)
        for k in range(balls.shape[0]):
            par = pars[starts[k] : starts[k + 1]]
            for e in range(within_reach(q, balls, k, reach, s2, near)):
                i = near[e]
                for c in range(m):
                    x[c], v[c] = q[i, c], p[i, c]
                clearance = project(x, v, par, gap, rate)
                if abs(clearance) >= reach:
                    continue
                w, b = pair_beta(clearance * clearance, beta)
                for c in range(m):
                    slip = rate[c] - p[i, c]
                    u[i, c] += c1 * w * gap[c] + c2 * b * slip
                    total += b * p[i, c] * slip
        return total

    @njit(cache=True)
    def potential(q, pars, starts, balls, beta, panels, reach):
        total = 0.0 * digest
        n, m = q.shape
        x, still, gap, rate = np.empty(m), np.zeros(m), np.empty(m), np.empty(m)
        near, s2 = np.empty(n, np.int64), np.empty(n)
        for k in range(balls.shape[0]):
            par = pars[starts[k] : starts[k + 1]]
            for e in range(within_reach(q, balls, k, reach, s2, near)):
                for c in range(m):
                    x[c] = q[near[e], c]
                clearance = project(x, still, par, gap, rate)
                total += psi_beta(sigma_norm(clearance * clearance, beta[0]), beta, panels)
        return total

    @njit(cache=True)
    def agents(q, p, par, gap, rate, clearance):
        n, m = q.shape
        x, v, g, w = np.empty(m), np.empty(m), np.empty(m), np.empty(m)
        for i in range(n):
            for c in range(m):
                x[c], v[c] = q[i, c], p[i, c]
            clearance[i] = project(x, v, par, g, w) + 0.0 * digest
            for c in range(m):
                gap[i, c], rate[i, c] = g[c], w[c]

    @njit(cache=True)
    def slopes(q, par, beta, reach, blocks):
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
                        blocks[i, e, c] += w * (axis[e] - rate[e]) + 2.0 * slope * gap[c] * gap[e] + 0.0 * digest
                axis[c] = 0.0

    @njit(cache=True)
    def braking(q, p, par, beta, reach, by_position, by_velocity):
        # d(s²) = −2 (q̂ − q)·dq, since D (q̂ − q) = 0
        n, m = q.shape
        axis, gap, rate, along, bend = np.zeros(m), np.empty(m), np.empty(m), np.empty(m), np.empty(m)
        for i in range(n):
            clearance = project(q[i], p[i], par, gap, rate)
            if abs(clearance) >= reach:
                continue
            s2 = clearance * clearance
            b, slope = pair_beta(s2, beta)[1], adjacency_beta_slope(s2, beta) + 0.0 * digest
            slip = rate - p[i]
            for c in range(m):
                axis[c] = 1.0
                project(q[i], axis, par, gap, along)
                turned(q[i], p[i], axis, par, bend)
                for e in range(m):
                    by_velocity[i, e, c] += b * (along[e] - axis[e])
                    by_position[i, e, c] += b * bend[e] - 2.0 * slope * slip[e] * gap[c]
                axis[c] = 0.0

    share = lift_shells(project, digest)
    bodies = lift_bodies(forces, potential, share)
    return ObstacleKernels(forces, potential, agents, slopes, braking, share, bodies, turns)


@register_jitable
def project_ball(q, p, centre, radius, along, gap, rate):
    """The β-agent on a sphere about `centre`, which itself moves at `along`: spheres and the rims of other bodies.

    `along` must be tangent to the sphere at the agent's foot (or zero); of `centre` the first m components are read.
    """
    s2, radial = 0.0, 0.0
    for c in range(q.size):
        s2 += (q[c] - centre[c]) ** 2
        radial += (q[c] - centre[c]) * p[c]
    distance = sqrt(s2)
    if distance == 0.0:  # the centre has no closest point
        for c in range(q.size):
            gap[c], rate[c] = np.nan, np.nan
        return -radius
    mu = radius / distance
    for c in range(q.size):
        a = (q[c] - centre[c]) / distance
        gap[c] = (radius - distance) * a
        rate[c] = along[c] + mu * (p[c] - along[c] - radial / distance * a)
    return distance - radius


@register_jitable
def turn_ball(q, p, e, centre, radius, p_centre, e_centre, out):
    """How the velocity on a sphere (`project_ball`) turns as the agent moves along e and the centre along e_centre.

    −(μ/ρ) [⟨a,e⟩ Pp + ⟨a,p⟩ Pe + a ⟨Pe,p⟩], symmetric in p and e, both relative to the centre; ⟨a,p⟩ sees no centre
    that moves tangentially.
    """
    s2 = 0.0
    for c in range(q.size):
        s2 += (q[c] - centre[c]) ** 2
    distance = sqrt(s2)
    ap, ae, pe = 0.0, 0.0, 0.0
    for c in range(q.size):
        a, slip, step = (q[c] - centre[c]) / distance, p[c] - p_centre[c], e[c] - e_centre[c]
        ap += a * slip
        ae += a * step
        pe += slip * step
    for c in range(q.size):
        a, slip, step = (q[c] - centre[c]) / distance, p[c] - p_centre[c], e[c] - e_centre[c]
        bend = ae * (slip - ap * a) + ap * (step - ae * a) + (pe - ap * ae) * a
        out[c] = -radius / s2 * bend
