"""Claims that several theorems share: what a finite run can say of a limit, and of collisions."""

from __future__ import annotations

from collections.abc import Iterable
from math import floor

import numpy as np

from flockana.lattice import classify
from flockana.metrics import coincident_pairs
from flockana.paths import Contact, contacts
from flockana.terminal import TerminalState, terminal_state
from flockana.theorems.theorem import Claim, Hypothesis, HypothesisStatus, Tolerances, judge
from flockana.trajectory import Trajectory


def velocities_match(run: Trajectory, tolerances: Tolerances, needs: Iterable[Hypothesis], *, name: str) -> Claim:
    """Velocities match in the moving frame: K̃ is negligible at the end. A finite run cannot refute it.

    Parameters
    ----------
    run : Trajectory
        The run.
    tolerances : Tolerances
        `velocity` is used.
    needs : iterable of Hypothesis
        Hypotheses of the claim.
    name : str
        Name of the claim.
    """
    series = run.metrics().velocity_mismatch.values
    margin = tolerances.velocity - float(series[-1])
    status = judge(margin, 0.0, needs)
    return Claim(
        name,
        "inconclusive" if status == "refuted" else status,
        computed=float(series[-1]),
        stated=f"K̃ -> 0 (K̃ <= {tolerances.velocity:g} at the end)",
        margin=margin,
        error=0.0,
        witness={"time": float(run.t[-1]), "K̃ at the start": float(series[0])},
        detail=f"velocities match: K̃ goes from {series[0]:.3g} to {series[-1]:.3g} at t = {run.t[-1]:g}",
    )


def settled(end: TerminalState, tolerances: Tolerances) -> bool:
    """Whether a terminal state is an equilibrium of the structural dynamics within tolerance.

    Parameters
    ----------
    end : TerminalState
        The state.
    tolerances : Tolerances
        `force` and `velocity` are used.
    """
    return end.force <= tolerances.force and end.mismatch <= tolerances.velocity


def lattice_limit(run: Trajectory, needs: Iterable[Hypothesis], tolerances: Tolerances, *, name: str) -> Claim:
    """The limit is an α-lattice. A strained limit refutes it only if it is a strict minimum (open basin).

    Parameters
    ----------
    run : Trajectory
        A run of Algorithm 1 or 2.
    needs : iterable of Hypothesis
        Hypotheses of the claim.
    tolerances : Tolerances
        `lattice`, `force`, `velocity` and `curvature` are used.
    name : str
        Name of the claim.
    """
    end = terminal_state(run.law, run.q[-1], run.p[-1], contact=tolerances.contact)
    kind = classify(end.strain, lattice=tolerances.lattice, quasi=tolerances.quasi)
    margin = tolerances.lattice - end.strain
    status = judge(margin, 0.0, needs)
    if status != "vacuous" and not settled(end, tolerances):
        status, kind = "inconclusive", f"{kind}, still moving"
    elif status == "refuted" and not end.curvature > tolerances.curvature:
        status = "inconclusive"
    return Claim(
        name,
        status,
        computed=end.strain,
        stated=f"|link - d|/d <= {tolerances.lattice:g} in the limit",
        margin=margin,
        error=0.0,
        witness={"force": end.force, "links": end.links, "curvature": end.curvature},
        detail=f"limit: {kind}, links {end.shortest:.6g} to {end.longest:.6g}, residual force {end.force:.2g}",
    )


def met(run: Trajectory, tolerances: Tolerances) -> tuple[Contact, ...]:
    """Pairs that coincide at some time of the run.

    Parameters
    ----------
    run : Trajectory
        The run.
    tolerances : Tolerances
        `contact` is used, relative to d.
    """
    return contacts(run.t, run.q, run.p, run.u, tol=tolerances.contact * run.law.alpha.d)


def below_the_barrier(run: Trajectory, energy: float) -> Hypothesis:
    """H(0) < min{V : two agents coincide}: met below its proved bound, unmet where a state with a pair is in reach.

    Between the two it is assumed: `flockana.equilibria.barrier.collision_barrier` searches the minimum itself.

    Parameters
    ----------
    run : Trajectory
        The run.
    energy : float
        The law's structural energy at the start.
    """
    from flockana.equilibria.barrier import collision_bounds

    low, high = (run.law.gains.c1_alpha * bound for bound in collision_bounds(run.law.alpha, run.n, run.m))
    status: HypothesisStatus = "met" if energy < low else "unmet" if energy >= high else "assumed"
    detail = f"H(0) = {energy:.5g}; the minimum is at least {low:.5g}, and a state of {high:.5g} is known"
    bound = high if status == "unmet" else low
    return Hypothesis("H(0) < min{V : two agents coincide}", status, bound - energy, detail)


def no_collision(
    run: Trajectory, needs: Iterable[Hypothesis], tolerances: Tolerances, *, name: str, proof: str | None = None
) -> Claim:
    """No two agents ever coincide: a lower bound of all distances, between samples too, is positive.

    Parameters
    ----------
    run : Trajectory
        The run.
    needs : iterable of Hypothesis
        Hypotheses of the claim.
    tolerances : Tolerances
        `contact` is used, relative to d.
    name : str
        Name of the claim.
    proof : str, optional
        Id of the proof that the hypotheses exclude collisions.
    """
    closest = run.closest_approach()
    floor_distance = tolerances.contact * run.law.alpha.d
    # the bound already contains the interpolation error; contact itself is refutation, anything between is unknown
    status = judge(closest.lower - floor_distance, 0.0, needs)
    if status == "refuted" and closest.distance > floor_distance and not met(run, tolerances):
        status = "inconclusive"
    return Claim(
        name,
        status,
        computed=closest.lower,
        stated="distance > 0 between any two agents, always",
        margin=closest.lower,
        error=floor_distance,
        witness={"pair": closest.pair, "time": closest.time},
        proof=proof,
        detail=f"no collision: no distance falls below {closest.lower:.4g} (agents {closest.pair[0]} and "
        f"{closest.pair[1]} at t = {closest.time:.4g})",
    )


def distinct_pairs(
    run: Trajectory, law: Hypothesis, tolerances: Tolerances, *, c_star: float, name: str, proof: str | None = None
) -> Claim:
    """As printed: with H(0) < (k+1)c*, at most k distinct pairs collide over the whole run (refuted by E13).

    Parameters
    ----------
    run : Trajectory
        The run.
    law : Hypothesis
        That the law is the theorem's.
    tolerances : Tolerances
        `contact` is used.
    c_star : float
        Energy of a coincident pair, gain included.
    name : str
        Name of the claim.
    proof : str, optional
        Id of the proof of what this run does.
    """
    energy = float(run.energy()[0])
    k, pairs = floor(energy / c_star), run.n * (run.n - 1) // 2
    bites = Hypothesis("k < n(n-1)/2", "met" if k < pairs else "unmet", float(pairs - k - 1))
    found = met(run, tolerances)
    status = judge(k + 0.5 - len(found), 0.0, [law, bites])
    return Claim(
        name,
        status,
        computed=len(found),
        stated=f"at most {k} of {pairs} pairs collide, as H(0) = {energy / c_star:.4g} c*",
        margin=float(k - len(found)),
        error=0.0,
        witness=[f"agents {c.i} and {c.j} at t = {c.time:.6g}{' (order changed)' if c.crossed else ''}" for c in found],
        proof=proof,
        detail=f"as printed: {len(found)} distinct pairs collide, at most {k} may"
        + ("; that is every pair, so nothing is claimed" if bites.status == "unmet" else ""),
    )


def pairs_at_one_instant(
    run: Trajectory, law: Hypothesis, tolerances: Tolerances, *, c_star: float, name: str, proof: str | None = None
) -> Claim:
    """Corrected: at any one instant at most ⌊H/c*⌋ pairs coincide.

    Parameters
    ----------
    run : Trajectory
        The run.
    law : Hypothesis
        That the law is the theorem's.
    tolerances : Tolerances
        `contact` is used.
    c_star : float
        Energy of a coincident pair, gain included.
    name : str
        Name of the claim.
    proof : str, optional
        Id of the proof of the bound.
    """
    tol = tolerances.contact * run.law.alpha.d
    together = np.array([coincident_pairs(q, tol) for q in run.q])
    allowed = np.floor(run.energy() / c_star)
    simultaneous = (
        max((sum(abs(a.time - b.time) <= 1e-12 for b in found) for a in found), default=0)
        if (found := met(run, tolerances))
        else 0
    )
    worst = int(np.argmin(allowed - together))
    most = max(int(together.max()), simultaneous)
    margin = min(float(allowed[worst] - together[worst]), float(allowed[0]) - simultaneous)
    return Claim(
        name,
        judge(margin + 0.5, 0.0, [law]),
        computed=most,
        stated="at most floor(H(t)/c*) pairs coincide at the same time t",
        margin=margin,
        error=0.0,
        witness={"time": float(run.t[worst]), "coincident": int(together[worst]), "allowed": int(allowed[worst])},
        proof=proof,
        detail=f"per instant: at most {most} pairs coincide at one time; the energy never allows fewer than "
        f"{int(allowed.min())}",
    )
