"""Certificates from one state for the limit of a flock on a frozen tree (Theorem 1).

*Undirected, reciprocal forces.* H never rises. While H < ½μρ² on every edge, no edge comes to length 0; then velocities
match and every |x_e| goes to ρ_e, by LaSalle's principle, as on a tree nothing else is at rest.

*Directed.* An edge obeys x'' = -g(x) - a x' + w, |g| = μ|y| with y = |x| - ρ, where w is the acceleration of its
parent, 0 at the root. Let V = ½|x'|² + ½μy², and W, P, Y the integrals of |w|², |x'|², y² from now on for ever.

1. V' = -a|x'|² + x'·w <= -½a|x'|² + |w|²/2a. So V never exceeds V̂ = V + W/2a, and P <= 2V̂/a.
2. Let V̂ = θ² ½μρ² with θ < 1: then |y| <= θρ and |x| >= (1 - θ)ρ > 0 for ever. With z = y (x·x')/|x|, |z| <= V̂/√μ
   and z' <= κ|x'|² - μy² + a|y||x'| + |y||w|, κ = max(1, θ/(1 - θ)). So μY <= 4V̂/√μ + 2(κ + a²/μ)P + 2W/μ.
3. The children feel w = g(x) + a x': their W is at most 2(μ·μY + a²P).

So, from the root outwards, all these integrals are finite if θ < 1 on every edge; and as x, x' and their derivatives
are bounded, every |x_e| goes to ρ_e and every x_e' to 0 (Barbalat's lemma). Bearings are free.
"""

from math import inf, sqrt
from typing import Any

import numpy as np

from flockana.measures.perception import edge_vectors
from flockana.sources.jond_2025.theorems.tree_case import TreeCase
from flockana.theorems.limit_certificates import Certificate, decays_to_zero
from flockana.theorems.observed_run import End
from flockana.theorems.rounding_bounds import frame_error
from flockana.theorems.theorem_toolkit import EPS, Claim, Enclosure, FloatArray, Hypothesis, Observed, lengths

_ERROR = 1e-12  # of a share: all roundings in it are taken outwards


def state(q: FloatArray, p: FloatArray) -> End:
    """Return given positions and velocities as a final state with zero error bounds."""
    return End(q, p, np.zeros(len(q)), np.zeros(len(q)))


def edge_shares(case: TreeCase, end: End) -> FloatArray:
    """Return an upper bound of each edge's energy over its barrier ½μρ²; ∞ where unknown."""
    link_lengths, rates = case.edges_of(end.q, end.q_error), case.edges_of(end.p, end.p_error)
    if case.root is not None:
        return _directed(case, case.energies(link_lengths, rates).hi)
    speeds = np.linalg.norm(end.p - end.p.mean(axis=0), axis=1)
    off = end.p_error + sqrt(end.p.shape[1]) * frame_error(end.p)
    H = 0.5 * Enclosure.around(speeds, off).square().sum() + case.energies(link_lengths, 0.0 * rates).sum()
    return H.hi * (1.0 + case.n * EPS) / case.barrier


def _directed(case: TreeCase, start: FloatArray) -> FloatArray:
    """Return an upper bound of each edge's energy over its barrier ½μρ² on a directed tree; ∞ if unknown."""
    shares, felt_accelerations = np.full(len(case.links), inf), {case.root: 0.0}
    for e, parent, child in case.walk:
        W, mu, a = felt_accelerations[parent], float(case.mu[e]), float(case.align[e])
        maximum = float(start[e]) + W / (2.0 * a)
        shares[e] = maximum / case.barrier[e]
        felt_accelerations[child] = inf
        if shares[e] < 1.0:
            theta = sqrt(shares[e])
            P, bend = 2.0 * maximum / a, max(1.0, theta / (1.0 - theta))
            stretch = 4.0 * maximum / sqrt(mu) + 2.0 * (bend + a * a / mu) * P + 2.0 * W / mu
            felt_accelerations[child] = 2.0 * (mu * stretch + a * a * P)
    return shares


def settles(case: TreeCase, end: End) -> Certificate:
    """Return a certificate that all edges reach their desired lengths and velocity differences decay."""
    share = float(edge_shares(case, end).max())
    edge_text = "no edge can shrink to 0 any more" if share < 1.0 else "an edge might still shrink to 0"
    text = f"{edge_text}: edges have at most {share:.2g} of the energy needed"
    return Certificate(max(-1.0, 1.0 - share), text, _ERROR)


def velocity_claim(case: TreeCase, seen: Observed, needs: list[Hypothesis], *, stated: str) -> Claim:
    """Return the claim that the velocities at both ends of every edge match in the limit."""
    speeds = lengths(edge_vectors(seen.run.p, case.links)).max(axis=1)
    about: dict[str, Any] = {"series": speeds, "what": "the largest |x_e'|", "of": "|x_e'|", "start": "at the start"}
    return decays_to_zero(seen, "velocities", needs, [settles(case, seen.end)], stated=stated, **about)


def kept(case: TreeCase, end: End) -> float:
    """Return a lower bound of |x|/ρ at all times for the edge farthest from collision; <= 0 if unknown."""
    share = float(edge_shares(case, end).min())
    return 1.0 - sqrt(share) - 4.0 * EPS if share < 4.0 else -1.0
