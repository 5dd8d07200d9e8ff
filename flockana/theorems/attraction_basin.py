"""Basin of the strict minimum near a state of Algorithm 1 or 2: a certificate of its limit.

The argument is that of `flockana.theorems.energy_basins`, in the moving frame, with U the structural potential.
"""

from math import inf, pi, sqrt

import numpy as np

from flockana.equilibria.final_state import DENSE_LIMIT, rigid_motions
from flockana.equilibria.gradient_flow import structural_force
from flockana.interactions import AlphaInteraction
from flockana.laws.olfati_saber import Algorithm1, Algorithm2, paper_pair
from flockana.measures.nets import link_lengths, links
from flockana.theorems import energy_basins as basins
from flockana.theorems.rounding_bounds import pair_force_error
from flockana.theorems.theorem_toolkit import EPS, Enclosure, FloatArray, Observed

_PIECES = 16  # into which the lengths that a link may take are divided: each is enclosed by itself


def attraction(
    law: Algorithm1 | Algorithm2, q: FloatArray, p: FloatArray, *, off: float = 0.0, p_off: float = 0.0
) -> basins.Basin:
    """Return the basin of the minimum near a state with a known position error."""
    # Its barrier is 0 where nothing is known: at a saddle, in a flexible net, of a pair law that is not the paper's,
    # and of a flock with more coordinates than a dense Hessian is made for.
    if q.shape[0] == 1:
        return basins.ALONE
    if q.size > DENSE_LIMIT or not isinstance(law.alpha, AlphaInteraction):
        return basins.Basin()
    everywhere = isinstance(law, Algorithm2) and law.gains.c2_gamma > 0.0
    if not (everywhere or law.gains.c2_alpha > 0.0):
        return basins.Basin()
    force, stiffness = _force(law, q), law.stiffness(q)
    curvature, stiffest = basins.curvatures(stiffness, rigid_motions(q))
    distance = float(2.0 * force / curvature) if curvature > 0.0 else inf
    if distance >= basins.gyration(q):  # there is no turning to speak of: all agents are at one place
        translations = np.tile(np.eye(q.shape[1]), (len(q), 1)) / sqrt(len(q))
        curvature, stiffest = basins.curvatures(stiffness, translations)
        distance = float(2.0 * force / curvature) if curvature > 0.0 else inf
    is_connected = everywhere or basins.connected_within(q, paper_pair(law).r - sqrt(2.0) * distance)
    if distance + off == inf or not is_connected:
        return basins.Basin(inf, 0.0, distance, curvature)
    windows = law.alpha.length * basins.WINDOWS
    leaving, lipschitz = basins.barrier(curvature, distance, windows, lambda w: lipschitz_within(law, q, w), off=off)
    height = basins.excess(p, p_off, force, curvature, off, stiffest, lipschitz) if leaving > 0.0 else inf
    return basins.Basin(height, leaving, distance + off, curvature)


def final_basin(seen: Observed) -> basins.Basin:
    """Return the basin near the last state of a run, with its error; cached with the run."""
    q, p, q_error, p_error = seen.end
    q_off, p_off = float(np.linalg.norm(q_error)), float(np.linalg.norm(p_error))
    return seen.cached("attraction at the end", lambda: attraction(seen.law, q, p, off=q_off, p_off=p_off))


def _force(law: Algorithm1 | Algorithm2, q: FloatArray) -> float:
    """Return the norm ‖∇U‖ of the structural force over all coordinates, plus a bound of its rounding."""
    most_links = float(np.bincount(links(q, law.alpha.range).ravel(), minlength=1).max())
    pull = law.gains.c1_gamma * float(np.abs(q).max()) if isinstance(law, Algorithm2) else 0.0
    rounding = law.gains.c1_alpha * pair_force_error(paper_pair(law)) * (most_links + 1.0) + 16.0 * EPS * pull
    return float(np.linalg.norm(structural_force(law, q))) + sqrt(q.size) * rounding


def lipschitz_within(law: Algorithm1 | Algorithm2, q: FloatArray, window: float) -> float:
    """Return a Lipschitz constant L of ∇²U within a distance of q."""
    alpha, slack = paper_pair(law), sqrt(2.0) * window
    pairs = links(q, alpha.r + slack)
    return basins.lipschitz_constant(len(q), pairs, law.gains.c1_alpha * _third(alpha, link_lengths(q, pairs), slack))


def _third(alpha: AlphaInteraction, lengths: FloatArray, slack: float) -> FloatArray:
    """Return an upper bound of each pair potential's third derivative, over lengths within a slack."""
    # With F(s) = ψ_α(‖s‖_σ) it is F‴ along the pair three times and (F'/s)' along it once and across twice; of unit
    # vectors the second kind makes 3 e (1 - e²) <= 2/√3 at most.
    ends = np.maximum(lengths + slack * np.linspace(-1.0, 1.0, _PIECES + 1)[:, None], 0.0)
    s = Enclosure.between(ends[:-1], ends[1:])
    root = (1.0 + alpha.eps * s.square()).sqrt()
    slant, steep = s / root, 1.0 / (root * root * root)
    phi, slope, second_slope = _action(alpha, (root - 1.0) / alpha.eps)
    bowed_term = 3.0 * (slope * slant - alpha.eps * s * phi / root.square()) * steep
    across = slope * slant / root - alpha.eps * s * phi * steep
    return (abs(second_slope * slant * slant * slant + bowed_term) + 2.0 / sqrt(3.0) * abs(across)).max(axis=0).hi


def _action(alpha: AlphaInteraction, z: Enclosure) -> tuple[Enclosure, Enclosure, Enclosure]:
    """Return φ_α, φ_α' and φ_α'' over enclosures of z."""
    rho, rho_slope, rho_bend = _bump(alpha, z)
    area = alpha.unit**2
    w = (z - alpha.d_alpha) / area + alpha.c
    flat = 1.0 / (1.0 + w.square()).sqrt()
    sigma = w.rising(lambda x: x / np.sqrt(1.0 + x * x))
    cube = flat * flat * flat
    phi = 0.5 * ((alpha.a + alpha.b) * sigma + (alpha.a - alpha.b))
    slope, bend = (0.5 * (alpha.a + alpha.b) * x for x in (cube / area, -3.0 * w * cube * flat.square() / area**2))
    return rho * phi, rho_slope * phi + rho * slope, rho_bend * phi + 2.0 * rho_slope * slope + rho * bend


def _bump(alpha: AlphaInteraction, z: Enclosure) -> tuple[Enclosure, Enclosure, Enclosure]:
    """Return ρ_h(z/r_α) and its first two derivatives in z; the second jumps at z = h r_α and r_α."""
    width = (1.0 - alpha.h) * alpha.r_alpha
    angle = (z - alpha.h * alpha.r_alpha) * (pi / width)
    inside = Enclosure(*(np.clip(end, 0.0, pi) for end in (angle.lo, angle.mid, angle.hi)))
    cosine = inside.falling(np.cos)
    peak = (inside.lo <= 0.5 * pi) & (inside.hi >= 0.5 * pi)
    ends = np.sin(inside.lo), np.sin(inside.hi)
    sine = Enclosure(np.minimum(*ends), np.sin(inside.mid), np.where(peak, 1.0, np.maximum(*ends))).widened(4.0 * EPS)
    in_support = 1.0 - ((angle.hi < 0.0) | (angle.lo > pi))
    partly = (angle.lo < 0.0) | (angle.hi > pi)
    bend = -0.5 * (pi / width) ** 2 * cosine
    low, high = np.where(partly, np.minimum(bend.lo, 0.0), bend.lo), np.where(partly, np.maximum(bend.hi, 0.0), bend.hi)
    return 0.5 * (1.0 + cosine), -0.5 * pi / width * sine * in_support, Enclosure(low, bend.mid, high) * in_support
