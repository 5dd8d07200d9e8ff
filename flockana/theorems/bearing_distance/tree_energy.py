"""Claims that energies on a frozen tree fall along a run, and that edges keep the lengths which these guarantee.

A bound that is attained, as ρ - √(2V/μ) is by an edge pressed and let go, leaves no margin. So it is compared with the
bound of an energy larger by the tolerance on energies, which leaves half of that.

A violation may be the integrator's, and a tighter second run no better where both are down to rounding: then the
difference of the two counts as error.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan, sqrt

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.theorems.bearing_distance.tree_case import TreeCase, length_error
from flockana.theorems.claims import judged
from flockana.theorems.hypotheses import below
from flockana.theorems.rounding import EPS, spread_error
from flockana.theorems.second_run import second_run
from flockana.theorems.theorem import Claim, Hypothesis, Tolerances

_PROOF = "bearing-distance"


def _noise(run: Trajectory, series: Callable[[Trajectory], FloatArray]) -> float:
    """Largest difference of a series between a run and a tighter one; ∞ if that does not get as far."""
    again = second_run(run)
    return float(np.abs(series(run) - series(again)).max()) if len(again.t) == len(run.t) else inf


def _slack(
    case: TreeCase, run: Trajectory, energy: FloatArray, edges: list[int], share: float
) -> tuple[float, bool, FloatArray]:
    """(least |x| - ρ + √(2E(1 + share)/μ) over √(2E/μ) of some edges, whether a sample is below, the bounds)."""
    amplitude = np.sqrt(2.0 * energy / case.mu)[edges]
    bounds: FloatArray = case.rho[edges] - amplitude * sqrt(1.0 + share)
    gaps = (case.shortest(run)[edges] - bounds) / amplitude
    broken = bool((case.lengths(run.q)[:, edges] < bounds).any())
    return float(gaps.min()), broken, bounds


def _amplitude_error(case: TreeCase, run: Trajectory, energy: float, edges: list[int]) -> float:
    """Rounding of lengths, over the amplitude √(2E/μ) that an energy allows; ∞ where it allows none."""
    if not energy > 0.0:
        return inf
    rounding = length_error(case, run) * float(case.rho[edges].max())
    return rounding * sqrt(float(case.mu[edges].max()) / (2.0 * energy))


def root_claim(case: TreeCase, run: Trajectory, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """The claim that V of an edge from the root falls, and while V(0) < μρ²/2 keeps that edge from length 0."""
    start, rounding = case.energies(run.q[0], run.p[0]), length_error(case, run)
    from_root = [e for e, (j, _) in enumerate(case.links) if j == case.root]
    edges = [e for e in from_root if start[e] / case.barrier[e] < 1.0 - 4.0 * rounding]
    if not edges:
        return Claim("root-edge", "vacuous", detail="no edge from the root starts below μρ²/2")
    least = float(start[edges].min())
    if not least > float(case.barrier.min()) * rounding**2:
        return Claim("root-edge", "inconclusive", detail="an edge from the root starts at its desired length, at rest")

    def relative(trajectory: Trajectory) -> FloatArray:
        """V/V(0) of these edges, over time."""
        series = [case.energies(q, p)[edges] / start[edges] for q, p in zip(trajectory.q, trajectory.p, strict=True)]
        return np.array(series)

    rises = float(np.diff(relative(run), axis=0).max(initial=0.0))
    slack, broken, bounds = _slack(case, run, start, edges, tolerances.energy)
    margin = min(slack, tolerances.energy - rises)
    error = 4.0 * _amplitude_error(case, run, least, edges) + 64.0 * EPS
    if slack < 0.0 and not broken:  # the path between two samples is known no better
        margin = nan
    if margin < 0.0:
        error += 4.0 * _noise(run, relative)
    return judged(
        "root-edge",
        margin,
        error,
        needs,
        computed={"least distance to the bound": slack, "largest rise of V in a step": rises},
        stated="|x(t)| >= ρ - sqrt(2V(0)/μ) > 0 on edges from the root, with V never rising",
        witness={f"edge {case.links[e]}": {"V(0)": float(start[e])} for e in edges},
        proof=_PROOF,
        detail=f"{len(edges)} edges from the root start below μρ²/2; their V rises by {rises:.1g} of V(0) at most, and "
        f"they stay above their bound, {np.min(bounds):.3g} or more",
    )


def _energy_error(case: TreeCase, run: Trajectory) -> float:
    """Rounding of H along a run: of velocities against their mean, of lengths against ρ, of its sums."""
    off = length_error(case, run) * case.rho
    stretch = np.abs(case.lengths(run.q) - case.rho)
    springs = float((case.mu * (stretch + off) * off).sum(axis=1).max())
    largest = float(np.abs(run.energy()).max())
    steps = float(run.stats.get("steps", len(run.t)))
    return springs + float(spread_error(run.p).max()) + (case.n**2 + steps) * EPS * largest


def energy_claim(case: TreeCase, run: Trajectory, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """The claim, on an undirected tree, that H never rises: its rate is −Σσ‖v_i − v_j‖²."""
    if "work" not in run.extra:
        return Claim("energy", "inconclusive", detail="the run carries no integral of dH/dt")
    H, largest = run.energy(), float(run.energy().max())
    rate, residual = float(run.energy_rate().max()), float(np.abs(run.energy_residual).max())
    error = _energy_error(case, run) / largest if largest > 0.0 else inf
    margin = tolerances.energy - residual / largest if largest > 0.0 else nan
    if margin < 0.0:
        error += 4.0 * (_noise(run, Trajectory.energy) + _noise(run, lambda again: again.extra["work"])) / largest
    return judged(
        "energy",
        margin if rate <= 0.0 else -1.0,
        error,
        needs,
        computed=rate,
        stated="dH/dt = -Σ σ |v_i - v_j|² <= 0",
        witness={"H(0)": float(H[0]), "H(T)": float(H[-1]), "residual": residual},
        proof=_PROOF,
        detail=f"H falls from {H[0]:.4g} to {H[-1]:.3g}; its rate is never above {rate:.1g}, and accounts for H to "
        f"{residual:.1g}",
    )


def edge_claim(case: TreeCase, run: Trajectory, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """The claim, on an undirected tree, that no edge shrinks below ρ − √(2H(0)/μ)."""
    start, barrier = float(run.energy()[0]), float(case.barrier.min())
    small = below("H(0) < μρ²/2 on every edge", start, barrier, _energy_error(case, run), f"H(0) = {start:.4g}")
    edges = list(range(len(case.links)))
    slack, broken = nan, False
    if start > 0.0:
        slack, broken, _ = _slack(case, run, np.full(len(edges), start), edges, tolerances.energy)
    error = 4.0 * _amplitude_error(case, run, start, edges) + 64.0 * EPS
    margin = nan if slack < 0.0 and not broken else slack
    if margin < 0.0:
        error += 4.0 * _noise(run, lambda again: case.lengths(again.q)) * sqrt(float(case.mu.max()) / (2.0 * start))
    return judged(
        "no-collision",
        margin,
        error,
        [*needs, small],
        computed=float(case.lengths(run.q).min()),
        stated="|x(t)| >= ρ - sqrt(2H(0)/μ) > 0 on every edge",
        witness={"H(0)": start, "least μρ²/2": barrier},
        proof=_PROOF,
        detail=f"H(0) = {start:.4g}, and a collision of an edge costs {barrier:.4g}; the shortest edge is "
        f"{case.lengths(run.q).min():.3g}",
    )
