"""Dead-zone pair law as scalar functions of the distance ρ, and sums with every pair held in its zone.

Parameters are a vector of float64 whose places have the names below: INNER is ψ where the inner ramp begins, OUTER
where the outer one ends. Zones of a pair: 0 repulsion, 1 dead zone, 2 attraction, 3 out of range. Without a ramp the
force jumps between them; `zone_forces` continues each piece smoothly beyond its zone, which is what a located switch
needs.
"""

from math import inf, log, log1p, sqrt

import numpy as np

from flockana.jit import kernel, register_jitable
from flockana.kernels.agent_sums import square_between
from flockana.kernels.integral_tables import on_panels

REPULSION, DEAD, ATTRACTION, OUT = 0, 1, 2, 3
ETA, K_R, K_DELTA, K_1, D_1, D_2, R, R_D, RAMP, INNER, OUTER = range(11)


@register_jitable
def repulsion(s, par):
    """Return the repulsive force 2k_r/s² + k_δ at distance s, without ramp."""
    return 2.0 * par[K_R] / (s * s) + par[K_DELTA] if s > 0.0 else inf


@register_jitable
def attraction(s, par):
    """Return the attractive force 2k_r/(r_d − s)² + k_δ at distance s, without ramp."""
    return 2.0 * par[K_R] / (par[R_D] - s) ** 2 + par[K_DELTA]


@register_jitable
def zone_of(s, par):
    """Return the zone of a pair at distance s; the dead zone is closed, the range open."""
    if s >= par[R]:
        return OUT
    if s < par[D_1]:
        return REPULSION
    return DEAD if s <= par[D_2] else ATTRACTION


@register_jitable
def action(s, par):
    """Return the scalar force f(s), negative where repulsive, ramped to 0 at the ends of the dead zone."""
    zone, ramp = zone_of(s, par), par[RAMP]
    if zone == REPULSION:
        return -repulsion(s, par) * (min(1.0, (par[D_1] - s) / ramp) if ramp > 0.0 else 1.0)
    if zone == ATTRACTION:
        return attraction(s, par) * (min(1.0, (s - par[D_2]) / ramp) if ramp > 0.0 else 1.0)
    return 0.0


@register_jitable
def action_slope(s, par):
    """Return the slope df/ds of the scalar force, away from the edges of the zones."""
    zone, ramp = zone_of(s, par), par[RAMP]
    if zone == REPULSION:
        slope, share = 4.0 * par[K_R] / s**3, (par[D_1] - s) / ramp if ramp > 0.0 else 1.0
        return slope * share + repulsion(s, par) / ramp if share < 1.0 else slope
    if zone == ATTRACTION:
        slope, share = 4.0 * par[K_R] / (par[R_D] - s) ** 3, (s - par[D_2]) / ramp if ramp > 0.0 else 1.0
        return slope * share + attraction(s, par) / ramp if share < 1.0 else slope
    return 0.0


@register_jitable
def force(s, par):
    """Return the pair force F(s) = f(s) s/√(1 + ηs²) + k₁ s within the range, 0 beyond; negative repels."""
    if s >= par[R]:
        return 0.0
    return action(s, par) * s / sqrt(1.0 + par[ETA] * s * s) + par[K_1] * s


@register_jitable
def repulsive_part(s, b, par):
    """Return the potential of repulsion, ∫_s^b (2k_r/x² + k_δ) x/√(1 + ηx²) dx, for 0 < s ≤ b."""
    root_at_s, root_at_b = sqrt(1.0 + par[ETA] * s * s), sqrt(1.0 + par[ETA] * b * b)
    gap = (b - s) * (b + s) / (root_at_s + root_at_b)
    is_close = b < 2.0 * s  # else nothing cancels, and 1 + x would round
    ratio = log1p((b - s) / s) if is_close else log(b / s)
    roots = log1p(-par[ETA] * gap / (1.0 + root_at_b)) if is_close else log((1.0 + root_at_s) / (1.0 + root_at_b))
    return 2.0 * par[K_R] * (ratio + roots) + par[K_DELTA] * gap


@register_jitable
def attractive_part(a, s, par):
    """Return the potential of attraction, ∫_a^s (2k_r/(r_d − x)² + k_δ) x/√(1 + ηx²) dx for s < r_d."""
    eta, r_d = par[ETA], par[R_D]
    squared_scale = 1.0 + eta * r_d * r_d
    root_at_s, root_at_a, root = sqrt(1.0 + eta * s * s), sqrt(1.0 + eta * a * a), sqrt(squared_scale)
    pole = r_d / squared_scale * (root_at_s / (r_d - s) - root_at_a / (r_d - a))
    ratio = (1.0 + eta * r_d * s + root * root_at_s) / (1.0 + eta * r_d * a + root * root_at_a)
    logarithm = (log(ratio) + log((r_d - a) / (r_d - s))) / (squared_scale * root)
    return 2.0 * par[K_R] * (pole - logarithm) + par[K_DELTA] * (s - a) * (s + a) / (root_at_s + root_at_a)


@register_jitable
def potential(s, par, panels):
    """Return the pair potential ψ(s) + ½ k₁ s², by Chebyshev panels on ramps; constant from r on, ∞ at 0."""
    if s <= 0.0:
        return inf
    x, ramp = min(s, par[R]), par[RAMP]
    pull = 0.5 * par[K_1] * x * x
    inner, outer = par[D_1] - ramp, par[D_2] + ramp
    if x <= inner:
        return repulsive_part(x, inner, par) + par[INNER] + pull
    if par[D_1] <= x <= par[D_2]:
        return pull
    if x < par[D_1] or x < outer:
        return on_panels(x, panels) + pull
    return attractive_part(outer, x, par) + par[OUTER] + pull


@register_jitable
def pair_dead_zone(s2, par):
    """Return (weight of q_j − q_i, a_ij) of a pair at squared distance s2 within range, without branches."""
    s, ramp_slope = sqrt(s2), 1.0 / par[RAMP] if par[RAMP] > 0.0 else 1e300
    ramp_value = max(0.0, min(1.0, (s - par[D_2]) * ramp_slope)) - max(0.0, min(1.0, (par[D_1] - s) * ramp_slope))
    gap = s if s < par[D_1] else par[R_D] - s
    gap2 = gap * gap
    weight = ramp_value * (2.0 * par[K_R] + par[K_DELTA] * gap2) / (gap2 * sqrt(1.0 + par[ETA] * s2)) + par[K_1]
    return weight, 1.0


@register_jitable
def pair_dead_zone_slope(s2, par):
    """Return the derivative by s2, the squared distance, of a pair's weight of q_j − q_i."""
    s, g = sqrt(s2), 1.0 + par[ETA] * s2
    return 0.5 * (action_slope(s, par) / s - par[ETA] * action(s, par) / g) / sqrt(g)


@register_jitable
def pair_dead_zone_potential(s2, par, panels):
    """Return the potential ψ + ½ k₁ s² of a pair at squared distance s2."""
    return potential(sqrt(s2), par, panels)


@register_jitable
def pair_dead_zone_adjacency_slope(s2, par):
    """Return the derivative 0 by s2 of the adjacency a_ij, which is 1 within the range and 0 beyond."""
    return 0.0


@kernel
def zones(q, par):
    """Return the zone of every pair, shape (n(n−1)/2,), pairs in lexicographic order."""
    n = len(q)
    zone_codes, k = np.empty(n * (n - 1) // 2, np.int8), 0
    for i in range(n):
        for j in range(i + 1, n):
            zone_codes[k] = zone_of(sqrt(square_between(q, i, j)), par)
            k += 1
    return zone_codes


@kernel
def zone_margins(q, zone, par):
    """Return each pair's distance from its zone's nearer edge, < 0 outside, and whether that is the upper edge."""
    n = len(q)
    margins, upper, k = np.empty(zone.size), np.empty(zone.size, np.bool_), 0
    for i in range(n):
        for j in range(i + 1, n):
            s, z = sqrt(square_between(q, i, j)), zone[k]
            low = (0.0, par[D_1], par[D_2], par[R])[z]
            high = (par[D_1], min(par[D_2], par[R]), par[R], inf)[z]
            upper[k] = high - s < s - low if z != REPULSION else True
            margins[k] = high - s if upper[k] else s - low
            k += 1
    return margins, upper


@kernel
def zone_forces(q, p, zone, par, c2, u):
    """Add every pair's force, continued beyond its zone, without ramps, to u; return Σ a_ij ‖p_j − p_i‖²."""
    n, m = q.shape
    total, k = 0.0, 0
    for i in range(n):
        for j in range(i + 1, n):
            z = zone[k]
            k += 1
            if z == OUT:
                continue
            for c in range(m):
                total += (p[j, c] - p[i, c]) ** 2
            s2 = square_between(q, i, j)
            s, f = sqrt(s2), 0.0
            if z == REPULSION:
                f = -repulsion(s, par)
            elif z == ATTRACTION:
                f = attraction(s, par)
            w = f / sqrt(1.0 + par[ETA] * s2) + par[K_1]
            for c in range(m):
                x = w * (q[j, c] - q[i, c]) + c2 * (p[j, c] - p[i, c])
                u[i, c] += x
                u[j, c] -= x
    return total
