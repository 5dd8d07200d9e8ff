"""Whether a state of Algorithm 1 or 2 is caught for ever in the basin of a strict minimum: a certificate of its limit.

The argument is that of `flockana.theorems.basin`, in the moving frame, with U the structural potential.
"""

from __future__ import annotations

from math import inf, sqrt

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.equilibria.gradient_flow import structural_force
from flockana.equilibria.terminal import DENSE_LIMIT, rigid_motions
from flockana.interactions import AlphaInteraction
from flockana.laws.olfati_saber import Algorithm1, Algorithm2, paper_pair
from flockana.measures.nets import link_lengths, links
from flockana.theorems.basin import (
    ALONE,
    WINDOWS,
    Basin,
    barrier,
    connected_within,
    curvatures,
    gyration,
    kinetic,
    lipschitz_constant,
    third_derivative,
)
from flockana.theorems.rounding import EPS, pair_force_error

_POINTS = 49  # of a difference quotient of the curvature over the lengths that a link may take


def attraction(law: Algorithm1 | Algorithm2, q: FloatArray, p: FloatArray) -> Basin:
    """The basin of the minimum beside a state.

    Its barrier is 0 where nothing is known: at a saddle, in a flexible net, and of a flock with more coordinates than a
    dense Hessian is made for.

    Examples
    --------
    >>> q = np.array([[0.0, 0.0], [7.001, 0.0]])
    >>> attraction(Algorithm1(), q, 0.0 * q).certificate.margin > 0.99
    True
    >>> attraction(Algorithm1(), q, np.array([[9.0, 0.0], [-9.0, 0.0]])).certificate.margin
    -1.0
    """
    if q.shape[0] == 1:
        return ALONE
    if q.size > DENSE_LIMIT:
        return Basin()
    everywhere = isinstance(law, Algorithm2) and law.gains.c2_gamma > 0.0
    if not (everywhere or law.gains.c2_alpha > 0.0):
        return Basin()
    force, stiffness = _force(law, q), law.stiffness(q)
    curvature = curvatures(stiffness, rigid_motions(q))[0]
    distance = float(2.0 * force / curvature) if curvature > 0.0 else inf
    if distance >= gyration(q):  # there is no turning to speak of: all agents are at one place
        curvature = curvatures(stiffness, _translations(q))[0]
        distance = float(2.0 * force / curvature) if curvature > 0.0 else inf
    connected = everywhere or connected_within(q, paper_pair(law).r - sqrt(2.0) * distance)
    if distance == inf or not connected:
        return Basin(inf, 0.0, distance, curvature)
    leaving = barrier(curvature, distance, law.alpha.length * WINDOWS, lambda window: lipschitz_within(law, q, window))
    return Basin(float(kinetic(p) + force**2 / curvature), leaving, distance, curvature)


def final_basin(run: Trajectory) -> Basin:
    """`attraction` of the last state of a run, kept with the run."""
    return run.remembered("attraction at the end", lambda: attraction(run.law, run.q[-1], run.p[-1]))


def _translations(q: FloatArray) -> FloatArray:
    """Orthonormal basis of the translations, shape (n m, m)."""
    n, m = q.shape
    basis: FloatArray = np.tile(np.eye(m), (n, 1)) / sqrt(n)
    return basis


def _force(law: Algorithm1 | Algorithm2, q: FloatArray) -> float:
    """|∇U(x)| over all coordinates, with the rounding of its sums added."""
    near = float(np.bincount(links(q, law.alpha.range).ravel(), minlength=1).max())
    pull = law.gains.c1_gamma * float(np.abs(q).max()) if isinstance(law, Algorithm2) else 0.0
    rounding = law.gains.c1_alpha * pair_force_error(paper_pair(law)) * (near + 1.0) + 16.0 * EPS * pull
    return float(np.linalg.norm(structural_force(law, q))) + sqrt(q.size) * rounding


def lipschitz_within(law: Algorithm1 | Algorithm2, q: FloatArray, window: float) -> float:
    """Lipschitz constant L of ∇²U within a distance of q."""
    alpha, slack = paper_pair(law), sqrt(2.0) * window
    pairs = links(q, alpha.r + slack)
    return lipschitz_constant(len(q), pairs, law.gains.c1_alpha * _third(alpha, link_lengths(q, pairs), slack))


def _third(alpha: AlphaInteraction, lengths: FloatArray, slack: float) -> FloatArray:
    """Norm of the third derivative of ψ_α(‖x‖_σ) for each pair, at worst over lengths within the slack."""
    s = np.abs(lengths + slack * np.linspace(-1.0, 1.0, _POINTS)[:, None])
    s = np.maximum(np.sort(s, axis=0), 1e-12 * alpha.d)
    root, z = np.sqrt(1.0 + alpha.eps * s**2), alpha.sigma_norm(s)
    action = alpha.phi_alpha(z)
    along = alpha.phi_alpha_slope(z) * (s / root) ** 2 + action / root**3
    return third_derivative(s, along, (along - action / root) / s, least_step=1e-12 * alpha.d)
