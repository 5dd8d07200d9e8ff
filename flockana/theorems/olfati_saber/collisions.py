"""Claims about collisions: which pairs certainly meet during a run, which may, and how many the energy allows.

Between samples paths are known up to an allowance, so contact is decided on three levels: a lower bound of a distance
that stays positive excludes it; two agents that stand to each other's left and right in turn, on a line that neither
ever leaves, certainly met; in between it is open. In the plane a numerical run never shows a contact, only nearness.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import floor

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.kernels.neighbours import pair_blocks
from flockana.kernels.paths import control_points, touching_pairs
from flockana.measures.metrics import pairs_at_one_place
from flockana.measures.path_bounds import ROUNDING, Contact, contacts
from flockana.theorems.claims import judged
from flockana.theorems.hypotheses import below, condition
from flockana.theorems.meeting import meeting
from flockana.theorems.rounding import energy_error
from flockana.theorems.theorem import Claim, Hypothesis, HypothesisStatus, Tolerances

Pair = tuple[int, int]
IndexArray = npt.NDArray[np.intp]


def contacts_of(run: Trajectory, tolerances: Tolerances) -> tuple[Contact, ...]:
    """Contacts of a run: pairs whose interpolated paths come within the contact distance."""
    tol = tolerances.contact * run.law.alpha.length
    return run.remembered(
        f"contacts within {tol!r}", lambda: contacts(*run.path[:4], tol=tol, intervals=_intervals(run, tol)[0])
    )


def passed(run: Trajectory, tolerances: Tolerances) -> dict[Pair, float]:
    """Pairs that certainly met, and how far they go past each other: they change places on a line both keep to."""
    depths, noise = {}, _noise(run, tolerances)
    for contact in contacts_of(run, tolerances):
        apart = run.path.q[:, contact.j] - run.path.q[:, contact.i]
        moving = np.flatnonzero((apart != 0.0).any(axis=0))
        if moving.size == 1:
            depth = float(min(apart[:, moving[0]].max(), -apart[:, moving[0]].min()))
            if depth > noise:
                depths[contact.i, contact.j] = depth
    return depths


def near(run: Trajectory, tolerances: Tolerances) -> list[set[Pair]]:
    """Pairs that may meet, by interval between samples: their paths, allowance included, come that near."""
    noise = _noise(run, tolerances)
    return run.remembered(f"near within {noise!r}", lambda: _near(run, noise))


def _near(run: Trajectory, noise: float) -> list[set[Pair]]:
    pairs: list[set[Pair]] = [set() for _ in run.t[1:]]
    t, *states, slack = run.path
    intervals, of_sample = _intervals(run, noise)
    for k in intervals:
        points, reach, allowance = control_points(t[k + 1] - t[k], *(x[s] for s in (k, k + 1) for x in states))
        within = noise + 2.0 * float((allowance if slack is None else allowance + slack[k]).max())
        for i, j in pair_blocks(states[0][k], within + 2.0 * float(reach.max())):
            at = np.empty(i.size)
            touching_pairs(points, reach, i, j, within, at)
            i, j = i[at >= 0.0], j[at >= 0.0]
            pairs[of_sample[k]].update(zip(np.minimum(i, j).tolist(), np.maximum(i, j).tolist(), strict=True))
    return pairs


def _intervals(run: Trajectory, distance: float) -> tuple[IndexArray, IndexArray]:
    """Intervals of the path in which a pair may come so near; and between which samples each of its intervals lies."""
    lower = run.closest_approach().lower_by_interval
    of_sample = np.searchsorted(run.t, run.path[0][:-1], side="right") - 1
    return np.flatnonzero(~(lower[of_sample] > distance)), of_sample


def _noise(run: Trajectory, tolerances: Tolerances) -> float:
    """Distance at which two agents count as coincident, the rounding of their coordinates added."""
    return float(tolerances.contact * run.law.alpha.length + ROUNDING * np.abs(run.q).max())


def below_the_barrier(run: Trajectory, energy: float, error: float) -> Hypothesis:
    """The hypothesis H(0) < min{V : two agents coincide}: met below a proved bound, unmet above the V of such a state.

    Between the two it is assumed: `flockana.equilibria.barrier.collision_barrier` searches the minimum itself.
    """
    from flockana.equilibria.barrier import collision_bounds

    low, high = (run.law.gains.c1_alpha * bound for bound in collision_bounds(run.law.alpha, run.n, run.m))
    status: HypothesisStatus = "met" if energy + error < low else "unmet" if energy - error >= high else "assumed"
    detail = f"H(0) = {energy:.5g}; the minimum is at least {low:.5g}, and a state of {high:.5g} is known"
    bound = high if status == "unmet" else low
    return Hypothesis("H(0) < min{V : two agents coincide}", status, bound - energy, detail, error)


def below_multiple(energy: float, error: float, c_star: float, times: int = 1) -> Hypothesis:
    """The hypothesis H(0) < k c*, the energy of k coincident pairs.

    Examples
    --------
    >>> below_multiple(1.0, 1e-12, 2.0).status, below_multiple(1.0, 1e-12, 0.5, 2).status
    ('met', 'assumed')
    """
    text = "c*" if times == 1 else f"{times} c*"
    detail = f"H(0) = {energy:.5g}, {text} = {times * c_star:.5g}"
    return below(f"H(0) < {text}", energy, times * c_star, error, detail)


def no_collision(
    run: Trajectory, needs: Iterable[Hypothesis], tolerances: Tolerances, *, name: str, proof: str | None = None
) -> Claim:
    """The claim that no two agents ever coincide: a lower bound of all distances is positive, between samples too."""
    needs, closest, noise = list(needs), run.closest_approach(), _noise(run, tolerances)
    pair, margin = closest.pair, closest.lower
    if not margin > noise and (certain := passed(run, tolerances)):
        pair = max(certain, key=lambda each: certain[each])
        margin = -certain[pair]
    error = noise if len(run.t) > 1 else float("inf")  # one instant excludes nothing
    text = f"no distance falls below {closest.lower:.4g}" if margin >= 0.0 else f"they pass by {-margin:.4g}"
    if margin < 0.0 and "work" in run.extra and _spare(run, pair, needs) <= float(np.abs(run.energy_residual).max()):
        error = float("inf")
    return judged(
        name,
        margin,
        error,
        needs,
        computed=closest.lower,
        stated="distance > 0 between any two agents, always",
        witness={"pair": pair, "time": closest.time},
        proof=proof,
        detail=f"no collision: {text} (agents {pair[0]} and {pair[1]}; the closest approach is at t = "
        f"{closest.time:.4g})",
    )


def _spare(run: Trajectory, pair: Pair, needs: Iterable[Hypothesis]) -> float:
    """Energy by which it is decided that a pair meets, and that the bounds on H(0) hold.

    A pair meets at no less than c*, and the energy never rises. So at the last sample before the meeting it is above c*
    by more than it is off, or the integrator may have lifted the pair over a top that turns it back in truth.
    """
    energies = (need for need in needs if need.name.startswith("H(0)") and need.status == "met")
    met_by = [need.margin for need in energies if need.margin is not None]
    apart = (run.q[:, pair[1]] - run.q[:, pair[0]]).sum(axis=1)  # on a line: the other components are 0
    before = max(int(np.argmax(apart * np.sign(apart[0]) < 0.0)) - 1, 0)
    pairs = meeting(run)
    energy = run.law.structural_energy(run.q[before], run.p[before]) - pairs.floor
    return float(min(*met_by, abs(energy - pairs.c_star), float("inf")))


def distinct_pairs(
    run: Trajectory, needs: Iterable[Hypothesis], tolerances: Tolerances, *, name: str, proof: str | None = None
) -> Claim:
    """The claim as printed that with H(0) < (k+1)c* at most k distinct pairs collide over the whole run (see E13)."""
    c_star = run.law.gains.c1_alpha * run.law.alpha.c_star
    energy, pairs = float(run.energy()[0]), run.n * (run.n - 1) // 2
    error = float(energy_error(run.law, run.q[:1], run.p[:1], run.energy()[:1])[0])
    least, most = floor((energy - error) / c_star), floor((energy + error) / c_star)
    bites = condition("k < n(n-1)/2", least < pairs, float(pairs - least - 1))
    certain, possible = passed(run, tolerances), set().union(*near(run, tolerances))
    refuted = len(certain) > most
    counted = set(certain) if refuted else possible
    first = [contact for contact in contacts_of(run, tolerances) if (contact.i, contact.j) in counted]
    return judged(
        name,
        (most if refuted else least) + 0.5 - len(counted),
        0.0,
        [*needs, bites],
        verifies=len(run.t) > 1,
        refutes=refuted and len(run.t) > 1,  # else it is open which pairs meet
        computed=len(counted),
        stated=f"at most {least} of {pairs} pairs collide, as H(0) = {energy / c_star:.4g} c*",
        witness=[f"agents {c.i} and {c.j} at t = {c.time:.6g}{' (order changed)' if c.crossed else ''}" for c in first],
        proof=proof,
        detail=f"as printed: {len(certain)} distinct pairs certainly collide and {len(possible)} may, where at most "
        f"{least} should" + ("; that is every pair, so nothing is claimed" if bites.status == "unmet" else ""),
    )


def pairs_at_one_instant(
    run: Trajectory, needs: Iterable[Hypothesis], tolerances: Tolerances, *, name: str, proof: str | None = None
) -> Claim:
    """The corrected claim that at any instant at most ⌊H/c*⌋ pairs coincide.

    Pairs that may meet between the same two samples count as if they met at once; those that were never apart by more
    than the contact distance at a sample, as coincident there.
    """
    c_star = run.law.gains.c1_alpha * run.law.alpha.c_star
    energy, error = run.energy(), energy_error(run.law, run.q, run.p, run.energy())
    allowed = np.floor((energy - error) / c_star)
    at_most = np.floor((energy + error) / c_star)
    together = np.array([len(pairs) for pairs in near(run, tolerances)])
    exactly = _at_one_place(run.q)  # nothing else is certain at an instant
    spare = np.minimum(allowed[:-1], allowed[1:]) - together
    worst, broken = (int(np.argmin(spare)) if spare.size else 0), int(np.argmin(at_most - exactly))
    refuted = bool(at_most[broken] < exactly[broken])
    return judged(
        name,
        float((at_most - exactly)[broken] if refuted else spare.min(initial=np.inf)) + 0.5,
        0.0,
        needs,
        verifies=len(run.t) > 1,
        refutes=refuted and len(run.t) > 1,  # else it is open which pairs meet
        computed=int(together.max(initial=0)),
        stated="at most floor(H(t)/c*) pairs coincide at the same time t",
        witness={"time": float(run.t[broken if refuted else worst]), "allowed": int(allowed[worst])},
        proof=proof,
        detail=f"per instant: at most {int(together.max(initial=0))} pairs may coincide at one time; the energy never "
        f"allows fewer than {int(allowed.min())}",
    )


def _at_one_place(q: FloatArray) -> IndexArray:
    """Pairs at one place to the last bit, at each instant: none where all first components differ, as nearly always."""
    pairs = np.zeros(len(q), dtype=np.intp)
    ties = (np.diff(np.sort(q[:, :, 0], axis=1), axis=1) == 0.0).any(axis=1)
    for k in np.flatnonzero(ties):
        pairs[k] = pairs_at_one_place(q[k])
    return pairs
