"""Theorem 1 of the bearing-distance paper as it can be corrected: edges of a tree take their desired lengths."""

from __future__ import annotations

from itertools import pairwise
from math import log, sqrt

import numpy as np

from flockana.checks import FloatArray
from flockana.laws.perception import edge_vectors
from flockana.theorems.asymptotics import velocities_match
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, judge
from flockana.theorems.tree_case import TreeCase, characteristic_residual, root_edges, tree_hypotheses
from flockana.trajectory import Trajectory

_ROUNDING = 1e-9  # relative error of characteristic polynomials, and of singular values that count as zero
_NEAR, _FLOOR = 1e-2, 1e-7  # length errors, relative to ρ: near the manifold, and above the integrator's own error
_PROOF = "bearing-distance"


def _errors(case: TreeCase, run: Trajectory) -> FloatArray:
    """Largest relative length error of an edge at each sample, shape (T,)."""
    lengths = np.linalg.norm(edge_vectors(run.q, case.links), axis=2)
    errors: FloatArray = np.abs(lengths / case.rho - 1.0).max(axis=1)
    return errors


def _lengths(case: TreeCase, run: Trajectory, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    errors = _errors(case, run)
    margin = tolerances.lattice - float(errors[-1])
    status = judge(margin, 0.0, needs)
    return Claim(
        "lengths",
        "inconclusive" if status == "refuted" else status,  # a finite run refutes no limit
        computed=float(errors[-1]),
        stated=f"||x_e| - ρ_e| -> 0 (<= {tolerances.lattice:g} ρ_e at the end)",
        margin=margin,
        error=0.0,
        witness={"time": float(run.t[-1]), "at the start": float(errors[0])},
        detail=f"every edge goes to its own desired length: off by up to {errors[0]:.3g} ρ at the start and "
        f"{errors[-1]:.2g} ρ at t = {run.t[-1]:g}",
    )


def _spectrum(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """At the point of M next to the end of the run: the factors edge by edge, and the zero modes."""
    m = run.m
    A = case.edge_system(case.on_manifold(run.q[-1]))
    if case.root is not None:
        sprung = [(float(a), float(mu)) for a, mu in zip(case.align, case.mu, strict=True)]
        error = characteristic_residual(A, sprung + [(a, 0.0) for a, _ in sprung for _ in range(m - 1)])
        factors = f"Π (s² + s + μ_e)(s² + s)^{m - 1}, off by {error:.1g}"
    else:
        error, factors = 0.0, "roots with negative real parts beside"
    singular = np.linalg.svd(A, compute_uv=False)
    zeros, expected = int(np.sum(singular <= _ROUNDING * singular[0])), (case.n - 1) * (m - 1)
    moving = np.sort_complex(np.linalg.eigvals(A))[: len(A) - expected]
    # a chain of equal edges has defective eigenvalues, which rounding spreads: they are far from zero all the same
    margin = min(_ROUNDING - error, -float(moving.real.max()), 0.5 - abs(zeros - expected))
    return Claim(
        "spectrum",
        judge(margin, 0.0, needs),
        computed={"zero modes": zeros, "slowest other": float(moving.real.max()), "polynomial error": error},
        stated=f"a semisimple zero of multiplicity (n - 1)(m - 1) = {expected}, and {factors}",
        margin=margin,
        error=0.0,
        witness="the law linearised in edge coordinates, at the end's bearings and the desired lengths",
        proof=_PROOF,
        detail=f"zero has a kernel of dimension {zeros}, that of the manifold of equilibria; the rest decays at "
        f"{-moving.real.max():.4g} or faster; {factors}",
    )


def _exponential(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """Near the manifold, and above the integrator's own error, length errors fall at half the slowest rate at least."""
    errors = _errors(case, run)
    first = int(np.max(np.flatnonzero(errors > _NEAR), initial=-1)) + 1  # from here on it stays near
    last = int(np.max(np.flatnonzero(errors > _FLOOR), initial=0))
    slowest = min((a - sqrt(max(a * a - 4.0 * mu, 0.0))) / 2.0 for a, mu in zip(case.align, case.mu, strict=True))
    seen = last > first
    rate = log(errors[first] / errors[last]) / (run.t[last] - run.t[first]) if seen else float("nan")
    status = judge(rate - 0.5 * slowest, 0.0, needs)
    return Claim(
        "exponential",
        "inconclusive" if status == "refuted" else status,
        computed=rate,
        stated=f"length errors fall as exp(-c t), c >= {0.5 * slowest:.4g}, half the slowest rate of the spectrum",
        margin=rate - 0.5 * slowest,
        error=0.0,
        witness={"slowest rate of the spectrum": slowest},
        detail=f"length errors fall from {errors[first]:.1g} to {errors[last]:.1g} ρ at a rate of {rate:.3g}"
        if seen
        else "the run does not stay near the manifold for long enough",
    )


def _root_edge(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """(iii): V of an edge from the root falls, and while V(0) < μρ²/2 it keeps that edge from length 0."""
    start = {e: one for e, one in root_edges(case, run.q[0], run.p[0]).items() if one[1] > 0.0}
    small = Hypothesis(
        "V(0) < μρ²/2 on an edge from the root", "met" if start else "unmet", detail=f"{len(start)} edges"
    )
    series = [root_edges(case, q, p) for q, p in zip(run.q, run.p, strict=True)]
    lengths = np.linalg.norm(edge_vectors(run.q, case.links), axis=2)
    rises = max((max(b[e][0] - a[e][0] for a, b in pairwise(series)) for e in start), default=0.0)
    slack = min((float(lengths[:, e].min()) - floor for e, (_, floor) in start.items()), default=float("nan"))
    error = 1e-7 * max((V for V, _ in start.values()), default=1.0)
    margin = min(slack, error - rises)
    return Claim(
        "root-edge",
        judge(margin, 0.0, [*needs, small]),
        computed={"least distance to the bound": slack, "largest rise of V in a step": rises},
        stated="|x(t)| >= ρ - sqrt(2V(0)/μ) > 0 on edges from the root, with V never rising",
        margin=margin,
        error=0.0,
        witness={f"edge {case.links[e]}": {"V(0)": V, "bound": floor} for e, (V, floor) in start.items()},
        proof=_PROOF,
        detail=f"{small.detail} from the root start below μρ²/2; their V never rises, and they stay {slack:.3g} "
        "or more above the bound"
        if start
        else "no edge from the root starts below μρ²/2",
    )


def _energy(run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """The undirected law: H never rises, and its rate is exact."""
    residual = float(np.abs(run.energy_residual).max())
    rate, H = float(run.energy_rate().max()), float(run.energy()[0])
    error = 1e-6 * H
    margin = min(error - residual, 1e-12 * H - rate)
    return Claim(
        "energy",
        judge(margin, 0.0, needs),
        computed=rate,
        stated="dH/dt = -Σ σ |v_i - v_j|² <= 0",
        margin=margin,
        error=error,
        witness={"H(0)": H, "H(T)": float(run.energy()[-1]), "residual": residual},
        proof=_PROOF,
        detail=f"H falls from {H:.4g} to {run.energy()[-1]:.3g}; its rate is never above {rate:.1g}, and accounts for "
        f"H to {residual:.1g}",
    )


def _no_collision(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """Undirected: H(0) pays for no edge to shrink below ρ − √(2H(0)/μ)."""
    start = float(run.energy()[0])
    barrier = float((0.5 * case.mu * case.rho**2).min())
    small = Hypothesis("H(0) < μρ²/2 on every edge", "met" if start < barrier else "unmet", barrier - start)
    lengths = np.linalg.norm(edge_vectors(run.q, case.links), axis=2).min(axis=0)
    margin = float((lengths - case.rho + np.sqrt(2.0 * start / case.mu)).min())
    return Claim(
        "no-collision",
        judge(margin, 0.0, [*needs, small]),
        computed=float(lengths.min()),
        stated="|x(t)| >= ρ - sqrt(2H(0)/μ) > 0 on every edge",
        margin=margin,
        error=0.0,
        witness={"H(0)": start, "least μρ²/2": barrier},
        proof=_PROOF,
        detail=f"H(0) = {start:.4g}, and a collision of an edge costs {barrier:.4g}; the shortest edge is "
        f"{lengths.min():.3g}",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    needs, case = tree_hypotheses(run)
    names = ("lengths", "velocities", "spectrum", "exponential", "root-edge", "energy", "no-collision")
    if case is None:
        return needs, [Claim(name, "vacuous", detail="another case") for name in names]
    constant = run.law.spacing is not None or len(set(case.rho)) == 1
    needs += [
        Hypothesis(
            "each edge has one desired length, for ever",
            "met" if constant else "unmet",
            detail=f"ρ from {case.rho.min():g} to {case.rho.max():g}",
        ),
        Hypothesis("μ > 0", "met" if case.mu.min() > 0.0 else "unmet", float(case.mu.min())),
        Hypothesis("alignment is at work", "met" if case.align.min() > 0.0 else "unmet", float(case.align.min())),
    ]
    if any(need.status == "unmet" for need in needs):
        return needs, [Claim(name, "vacuous", detail="a hypothesis is not met") for name in names]
    claims = [
        _lengths(case, run, needs, tolerances),
        velocities_match(run, tolerances, needs, name="velocities"),
        _spectrum(case, run, needs),
    ]
    if case.root is None:
        return needs, [*claims, _energy(run, needs), _no_collision(case, run, needs)]
    return needs, [*claims, _exponential(case, run, needs), _root_edge(case, run, needs)]


THEOREM = Theorem(
    id="zone-1-corrected",
    title="Bearing-distance Theorem 1 corrected: edges of a tree take their desired lengths",
    statement=(
        "On a frozen rooted out-tree with constant ρ_i > 0, μ_i > 0 the equilibria are |x_e| = ρ_e, x' = 0: a product "
        "of spheres. At each, the spectrum is, edge by edge, the roots of s² + s + μ once and {0, -1} m - 1 times, "
        "zero semisimple: the manifold is normally hyperbolic, and length and velocity errors converge "
        "exponentially near it. On an edge from the root V = |x'|²/2 + μ(|x| - ρ)²/2 falls, and V(0) < μρ²/2 excludes "
        "its collision. On an undirected tree with the reciprocal law H = Σ|v - v̄|²/2 + Σ μ(|x| - ρ)²/2 falls and "
        "every equilibrium without collision has |x_e| = ρ. Pairs that are no edge are not controlled."
    ),
    source="Jond, bearing-distance flocking, Theorem 1; corrected by us",
    kind="trajectory",
    check=_check,
    references=("jond-2025",),
)
