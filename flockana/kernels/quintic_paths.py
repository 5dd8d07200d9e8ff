"""Distance of two agents *between* samples: quintics through (q, p, u), bounded by control points.

Between two samples a path is taken for the quintic Q that matches position, velocity and acceleration at both ends. In
Bernstein form it stays in the convex hull of its control points, so subdivision bounds the distance of a pair from
below for the whole interval: two crossings hidden in one step are found like one.

How far is the motion q itself from Q? Let L2 and L3 be the differences between the inner control points of Q and those
of the cubic C through positions and velocities alone (raised to degree five), and let q⁽ᵏ⁾ be of one sign on the
interval, coordinate by coordinate, for some k from 4 to 11: at these lengths the integrator, whose local error is of
such an order, has resolved the motion, kinks of the force included. Then ‖q − Q‖ ≤ 0.35 (‖L2‖ + ‖L3‖). For q is a cubic
plus ∫ (t − θ)₊ᵏ⁻¹ dμ(θ) with a μ of one sign; q − Q, L2 and L3 are linear in q and vanish for cubics; L2 and L3 of
every (t − θ)₊ᵏ⁻¹ are ≥ 0; and of each of these the bound holds (tests/kernels/test_quintic_paths.py): the allowance.
"""

import numpy as np

from flockana.jit import inlined, kernel, register_jitable, subroutine

ALLOWED = 0.35  # of ‖L2‖ + ‖L3‖: the largest quotient of a single truncated power is 0.3453
_DEPTH = 48  # halvings of an interval: below rounding of the time itself


@inlined
def _norm(x):
    return np.sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2])


@register_jitable
def polygon(a, b, out, back, bend0, bend1):
    """Return the control points of a coordinate's quintic from a to b, with h p/5 and h² u/20 at both ends."""
    return a, a + out, a + 2.0 * out + bend0, b - 2.0 * back + bend1, b - back, b


@subroutine
def quintic(h, a, p0, u0, b, p1, u1, out):
    """Write the control points of one agent's quintic from a to b into `out`, (6, 3); return its error allowance."""
    off2, off3 = 0.0, 0.0
    for k in range(a.size):
        bends = h * h * u0[k] / 20.0, h * h * u1[k] / 20.0
        points = polygon(a[k], b[k], h * p0[k] / 5.0, h * p1[k] / 5.0, bends[0], bends[1])
        out[0, k], out[1, k], out[2, k], out[3, k], out[4, k], out[5, k] = points
        c1, c2 = a[k] + h * p0[k] / 3.0, b[k] - h * p1[k] / 3.0
        off2 += (out[2, k] - (a[k] + 6.0 * c1 + 3.0 * c2) / 10.0) ** 2
        off3 += (out[3, k] - (3.0 * c1 + 6.0 * c2 + b[k]) / 10.0) ** 2
    return ALLOWED * (np.sqrt(off2) + np.sqrt(off3))


@kernel
def bernstein(h, q0, p0, u0, q1, p1, u1):
    """Return Bernstein control points (n, 6, 3), reach (n,) and error allowance (n,) of every agent's quintic.

    The reach bounds how far an agent gets from its first point. The allowance, which it includes, bounds how far the
    motion is from the quintic where the interval resolves it (see above).
    """
    n = q0.shape[0]
    points, reach, allowance = np.empty((n, 6, 3)), np.empty(n), np.empty(n)
    for i in range(n):
        for k in range(6):
            for c in range(3):
                points[i, k, c] = 0.0  # coordinates that there are not
        allowance[i] = quintic(h, q0[i], p0[i], u0[i], q1[i], p1[i], u1[i], points[i])
        reach[i] = reach_of(points[i]) + allowance[i]
    return points, reach, allowance


@subroutine
def reach_of(c):
    """Return the largest distance of a curve's control points (6, 3) from the first: a bound for the curve."""
    s2 = 0.0
    for k in range(1, 6):
        s2 = max(s2, (c[k, 0] - c[0, 0]) ** 2 + (c[k, 1] - c[0, 1]) ** 2 + (c[k, 2] - c[0, 2]) ** 2)
    return np.sqrt(s2)


@subroutine
def centred(points, allowance):
    """Subtract the flock's common drift from the control points in place; return the remaining reaches.

    No distance between agents changes.
    """
    n = points.shape[0]
    reach = np.empty(n)
    for c in range(1, 6):
        for k in range(3):
            drift = 0.0
            for i in range(n):
                drift += (points[i, c, k] - points[i, 0, k]) / n
            for i in range(n):
                points[i, c, k] -= drift
    for i in range(n):
        reach[i] = reach_of(points[i]) + allowance[i]
    return reach


@kernel
def control_points(h, q0, p0, u0, q1, p1, u1):
    """Return control points, reaches and error allowances of all agents' quintics, less the common drift."""
    points, _, allowance = bernstein(h, q0, p0, u0, q1, p1, u1)
    reach = centred(points, allowance)
    return points, reach, allowance


@subroutine
def _start(points, reach, i, j, stop, stack):
    """Load a pair's relative curve into the stack; return False if its ends exclude distances below stop."""
    s2 = 0.0
    for x in range(3):
        s2 += (points[j, 0, x] - points[i, 0, x]) ** 2
    if s2 >= (stop + reach[i] + reach[j]) ** 2:
        return False
    for k in range(6):
        for x in range(3):
            stack[0, k, x] = points[j, k, x] - points[i, k, x]
    return True


@subroutine
def _hull_bound(c):
    """Return a lower bound of the curve's distance to 0: its control points projected on their mean direction."""
    axis0, axis1, axis2 = 0.0, 0.0, 0.0
    for k in range(6):
        axis0, axis1, axis2 = axis0 + c[k, 0], axis1 + c[k, 1], axis2 + c[k, 2]
    magnitude = np.sqrt(axis0 * axis0 + axis1 * axis1 + axis2 * axis2)
    if magnitude == 0.0:
        return 0.0
    bound = np.inf
    for k in range(6):
        bound = min(bound, (c[k, 0] * axis0 + c[k, 1] * axis1 + c[k, 2] * axis2) / magnitude)
    return bound


@subroutine
def _halve(stack, spans, top):
    """Halve the curve stack[top] by de Casteljau: the left half is pushed, the right half stays."""
    c, left, right = stack[top], spans[top, 0], spans[top, 1]
    midpoint = 0.5 * (left + right)
    for level in range(6):
        for x in range(3):
            stack[top + 1, level, x] = c[0, x]
            for k in range(5 - level):
                c[k, x] = 0.5 * (c[k, x] + c[k + 1, x])
    spans[top, 0] = midpoint
    spans[top + 1, 0], spans[top + 1, 1] = left, midpoint


@subroutine
def _least_distance(stack, spans, stop, tol):
    """Return (lower bound, distance, parameter) of the closest point to 0 of the curve stack[0], within tol.

    The distance is (stop, -1) if none is below stop; the bound holds all the same, up to stop.
    The arrays are work space: (_DEPTH + 2, 6, 3) and (_DEPTH + 2, 2).
    """
    proven_bound, best_value, best_time = stop, stop, -1.0
    spans[0, 0], spans[0, 1] = 0.0, 1.0
    top = np.int64(0)  # typed: of a literal, `_halve` would be compiled once more
    while top >= 0:
        c, left, right = stack[top], spans[top, 0], spans[top, 1]
        for end in (0, 5):
            value = _norm(c[end])
            if value < best_value:
                best_value, best_time = value, left if end == 0 else right
        bound = _hull_bound(c)
        if bound >= best_value - tol or right - left < 2.0**-_DEPTH:
            proven_bound = min(proven_bound, bound)
            top -= 1
            continue
        _halve(stack, spans, top)
        top += 1
    return proven_bound, best_value, best_time


@subroutine
def _first_touch(stack, spans, tol):
    """Return the first parameter at which the curve stack[0] is within tol of 0; -1 if it never is."""
    spans[0, 0], spans[0, 1] = 0.0, 1.0
    top = np.int64(0)  # typed: of a literal, `_halve` would be compiled once more
    while top >= 0:
        left, right = spans[top, 0], spans[top, 1]
        if _norm(stack[top, 0]) < tol:
            return left
        if _hull_bound(stack[top]) >= tol:
            top -= 1
        elif right - left < 2.0**-_DEPTH:
            return left
        else:
            _halve(stack, spans, top)
            top += 1
    return -1.0


@kernel
def closest_pair(points, reach, allowance, first, second, stop, tol):
    """Return (lower bound, distance, parameter, i, j) over the pairs given; i = -1 if none comes below `stop`.

    The parameter is -1 where the bound is below `stop`, by the tolerance, and no place of the curve is. `reach` bounds
    how far each agent gets from its first control point.
    """
    lower, best_value, best_time, a, b = stop, stop, -1.0, -1, -1
    stack, time_spans = np.empty((_DEPTH + 2, 6, 3)), np.empty((_DEPTH + 2, 2))
    for k in range(first.size):
        i, j = first[k], second[k]
        slack = allowance[i] + allowance[j]
        if not _start(points, reach, i, j, lower + slack, stack):
            continue
        # there is no sense in resolving what the allowance blurs
        proven_bound, value, closest_time = _least_distance(stack, time_spans, lower + slack, max(tol, 0.01 * slack))
        if proven_bound - slack < lower:
            lower = max(0.0, proven_bound - slack)
            best_time, a, b = closest_time, i, j
        if closest_time >= 0.0:
            best_value = min(best_value, value)
        if lower == 0.0:
            break
    return lower, best_value, best_time, a, b


@kernel
def closest_of_few(t, states, slack, stops, tols):
    """Return `closest_pair` over all pairs of a small flock in each interval, five arrays; skip those with stop 0.

    `states` are (q, p, u) over time; `slack`, (T − 1, n), adds to reaches and allowances.
    """
    (q, p, u), steps, n = states, len(t) - 1, states[0].shape[1]
    first, second_agents = np.empty(n * (n - 1) // 2, np.int32), np.empty(n * (n - 1) // 2, np.int32)
    lower, distances, best_times = np.empty(steps), np.empty(steps), np.empty(steps)
    a, b, x = np.empty(steps, np.int64), np.empty(steps, np.int64), np.empty((n, 3))
    for k in range(steps):
        lower[k], distances[k], best_times[k], a[k], b[k] = stops[k], stops[k], -1.0, -1, -1
        if stops[k] == 0.0:
            continue
        points, reach, allowance = control_points(t[k + 1] - t[k], q[k], p[k], u[k], q[k + 1], p[k + 1], u[k + 1])
        farthest_reach, count = 0.0, 0
        for i in range(n):
            reach[i], allowance[i] = reach[i] + slack[k, i], allowance[i] + slack[k, i]
            x[i, 0], x[i, 1], x[i, 2] = points[i, 0, 0], points[i, 0, 1], points[i, 0, 2]
            if reach[i] > farthest_reach or np.isnan(reach[i]):
                farthest_reach = reach[i]
        limit = ((stops[k] + 2.0 * farthest_reach) * (1.0 + 1e-9)) ** 2
        for i in range(n):
            for j in range(i + 1, n):
                first[count], second_agents[count] = i, j
                d0, d1, d2 = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]
                count += d0 * d0 + d1 * d1 + d2 * d2 < limit
        approach = closest_pair(points, reach, allowance, first[:count], second_agents[:count], stops[k], tols[k])
        lower[k], distances[k], best_times[k], a[k], b[k] = approach
    return lower, distances, best_times, a, b


@kernel
def touching_pairs(points, reach, first, second, tol, out):
    """Mark in `out` the first parameter at which each pair's quintics are within tol of each other, -1 if never."""
    stack, time_spans = np.empty((_DEPTH + 2, 6, 3)), np.empty((_DEPTH + 2, 2))
    for k in range(first.size):
        out[k] = -1.0
        if not _start(points, reach, first[k], second[k], tol, stack):
            continue
        out[k] = _first_touch(stack, time_spans, tol)


@subroutine
def _largest_distance(stack, spans, enough, tol):
    """Return a bound of a curve's largest distance from 0, to `tol` or once below `enough`, and its parameter."""
    proven_bound, best_value, best_time = 0.0, 0.0, -1.0
    spans[0, 0], spans[0, 1] = 0.0, 1.0
    top = np.int64(0)  # typed: of a literal, `_halve` would be compiled once more
    while top >= 0:
        c, left, right = stack[top], spans[top, 0], spans[top, 1]
        for end in (0, 5):
            value = _norm(c[end])
            if value > best_value:
                best_value, best_time = value, left if end == 0 else right
        bound = 0.0
        for k in range(6):
            bound = max(bound, _norm(c[k]))
        if bound <= max(enough, best_value + tol) or right - left < 2.0**-_DEPTH:
            proven_bound = max(proven_bound, bound)
            top -= 1
            continue
        _halve(stack, spans, top)
        top += 1
    return proven_bound, best_time


@subroutine
def farthest(points, allowance, floor, tol):
    """Return (upper bound, agent, parameter) of the largest agent distance from the centre, at least `floor`.

    Changes the control points. The centre's allowance is the mean one.
    """
    n = points.shape[0]
    upper, agent, far_time, mean_slack = floor, -1, -1.0, 0.0
    stack, time_spans = np.empty((_DEPTH + 2, 6, 3)), np.empty((_DEPTH + 2, 2))
    for c in range(6):
        for k in range(3):
            centre = 0.0
            for i in range(n):
                centre += points[i, c, k] / n
            for i in range(n):
                points[i, c, k] -= centre
    for i in range(n):
        mean_slack += allowance[i] / n
    for i in range(n):
        slack = allowance[i] + mean_slack
        for c in range(6):
            for k in range(3):
                stack[0, c, k] = points[i, c, k]
        bound, best_time = _largest_distance(stack, time_spans, max(upper, floor + tol) - slack, tol)
        if bound + slack > upper:
            upper, agent, far_time = bound + slack, i, best_time
    return upper, agent, far_time


@kernel
def farthest_in_turn(t, states, slack, floors, tols):
    """Return an upper bound of the largest distance of an agent from the flock's centre in each interval."""
    (q, p, u), upper = states, np.empty(len(t) - 1)
    for k in range(len(t) - 1):
        points, _, allowance = bernstein(t[k + 1] - t[k], q[k], p[k], u[k], q[k + 1], p[k + 1], u[k + 1])
        for i in range(allowance.size):
            allowance[i] += slack[k, i]
        upper[k] = farthest(points, allowance, floors[k], tols[k])[0]
    return upper
