"""Theorem 1 of the bearing-distance paper as it can be corrected: edges of a tree take their desired lengths."""

from __future__ import annotations

from math import log, nan

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.theorems.bearing_distance.tree_case import TreeCase, length_error, minimal_law, tree_hypotheses
from flockana.theorems.bearing_distance.tree_energy import edge_claim, energy_claim, root_claim
from flockana.theorems.bearing_distance.tree_limits import settles, velocity_claim
from flockana.theorems.bearing_distance.tree_spectrum import tree_spectrum
from flockana.theorems.claims import judged
from flockana.theorems.hypotheses import condition
from flockana.theorems.limits import TIME_CONSTANTS, limit_claim
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, unmet

_NEAR, _FLOOR = 1e-2, 1e-7  # length errors, relative to ρ: near the manifold, and above the integrator's own error
_BLUR = 1e-3  # largest share of a length error that may be rounding
_PROOF = "bearing-distance"


def _errors(case: TreeCase, run: Trajectory) -> np.ndarray:
    """Largest relative length error of an edge at each sample, shape (T,)."""
    errors: np.ndarray = np.abs(case.lengths(run.q) / case.rho - 1.0).max(axis=1)
    return errors


def _lengths(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """The claim that every edge takes its desired length in the limit."""
    errors = _errors(case, run)
    return limit_claim(
        "lengths",
        needs,
        [settles(case, run.q[-1], run.p[-1])],
        computed=float(errors[-1]),
        stated="||x_e| - ρ_e| -> 0",
        witness={"time": float(run.t[-1]), "at the start": float(errors[0])},
        detail=f"every edge goes to its own desired length: off by up to {errors[0]:.3g} ρ at the start and "
        f"{errors[-1]:.2g} ρ at t = {run.t[-1]:g}",
    )


def _spectrum(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """The claim about the spectrum at the equilibrium beside the end of the run: its factors and its zero modes."""
    m, spectrum = run.m, tree_spectrum(case, case.on_manifold(run.q[-1]))
    expected, factors = (case.n - 1) * (m - 1), "roots with negative real parts beside"
    if case.root is not None:
        factors = f"Π (s² + a s + μ_e)(s² + a s)^{m - 1}, off by {spectrum.residual:.1g}"
    return judged(
        "spectrum",
        spectrum.margin,
        spectrum.error,
        needs,
        computed={
            "zero modes": spectrum.zeros,
            "slowest other": -spectrum.slowest,
            "polynomial error": spectrum.residual,
        },
        stated=f"a semisimple zero of multiplicity (n - 1)(m - 1) = {expected}, and {factors}",
        witness="the law linearised in edge coordinates, at the end's bearings and the desired lengths",
        proof=_PROOF,
        detail=f"zero has a kernel of dimension {spectrum.zeros}, that of the manifold of equilibria; the rest decays "
        f"at {spectrum.slowest:.4g} or faster; {factors}",
    )


def _exponential(case: TreeCase, run: Trajectory, needs: list[Hypothesis]) -> Claim:
    """The claim that near the manifold length errors fall at half the slowest rate of the spectrum at least.

    It must be seen through five time constants of that rate, above the integrator's own error; a chain of equal edges
    starts more slowly, which refutes nothing.
    """
    errors, rounding = _errors(case, run), length_error(case, run)
    slowest = tree_spectrum(case, case.on_manifold(run.q[-1])).slowest
    first = int(np.max(np.flatnonzero(errors > _NEAR), initial=-1)) + 1  # from here on it stays near
    last = int(np.max(np.flatnonzero(errors > max(_FLOOR, rounding / _BLUR)), initial=0))
    seen = last > first and (run.t[last] - run.t[first]) * slowest >= TIME_CONSTANTS
    rate = log(errors[first] / errors[last]) / (run.t[last] - run.t[first]) if seen else nan
    return judged(
        "exponential",
        rate / slowest - 0.5,
        _BLUR / TIME_CONSTANTS,
        needs,
        refutes=False,
        computed=rate,
        stated=f"length errors fall as exp(-c t), c >= {0.5 * slowest:.4g}, half the slowest rate of the spectrum",
        witness={"slowest rate of the spectrum": slowest},
        detail=f"length errors fall from {errors[first]:.1g} to {errors[last]:.1g} ρ at a rate of {rate:.3g}"
        if seen
        else "the run does not stay near the manifold for long enough",
    )


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    needs, case = tree_hypotheses(run)
    if case is None or unmet(needs):
        return needs, []
    # on a graph that never changes the number of neighbours, and so the spacing, never does
    spacings = f"ρ from {case.rho.min():g} to {case.rho.max():g}"
    needs.append(condition("each edge has one desired length, for ever", True, detail=spacings))
    claims = [
        _lengths(case, run, needs),
        velocity_claim(case, run, needs, stated="|x_e'| -> 0"),
        _spectrum(case, run, needs),
    ]
    if case.root is None:
        return needs, [*claims, energy_claim(case, run, needs, tolerances), edge_claim(case, run, needs, tolerances)]
    return needs, [*claims, _exponential(case, run, needs), root_claim(case, run, needs, tolerances)]


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
    law=minimal_law,
    check=_check,
    claims=("lengths", "velocities", "spectrum", "exponential", "root-edge", "energy", "no-collision"),
    references=("jond-2025",),
)
