"""Rounding error bounds of quantities in verdicts, from the number and size of their terms.

A sum of k numbers in floating point is off by at most about k ε times the sum of their magnitudes, and a difference
of two numbers by ε times the larger of the two. Nothing here says how far the integration is off: that a second,
tighter run tells.
"""

from math import sqrt
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.interactions import AlphaInteraction, PairInteraction
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.composition import Composition
from flockana.laws.olfati_saber import Algorithm1, Algorithm2

EPS = float(np.finfo(float).eps)
_POTENTIAL = 1e-13  # of c*: to which ψ_α is known (`AlphaInteraction.psi_alpha`), and ψ_β of its own largest value


def frame_error(x: FloatArray) -> float:
    """Return a bound of the rounding error of each coordinate of x_i − x_c, x_c a mean over n agents."""
    return float((x.shape[-2] + 4) * EPS * np.abs(x).max())


def spread_error(x: FloatArray) -> FloatArray:
    """Return a bound of the rounding error of ½ Σ‖x_i − x_c‖² at each time."""
    entry_count, off = x.shape[1] * x.shape[2], frame_error(x)
    norm = np.linalg.norm((x - x.mean(axis=1, keepdims=True)).reshape(len(x), entry_count), axis=1)
    return (entry_count + 4) * EPS * norm**2 + sqrt(entry_count) * off * norm + entry_count * off**2


def pair_force_error(alpha: AlphaInteraction) -> float:
    """Return a bound of the rounding of φ_α(‖x‖_σ) x/√(1 + εx²) at any distance up to r."""
    # φ loses nothing to cancellation, but its argument (‖x‖_σ − d_α)/ℓ² does: by a few ε of both terms, times its
    # slope.
    argument = (alpha.r_alpha + alpha.d_alpha) / alpha.unit**2
    longest = alpha.r / sqrt(1.0 + alpha.eps * alpha.r**2)
    return 4.0 * EPS * (0.5 * (alpha.a + alpha.b) * argument * longest + alpha.strength)


def energy_error(law: Any, q: FloatArray, p: FloatArray, energy: FloatArray) -> FloatArray:
    """Return a rounding error bound of the energy of Algorithm 1, 2, 3 or a composition, at each time."""
    # All terms of the three are >= 0; those of another pair law may cancel, and count by their own size.
    n, m = q.shape[1:]
    alpha, gains, pairs = law.alpha, law.gains, n * (n - 1) // 2
    pull = float(np.max(gains.c1_gamma)) if law.target is not None else 0.0
    reach = float(np.abs(q).max())
    if pull:
        reach += float(np.abs(law.target.position(0.0)).max())
    error, magnitude = 0.0, np.abs(energy)
    if alpha is not None:
        steepest = 1.01 * alpha.strength  # force of a pair: how much its potential moves with its distance
        well_depth = deepest_of(alpha)
        error += gains.c1_alpha * pairs * (_POTENTIAL * well_depth + 8.0 * EPS * steepest * (alpha.range + reach))
        if not isinstance(alpha, AlphaInteraction):
            magnitude = magnitude + 2.0 * gains.c1_alpha * pairs * well_depth
    error += pull * (n + 8) * EPS * reach**2
    for _ in law.obstacles:
        maximum, steepest = float(law.beta.psi_beta(0.0)), 2.0 / sqrt(law.beta.eps)
        error += gains.c1_beta * n * (_POTENTIAL * maximum + 16.0 * EPS * steepest * (law.beta.r + reach))
    return error + (pairs + n * m + 8) * EPS * magnitude + 2.0 * spread_error(p)


def deepest_of(pair: PairInteraction) -> float:
    """Return the depth of a pair's potential: c* of Olfati-Saber's, else the largest of sampled values."""
    # A potential that has no bound at 0 counts by what it is at a tenth of d.
    if isinstance(pair, AlphaInteraction):
        return float(pair.c_star)
    with np.errstate(all="ignore"):
        magnitudes = np.abs(pair.energy(np.array([0.0, 0.1 * pair.length, pair.length])))
    return float(np.max([abs(pair.far_potential), *magnitudes[np.isfinite(magnitudes)]]))


def energy_rounding(run: Trajectory) -> FloatArray:
    """Return a bound of the rounding error of a run's energy at each time."""
    energy = run.energy()
    if isinstance(run.law, Algorithm1 | Algorithm2 | Algorithm3 | Composition):
        return energy_error(run.law, run.q, run.p, energy)
    return run.n**2 * EPS * np.abs(energy) + 2.0 * spread_error(run.p)
