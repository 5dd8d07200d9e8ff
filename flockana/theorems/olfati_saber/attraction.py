"""Whether a state of Algorithm 1 or 2 is caught for ever in the basin of a strict minimum: a certificate of its limit.

In the moving frame x' = v, v' = -∇U - D(x) v with D >= 0, so that E = U + K never rises. Let λ be the least eigenvalue
of ∇²U(x) off the rigid motions, g = ∇U(x), and let ∇²U be Lipschitz with constant L within the distance w of x.

1. Off the rigid motions U is strictly convex near x. If |g| is small, it has a minimum x* there, within δ = 2|g|/λ
   of x; ∇U(x*) is orthogonal both to the rigid motions of x* and to the complement of those of x, so it is 0 as long
   as δ is less than the least radius of gyration (else λ is taken off the translations alone). The curvature at x* is
   λ - Lδ at least, and U(x) - U(x*) <= |g|²/λ.
2. Of the states with the distance ρ from the set of all x* moved rigidly, the nearest of these differs from each by a
   vector that is orthogonal to the rigid motions; so U >= U(x*) + ρ²(½(λ - Lδ) - Lρ/6) there, for ρ + δ <= w, and for
   ρ <= λ/(2L) there is no equilibrium nearer than ρ but x* itself.
3. If E - U(x*) <= K + |g|²/λ is less than that barrier, the flock never leaves. With damping of all relative motion
   (c2γ > 0, or c2α > 0 on a connected net) it converges to x*, and its velocities match, by LaSalle's principle.

Nothing here is a tolerance. The flock's own scales come in through λ, L and the barrier.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf, sqrt

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.equilibria.gradient_flow import structural_force
from flockana.equilibria.terminal import DENSE_LIMIT, rigid_motions
from flockana.interactions import AlphaInteraction
from flockana.laws.olfati_saber import Algorithm1, Algorithm2, paper_pair
from flockana.measures.frame import moving_frame
from flockana.measures.nets import LinkArray, components, link_lengths, links
from flockana.theorems.limits import Certificate
from flockana.theorems.rounding import pair_force_error

_EPS = float(np.finfo(float).eps)
WINDOWS = np.geomspace(1e-8, 0.25, 25)  # of d: distances up to which L is taken
_POINTS = 49  # of a difference quotient of the curvature over the lengths that a link may take
_SAFETY = 1.25  # on that quotient: its curve is smooth but for two kinks
_SYMMETRIC = 1e-9  # of the largest: a rotation that moves the agents by less is no motion, as in `rigid_motions`


@dataclass(frozen=True)
class Attraction:
    """How firmly a state is held by the minimum beside it.

    Attributes
    ----------
    excess : float
        Bound of its energy above that minimum; ∞ where there is none.
    barrier : float
        Energy that the flock needs at least to leave; 0 where nothing is known.
    distance : float
        Bound δ of the distance to the minimum, over all coordinates; ∞ where there is none.
    curvature : float
        Least eigenvalue λ of ∇²U off the rigid motions, less its rounding.
    """

    excess: float
    barrier: float
    distance: float
    curvature: float

    @property
    def certificate(self) -> Certificate:
        """The energy above the minimum is less than the barrier."""
        if not self.barrier > 0.0:
            return Certificate(-1.0, "it is not known to be caught by a minimum")
        ratio = self.excess / self.barrier
        held = "caught by a strict minimum for ever" if ratio < 1.0 else "near a minimum, with energy enough to leave"
        text = f"it is {held}: {self.excess:.2g} above it, where leaving takes {self.barrier:.2g} at least"
        return Certificate(max(-1.0, 1.0 - ratio), text)


def attraction(law: Algorithm1 | Algorithm2, q: FloatArray, p: FloatArray) -> Attraction:
    """Measure whether a state is caught for ever; see the module's text for the argument.

    Returns Attraction With a barrier of 0 where nothing is known: at a saddle, in a flexible net, and of a flock with
    more coordinates than a dense Hessian is made for.

    Examples
    --------
    >>> q = np.array([[0.0, 0.0], [7.001, 0.0]])
    >>> attraction(Algorithm1(), q, 0.0 * q).certificate.margin > 0.99
    True
    >>> attraction(Algorithm1(), q, np.array([[9.0, 0.0], [-9.0, 0.0]])).certificate.margin
    -1.0
    """
    unknown = Attraction(inf, 0.0, inf, float("nan"))
    if q.shape[0] == 1:
        return Attraction(0.0, inf, 0.0, inf)
    if q.size > DENSE_LIMIT:
        return unknown
    everywhere = isinstance(law, Algorithm2) and law.gains.c2_gamma > 0.0
    if not (everywhere or law.gains.c2_alpha > 0.0):
        return unknown
    force = _force(law, q)
    curvature = _curvature(law, q, rigid_motions(q))
    distance = float(2.0 * force / curvature) if curvature > 0.0 else inf
    if distance >= gyration(q):  # there is no turning to speak of: all agents are at one place
        curvature = _curvature(law, q, _shifts(q))
        distance = float(2.0 * force / curvature) if curvature > 0.0 else inf
    if distance == inf or not (everywhere or _joined(paper_pair(law), q, sqrt(2.0) * distance)):
        return Attraction(inf, 0.0, distance, curvature)
    leaving = barrier(curvature, distance, law.alpha.length * WINDOWS, lambda window: _lipschitz(law, q, window))
    return Attraction(float(kinetic(p) + force**2 / curvature), leaving, distance, curvature)


def held(run: Trajectory) -> Attraction:
    """`attraction` of the last state of a run, kept with the run."""
    return run.remembered("attraction at the end", lambda: attraction(run.law, run.q[-1], run.p[-1]))


def _shifts(q: FloatArray) -> FloatArray:
    """Orthonormal basis of the translations, shape (n m, m)."""
    n, m = q.shape
    basis: FloatArray = np.tile(np.eye(m), (n, 1)) / sqrt(n)
    return basis


def _curvature(law: Algorithm1 | Algorithm2, q: FloatArray, rigid: FloatArray) -> float:
    """λ off some rigid motions, less its rounding: of a symmetric eigenvalue problem, some N ε of the largest."""
    free = np.linalg.svd(rigid, full_matrices=True)[0][:, rigid.shape[1] :]
    if free.shape[1] == 0:
        return float("nan")
    values = np.linalg.eigvalsh(free.T @ (law.stiffness(q) @ free))
    return float(values[0]) - 64.0 * q.size * _EPS * float(np.abs(values).max())


def _force(law: Algorithm1 | Algorithm2, q: FloatArray) -> float:
    """|∇U(x)| over all coordinates, with the rounding of its sums added."""
    near = float(np.bincount(links(q, law.alpha.range).ravel(), minlength=1).max())
    pull = law.gains.c1_gamma * float(np.abs(q).max()) if isinstance(law, Algorithm2) else 0.0
    rounding = law.gains.c1_alpha * pair_force_error(paper_pair(law)) * (near + 1.0) + 16.0 * _EPS * pull
    return float(np.linalg.norm(structural_force(law, q))) + sqrt(q.size) * rounding


def kinetic(p: FloatArray) -> float:
    """K(v) = ½ Σ‖p_i − p_c‖², with the rounding of v added.

    Examples
    --------
    >>> 1.0 <= kinetic(np.array([[1.0], [-1.0]])) < 1.0 + 1e-12
    True
    """
    rounding = sqrt(p.size) * 8.0 * _EPS * float(np.abs(p).max())
    return 0.5 * (float(np.linalg.norm(moving_frame(p))) + rounding) ** 2


def gyration(q: FloatArray) -> float:
    """Least size of a unit rotation's motion, over all coordinates; ∞ on a line.

    Examples
    --------
    >>> gyration(np.array([[-1.0, 0.0], [1.0, 0.0]]))
    1.4142135623730951
    """
    x, m = moving_frame(q), q.shape[1]
    turns = []
    for a in range(m):
        for b in range(a):
            turn = np.zeros_like(x)
            turn[:, a], turn[:, b] = x[:, b], -x[:, a]
            turns.append(turn.ravel())
    sizes = np.linalg.svd(np.array(turns), compute_uv=False) if turns else np.empty(0)
    return float(np.min(sizes[sizes > _SYMMETRIC * sizes.max(initial=0.0)], initial=inf))


def _joined(alpha: AlphaInteraction, q: FloatArray, slack: float) -> bool:
    """Whether the net is connected by links that stay shorter than r by more than a slack."""
    reach = alpha.r - slack
    return reach > 0.0 and not components(len(q), links(q, reach)).any()


def barrier(
    curvature: float, distance: float, windows: Iterable[float], lipschitz_within: Callable[[float], float]
) -> float:
    """The highest barrier of step 2 over a choice of windows w: a wide one has a large L, a narrow one a small ρ.

    Examples
    --------
    >>> barrier(2.0, 0.0, [1.0, 3.0], lambda window: 0.0)
    9.0
    """
    best = 0.0
    for window in windows:
        lipschitz = lipschitz_within(float(window))
        reach = window - distance
        if lipschitz > 0.0:
            reach = min(reach, 0.5 * curvature / lipschitz)
        inner = curvature - lipschitz * distance
        if reach > 4.0 * distance and inner > 0.5 * curvature:
            best = max(best, reach**2 * (0.5 * inner - lipschitz * reach / 6.0))
    return float(best)


def _lipschitz(law: Algorithm1 | Algorithm2, q: FloatArray, window: float) -> float:
    """Lipschitz constant L of ∇²U within a distance of q.

    A displacement a of all agents changes the Hessian's block of a pair by at most T |a_j - a_i| and a pair's length by
    at most √2 |a|, with T the norm of the third derivative of the pair's potential in the lengths it may take. So
    L <= √2 max Σ T |b_j - b_i|² over unit b: the largest eigenvalue of the Laplacian weighted by T, which is at most
    the largest sum of the weights at both ends of a link.
    """
    alpha, slack = paper_pair(law), sqrt(2.0) * window
    pairs = links(q, alpha.r + slack)
    weights = law.gains.c1_alpha * _third(alpha, link_lengths(q, pairs), slack)
    return sqrt(2.0) * weight_at_both_ends(len(q), pairs, weights)


def weight_at_both_ends(n: int, pairs: LinkArray, weights: FloatArray) -> float:
    """The largest sum of the weights at both ends of a link: a bound of the weighted Laplacian's largest eigenvalue.

    Examples
    --------
    >>> weight_at_both_ends(3, np.array([[0, 1], [1, 2]]), np.array([1.0, 2.0]))
    5.0
    """
    if not len(pairs):
        return 0.0
    ends = np.bincount(pairs.ravel(), weights=np.repeat(weights, 2), minlength=n)
    return float((ends[pairs[:, 0]] + ends[pairs[:, 1]]).max())


def _third(alpha: AlphaInteraction, lengths: FloatArray, slack: float) -> FloatArray:
    """Norm of the third derivative of ψ_α(‖x‖_σ) for each pair, at worst over lengths within the slack.

    With F(s) the potential at distance s and w = F'/s, it is F''' along the pair three times, and w' along it once and
    across twice; of unit vectors the second kind makes 3 e (1 - e²) <= 2/√3 at most.
    """
    s = np.abs(lengths[:, None] + slack * np.linspace(-1.0, 1.0, _POINTS))
    s = np.maximum(np.sort(s, axis=1), 1e-12 * alpha.d)
    root, z = np.sqrt(1.0 + alpha.eps * s**2), alpha.sigma_norm(s)
    action = alpha.phi_alpha(z)
    along = alpha.phi_alpha_slope(z) * (s / root) ** 2 + action / root**3
    across = (along - action / root) / s
    step = np.diff(s, axis=1)
    change = np.divide(np.abs(np.diff(along, axis=1)), step, out=np.zeros_like(step), where=step > 1e-12 * alpha.d)
    norm: FloatArray = _SAFETY * change.max(axis=1) + 2.0 / sqrt(3.0) * np.abs(across).max(axis=1)
    return norm
