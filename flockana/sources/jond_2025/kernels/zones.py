"""Zone-based flocking: the six behaviours of an agent in two forms, and whole runs of the map.

Equation numbers are those of Jond's paper on bearing-distance flocking. The position form is (3) to (8); the bearing
form is (14), (15) and (18) to (21), from distances, bearings b and their rates alone. Neighbours are looked for in
cells and summed in the order of their indices, so that the sums are those over all agents. What allocates nothing
counts no references, which for ten agents takes as long as what it computes.
"""

from math import inf, sqrt, tanh
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.jit import kernel, register_jitable
from flockana.kernels.agent_sums import square_between
from flockana.kernels.random_noise import noise
from flockana.sources.jond_2025.kernels.neighbour_candidates import gather, sort_into_cells
from flockana.sources.jond_2025.kernels.zone_obstacles import obstacle_terms, to_boundary

FloatArray = npt.NDArray[np.float64]
COHESION, ALIGNMENT, SEPARATION, STRATEGIC, OBSTACLE, SPEED = range(6)
_VELOCITY = 6  # the channel of noise that is no behaviour's
_ROOT_3 = sqrt(3.0)  # over the deviation of what is uniform in (−1, 1)
_NEAR_ZERO = 1e-4  # below it tanh(x)/x is 1 − x²/3 to rounding: the next term is 2x⁴/15


class Zones(NamedTuple):
    """Zone radii of agents, and behaviour weights of pairs (n, n) or (1, 1), agents (n,) and aliens (n, K)."""

    r: FloatArray
    c: FloatArray
    a: FloatArray
    s: FloatArray
    separation: FloatArray
    cohesion: FloatArray
    alignment: FloatArray
    speed: FloatArray
    obstacle: FloatArray
    alien: FloatArray


class Settings(NamedTuple):
    """Numeric settings of zone-based flocking."""

    dt: float
    desired_speed: float
    u_max: float
    v_max: float
    cohesion_gain: float
    alignment_gain: float
    base: float
    growth: float
    weight_noise: float
    velocity_noise: float
    seed: int


class Choices(NamedTuple):
    """Choices of reading the paper: 0 is the recommended reading, others as in `laws.zone_flocking`."""

    form: int
    order: int
    speed_bound: int
    own_velocity: int
    surveillance: int
    obstacle_zone: int
    zone_length: int
    trigger: int
    obstacle_force: int
    inside: int
    walls: int
    polygons: int


class World(NamedTuple):
    """Edges of all polygons, balls (centre, radius), the box (low, high), and each alien's territory and habits."""

    edges: FloatArray
    starts: npt.NDArray[np.int64]
    balls: FloatArray
    box: FloatArray
    territory: FloatArray
    territory_starts: npt.NDArray[np.int64]
    detection: FloatArray
    pace: FloatArray


class Rules(NamedTuple):
    """Rules of zone-based flocking: all parameters together."""

    zones: Zones
    settings: Settings
    choices: Choices
    world: World


class Flock(NamedTuple):
    """State: positions, velocities, headings and velocity estimates (n, m), radii of attraction (n,), aliens (K, m)."""

    q: FloatArray
    p: FloatArray
    heading: FloatArray
    estimate: FloatArray
    reach: FloatArray
    alien: FloatArray


@kernel
def saturation(norm, bound):
    """Return the factor by which (9) and (10) shorten a vector: tanh(x)/x at x = norm/bound, 1 at 0."""
    x = norm / bound
    return 1.0 - x * x / 3.0 if x < _NEAR_ZERO else tanh(x) / x


@kernel
def _length(x):
    s2 = 0.0
    for k in range(x.size):
        s2 += x[k] * x[k]
    return sqrt(s2)


@kernel
def _weight(table, i, j):
    """Return the weight of a pair from a table of weights, or the single weight."""
    return table[0, 0] if table.size == 1 else table[i, j]


@kernel
def _noise_factor(settings, step, i, j, behaviour):
    """Return the random factor of a behaviour weight in a time step; 1 without noise."""
    if settings.weight_noise == 0.0:
        return 1.0
    return 1.0 + settings.weight_noise * noise(settings.seed, step, i, j, behaviour)


@register_jitable  # a call would hand over a hundred numbers
def _neighbours(i, near, flock, step, rules, out):
    """Return cohesion, alignment and separation of agent i from the candidates in `near`.

    Returns the least distance of those who attract it, infinite without any.
    """
    q, p, a, zones, settings = flock.q, flock.p, flock.reach[i], rules.zones, rules.settings
    m, bearing = q.shape[1], rules.choices.form == 1
    r, c, nearest, has_noise = zones.r[i], zones.c[i], inf, settings.weight_noise > 0.0
    total_c, total_a = 0.0, 0.0
    for j in near:
        if j == i:
            continue
        d2 = square_between(q, i, j)
        d = sqrt(d2)
        if d > a or d == 0.0:
            continue
        if d <= c:
            w = _weight(zones.separation, i, j) * (d - c)
            if has_noise:
                w *= _noise_factor(settings, step, i, j, SEPARATION)
            for k in range(m):
                out[SEPARATION, k] += w * ((q[j, k] - q[i, k]) / d)
        if d <= r:
            continue
        if d < nearest:
            nearest = d
        w_c, w_a = _weight(zones.cohesion, i, j), _weight(zones.alignment, i, j)
        if has_noise:
            w_c *= _noise_factor(settings, step, i, j, COHESION)
            w_a *= _noise_factor(settings, step, i, j, ALIGNMENT)
        total_c += w_c
        total_a += w_a
        if not bearing:
            for k in range(m):
                out[COHESION, k] += w_c * q[j, k]
                out[ALIGNMENT, k] += w_a * p[j, k]
            continue
        rate = 0.0  # of the distance
        for k in range(m):
            rate += (q[j, k] - q[i, k]) / d * (p[j, k] - p[i, k])
        for k in range(m):
            b = (q[j, k] - q[i, k]) / d
            b_rate = (p[j, k] - p[i, k] - rate * b) / d
            out[COHESION, k] += w_c * d * b
            out[ALIGNMENT, k] += w_a * (d * b_rate + rate * b)
    for k in range(m):
        own_q, own_p = (0.0, 0.0) if bearing else (q[i, k], p[i, k])
        out[COHESION, k] = settings.cohesion_gain * (out[COHESION, k] / total_c - own_q) if total_c > 0.0 else 0.0
        out[ALIGNMENT, k] = settings.alignment_gain * (out[ALIGNMENT, k] / total_a - own_p) if total_a > 0.0 else 0.0
    return nearest


@kernel
def _aliens(i, flock, step, rules, out):
    """Return the strategic separation (7) of agent i from watched aliens."""
    q, alien, zones, settings, annulus = flock.q, flock.alien, rules.zones, rules.settings, rules.choices.surveillance
    m = q.shape[1]
    for e in range(alien.shape[0]):
        d2 = 0.0
        for k in range(m):
            d2 += (alien[e, k] - q[i, k]) ** 2
        d = sqrt(d2)
        if 0.0 < d <= zones.s[i] and not (annulus == 1 and d <= zones.a[i]):
            w = zones.alien[i, e] * _noise_factor(settings, step, i, e, STRATEGIC)
            for k in range(m):
                out[STRATEGIC, k] += w * (d - zones.s[i]) * ((alien[e, k] - q[i, k]) / d)


@kernel
def altitude(speed, r, c, a, settings, choices):
    """Return the length of the obstacle zone along the heading: c, a, or between r at rest and a at full speed."""
    if choices.zone_length == 2:
        return r + (a - r) * min(1.0, speed / settings.v_max)
    return a if choices.zone_length == 1 else c


@kernel
def _grown(reach, a, nearest, settings):
    """Return the next radius of attraction: a with an agent within a, unchanged with one in reach, or larger."""
    if nearest <= a:
        return a
    return reach if nearest <= reach else reach + settings.dt * settings.growth


@register_jitable  # a call would hand over a hundred numbers
def behave(i, near, flock, step, rules, out):
    """Write the accelerations of agent i by the six behaviours, from the candidates `near`, into out (6, m).

    Its heading and its estimate move on. Returns how near the nearest is of those who attract it.
    """
    q, p, heading, estimate, _, _ = flock
    zones, settings, choices, world = rules
    m = q.shape[1]
    out[:] = 0.0
    nearest = _neighbours(i, near, flock, step, rules, out)
    _aliens(i, flock, step, rules, out)
    speed = _length(p[i])
    if speed > 0.0:
        for k in range(m):
            heading[i, k] = p[i, k] / speed
    moving = _length(heading[i]) > 0.0
    c = zones.c[i]
    depth = altitude(speed, zones.r[i], c, zones.a[i], settings, choices)
    force_end = depth if choices.obstacle_force == 1 else c  # where the repulsion ends
    obstacle_terms(q[i], heading[i], moving, depth, settings.base * c, force_end, world, choices, out[OBSTACLE])
    w_o = zones.obstacle[i] * _noise_factor(settings, step, i, 0, OBSTACLE)
    w_s = zones.speed[i] * _noise_factor(settings, step, i, 0, SPEED)
    own2 = 0.0
    for k in range(m):
        out[OBSTACLE, k] *= w_o
        other_sum = (
            out[COHESION, k] + out[ALIGNMENT, k] + out[SEPARATION, k] + out[STRATEGIC, k] + out[OBSTACLE, k]
        )  # (16)
        if choices.own_velocity == 2:  # (17)
            estimate[i, k] += settings.dt * other_sum
        else:
            estimate[i, k] = p[i, k] + (settings.dt * other_sum if choices.own_velocity == 1 else 0.0)
        own2 += estimate[i, k] ** 2
    if own2 > 0.0:
        for k in range(m):
            wanted_velocity = settings.desired_speed * estimate[i, k] / sqrt(own2)
            out[SPEED, k] = w_s * (wanted_velocity - estimate[i, k])
    return nearest


@kernel
def behaviours(flock, step, rules):
    """Return the six behaviours of all agents at one instant, shape (6, n, m); headings and estimates change."""
    q, reach = flock.q, flock.reach
    n, m = q.shape
    components, outputs = np.empty((6, n, m)), np.empty((6, m))
    cells, near_agents = sort_into_cells(q, reach.max()), np.empty(n, np.int64)
    for i in range(n):
        count = gather(i, q, reach[i], cells, near_agents)
        behave(i, near_agents[:count], flock, step, rules, outputs)
        components[:, i] = outputs
    return components


@kernel
def _move(i, q, p, u, step, settings, literal):
    """Move agent i by its input and a gust, with bounded speed (steps (j), (k))."""
    m = q.shape[1]
    for k in range(m):
        p[i, k] += settings.dt * u[i, k]
        if settings.velocity_noise > 0.0:
            p[i, k] += settings.velocity_noise * _ROOT_3 * noise(settings.seed, step, i, k, _VELOCITY)
    speed = _length(p[i])
    factor = saturation(speed, settings.v_max) if literal else min(1.0, settings.v_max / max(speed, 1e-300))
    for k in range(m):
        p[i, k] *= factor
        q[i, k] += settings.dt * p[i, k]


@kernel
def _move_aliens(alien, q, dt, world):
    """Move every alien towards the nearest detected agent, within its territory."""
    m = q.shape[1]
    for e in range(alien.shape[0]):
        least_square, prey_index = world.detection[e] ** 2, -1
        for i in range(q.shape[0]):
            d2 = 0.0
            for k in range(m):
                d2 += (q[i, k] - alien[e, k]) ** 2
            if d2 <= least_square and (prey_index < 0 or d2 < least_square):
                least_square, prey_index = d2, i
        if prey_index < 0 or least_square == 0.0:
            continue
        way_share = dt * world.pace[e] / sqrt(least_square)
        for k in range(m):
            alien[e, k] += way_share * (q[prey_index, k] - alien[e, k])
        first_index, edge_stop = world.territory_starts[e], world.territory_starts[e + 1]
        if edge_stop > first_index:
            gx, gy, is_inside = to_boundary(alien[e, 0], alien[e, 1], world.territory, first_index, edge_stop)
            if not is_inside:
                alien[e, 0] += gx
                alien[e, 1] += gy


@kernel
def _take_step(flock, u, step, cells, near, rules, out, total):
    """Advance all agents by one step, then the aliens, with one cell list for the step."""
    (q, p, _, _, reach, alien), (zones, settings, choices, world) = flock, rules
    (n, m), is_sequential, is_literal = q.shape, choices.order == 1, choices.speed_bound == 1
    for i in range(n):
        count = gather(i, q, reach[i], cells, near)
        nearest = behave(i, near[:count], flock, step, rules, out)
        if settings.growth > 0.0:
            reach[i] = _grown(reach[i], zones.a[i], nearest, settings)
        total[:] = 0.0
        for term in range(6):
            for k in range(m):
                total[k] += out[term, k]
        factor = saturation(_length(total), settings.u_max)
        for k in range(m):
            u[i, k] = factor * total[k]
        if is_sequential:
            _move(i, q, p, u, step, settings, is_literal)
    if not is_sequential:
        for i in range(n):
            _move(i, q, p, u, step, settings, is_literal)
    _move_aliens(alien, q, settings.dt, world)


@kernel
def run(flock, first, rules, steps):
    """Simulate `steps` steps of zone-based flocking from a given step number, changing the flock's arrays.

    Returns (q, p, u, heading, estimate, reach, alien) over time, each (steps, ...).
    """
    q, p, heading, estimate, reach, alien = flock
    settings, choices = rules.settings, rules.choices
    n, m = q.shape
    states = np.empty((5, steps, n, m))
    aliens, reach_series = np.empty((steps, alien.shape[0], m)), np.empty((steps, n))
    u, outputs, total = np.empty((n, m)), np.empty((6, m)), np.empty(m)
    near_agents = np.empty(n, np.int64)
    step_bound = settings.dt * settings.v_max if choices.order == 1 else 0.0  # those before agent i have moved since
    for count in range(steps):
        step, cells = first + count, sort_into_cells(q, reach.max() + step_bound)
        _take_step(flock, u, step, cells, near_agents, rules, outputs, total)
        for k, row in enumerate((q, p, u, heading, estimate)):
            states[k, count] = row
        reach_series[count], aliens[count] = reach, alien
    return states[0], states[1], states[2], states[3], states[4], reach_series, aliens
