"""Certificates for averaged headings: permanent nets, permanent separation, contraction."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf

import numpy as np
import numpy.typing as npt

from flockana.measures.nets import LinkArray, components
from flockana.sources.vicsek_1995.laws import HeadingAveraging
from flockana.theorems.theorem_toolkit import EPS, Certificate, FloatArray

_DIRECTIONS = 360  # along which two groups may be seen to part
_TERMS = 4.0  # roundings of a difference, a length and a quotient


def averaging_matrix(n: int, pairs: LinkArray) -> FloatArray:
    """Return the row-stochastic matrix M of one step θ' = M θ, equal weights over neighbours and itself."""
    matrix = np.eye(n)
    matrix[pairs[:, 0], pairs[:, 1]] = matrix[pairs[:, 1], pairs[:, 0]] = 1.0
    matrix /= matrix.sum(axis=1, keepdims=True)
    return matrix


def contraction(matrix: FloatArray) -> float:
    """Return Dobrushin's coefficient ½ max_ij Σ_k |M_ik − M_jk|: M shrinks spreads to this share or less."""
    return float(max(0.5 * np.abs(matrix - row).sum(axis=1).max() for row in matrix))


@dataclass(frozen=True)
class Block:
    """Sequence of n − 1 jointly connected windows, enough to contract the headings."""

    start: int
    stop: int
    factor: float
    error: float
    mixes: bool


def blocks(nets: Sequence[LinkArray], headings: FloatArray, windows: Sequence[tuple[int, int]]) -> tuple[Block, ...]:
    """Return consecutive blocks of n − 1 windows, each with its guaranteed contraction."""
    n, groups = headings.shape[1], []
    block_length = max(1, n - 1)
    for k in range(0, len(windows) - block_length + 1, block_length):
        start, stop = windows[k][0], windows[k + block_length - 1][1]
        product, heard_matrix = np.eye(n), np.eye(n)
        for net in nets[start:stop]:
            matrix = averaging_matrix(n, net)
            product, heard_matrix = matrix @ product, np.sign(np.sign(matrix) @ heard_matrix)
        steps, spread = stop - start, float(np.ptp(headings[start]))
        error = steps * (n + _TERMS) * EPS * (float(np.abs(headings[start]).max()) + n * spread)
        groups.append(Block(start, stop, min(contraction(product), 1.0), error, bool(heard_matrix.all(axis=0).any())))
    return tuple(groups)


def permanently_connected(law: HeadingAveraging, q: FloatArray, heading: FloatArray) -> Certificate:
    """Return a certificate that a connected net stays constant, so that all headings tend to one."""
    # With an unchanged net √w (θ − θ∞) shrinks by ρ in each step, w_i counting agent i and its neighbours, θ∞ the mean
    # of θ by w, ρ the second largest modulus of the eigenvalues of a matrix similar to a symmetric one. Summed over all
    # steps to come, the distance of i and j changes by at most v dt √(1/w_i + 1/w_j) ‖√w (θ − θ∞)‖/(1 − ρ). If that is
    # less than what each distance is away from r, the net stays; by induction for ever.
    n, pairs = len(q), law.links(q)
    if components(n, pairs).max() > 0:
        return Certificate(-1.0, "the net is not connected")
    weights = neighbourhood_sizes(n, pairs)
    root_weights = np.sqrt(weights)
    symmetric = averaging_matrix(n, pairs) * root_weights[:, None] / root_weights[None, :]
    moduli = np.sort(np.abs(np.linalg.eigvalsh(0.5 * (symmetric + symmetric.T))))
    gap = 1.0 - (float(moduli[-2]) if n > 1 else 0.0) - (n + _TERMS) * EPS
    if gap <= 0.0:
        return Certificate(-1.0, "rounding hides how fast the net averages")
    deviation = root_weights * (heading - final_heading(heading, weights))
    magnitude = float(np.linalg.norm(deviation)) + (n + _TERMS) * EPS * float(np.linalg.norm(root_weights * heading))
    i, j = np.triu_indices(n, 1)
    slack = np.abs(np.linalg.norm(q[i] - q[j], axis=1) - law.range)
    drift = law.speed * law.dt * np.sqrt(1.0 / weights[i] + 1.0 / weights[j]) * magnitude / gap
    margin = float((slack - drift).min(initial=inf)) / law.range
    error = _TERMS * EPS * (1.0 + float(np.abs(q).max()) / law.range)
    text = (
        f"every distance is {slack.min(initial=inf) / law.range:.2g} r or more from r and can still change by "
        f"{drift.max(initial=0.0) / law.range:.2g} r: the net "
        + ("never changes again" if margin > error else "may change again")
    )
    return Certificate(float(np.clip(margin, -1.0, 1.0)), text, error)


def neighbourhood_sizes(n: int, pairs: LinkArray) -> FloatArray:
    """Return the number of agents in each agent's average, itself included."""
    return np.bincount(pairs.ravel(), minlength=n).astype(np.float64) + 1.0


def final_heading(heading: FloatArray, weights: FloatArray) -> float:
    """Return the limit heading of a constant connected net: the preserved weighted mean."""
    return float(weights @ heading / weights.sum())


def permanently_separated(law: HeadingAveraging, q: FloatArray, heading: FloatArray) -> Certificate:
    """Return a certificate that a component of the net never meets the other agents again."""
    # There is a direction in which all its agents are more than r ahead of all others, and in which each of its
    # headings advances faster than each of theirs. No heading leaves the span of those of its own side while the sides
    # do not meet, so that they never do, and the spans stay apart.
    labels = components(len(q), law.links(q))
    angles = 2.0 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    places = q @ np.array([np.cos(angles), np.sin(angles)])
    best = Certificate(-1.0, "the net is connected")
    for label in range(labels.max() + 1 if labels.max() else 0):
        same_group = labels == label
        ahead = (places[same_group].min(axis=0) - places[~same_group].max(axis=0)) / law.range - 1.0
        slowest, fastest = _advance(heading[same_group], angles)[0], _advance(heading[~same_group], angles)[1]
        margins = np.minimum(ahead, slowest - fastest)
        k = int(np.argmax(margins))
        if best.margin == -1.0 or margins[k] > best.margin:
            text = f"{int(same_group.sum())} of {len(q)} agents are {ahead[k] + 1.0:.3g} r ahead of the others at {k}°"
            text += f" and advance faster there, by {slowest[k] - fastest[k]:.3g} v or more"
            error = _TERMS * EPS * (2.0 + float(np.abs(q).max()) / law.range)
            best = Certificate(float(np.clip(margins[k], -1.0, 1.0)), text, error)
    return best


def _advance(heading: FloatArray, angles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the least and greatest cos(θ − φ) over the range of headings θ, for each φ."""
    low, high = float(heading.min()), float(heading.max())
    cosine_bounds = np.cos(low - angles), np.cos(high - angles)
    full_turn = 2.0 * np.pi

    def within(angle: FloatArray) -> npt.NDArray[np.bool_]:
        return np.ceil((low - angle) / full_turn) * full_turn + angle <= high

    lower = np.where(within(angles + np.pi), -1.0, np.minimum(*cosine_bounds))
    return lower, np.where(within(angles), 1.0, np.maximum(*cosine_bounds))
