"""The dead-zone pair law as scalar functions of the distance ρ, its sums with every pair held in its zone, its steps.

Parameters are a vector of float64 whose places have the names below: INNER is ψ where the inner ramp begins, OUTER
where the outer one ends. Zones of a pair: 0 repulsion, 1 dead zone, 2 attraction, 3 out of range. Without a ramp the
force jumps between them; `zone_forces` continues each piece smoothly beyond its zone, which is what a located switch
needs.
"""

from __future__ import annotations

from math import inf, log, log1p, sqrt

import numpy as np

from flockana.kernels.compiling import njit, register_jitable
from flockana.kernels.copies import put
from flockana.kernels.scalars import on_panels

REPULSION, DEAD, ATTRACTION, OUT = 0, 1, 2, 3
_AHEAD = 30.0  # steps that a list is made for, at the speeds of its time
ETA, K_R, K_DELTA, K_1, D_1, D_2, R, R_D, RAMP, INNER, OUTER = range(11)


@register_jitable
def repulsion(s, par):
    """2k_r/s² + k_δ, without ramp."""
    return 2.0 * par[K_R] / (s * s) + par[K_DELTA] if s > 0.0 else inf


@register_jitable
def attraction(s, par):
    """2k_r/(r_d − s)² + k_δ, without ramp."""
    return 2.0 * par[K_R] / (par[R_D] - s) ** 2 + par[K_DELTA]


@register_jitable
def zone_of(s, par):
    """Which zone a pair at distance s is in; the dead zone is closed, the range open."""
    if s >= par[R]:
        return OUT
    if s < par[D_1]:
        return REPULSION
    return DEAD if s <= par[D_2] else ATTRACTION


@register_jitable
def action(s, par):
    """f(s): negative repels, positive attracts; ramped to 0 at both ends of the dead zone."""
    zone, ramp = zone_of(s, par), par[RAMP]
    if zone == REPULSION:
        return -repulsion(s, par) * (min(1.0, (par[D_1] - s) / ramp) if ramp > 0.0 else 1.0)
    if zone == ATTRACTION:
        return attraction(s, par) * (min(1.0, (s - par[D_2]) / ramp) if ramp > 0.0 else 1.0)
    return 0.0


@register_jitable
def action_slope(s, par):
    """df/ds off the edges of the zones."""
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
    """F(s) = f(s) s/√(1 + ηs²) + k₁ s within the range, 0 beyond: negative repels."""
    if s >= par[R]:
        return 0.0
    return action(s, par) * s / sqrt(1.0 + par[ETA] * s * s) + par[K_1] * s


@register_jitable
def repulsive_part(s, b, par):
    """∫_s^b (2k_r/x² + k_δ) x/√(1 + ηx²) dx for 0 < s ≤ b, every difference rearranged: η = 0 is no special case."""
    at_s, at_b = sqrt(1.0 + par[ETA] * s * s), sqrt(1.0 + par[ETA] * b * b)
    gap = (b - s) * (b + s) / (at_s + at_b)
    near = b < 2.0 * s  # else nothing cancels, and 1 + x would round
    ratio = log1p((b - s) / s) if near else log(b / s)
    roots = log1p(-par[ETA] * gap / (1.0 + at_b)) if near else log((1.0 + at_s) / (1.0 + at_b))
    return 2.0 * par[K_R] * (ratio + roots) + par[K_DELTA] * gap


@register_jitable
def attractive_part(a, s, par):
    """∫_a^s (2k_r/(r_d − x)² + k_δ) x/√(1 + ηx²) dx for a ≤ s < r_d."""
    eta, r_d = par[ETA], par[R_D]
    big = 1.0 + eta * r_d * r_d
    at_s, at_a, root = sqrt(1.0 + eta * s * s), sqrt(1.0 + eta * a * a), sqrt(big)
    pole = r_d / big * (at_s / (r_d - s) - at_a / (r_d - a))
    ratio = (1.0 + eta * r_d * s + root * at_s) / (1.0 + eta * r_d * a + root * at_a)
    logarithm = (log(ratio) + log((r_d - a) / (r_d - s))) / (big * root)
    return 2.0 * par[K_R] * (pole - logarithm) + par[K_DELTA] * (s - a) * (s + a) / (at_s + at_a)


@register_jitable
def potential(s, par, panels):
    """ψ(s) + ½ k₁ s²: closed form off the ramps, Chebyshev panels on them, constant from r on, ∞ at 0."""
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
    """(weight of q_j − q_i, a_ij) of a pair at squared distance s2 within the range: `action` without its branches."""
    s, steep = sqrt(s2), 1.0 / par[RAMP] if par[RAMP] > 0.0 else 1e300
    ramped = max(0.0, min(1.0, (s - par[D_2]) * steep)) - max(0.0, min(1.0, (par[D_1] - s) * steep))
    gap = s if s < par[D_1] else par[R_D] - s
    gap2 = gap * gap
    weight = ramped * (2.0 * par[K_R] + par[K_DELTA] * gap2) / (gap2 * sqrt(1.0 + par[ETA] * s2)) + par[K_1]
    return weight, 1.0


@register_jitable
def pair_dead_zone_slope(s2, par):
    """d(weight)/d(s2)."""
    s, g = sqrt(s2), 1.0 + par[ETA] * s2
    return 0.5 * (action_slope(s, par) / s - par[ETA] * action(s, par) / g) / sqrt(g)


@register_jitable
def pair_dead_zone_potential(s2, par, panels):
    """ψ + ½ k₁ s² of a pair at squared distance s2."""
    return potential(sqrt(s2), par, panels)


@register_jitable
def pair_dead_zone_adjacency_slope(s2, par):
    """da/d(s2) = 0: a_ij is 1 within the range and 0 beyond."""
    return 0.0


@njit(cache=True)
def zones(q, par):
    """Zone of every pair, shape (n(n−1)/2,), pairs in lexicographic order."""
    n, m = q.shape
    out, k = np.empty(n * (n - 1) // 2, np.int8), 0
    for i in range(n):
        for j in range(i + 1, n):
            s2 = 0.0
            for c in range(m):
                s2 += (q[j, c] - q[i, c]) ** 2
            out[k] = zone_of(sqrt(s2), par)
            k += 1
    return out


@njit(cache=True)
def zone_margins(q, zone, par):
    """How far inside its zone each pair is (negative beyond it), and whether the nearer edge is the upper one."""
    n, m = q.shape
    margins, upper, k = np.empty(zone.size), np.empty(zone.size, np.bool_), 0
    for i in range(n):
        for j in range(i + 1, n):
            s2 = 0.0
            for c in range(m):
                s2 += (q[j, c] - q[i, c]) ** 2
            s, z = sqrt(s2), zone[k]
            low = (0.0, par[D_1], par[D_2], par[R])[z]
            high = (par[D_1], min(par[D_2], par[R]), par[R], inf)[z]
            upper[k] = high - s < s - low if z != REPULSION else True
            margins[k] = high - s if upper[k] else s - low
            k += 1
    return margins, upper


@njit(cache=True)
def zone_forces(q, p, zone, par, c2, u):
    """Add every pair's force, continued beyond its zone and without ramps, to u; return Σ a_ij ‖p_j − p_i‖²."""
    n, m = q.shape
    total, k = 0.0, 0
    for i in range(n):
        for j in range(i + 1, n):
            z = zone[k]
            k += 1
            if z == OUT:
                continue
            s2 = 0.0
            for c in range(m):
                s2 += (q[j, c] - q[i, c]) ** 2
                total += (p[j, c] - p[i, c]) ** 2
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


# Loops over arrays without branches become vector instructions: no check for a zero divisor stands in their way. The
# order of every sum is written down, so that all processors give the same bits, and so does every list that is kept.
@njit(cache=True, error_model="numpy")
def semi_implicit_steps(q, p, par, c2, dt, steps):
    """`steps` semi-implicit Euler steps of the law: q, p after each of them and the u that was applied.

    Neighbours pull by k₁ and c₂ alone where nothing else acts, which is a sum over a table of who is in range. Pairs
    that may act otherwise, or come into range, are listed with a skin: the list holds until somebody has moved by half
    of it, seen from the centre.
    """
    n, m = q.shape
    all_q, all_p, all_u = np.empty((steps, n, m)), np.empty((steps, n, m)), np.empty((steps, n, m))
    x, v, u, z = q.T.copy(), p.T.copy(), np.empty((m, n)), np.zeros((m, n + 3))
    near, degree, then, skin, kept = np.zeros((n + 3, n)), np.empty(n), np.full((m, n), inf), 0.0, 0
    most = n * (n - 1) // 2
    first, second, inside = np.empty(most, np.uint32), np.empty(most, np.uint32), np.empty(most, np.uint8)
    ends = np.empty(n, np.uint32)  # of each agent's pairs with later ones in the list
    s2, w, d = np.empty(most), np.empty(most), np.empty((m, most))
    r, k_1, square = par[R], par[K_1], _square_of_range(par[R])
    held = (par[0], par[1], par[2], 0.0, par[4], par[5], par[6], par[7], par[8])  # without k₁, in registers
    for step in range(steps):
        if not _moved(x, then) <= 0.5 * skin:
            skin = 1e-3 * r + _AHEAD * dt * _moved(v, np.zeros((m, n)))
            kept = _listed(x, par, skin, near, degree, first, second, inside, ends)
            put(x, then)
        for c in range(m):
            x_c, d_c = x[c], d[c]
            for k in range(kept):
                d_c[k] = x_c[second[k]] - x_c[first[k]]
            for k in range(kept):
                s2[k] = d_c[k] * d_c[k] + (s2[k] if c > 0 else 0.0)
        changed = 0
        for k in range(kept):
            w[k] = pair_dead_zone(s2[k], held)[0] if s2[k] < square else 0.0
            changed += (s2[k] < square) != (inside[k] == 1)
        if changed:
            _crossed(s2, square, kept, near, degree, first, second, inside)
        for c in range(m):
            for i in range(n):
                z[c, i], u[c, i] = k_1 * (x[c, i] - x[c, 0]) + c2 * (v[c, i] - v[c, 0]), 0.0
            z_c, u_c = z[c], u[c]
            for j in range(0, n, 4):
                a_0, a_1, a_2, a_3 = near[j], near[j + 1], near[j + 2], near[j + 3]
                z_0, z_1, z_2, z_3 = z_c[j], z_c[j + 1], z_c[j + 2], z_c[j + 3]
                for i in range(n):
                    u_c[i] += (a_0[i] * z_0 + a_1[i] * z_1) + (a_2[i] * z_2 + a_3[i] * z_3)
            for i in range(n):
                u_c[i] -= degree[i] * z_c[i]
        begin = 0
        for i in range(n):
            for c in range(m):
                u_c, d_c = u[c], d[c]
                own = u_c[i]  # in a register, not stored and loaded again from pair to pair
                for k in range(begin, ends[i]):
                    f = w[k] * d_c[k]
                    own += f
                    u_c[second[k]] -= f
                u_c[i] = own
            begin = ends[i]
        for c in range(m):
            x_c, v_c, u_c = x[c], v[c], u[c]
            for i in range(n):
                v_c[i] += dt * u_c[i]
                x_c[i] += dt * v_c[i]
            for i in range(n):
                all_q[step, i, c], all_p[step, i, c], all_u[step, i, c] = x_c[i], v_c[i], u_c[i]
    return all_q, all_p, all_u


@njit(cache=True)
def _square_of_range(r):
    """The least number whose square root is not below r: `s2 < square` says that √s2 < r, to the bit."""
    square = r * r
    while sqrt(square) >= r:
        square = np.nextafter(square, 0.0)
    while sqrt(square) < r:
        square = np.nextafter(square, inf)
    return square


@njit(cache=True)
def _crossed(s2, square, kept, near, degree, first, second, inside):
    """Note which pairs of the list have come into range or left it."""
    for k in range(kept):
        now = s2[k] < square
        if now != (inside[k] == 1):
            i, j, more = first[k], second[k], 1.0 if now else -1.0
            inside[k], near[i, j], near[j, i] = now, now, now
            degree[i] += more
            degree[j] += more


@njit(cache=True)
def _moved(x, then):
    """The largest change of a place, less the mean change: at least that of a pair's distance, halved."""
    m, n = x.shape
    most = np.zeros(n)
    for c in range(m):
        mean = 0.0
        for i in range(n):
            mean += x[c, i] - then[c, i]
        mean /= n
        for i in range(n):
            most[i] += (x[c, i] - then[c, i] - mean) ** 2
    largest = 0.0
    for i in range(n):
        largest = most[i] if not most[i] <= largest else largest  # NaN is the largest
    return sqrt(largest)


@njit(cache=True)
def _listed(x, par, skin, near, degree, first, second, inside, ends):
    """List pairs within a skin of where they act by more than k₁ or come into range.

    Who is in range of whom goes to `near`, of how many to `degree`, and where each agent's pairs end to `ends`.
    """
    m, n = x.shape
    low, high, r = par[D_1] + skin, min(par[D_2], par[R]) - skin, par[R]
    kept = 0
    degree[:] = 0.0
    for i in range(n):
        for j in range(i + 1, n):
            s2 = 0.0
            for c in range(m):
                s2 += (x[c, j] - x[c, i]) ** 2
            s = sqrt(s2)
            near[i, j] = near[j, i] = s < r
            degree[i] += near[i, j]
            degree[j] += near[i, j]
            if not low <= s <= high and not s >= r + skin:
                first[kept], second[kept], inside[kept] = i, j, s < r
                kept += 1
        ends[i] = kept
    return kept
