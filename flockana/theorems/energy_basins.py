"""Basins of strict minima: the least energy with which a flock can leave the nearby minimum of U.

Where x' = v, v' = -∇U - D(x) v with D >= 0, the energy E = U + K never rises. Let λ be the least eigenvalue of ∇²U(x)
off the rigid motions, g = ∇U(x), and let ∇²U be Lipschitz with constant L within the distance w of x.

1. Off the rigid motions U is strictly convex near x. If |g| is small, it has a minimum x* there, within δ = 2|g|/λ
   of x; ∇U(x*) is orthogonal both to the rigid motions of x* and to the complement of those of x, so it is 0 as long
   as δ is less than the least radius of gyration (else λ is taken off the translations alone). The curvature at x* is
   λ - Lδ at least, and U(x) - U(x*) <= |g|²/λ.
2. Of the states with the distance ρ from the set of all x* moved rigidly, the nearest of these differs from each by a
   vector that is orthogonal to the rigid motions; so U >= U(x*) + ρ²(½(λ - Lδ) - Lρ/6) there, for ρ + δ <= w, and for
   ρ <= λ/(2L) there is no equilibrium nearer than ρ but x* itself.
3. If E - U(x*) <= K + |g|²/λ is less than that barrier, the flock never leaves. With damping of all relative motion
   (c2γ > 0, or damping along the links of a connected net) it converges to x*, and its velocities match, by LaSalle's
   principle.
4. A state that is known to a distance Δ has U less than U(x) + |g|Δ + ½(Λ + LΔ)Δ², with Λ the largest eigenvalue of
   ∇²U(x), and lies in the basin if δ + Δ <= ρ as well.

No tolerance enters: the flock's own scales come in through λ, L and the barrier. What depends on the law, its force,
its Hessian and the third derivatives of its pair potential, is in `olfati_saber.attraction` and `dead_zone.hold`.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf, nan, sqrt
from typing import Any

import numpy as np

from flockana.measures.centre_frame import moving_frame
from flockana.measures.nets import LinkArray, components, links
from flockana.theorems.theorem_toolkit import EPS, Certificate, FloatArray

WINDOWS = np.geomspace(1e-8, 0.25, 25)  # of the law's length: distances up to which L is taken
_SYMMETRIC = 1e-9  # of the largest: a rotation that moves the agents by less is no motion, as in `rigid_motions`
_GROWTH = 10.0  # factor by which the energy of a map of steps may rise


@dataclass(frozen=True)
class Basin:
    """Basin of the strict minimum near a state, with the state's energy above the minimum."""

    excess: float = inf  # Bound of the energy above the minimum; ∞ where there is none
    barrier: float = 0.0  # Energy that the flock needs at least to leave; 0 where nothing is known
    distance: float = inf  # Bound δ of the distance to the minimum, over all coordinates; ∞ where there is none
    curvature: float = nan  # Least eigenvalue λ of ∇²U off the rigid motions, less its rounding
    stability: float = 1.0  # Of a map of steps, positive where every mode of it decays, with room to spare; 1 of a flow

    @property
    def reach(self) -> float:
        """Bound of a trapped flock's distance from the state, over all coordinates up to rigid motions."""
        return self.distance + 2.0 * sqrt(self.excess / self.curvature)

    @property
    def certificate(self) -> Certificate:
        """Certificate that the energy above the minimum is below the barrier (a tenth of it for maps)."""
        if not self.barrier > 0.0:
            return Certificate(-1.0, "no basin of a strict minimum is certified here")
        if self.stability <= 0.0:
            return Certificate(max(-1.0, self.stability), "the step is too long for the stiffness of its contacts")
        ratio = self.excess / self.barrier * (_GROWTH if self.stability < 1.0 else 1.0)
        where = "certified to stay" if ratio < 1.0 else "not certified to stay"
        text = f"{where} near a strict minimum of U ({self.excess:.2g} above it; {self.barrier:.2g} needed to leave)"
        return Certificate(max(-1.0, min(1.0 - ratio, self.stability)), text)


ALONE = Basin(0.0, inf, 0.0, inf)  # of one agent, which has no relative motion


def curvatures(stiffness: Any, rigid: FloatArray) -> tuple[float, float]:
    """Return least stiffness eigenvalue off rigid motions, less rounding, and largest; NaN and 0 if none."""
    free_directions = np.linalg.svd(rigid, full_matrices=True)[0][:, rigid.shape[1] :]
    if free_directions.shape[1] == 0:
        return nan, 0.0
    values = np.linalg.eigvalsh(free_directions.T @ (stiffness @ free_directions))
    largest = float(np.abs(values).max())
    return float(values[0]) - 64.0 * len(rigid) * EPS * largest, largest


def kinetic(p: FloatArray, off: float = 0.0) -> float:
    """Return an upper bound of K(v) = ½ Σ‖p_i − p_c‖² for velocities with known error."""
    rounding = sqrt(p.size) * 8.0 * EPS * float(np.abs(p).max())
    return 0.5 * (float(np.linalg.norm(moving_frame(p))) + rounding + off) ** 2


def gyration(q: FloatArray) -> float:
    """Return the least norm of all agents' displacement by a unit infinitesimal rotation; ∞ on a line."""
    x, m = moving_frame(q), q.shape[1]
    turns = []
    for a in range(m):
        for b in range(a):
            quarter_turn = np.zeros_like(x)
            quarter_turn[:, a], quarter_turn[:, b] = x[:, b], -x[:, a]
            turns.append(quarter_turn.ravel())
    singular_values = np.linalg.svd(np.array(turns), compute_uv=False) if turns else np.empty(0)
    return float(np.min(singular_values[singular_values > _SYMMETRIC * singular_values.max(initial=0.0)], initial=inf))


def connected_within(q: FloatArray, reach: float) -> bool:
    """Return whether the net of all pairs nearer than a reach is connected."""
    return reach > 0.0 and not components(len(q), links(q, reach)).any()


def barrier(
    curvature: float,
    distance: float,
    windows: Iterable[float],
    lipschitz_within: Callable[[float], float],
    *,
    off: float = 0.0,
) -> tuple[float, float]:
    """Return the highest barrier over a choice of windows w, and its constant L; 0 and ∞ without one."""
    # A wide window has a large L, a narrow one a small ρ. The widest is taken first, and the rest are left out when
    # even with L = 0 they were no better.
    best_level, constant = 0.0, inf
    for window in sorted(windows, reverse=True):
        reach = window - distance
        if reach <= 0.0 or reach**2 * (0.5 * curvature) <= best_level:
            break
        lipschitz = lipschitz_within(float(window))
        if lipschitz > 0.0:
            reach = min(reach, 0.5 * curvature / lipschitz)
        inner = curvature - lipschitz * distance  # 7/8 of the curvature at least, if the distance is reach/4 at most
        height = reach**2 * (0.5 * inner - lipschitz * reach / 6.0)
        if reach > max(4.0 * distance, distance + off) and height > best_level:
            best_level, constant = float(height), lipschitz
    return best_level, constant


def excess(
    p: FloatArray, p_off: float, force: float, curvature: float, off: float, stiffest: float, lipschitz: float
) -> float:
    """Return an upper bound of the energy above the minimum, for states with errors `off` and `p_off`."""
    height = kinetic(p, p_off) + force**2 / curvature
    return height if off == 0.0 else height + force * off + 0.5 * (stiffest + lipschitz * off) * off**2


def lipschitz_constant(n: int, pairs: LinkArray, third: FloatArray) -> float:
    """Return a Lipschitz constant L of ∇²U from bounds T of the pair potentials' third derivatives."""
    # A displacement a of all agents changes the Hessian's block of a pair by at most T |a_j - a_i| and a pair's length
    # by at most √2 |a|. So L <= √2 max Σ T |b_j - b_i|² over unit b: the largest eigenvalue of the Laplacian weighted
    # by T, which is at most the largest sum of the weights at both ends of a link.
    if not len(pairs):
        return 0.0
    third_sums = np.bincount(pairs.ravel(), weights=np.repeat(third, 2), minlength=n)
    return sqrt(2.0) * float((third_sums[pairs[:, 0]] + third_sums[pairs[:, 1]]).max())
