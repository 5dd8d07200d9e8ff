"""Pairs that come into range *between* samples, by the sign of ρ² - r² along quintics through (q, p, u).

The squared distance of two agents on their quintics is a polynomial of degree 10. Its Bernstein coefficients bound it,
and those of its derivative tell that it rises or falls, on pieces that are halved until one of the two is decided.
"""

import numpy as np

from flockana.jit import kernel
from flockana.kernels.agent_sums import square_between
from flockana.kernels.quintic_paths import control_points

NEVER, UNSURE, ENTERS = 0, 1, 2
_DEPTH = 30  # halvings of an interval: a visit that is shorter is left open
_WIGGLE = 10.0  # slope of what the path may be off the quintic, in its size over the interval
_ROUNDING = 2.0**-46  # of the largest coefficient: some dozen roundings in each
_CHOOSE = np.array([1.0, 5.0, 10.0, 10.0, 5.0, 1.0])
_CHOOSE_10 = np.array([1.0, 10.0, 45.0, 120.0, 210.0, 252.0, 210.0, 120.0, 45.0, 10.0, 1.0])


@kernel
def _squared(points, i, j, r, out):
    """Write the Bernstein coefficients of ρ² − r², with ρ the distance of two agents on quintic paths."""
    for k in range(11):
        out[k] = 0.0
    for a in range(6):
        for b in range(6):
            dot = 0.0
            for x in range(3):
                dot += (points[j, a, x] - points[i, a, x]) * (points[j, b, x] - points[i, b, x])
            out[a + b] += _CHOOSE[a] * _CHOOSE[b] / _CHOOSE_10[a + b] * dot
    for k in range(11):
        out[k] -= r * r


@kernel
def _halve(stack, top):
    """Halve the polynomial stack[top]: the left half is pushed, the right half stays."""
    c = stack[top]
    for level in range(11):
        stack[top + 1, level] = c[0]
        for k in range(10 - level):
            c[k] = 0.5 * (c[k] + c[k + 1])


@kernel
def _slopes(c):
    """Return the least and largest difference of adjacent Bernstein coefficients, a tenth of the slope."""
    minimum, maximum = np.inf, -np.inf
    for k in range(10):
        minimum, maximum = min(minimum, c[k + 1] - c[k]), max(maximum, c[k + 1] - c[k])
    return minimum, maximum


@kernel
def _follow(stack, widths, band, slope_band, was_out):
    """Return (whether a pair was out of range; NEVER, UNSURE or ENTERS) along the polynomial ρ² − r²."""
    side = NEVER
    widths[0], top = 1.0, 0
    while top >= 0:
        c, width = stack[top], widths[top]
        minimum, maximum = c.min(), c.max()
        slopes = _slopes(c)
        if minimum > band:
            was_out, top = True, top - 1
        elif maximum < -band:
            if was_out:
                return was_out, ENTERS
            top -= 1
        elif slopes[0] * 10.0 > slope_band * width:  # it rises: from within the range, if it was
            if was_out and c[0] < -band:
                return was_out, ENTERS
            was_out = was_out or c[10] > band
            top -= 1
        elif slopes[1] * 10.0 < -slope_band * width and (c[0] > band or was_out) and c[10] < -band:
            return True, ENTERS
        elif width < 2.0**-_DEPTH or (minimum >= -band and maximum <= band):
            was_out = was_out or c[0] > band or c[10] > band
            side, top = UNSURE, top - 1
        else:
            _halve(stack, top)
            widths[top] = widths[top + 1] = 0.5 * width
            top += 1
    return was_out, side


@kernel
def follow_pairs(h, start, end, r, noise, was_out, unsure):
    """Follow every pair for one interval; return the first that comes into range for certain, or (-1, -1).

    `start` and `end` are (q, p, u). `was_out` and `unsure` are flags of all pairs in lexicographic order; `noise` is
    (the rounding of a distance, and by how much it and its rate may be off the true ones).
    """
    rounding, place, speed = noise
    (q0, p0, u0), (q1, p1, u1), n = start, end, start[0].shape[0]
    points, reach, allowance = control_points(h, q0, p0, u0, q1, p1, u1)
    stack, widths, k = np.empty((_DEPTH + 3, 11)), np.empty(_DEPTH + 3), -1
    for i in range(n):
        for j in range(i + 1, n):
            k += 1
            s2 = 0.0
            for x in range(3):
                s2 += (points[j, 0, x] - points[i, 0, x]) ** 2
            s, way = np.sqrt(s2), reach[i] + reach[j] + rounding + place
            if s - way > r:
                was_out[k] = True
                continue
            if s + way < r and not was_out[k]:
                continue
            off = allowance[i] + allowance[j] + rounding
            slack = off + place
            _squared(points, i, j, r, stack[0])
            threshold = _ROUNDING * np.abs(stack[0]).max()
            band = (4.0 * r + slack) * slack + threshold
            slope_band = _WIGGLE * ((4.0 * r + slack) * off + threshold) + 4.0 * ((r + slack) * speed * h + way * place)
            was_out[k], side = _follow(stack, widths, band, slope_band, was_out[k])
            if side == ENTERS:
                return i, j
            if side == UNSURE:
                unsure[k] = True
    return -1, -1


@kernel
def follow_steps(q, r, noise, was_out, unsure):
    """Follow every pair for one state of a map; return the first that was out of range and is in it, or (-1, -1)."""
    n, k = len(q), -1
    for i in range(n):
        for j in range(i + 1, n):
            k += 1
            s2 = square_between(q, i, j)
            s = np.sqrt(s2)
            if s > r + noise:
                was_out[k] = True
            elif s < r - noise:
                if was_out[k]:
                    return i, j
            else:
                unsure[k] = True
    return -1, -1
