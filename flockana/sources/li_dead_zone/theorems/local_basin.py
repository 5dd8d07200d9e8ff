"""Basin of the strict minimum near a dead-zone flock: a certificate of its limit.

The argument is that of `flockana.theorems.energy_basins`, with U = Σψ̄, whose Hessian has a finite Lipschitz constant
only where no pair comes to a kink of its force: the ends of the ramps, of the dead zone, and the range. So the windows
in which it is taken end before the first kink; a flock with printed jumps, whose contacts sit on them, is never held.

A map of semi-implicit Euler steps has an energy of its own. Where dt²Λ + 2 dt Γ < 4, with Λ and Γ the largest
eigenvalues of ∇²U and k₂ L̂, all modes z of the linearised map but the rigid ones have |z| < 1: they are the roots of
z² - (2 - dt²κ - dt γ) z + 1 - dt γ, with κ and γ the Rayleigh quotients of the mode. Below half of that bound H̄
never grows to more than six times itself on the way (measured, at random Λ and Γ), so that a tenth of the barrier is
allowed there.
"""

from functools import partial
from math import inf, sqrt

import numpy as np

from flockana.equilibria.final_state import DENSE_LIMIT, rigid_motions
from flockana.measures.nets import link_lengths, links
from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.theorems import energy_basins as basins
from flockana.theorems.theorem_toolkit import EPS, Enclosure, FloatArray

_PIECES = 8  # into which the lengths that a pair may take are divided: each is enclosed by itself
_DEAD = 2  # which piece of the action the dead zone is, where all pairs at rest are
_CLEAR = 0.999  # of the way to the nearest kink: so wide the widest window is
_UNKNOWN = basins.Basin()


def hold(
    law: DeadZoneFlocking,
    q: FloatArray,
    p: FloatArray,
    dt: float | None = None,
    *,
    off: float = 0.0,
    p_off: float = 0.0,
) -> basins.Basin:
    """Return a basin of the potential's minimum near an isolated flock, for the flow or a map of steps dt."""
    if len(q) == 1:
        return basins.ALONE
    if q.size > DENSE_LIMIT or law.k2 == 0.0:
        return _UNKNOWN
    curvature, upper_curvature = basins.curvatures(law.interaction.hessian(q).toarray(), rigid_motions(q))
    if not curvature > 0.0:
        return _UNKNOWN
    force = _force(law, q, upper_curvature)
    distance = 2.0 * force / curvature
    nearer = law.interaction.r - sqrt(2.0) * distance  # links shorter than this are links at the minimum too
    if distance >= basins.gyration(q) or not basins.connected_within(q, nearer):
        return _UNKNOWN
    margin = _CLEAR * _nearest_kink(law, q) / sqrt(2.0)
    windows = [*(w for w in law.interaction.d1 * basins.WINDOWS if w < margin), margin]
    barrier_level, lipschitz = basins.barrier(curvature, distance, windows, partial(_lipschitz, law, q), off=off)
    stability = 1.0 if dt is None else _stability(law, q, upper_curvature, dt)
    height = basins.excess(p, p_off, force, curvature, off, upper_curvature, lipschitz) if barrier_level > 0.0 else inf
    return basins.Basin(height, barrier_level, distance + off, curvature, stability)


def _force(law: DeadZoneFlocking, q: FloatArray, stiffest: float) -> float:
    """Return ‖∇U‖, the norm of the potential's gradient, plus a bound of its rounding error."""
    pair, pairs = law.interaction, links(q, law.interaction.r)
    pulls = np.abs(pair.force(link_lengths(q, pairs)))
    maximum = float(np.bincount(pairs.ravel(), weights=np.repeat(pulls, 2), minlength=1).max())
    rounding = (len(q) + 16.0) * EPS * (maximum + stiffest * pair.r)
    u = law.flow(0.0, q, np.zeros_like(q))[0]
    return float(np.linalg.norm(u)) + sqrt(q.size) * rounding


def _nearest_kink(law: DeadZoneFlocking, q: FloatArray) -> float:
    """Return the least difference between a pair's distance and a distance at which the force switches."""
    pair = law.interaction
    kinks = [pair.d1 - pair.ramp, pair.d1]
    if pair.d2 < pair.r:
        kinks += [pair.d2, pair.d2 + pair.ramp]
    if pair.d2 < pair.r or pair.k1 > 0.0:
        kinks.append(pair.r)
    i, j = np.triu_indices(len(q), 1)
    link_lengths = np.linalg.norm(q[j] - q[i], axis=1)
    return float(np.abs(link_lengths[:, None] - np.array(kinks)).min())


def _lipschitz(law: DeadZoneFlocking, q: FloatArray, window: float) -> float:
    """Return a Lipschitz constant of the Hessian ∇²U of the potential within a distance of q."""
    pairs = links(q, law.interaction.r)
    return basins.lipschitz_constant(len(q), pairs, _third(law, link_lengths(q, pairs), sqrt(2.0) * window))


def _third(law: DeadZoneFlocking, lengths: FloatArray, slack: float) -> FloatArray:
    """Return a bound of each pair potential's third derivative, for lengths changed by up to `slack`."""
    # It is F'' along the pair three times, and (F/s)' along it once and across twice; of unit vectors the second kind
    # makes 3 e (1 - e²) <= 2/√3 at most. No pair leaves its piece of F within the slack.
    bounds, pair = np.zeros(lengths.shape), law.interaction
    zones = np.searchsorted([pair.d1 - pair.ramp, pair.d1, pair.d2, pair.d2 + pair.ramp], lengths)
    for zone in np.unique(zones[zones != _DEAD]):
        zone_pairs = np.flatnonzero(zones == zone)
        length_grid = lengths[zone_pairs] + slack * np.linspace(-1.0, 1.0, _PIECES + 1)[:, None]
        s = Enclosure.between(np.maximum(length_grid[:-1], 0.0), length_grid[1:])
        action, slope, second_slope = _action(pair, int(zone), s)
        root = (1.0 + pair.eta * s.square()).sqrt()
        cube = root * root.square()
        curve = second_slope * s / root + 2.0 * slope / cube - 3.0 * pair.eta * s * action / (cube * root.square())
        transverse_term = slope / root - pair.eta * s * action / cube
        bounds[zone_pairs] = (abs(curve) + 2.0 / sqrt(3.0) * abs(transverse_term)).max(axis=0).hi
    return bounds


def _action(pair: DeadZoneInteraction, zone: int, s: Enclosure) -> tuple[Enclosure, Enclosure, Enclosure]:
    """Return the force f and its derivatives f', f'' in one zone: repulsion, either ramp, or attraction."""
    near = zone < _DEAD
    way = s if near else pair.r_d - s
    squared_value = way.square()
    full = 2.0 * pair.k_r / squared_value + pair.k_delta
    growth_sign = -1.0 if near else 1.0  # the full action grows towards its pole
    slope, bend = growth_sign * (4.0 * pair.k_r / (squared_value * way)), 12.0 * pair.k_r / squared_value.square()
    if zone in (1, 3):
        share, rise = (pair.d1 - s, -1.0) if near else (s - pair.d2, 1.0)
        share, rise = share / pair.ramp, rise / pair.ramp
        full, slope, bend = full * share, slope * share + rise * full, bend * share + 2.0 * rise * slope
    return growth_sign * full, growth_sign * slope, growth_sign * bend


def _stability(law: DeadZoneFlocking, q: FloatArray, stiffest: float, dt: float) -> float:
    """Return 1 − (dt²Λ + 2 dt Γ)/2, positive where all modes of the semi-implicit Euler map decay."""
    m = q.shape[1]
    agent_laplacian = law.interaction.laplacian(q).toarray()[::m, ::m]  # each component has the same
    dissipation = law.k2 * float(np.linalg.eigvalsh(agent_laplacian)[-1])
    return 1.0 - 0.5 * (dt * dt * stiffest + 2.0 * dt * dissipation)
