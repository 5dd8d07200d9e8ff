"""Collision claims: pairs that certainly or possibly meet during a run, and the number allowed by energy.

Between samples paths are known up to an allowance, so contact is decided on three levels: a lower bound of a distance
that stays positive excludes it; two agents that stand to each other's left and right in turn, on a line that neither
ever leaves, certainly met; in between it is open. In the plane a numerical run never shows a contact, only nearness.
"""

from itertools import combinations

import numpy as np
import numpy.typing as npt

from flockana.interactions import AlphaInteraction
from flockana.kernels.neighbours import pair_blocks
from flockana.kernels.quintic_paths import control_points, touching_pairs
from flockana.measures.metrics import pairs_at_one_place
from flockana.measures.path_bounds import ROUNDING, Contact, contacts
from flockana.theorems.claims import counted, judged
from flockana.theorems.meeting_energy import above_least, meeting
from flockana.theorems.rounding_bounds import energy_error
from flockana.theorems.second_runs import DOUBT
from flockana.theorems.theorem import Claim, Hypothesis, HypothesisStatus, Needs, Tolerances
from flockana.theorems.theorem_toolkit import (
    Enclosure,
    FloatArray,
    Observed,
    Trajectory,
    condition,
    lengths,
    positive_room,
)

Pair = tuple[int, int]
IndexArray = npt.NDArray[np.intp]
LESS_ENERGY = "start slower, with fewer agents, or with distances nearer to rest"


def contacts_of(run: Trajectory, tolerances: Tolerances) -> tuple[Contact, ...]:
    """Return contacts of a run: pairs whose interpolated paths come within the contact distance."""
    tol = tolerances.contact * run.law.alpha.length
    key = f"contacts within {tol!r}"
    return run.cached(key, lambda: contacts(*run.path[:4], tol=tol, intervals=_intervals(run, tol)[0]))


def passed(seen: Observed, tolerances: Tolerances) -> dict[Pair, float]:
    """Return pairs of agents that certainly met by swapping order on a line, with the overlap."""
    # How far they go past is known to the error of the run.
    depths: dict[Pair, float] = {}
    noise = _noise(seen, tolerances)
    if seen.doubt:
        return depths
    pair_error = float(2.0 * seen.shape_error.max())
    path = seen.run.path.q
    for contact in contacts_of(seen.run, tolerances):
        displacement = path[:, contact.j] - path[:, contact.i]
        moving = np.flatnonzero((displacement != 0.0).any(axis=0))
        if moving.size == 1:
            depth = float(min(displacement[:, moving[0]].max(), -displacement[:, moving[0]].min()))
            if depth > noise + pair_error:
                depths[contact.i, contact.j] = depth - pair_error
    return depths


def near(seen: Observed, tolerances: Tolerances) -> list[set[Pair]]:
    """Return pairs of agents that may come within contact distance, for each interval between samples."""
    noise = _noise(seen, tolerances) + 2.0 * seen.between_error
    return seen.cached(f"near within {noise.tobytes()!r}", lambda: _near(seen.run, noise))


def _near(run: Trajectory, noises: FloatArray) -> list[set[Pair]]:
    all_pairs = set(combinations(range(run.n), 2)) if not np.isfinite(noises).all() else set()
    pairs = [set() if np.isfinite(noise) else all_pairs for noise in noises]
    t, *states, slack = run.path
    intervals, sample_indices = _intervals(run, noises)
    for k in intervals:
        noise = float(noises[sample_indices[k]])
        if not np.isfinite(noise):
            continue
        points, reach, allowance = control_points(t[k + 1] - t[k], *(x[s] for s in (k, k + 1) for x in states))
        contact_limit = noise + 2.0 * float((allowance if slack is None else allowance + slack[k]).max())
        for i, j in pair_blocks(states[0][k], contact_limit + 2.0 * float(reach.max())):
            hit_times = np.empty(i.size)
            touching_pairs(points, reach, i, j, contact_limit, hit_times)
            i, j = i[hit_times >= 0.0], j[hit_times >= 0.0]
            pairs[sample_indices[k]].update(zip(np.minimum(i, j).tolist(), np.maximum(i, j).tolist(), strict=True))
    return pairs


def _intervals(run: Trajectory, distance: FloatArray | float) -> tuple[IndexArray, IndexArray]:
    """Return path intervals in which a pair may come into contact, and the neighbouring samples."""
    lower = run.closest_approach().lower_by_interval
    sample_indices = np.searchsorted(run.t, run.path[0][:-1], side="right") - 1
    return np.flatnonzero(~(lower > distance)[sample_indices]), sample_indices


def _noise(seen: Observed, tolerances: Tolerances) -> float:
    """Return the distance below which two agents count as coincident, rounding included."""
    return float(tolerances.contact * seen.law.alpha.length + ROUNDING * np.abs(seen.run.q).max())


def least_distance(seen: Observed) -> Enclosure:
    """Return an enclosure of the least distance of any two agents over the run, and its time."""
    closest = seen.run.closest_approach()
    if len(seen.t) == 1 or seen.doubt:
        return Enclosure(0.0, closest.distance, np.inf)
    low = float((closest.lower_by_interval - 2.0 * seen.between_error).min())
    high = closest.distance + 2.0 * float(max(seen.shape_error.max(), seen.between_error.max()))
    return Enclosure(max(0.0, min(low, closest.distance)), closest.distance, high)


def energy_at_start(seen: Observed) -> Enclosure:
    """Return the start's energy in the moving frame, exact up to rounding."""
    run = seen.run
    energy = run.law.structural_energy(run.q[0], run.p[0])
    allowed = energy_within_accuracy(seen, 0)
    return Enclosure.around(energy, energy_error(run.law, run.q[:1], run.p[:1], np.array([energy]))[0] + allowed)


def energy_within_accuracy(seen: Observed, k: int) -> float:
    """Return the energy error of sample k from a recording's accuracy; 0 for a run.

    A pair's potential falls to d and rises beyond: it is farthest off at an end of the lengths that the pair may have,
    or at d. Other potentials are looked at on 33 lengths.
    """
    if not seen.allowed:
        return 0.0
    law, run, place, speed = seen.law, seen.run, seen.shape_error[k], seen.speed_error[k]
    if not (np.isfinite(place).all() and np.isfinite(speed).all()):
        return float("inf")
    centre_distances, drift = (lengths(x - x.mean(axis=0)) for x in (run.q[k], run.p[k]))
    off = float(np.sum(drift * speed + 0.5 * speed**2))
    if law.target is not None:
        off += float(np.max(law.gains.c1_gamma)) * float(np.sum(centre_distances * place + 0.5 * place**2))
    if law.alpha is not None and law.gains.c1_alpha:
        i, j = np.triu_indices(seen.n, 1)
        distances, width = lengths(run.q[k][j] - run.q[k][i]), place[i] + place[j]
        where = np.maximum(distances + width * np.linspace(-1.0, 1.0, 33)[:, None], 0.0)
        best_energy = law.alpha.energy(distances)
        energy_excess = np.abs(law.alpha.energy(np.full_like(distances, law.alpha.length)) - best_energy)
        change = np.abs(law.alpha.energy(where.ravel()).reshape(where.shape) - best_energy).max(axis=0)
        holds_least = np.abs(distances - law.alpha.length) <= width
        off += float(law.gains.c1_alpha) * float(np.where(holds_least, np.maximum(change, energy_excess), change).sum())
    return off if np.isfinite(off) else float("inf")


def energy_at_end(seen: Observed) -> Enclosure:
    """Return the energy of the last state in the moving frame, enclosed by both runs."""
    best_energy, other_energy = (run.law.structural_energy(run.q[-1], run.p[-1]) for run in (seen.run, seen.other))
    rounding = energy_error(seen.law, seen.run.q[-1:], seen.run.p[-1:], np.array([best_energy]))[0]
    allowed = energy_within_accuracy(seen, -1)
    allowance = DOUBT * abs(best_energy - other_energy) + seen.floors.work + rounding + allowed
    return Enclosure.around(best_energy, np.inf if seen.doubt else allowance)


def below_the_barrier(seen: Observed, energy: Enclosure) -> Hypothesis:
    """Return the hypothesis H(0) < min{V : two agents coincide}: met below a proved bound, unmet above a known state.

    Between the two it is assumed: `flockana.equilibria.energy_barrier.collision_barrier` searches the minimum itself.
    """
    from flockana.equilibria.energy_barrier import collision_bounds

    if isinstance(seen.law.alpha, AlphaInteraction):
        low, high = (seen.law.gains.c1_alpha * bound for bound in collision_bounds(seen.law.alpha, seen.n, seen.m))
    else:
        low, high = sum(meeting(seen)), np.inf
    status: HypothesisStatus = "met" if energy.hi < low else "unmet" if energy.lo >= high else "assumed"
    detail = f"H(0) = {energy.mid:.5g}; the minimum is at least {low:.5g}"
    detail += f" and at most {high:.5g}" if np.isfinite(high) else ""
    name, margin = "H(0) < min{V : two agents coincide}", float((high if status == "unmet" else low) - energy.mid)
    return Hypothesis(name, status, margin, detail, float(energy.half_width), decided="enclosed", remedy=LESS_ENERGY)


def below_multiple(energy: Enclosure, c_star: float, times: int = 1) -> Hypothesis:
    """Return the hypothesis H(0) < k c*, the energy of k coincident pairs."""
    text = "c*" if times == 1 else f"{times} c*"
    detail = f"H(0) = {energy.mid:.5g}, {text} = {times * c_star:.5g}"
    return positive_room(f"H(0) < {text}", times * c_star - energy, detail, remedy=LESS_ENERGY)


def no_collision(seen: Observed, needs: Needs, tolerances: Tolerances, *, name: str, proof: str | None = None) -> Claim:
    """Return the claim that no two agents ever coincide, by a positive lower bound of all distances."""
    closest, distance = seen.run.closest_approach(), least_distance(seen)
    pair, margin = closest.pair, distance - _noise(seen, tolerances)
    text = f"no two agents come nearer than {distance.lo:.4g}"
    if not margin.lo > 0.0:
        margin = Enclosure(-np.inf, margin.mid, np.inf)  # in the plane nearness is no contact
        text = f"the least distance is between {distance.lo:.4g} and {distance.hi:.4g}"
        if certain_meetings := passed(seen, tolerances):
            pair = max(certain_meetings, key=lambda each: certain_meetings[each])
            margin = Enclosure.of(-certain_meetings[pair])
            distance_text = f"passing each other by at least {certain_meetings[pair]:.4g}"
            text = f"collision: agents {pair[0]} and {pair[1]} change places on a line, {distance_text}"
    return judged(name, margin, needs, proof=proof, computed=float(distance.mid)).described(
        stated="no two agents ever meet",
        witness={"pair": pair, "time": closest.time},
        detail=f"{text} (closest: agents {pair[0]} and {pair[1]} at t = {closest.time:.4g})",
    )


def distinct_pairs(
    seen: Observed, needs: Needs, tolerances: Tolerances, *, name: str, disproof: str | None = None
) -> Claim:
    """Return the printed claim that with H(0) < (k+1)c* at most k distinct pairs collide over the run (see E13)."""
    c_star, energy, pairs = meeting(seen).c_star, above_least(seen, seen.energy[0]), seen.n * (seen.n - 1) // 2
    fewest, maximum = (int(np.clip(np.floor(end / c_star), 0, pairs)) for end in (energy.lo, energy.hi))
    bites = condition("k < n(n-1)/2", fewest < pairs, float(pairs - fewest - 1))
    certain, possible = passed(seen, tolerances), set().union(*near(seen, tolerances))
    refuted = len(certain) > maximum
    counted_pairs = set(certain) if refuted else possible
    first = [c for c in contacts_of(seen.run, tolerances) if (c.i, c.j) in counted_pairs]
    return counted(
        name,
        maximum if refuted else fewest,
        len(certain),
        pairs if seen.doubt else max(len(possible), len(certain)),
        [*needs, bites],
        computed=len(counted_pairs),
        stated=f"at most {fewest} of {pairs} pairs collide, as H(0) = {energy.mid / c_star:.4g} c*",
        witness=[f"agents {c.i} and {c.j} at t = {c.time:.6g}{' (order changed)' if c.crossed else ''}" for c in first],
        disproof=disproof,
        detail=f"{len(certain)} distinct pairs certainly collide and {len(possible)} may; printed: at most {fewest}"
        + ("; that is every pair, so nothing is claimed" if bites.status == "unmet" else ""),
    )


def pairs_at_one_instant(
    seen: Observed, needs: Needs, tolerances: Tolerances, *, name: str, proof: str | None = None
) -> Claim:
    """Return the corrected claim that at any instant at most ⌊H/c*⌋ pairs coincide."""
    # Pairs that may meet between the same two samples count as if they met at once; those that were never apart by more
    # than the contact distance at a sample, as coincident there.
    c_star, above = meeting(seen).c_star, above_least(seen, seen.energy)
    pair_limit, upper_count = np.floor(above.lo / c_star), np.floor(above.hi / c_star)
    pair_counts = np.array([len(pairs) for pairs in near(seen, tolerances)])
    exactly = _at_one_place(seen.run.q)  # nothing else is certain at an instant
    pair_margin = np.minimum(pair_limit[:-1], pair_limit[1:]) - pair_counts
    worst, broken = (int(np.argmin(pair_margin)) if pair_margin.size else 0), int(np.argmin(upper_count - exactly))
    high = float((upper_count - exactly)[broken]) + 0.5
    low = float(pair_margin.min(initial=-np.inf if len(seen.t) == 1 else np.inf)) + 0.5
    refuted = high < 0.0 and not seen.doubt
    margin = Enclosure.of(high) if refuted else Enclosure(min(low, high), min(low, high), max(low, high))
    return judged(name, margin, needs, proof=proof, computed=int(pair_counts.max(initial=0))).described(
        stated="at most floor(H(t)/c*) pairs coincide at the same time t",
        witness={"time": float(seen.t[broken if refuted else worst]), "allowed": float(pair_limit[worst])},
        detail=_instant_text(int(pair_counts.max(initial=0)), float(pair_limit.min())),
    )


def _instant_text(together: int, allowed: float) -> str:
    """Return in words how many pairs may coincide at one time."""
    if not together:
        return "no two agents can coincide at any time"
    pairs = "1 pair" if together == 1 else f"{together} pairs"
    return f"at most {pairs} may coincide at one time; the energy allows {allowed:g} or more at every time"


def _at_one_place(q: FloatArray) -> IndexArray:
    """Return the number of exactly coincident pairs at each instant."""
    pairs = np.zeros(len(q), dtype=np.intp)
    is_tied = (np.diff(np.sort(q[:, :, 0], axis=1), axis=1) == 0.0).any(axis=1)
    for k in np.flatnonzero(is_tied):
        pairs[k] = pairs_at_one_place(q[k])
    return pairs
