"""Corrected Theorem 1 of the bearing-distance paper: edges of a tree take their desired lengths."""

import numpy as np

from flockana.sources.jond_2025.theorems.tree_case import TreeCase, minimal_law, tree_hypotheses
from flockana.sources.jond_2025.theorems.tree_energy import edge_claim, energy_claim, proof_of, root_claim
from flockana.sources.jond_2025.theorems.tree_limits import settles, velocity_claim
from flockana.sources.jond_2025.theorems.tree_spectrum import Spectrum, tree_spectrum
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances, unmet
from flockana.theorems.theorem_toolkit import (
    Certificate,
    Observed,
    condition,
    evidence,
    limit_claim,
    run_theorem,
    spectral,
)


def _errors(case: TreeCase, seen: Observed) -> np.ndarray:
    """Return the largest relative length error of an edge at each sample, shape (T,)."""
    return np.abs(case.lengths(seen.run.q) / case.rho - 1.0).max(axis=1)


def _lengths(case: TreeCase, seen: Observed, needs: list[Hypothesis]) -> Claim:
    """Return the claim that every edge takes its desired length in the limit."""
    errors = _errors(case, seen)
    return limit_claim(
        "lengths", needs, [settles(case, seen.end)], evidence=evidence(seen.t, errors, "the largest length error")
    ).described(
        computed=float(errors[-1]),
        stated="||x_e| - ρ_e| -> 0",
        witness={"time": float(seen.t[-1]), "at the start": float(errors[0])},
        detail=f"edges are off their desired lengths by up to {errors[0]:.3g} ρ at the start and "
        f"{errors[-1]:.2g} ρ at t = {seen.t[-1]:g}",
    )


def _spectrum(case: TreeCase, seen: Observed, spectrum: Spectrum, needs: list[Hypothesis]) -> Claim:
    """Return the claim that the spectrum at the final equilibrium has the stated factors and zero modes."""
    m, directed = seen.m, case.root is not None
    expected, factors = (case.n - 1) * (m - 1), "roots with negative real parts beside"
    if directed:
        factors = f"Π (s² + a s + μ_e)(s² + a s)^{m - 1}, off by {spectrum.residual:.1g}"
    margin = spectrum.margin
    return spectral("spectrum", margin, spectrum.error, needs, proof=proof_of(case, m) if directed else None).described(
        computed={
            "zero modes": spectrum.zeros,
            "slowest other": -spectrum.slowest,
            "polynomial error": spectrum.residual,
        },
        stated=f"a semisimple zero of multiplicity (n - 1)(m - 1) = {expected}, and {factors}",
        witness="the law linearised in edge coordinates, at the end's bearings and the desired lengths",
        detail=f"the eigenvalue 0 has multiplicity {spectrum.zeros}, the dimension of the manifold of equilibria; the "
        f"other modes decay at {spectrum.slowest:.4g} or faster; {factors}",
    )


def _exponential(case: TreeCase, seen: Observed, spectrum: Spectrum, needs: list[Hypothesis]) -> Claim:
    """Return the claim that length errors finally decay at least at half the slowest rate of the spectrum."""
    # A flock that certainly goes to the manifold, which is normally hyperbolic by that spectrum, comes to it at any
    # rate below the slowest. Near it is too late to measure: a chain of equal edges starts more slowly.
    hyperbolic = Certificate(spectrum.margin, "the spectrum is not as stated", spectrum.error)
    errors = _errors(case, seen)
    return limit_claim(
        "exponential",
        needs,
        [settles(case, seen.end) if hyperbolic.certain else hyperbolic],
        computed=spectrum.slowest,
        stated=f"length errors fall as exp(-c t), c >= {0.5 * spectrum.slowest:.4g}, half the slowest rate of the "
        "spectrum",
        witness={"slowest rate of the spectrum": spectrum.slowest},
        evidence=evidence(seen.t, errors, "the largest length error"),
        detail=f"the manifold of equilibria attracts at a rate of {spectrum.slowest:.4g} or more",
    )


@run_theorem(
    "zone-1-corrected",
    title="Bearing-distance Theorem 1 corrected: edges of a tree take their desired lengths",
    source="Jond, bearing-distance flocking, Theorem 1; corrected by us",
    law=minimal_law,
    claims=("lengths", "velocities", "spectrum", "exponential", "root-edge", "energy", "no-collision"),
    references=("jond-2025",),
    author="corrected",
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """On a frozen rooted out-tree with constant ρ_i > 0, μ_i > 0 the equilibria are |x_e| = ρ_e, x' = 0: a product of
    spheres. At each, the spectrum is, edge by edge, the roots of s² + s + μ once and {0, -1} m - 1 times, with 0
    semisimple: the manifold is normally hyperbolic, and length and velocity errors converge exponentially near it. On
    an edge from the root V = |x'|²/2 + μ(|x| - ρ)²/2 falls, and V(0) < μρ²/2 excludes its collision. On an undirected
    tree with the reciprocal law H = Σ|v - v̄|²/2 + Σ μ(|x| - ρ)²/2 falls and every equilibrium without collision has
    |x_e| = ρ. Distances of pairs that are not edges are not controlled.
    """
    needs, case = tree_hypotheses(seen)
    if case is None or unmet(needs):
        return needs, []
    # on a graph that never changes the number of neighbours, and so the spacing, never does
    spacings = f"ρ from {case.rho.min():g} to {case.rho.max():g}"
    needs.append(condition("each edge has one constant desired length", True, detail=spacings))
    spectrum = tree_spectrum(case, case.on_manifold(seen.run.q[-1]))
    velocities = velocity_claim(case, seen, needs, stated="|x_e'| -> 0")
    claims = [_lengths(case, seen, needs), velocities, _spectrum(case, seen, spectrum, needs)]
    if case.root is None:
        return needs, [*claims, energy_claim(case, seen, needs, tolerances), edge_claim(case, seen, needs, tolerances)]
    return needs, [*claims, _exponential(case, seen, spectrum, needs), root_claim(case, seen, needs, tolerances)]
