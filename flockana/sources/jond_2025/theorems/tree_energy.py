"""Claims that energies on a frozen tree fall along a run, with the guaranteed edge lengths.

A bound that is attained, as ρ - √(2V/μ) is by an edge pressed and let go, leaves no margin. So it is compared with the
bound of an energy larger by the tolerance on energies, which leaves half of that.
"""

import numpy as np

from flockana.sources.jond_2025.theorems.tree_case import TreeCase
from flockana.theorems.claims import judged, undecided, vacuous
from flockana.theorems.hypotheses import condition, positive_room
from flockana.theorems.theorem_toolkit import EPS, Claim, Enclosure, Hypothesis, Observed, Tolerances, stacked

_PROOF = "bearing-distance"


def proof_of(case: TreeCase, m: int) -> str | None:
    """Return the id of the proof that covers a tree in m dimensions; None if no proof does."""
    return _PROOF if m in (2, 3) and (case.root is None or bool((case.align == 1.0).all())) else None


def _room(case: TreeCase, seen: Observed, energy: Enclosure, edges: list[int], share: float) -> Enclosure:
    """Return the margin of edges' least lengths over the bound from their initial energies, relative to ρ."""
    rho, mu = case.rho[edges], case.mu[edges]
    amplitude = (2.0 * (1.0 + share) * energy / mu).sqrt()
    return (case.shortest(seen)[edges] - rho + amplitude) / rho


def root_claim(case: TreeCase, seen: Observed, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """Return the claim that the energy of edges from the root falls and keeps their lengths above 0."""
    if seen.doubt:
        return undecided("root-edge", "the edges' energies are not known", needs)
    link_lengths, rates = case.edges_of(seen.run.q, seen.shape_error), case.edges_of(seen.run.p, seen.speed_error)
    energies = case.energies(link_lengths, rates)
    below_barrier = energies.hi[0] < case.barrier
    edges = [e for e, (j, _) in enumerate(case.links) if j == case.root and below_barrier[e]]
    if not edges:
        return vacuous("root-edge", condition("an edge from the root starts below μρ²/2", False))
    V, start = energies[:, edges], energies[0, edges]
    margin = _room(case, seen, start, edges, tolerances.energy)
    falls = (V[:-1] - V[1:] + tolerances.energy * start) / case.barrier[edges]
    rises = float((np.diff(V.mid, axis=0) / case.barrier[edges]).max(initial=0.0))
    return judged("root-edge", stacked([margin.worst, falls.worst]), needs, proof=proof_of(case, seen.m)).described(
        computed={"least distance to the bound": float(margin.worst.mid), "largest rise of V in a step": rises},
        stated="|x(t)| >= ρ - sqrt(2V(0)/μ) > 0 on edges from the root, with V never rising",
        witness={f"edge {case.links[e]}": {"V(0)": float(V.mid[0, k])} for k, e in enumerate(edges)},
        detail=f"{len(edges)} edges from the root start below μρ²/2; V rises by at most {rises:.1g} of this from "
        f"sample to sample, and the shortest of them is never below {case.shortest(seen).mid[edges].min():.4g}",
    )


def _springs_rounding(case: TreeCase, seen: Observed) -> float:
    """Return the rounding error of the spring energy ½ Σ μ (|x| − ρ)² far from the origin."""
    rounding_error = 16.0 * EPS * float(np.abs(seen.run.q).max())
    stretch = np.abs(case.lengths(seen.run.q) - case.rho)
    return float((case.mu * (stretch + rounding_error) * rounding_error).sum(axis=1).max())


def energy_claim(case: TreeCase, seen: Observed, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """Return the claim that the energy H of a flock on an undirected tree never rises."""
    if "work" not in seen.run.extra:
        return undecided("energy", "the run carries no integral of dH/dt", needs)
    H, largest, rate = seen.run.energy(), float(seen.run.energy().max()), float(seen.run.energy_rate().max())
    residual = abs(seen.residual.widened(_springs_rounding(case, seen)))
    deviation = float(residual.mid.max())
    balance_margin = tolerances.energy - residual.max() / Enclosure.around(largest, _springs_rounding(case, seen))
    stays_apart = float(case.shortest(seen).lo.min()) > 0.0  # the proof is silent on edges of length 0
    return judged(
        "energy",
        balance_margin if rate <= 0.0 else Enclosure.of(-1.0),  # a sum of squares: no rounding turns its sign
        needs,
        computed=rate,
        stated="dH/dt = -Σ σ |v_i - v_j|² <= 0",
        witness={"H(0)": float(H[0]), "H(T)": float(H[-1]), "residual": deviation},
        proof=proof_of(case, seen.m) if stays_apart else None,
        detail=f"H falls from {H[0]:.4g} to {H[-1]:.3g}; its rate is never above {rate:.1g}, and accounts for H to "
        f"{deviation:.1g}",
    )


def edge_claim(case: TreeCase, seen: Observed, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """Return the claim, on an undirected tree, that no edge shrinks below ρ − √(2H(0)/μ)."""
    start, barrier = seen.energy[0].widened(_springs_rounding(case, seen)).clip(0.0), float(case.barrier.min())
    text = f"H(0) = {start.mid:.4g}"
    edges = list(range(len(case.links)))
    return judged(
        "no-collision",
        _room(case, seen, start, edges, tolerances.energy),
        [*needs, positive_room("H(0) < μρ²/2 on every edge", barrier - start, text)],
        computed=float(case.lengths(seen.run.q).min()),
        stated="|x(t)| >= ρ - sqrt(2H(0)/μ) > 0 on every edge",
        witness={"H(0)": float(start.mid), "least μρ²/2": barrier},
        proof=proof_of(case, seen.m),
        detail=f"{text}, and a collision of an edge costs {barrier:.4g}; the shortest edge is "
        f"{case.lengths(seen.run.q).min():.3g}",
    )
