"""Obstacles in contact with an agent's zone, and their push: polygons, balls and the walls of a box.

The zone is a triangle in the plane and a cone in space: an altitude `depth` along the heading, and a half base `half`
across it. It is a body of revolution about the heading, so that against balls and walls both are one formula in the
axial and the lateral coordinate. Segments are rows (x0, y0, x1, y1), the counter-clockwise boundary of a polygon.
"""

from math import inf, sqrt

from flockana.jit import kernel


@kernel
def _cross(ax, ay, bx, by, x, y):
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax)


@kernel
def _between(ax, ay, bx, by, x, y):
    return min(ax, bx) <= x <= max(ax, bx) and min(ay, by) <= y <= max(ay, by)


@kernel
def segments_meet(ax, ay, bx, by, cx, cy, dx, dy):
    """Return whether two closed segments of the plane share a point, touching included."""
    o1, o2 = _cross(ax, ay, bx, by, cx, cy), _cross(ax, ay, bx, by, dx, dy)
    o3, o4 = _cross(cx, cy, dx, dy, ax, ay), _cross(cx, cy, dx, dy, bx, by)
    if ((o1 > 0.0) != (o2 > 0.0)) and ((o3 > 0.0) != (o4 > 0.0)) and o1 * o2 != 0.0 and o3 * o4 != 0.0:
        return True
    if o1 == 0.0 and _between(ax, ay, bx, by, cx, cy):
        return True
    if o2 == 0.0 and _between(ax, ay, bx, by, dx, dy):
        return True
    if o3 == 0.0 and _between(cx, cy, dx, dy, ax, ay):
        return True
    return o4 == 0.0 and _between(cx, cy, dx, dy, bx, by)


@kernel
def to_segment(x, y, ax, ay, bx, by):
    """Return the vector from a point to the closest point of a segment, possibly degenerate."""
    sx, sy = bx - ax, by - ay
    length2 = sx * sx + sy * sy
    share = 0.0
    if length2 > 0.0:
        share = min(1.0, max(0.0, (sx * (x - ax) + sy * (y - ay)) / length2))
    return ax + share * sx - x, ay + share * sy - y


@kernel
def to_boundary(x, y, edges, first, last):
    """Return (vector to the closest boundary point of the polygon edges[first:last], whether the point is inside)."""
    least_square, gx, gy, is_inside = inf, 0.0, 0.0, False
    for k in range(first, last):
        ax, ay, bx, by = edges[k, 0], edges[k, 1], edges[k, 2], edges[k, 3]
        ux, uy = to_segment(x, y, ax, ay, bx, by)
        s2 = ux * ux + uy * uy
        if s2 < least_square:
            least_square, gx, gy = s2, ux, uy
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            is_inside = not is_inside
    return gx, gy, is_inside


@kernel
def _in_zone(along, across, depth, half):
    """Return whether a triangular or conical zone contains a point given by axial and lateral coordinates."""
    return along >= 0.0 and along / depth + across / half <= 1.0


@kernel
def _crosses(zone, edge, literal):
    """Return whether a side of a triangular zone meets a segment; `literal` tests the sides at the agent only."""
    (x, y, hx, hy, depth, half_width), (cx, cy, dx, dy) = zone, edge
    ax, ay = x + depth * hx, y + depth * hy
    rx, ry, lx, ly = x + half_width * hy, y - half_width * hx, x - half_width * hy, y + half_width * hx
    if segments_meet(rx, ry, lx, ly, cx, cy, dx, dy):
        return True
    if literal:
        return segments_meet(x, y, ax, ay, cx, cy, dx, dy)
    return segments_meet(ax, ay, rx, ry, cx, cy, dx, dy) or segments_meet(lx, ly, ax, ay, cx, cy, dx, dy)


@kernel
def _holds(zone, px, py):
    """Return whether a triangular zone contains a point."""
    x, y, hx, hy, depth, half_width = zone
    return _in_zone((px - x) * hx + (py - y) * hy, abs((px - x) * hy - (py - y) * hx), depth, half_width)


@kernel
def _add_push(gx, gy, c, inside, choices, out):
    """Add an obstacle's push along the vector to its closest boundary point to `out`."""
    distance = sqrt(gx * gx + gy * gy)
    if distance > 0.0:
        factor = push(distance, c, inside, choices) / distance
        out[0] += factor * gx
        out[1] += factor * gy


@kernel
def _edge_terms(zone, c, world, first, last, inside, choices, out):
    """Add one obstacle-avoidance term to `out` for each edge of a polygon that an agent's zone meets."""
    is_literal = choices.trigger == 1
    for k in range(first, last):
        edge = (world.edges[k, 0], world.edges[k, 1], world.edges[k, 2], world.edges[k, 3])
        if _crosses(zone, edge, is_literal) or (not is_literal and _holds(zone, edge[0], edge[1])):
            gx, gy = to_segment(zone[0], zone[1], edge[0], edge[1], edge[2], edge[3])
            _add_push(gx, gy, c, inside, choices, out)


@kernel
def zone_meets_polygon(zone, edges, first, last, literal):
    """Return whether a triangular obstacle zone meets the polygon with the edges edges[first:last].

    Literal: one of the segments from the agent to the three corners meets an edge, which misses a corner of the
    polygon that comes in between them. Else exact: edges cross, or one of the two holds the other.
    """
    for k in range(first, last):
        if _crosses(zone, (edges[k, 0], edges[k, 1], edges[k, 2], edges[k, 3]), literal):
            return True
    if literal:
        return False
    return _holds(zone, edges[first, 0], edges[first, 1]) or to_boundary(zone[0], zone[1], edges, first, last)[2]


@kernel
def zone_meets_ball(along, across, depth, half, radius, literal):
    """Return whether a triangular zone meets a ball, by its centre along and across (>= 0) the heading."""
    bx, by = to_segment(along, across, 0.0, 0.0, 0.0, half)
    ux, uy = to_segment(along, across, 0.0, 0.0, depth, 0.0)
    vx, vy = to_segment(along, across, depth, 0.0, 0.0, half)
    if not literal and _in_zone(along, across, depth, half):
        return True
    side2 = ux * ux + uy * uy if literal else vx * vx + vy * vy
    return min(bx * bx + by * by, side2) <= radius * radius


@kernel
def push(distance, c, inside, choices):
    """Return the push factor along the unit vector b to the closest boundary point, for one obstacle or wall."""
    if inside and choices.inside == 0:
        return distance + c
    return min(0.0, distance - c) if choices.obstacle_force != 2 else distance - c


@kernel
def obstacle_terms(x, h, moving, depth, half, c, world, choices, out):
    """Write Σ_e (d_ie − c) b_ie over all triggered obstacles and walls of one agent into `out`."""
    m, buffer, outward, is_literal = x.size, choices.obstacle_zone == 1, choices.inside == 0, choices.trigger == 1
    for k in range(m):
        out[k] = 0.0
    for o in range(world.starts.size - 1):
        first, last = world.starts[o], world.starts[o + 1]
        zone = (x[0], x[1], h[0], h[1], depth, half)
        gx, gy, inside = to_boundary(x[0], x[1], world.edges, first, last)
        s2 = gx * gx + gy * gy
        if s2 == 0.0 or (s2 > (depth + half) ** 2 and not inside):
            continue
        if choices.polygons == 1 and not (inside and outward and not is_literal):  # (21); out of one the nearest leads
            if moving:
                _edge_terms(zone, c, world, first, last, inside, choices, out)
        elif (inside and not is_literal) or (moving and zone_meets_polygon(zone, world.edges, first, last, is_literal)):
            _add_push(gx, gy, c, inside, choices, out)
    for o in range(world.balls.shape[0]):
        s2, along = 0.0, 0.0
        for k in range(m):
            gap = world.balls[o, k] - x[k]
            s2 += gap * gap
            along += gap * h[k]
        radius, apart = world.balls[o, m], sqrt(s2)
        across = sqrt(max(0.0, s2 - along * along))
        inside = apart < radius
        if apart == 0.0 or apart == radius:
            continue
        is_met = moving and zone_meets_ball(along, across, depth, half, radius, is_literal)
        if inside or (apart - radius <= c if buffer else is_met):
            # b points away from the centre where the agent is inside
            sign = -1.0 if inside else 1.0
            factor = sign * push(abs(apart - radius), c, inside, choices) / apart
            for k in range(m):
                out[k] += factor * (world.balls[o, k] - x[k])
    _walls(x, h, moving, depth, half, c, world.box, choices, out)


@kernel
def _walls(x, h, moving, depth, half, c, box, choices, out):
    """Add one push term for each wall within the zone, or for the nearest wall."""
    buffer, nearest, least_distance = choices.obstacle_zone == 1, choices.walls == 1, inf
    axis, force = -1, 0.0
    for k in range(x.size):
        for side in range(2):
            normal = 2.0 * side - 1.0
            distance = normal * (box[side, k] - x[k])
            reach = 0.0
            if moving:
                reach = max(0.0, depth * normal * h[k], half * sqrt(max(0.0, 1.0 - h[k] * h[k])))
            if not (distance <= c if buffer else distance < reach or distance < 0.0):
                continue
            is_outside = distance < 0.0
            wall_direction = -normal if is_outside else normal
            term = push(abs(distance), c, is_outside, choices) * wall_direction
            if not nearest:
                out[k] += term
            elif distance < least_distance:
                least_distance, axis, force = distance, k, term
    if axis >= 0:
        out[axis] += force
