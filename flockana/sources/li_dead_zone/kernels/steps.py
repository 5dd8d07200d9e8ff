"""Semi-implicit Euler steps of the dead-zone law, many in one loop."""

from math import inf, sqrt

import numpy as np

from flockana.jit import kernel, register_jitable
from flockana.kernels.agent_sums import put
from flockana.sources.li_dead_zone.kernels.pair import D_1, D_2, K_1, R, pair_dead_zone

_AHEAD = 30.0  # steps that a list is made for, at the speeds of its time


# Loops over arrays without branches become vector instructions: no check for a zero divisor stands in their way. The
# order of every sum is written down, so that all processors give the same bits, and so does every list that is kept.
# Two components are summed at a time: what is read of a pair serves both. An odd one goes with a row of zeros.
@kernel
def semi_implicit_steps(q, p, par, c2, dt, wanted):
    """Return q, p after the requested steps (rising numbers), and the applied u, by semi-implicit Euler.

    Neighbours pull by k₁ and c₂ alone where nothing else acts, which is a sum over a table of who is in range. Pairs
    that may act otherwise, or come into range, are listed with a skin: the list holds until somebody has moved by half
    of it beside the mean velocity of its making.
    """
    n, m = q.shape
    shape = (wanted.size, n, m)
    kept_q, kept_p, kept_u = np.empty(shape), np.empty(shape), np.empty(shape)
    rows, wide = m + m % 2, 8 * ((n + 7) // 8)  # by eights no vector of the machine leaves a rest
    x, v, u, z = np.zeros((rows, n)), np.zeros((rows, n)), np.zeros((rows, wide)), np.zeros((rows, wide))
    for c in range(m):
        x[c], v[c] = q[:, c], p[:, c]
    is_near, degree = np.zeros((4 * ((n + 3) // 4), wide), np.bool_), np.empty(n)
    then, skin, listed = np.full((rows, n), inf), 0.0, 0
    drift, squares, last_update, row = np.zeros(rows), np.empty(n), 0, 0
    most = n * (n - 1) // 2
    first_agents, partners, is_inside = np.empty(most, np.uint32), np.empty(most, np.uint32), np.empty(most, np.uint8)
    ends = np.empty(n, np.uint32)  # of each agent's pairs with later ones in the list
    s2, w, d, both = np.empty(most), np.empty(most), np.empty((rows // 2, most, 2)), np.empty((n, 2))
    r, k_1, square = par[R], par[K_1], _square_of_range(par[R])
    constants = (par[0], par[1], par[2], 0.0, par[4], par[5], par[6], par[7], par[8])  # without k₁, in registers
    for step in range(1, wanted[-1] + 1 if wanted.size else 1):
        if _moved_beyond(x, then, drift, (step - last_update) * dt, 0.25 * skin * skin, squares):
            skin = 1e-3 * r + _AHEAD * dt * _spread(v, drift)
            listed = _listed(x, par, skin, is_near, degree, first_agents, partners, is_inside, ends)
            put(x, then)
            last_update = step
        s2[:listed] = 0.0
        for c in range(0, rows, 2):
            _part(x[c], x[c + 1], first_agents, partners, listed, d[c // 2], s2)
        change_count = 0
        for k in range(listed):
            w[k] = pair_dead_zone(s2[k], constants)[0] if s2[k] < square else 0.0
            change_count += (s2[k] < square) != (is_inside[k] == 1)
        if change_count:
            _crossed(s2, square, listed, is_near, degree, first_agents, partners, is_inside)
        for c in range(rows):
            for i in range(n):
                z[c, i], u[c, i] = k_1 * (x[c, i] - x[c, 0]) + c2 * (v[c, i] - v[c, 0]), 0.0
        for c in range(0, rows, 2):
            _gather(is_near, degree, z[c], z[c + 1], u[c], u[c + 1])
            _scatter(w, d[c // 2], partners, ends, u[c], u[c + 1], both)
        for c in range(m):
            x_c, v_c, u_c = x[c], v[c], u[c]
            for i in range(n):
                v_c[i] += dt * u_c[i]
                x_c[i] += dt * v_c[i]
        if step == wanted[row]:
            for c in range(m):
                for i in range(n):
                    kept_q[row, i, c], kept_p[row, i, c], kept_u[row, i, c] = x[c, i], v[c, i], u[c, i]
            row += 1
    return kept_q, kept_p, kept_u


@register_jitable
def _part(x, y, first, second, kept, d, s2):
    """Write two components of the difference of each listed pair to `d`, and add their squares to `s2`."""
    for k in range(kept):
        i, j = first[k], second[k]
        dx, dy = x[j] - x[i], y[j] - y[i]
        d[k, 0], d[k, 1] = dx, dy
        s2[k] = dy * dy + (dx * dx + s2[k])


@register_jitable
def _gather(near, degree, y, z, u, v):
    """Add Σ_j near[i, j] (y_j − y_i) to u_i for every agent i, and Σ_j near[i, j] (z_j − z_i) to v_i."""
    for j in range(0, len(near), 4):
        a = near[j : j + 4]
        y_0, y_1, y_2, y_3 = y[j], y[j + 1], y[j + 2], y[j + 3]
        z_0, z_1, z_2, z_3 = z[j], z[j + 1], z[j + 2], z[j + 3]
        for i in range(len(y)):
            a_0, a_1, a_2, a_3 = a[0, i], a[1, i], a[2, i], a[3, i]
            u[i] += ((y_0 if a_0 else 0.0) + (y_1 if a_1 else 0.0)) + ((y_2 if a_2 else 0.0) + (y_3 if a_3 else 0.0))
            v[i] += ((z_0 if a_0 else 0.0) + (z_1 if a_1 else 0.0)) + ((z_2 if a_2 else 0.0) + (z_3 if a_3 else 0.0))
    for i in range(len(degree)):
        u[i] -= degree[i] * y[i]
        v[i] -= degree[i] * z[i]


@register_jitable
def _scatter(w, d, second, ends, u, v, both):
    """Add forces w d of listed pairs to u and v on both their agents."""
    for i in range(len(ends)):
        both[i, 0], both[i, 1] = u[i], v[i]
    begin = 0
    for i in range(len(ends)):
        own_entry, second_entry = both[i, 0], both[i, 1]  # in registers, not stored and loaded again from pair to pair
        for k in range(begin, ends[i]):
            j, f, g = second[k], w[k] * d[k, 0], w[k] * d[k, 1]
            own_entry += f
            second_entry += g
            both[j, 0] -= f
            both[j, 1] -= g
        both[i, 0], both[i, 1], begin = own_entry, second_entry, ends[i]
    for i in range(len(ends)):
        u[i], v[i] = both[i, 0], both[i, 1]


@kernel
def _square_of_range(r):
    """Return the least number whose square root is not below r, so that `s2 < square` means √s2 < r exactly."""
    squared_value = r * r
    while sqrt(squared_value) >= r:
        squared_value = np.nextafter(squared_value, 0.0)
    while sqrt(squared_value) < r:
        squared_value = np.nextafter(squared_value, inf)
    return squared_value


@kernel
def _crossed(s2, square, kept, near, degree, first, second, inside):
    """Record which listed pairs have entered or left the range."""
    for k in range(kept):
        is_inside = s2[k] < square
        if is_inside != (inside[k] == 1):
            i, j, change = first[k], second[k], 1.0 if is_inside else -1.0
            inside[k], near[i, j], near[j, i] = is_inside, is_inside, is_inside
            degree[i] += change
            degree[j] += change


@register_jitable
def _moved_beyond(x, then, drift, passed, square, squares):
    """Return whether an agent's displacement relative to the drift exceeds √square, or is NaN."""
    # where `square` is infinite a list would hold for ever, and pairs at distances that overflow are on none
    squares[:] = 0.0
    for c in range(len(x)):
        x_c, then_c, drift_passed = x[c], then[c], passed * drift[c]
        for i in range(len(squares)):
            squares[i] += (x_c[i] - then_c[i] - drift_passed) ** 2
    far_count = 0 if square < inf else 1
    for i in range(len(squares)):
        far_count += not squares[i] <= square
    return far_count > 0


@kernel
def _spread(v, drift):
    """Return the largest speed relative to the mean velocity, which is written to `drift`."""
    largest = 0.0
    for c in range(len(v)):
        drift[c] = v[c].mean()
    for i in range(v.shape[1]):
        squared_value = 0.0
        for c in range(len(v)):
            squared_value += (v[c, i] - drift[c]) ** 2
        largest = max(largest, squared_value)
    return sqrt(largest)


@kernel
def _listed(x, par, skin, near, degree, first, second, inside, ends):
    """List all pairs but those more than a skin deep in the dead zone or beyond the range."""
    m, n = x.shape
    low, high, r = par[D_1] + skin, min(par[D_2], par[R]) - skin, par[R]
    pair_count = 0
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
                first[pair_count], second[pair_count], inside[pair_count] = i, j, s < r
                pair_count += 1
        ends[i] = pair_count
    return pair_count
