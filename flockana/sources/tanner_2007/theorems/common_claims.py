"""Claims of Tanner, Jadbabaie and Pappas about a run: no collision, and rest in the limit."""

from math import inf
from typing import Any

import numpy as np

from flockana.theorems.bounds_between_samples import least_distance
from flockana.theorems.limit_certificates import decays_to_zero
from flockana.theorems.limit_claims import velocities_match
from flockana.theorems.theorem_toolkit import EPS, Claim, Enclosure, Needs, Observed, by_count, judged

MATCHED = "matched-velocities"


def no_collision(seen: Observed, i: Any, j: Any, proof: str, needs: Needs) -> Claim:
    """Return the claim that given pairs stay beyond the distance where V alone equals the initial energy."""
    if not len(i):
        return by_count("no-collision", 0, needs, detail="no pair is joined")
    energy, distance = seen.energy[0].widened(_energy_error(seen, i, j)), least_distance(seen, i, j)
    bound = energy.clip(0.0).falling(np.vectorize(seen.law.potential.nearest, otypes=[float]))
    bound = bound.widened(1e-12 * seen.scales.length)
    k = int(seen.distances(i, j).mid.min(axis=1).argmin())
    return judged("no-collision", (distance - bound) / seen.scales.length, needs, proof=proof).described(
        computed=float(distance.mid),
        stated=f"no such pair comes nearer than {bound.mid:.6g}, where V = H(0)",
        witness={"time": float(seen.t[k])},
        detail=f"the least distance at the samples is {distance.mid:.6g}, and between them at least {distance.lo:.6g}",
    )


def _energy_error(seen: Observed, i: Any, j: Any) -> float:
    """Return the error of H at the start due to rounding."""
    q, potential = seen.run.q[0], seen.law.potential
    s = np.linalg.norm(q[j] - q[i], axis=1)
    x, e = (potential.d / s) ** 2, 8.0 * EPS * (1.0 + float(np.abs(q).max()) / s)
    return float(potential.strength * np.sum(np.abs(x - 1.0) * e + e * e))


def comes_to_rest(seen: Observed, needs: Needs, names: tuple[str, str], *, forces: str | None = None) -> list[Claim]:
    """Return the claims that relative velocities, and the forces of the potentials, tend to 0."""
    still = np.zeros_like(seen.run.p[0])
    force = np.array([float(np.abs(seen.law.flow(0.0, q, still)[0]).max()) for q in seen.run.q])
    what: dict[str, Any] = {"what": "the largest force", "of": "the largest force", "stated": "the largest force -> 0"}
    decay_claim = decays_to_zero(seen, names[1], needs, series=force, proof=forces, **what)
    return [velocities_match(seen, needs, name=names[0], proof=MATCHED), decay_claim]


def out_of_range(seen: Observed) -> Enclosure:
    """Return H(0)/V(R), an upper bound of the number of pairs that can ever leave the range."""
    far_energy = float(seen.law.potential.energy(seen.law.r))
    energy = seen.energy[0].widened(_energy_error(seen, *np.triu_indices(seen.n, 1)))
    return energy / far_energy if far_energy > 0.0 else Enclosure.of(inf)
