"""Cucker and Dong (2010): flocks whose pairs all stay farther apart than a given distance."""

import numpy as np

from flockana.sources.cucker_dong_2010.laws import CuckerDong
from flockana.theorems.alignment_bounds import AlignmentRate, Guarantee
from flockana.theorems.bounds_between_samples import spread_over
from flockana.theorems.claims import judged, run_theorem
from flockana.theorems.collisions import least_distance
from flockana.theorems.theorem import Checked, Tolerances, unmet
from flockana.theorems.theorem_toolkit import EPS, Enclosure, Observed, condition, law_is, limit_claim, positive_room

_PROOF = "avoided-collisions"


@run_theorem(
    "cucker-dong",
    title="A repulsion that ends with the differences of velocities keeps a flock farther apart than δ",
    source="Cucker and Dong 2010, in our words; bounds ours",
    law=law_is("the law of Cucker and Dong", CuckerDong),
    claims=("functional", "apart", "bounded", "flock"),
    references=("cucker-dong-2010", "flockana"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let u_i = Σ_j a(s_ij)(p_j - p_i) + V Σ_j f(s_ij)(q_i - q_j), f(s) = kδ³/(s² - δ²)², k > 0, V² = Σ‖p_i - p̄‖², and
    all pairs start farther apart than δ. Then E = V + ½ Σ_{i<j} kδ³/(s_ij² - δ²) never rises, and every s_ij² is at
    least δ² + kδ³/(2E(0)). If E(0) < n∫a(√2 s) ds from ‖x(0)‖ = √Σ‖q_i - q̄‖² on, which always holds for β <= ½, then
    ‖x‖ <= x_M, where that integral from ‖x(0)‖ is E(0), velocities match, and every q_j - q_i has a limit.
    """
    law: CuckerDong = seen.law
    push, far, n = law.repulsion, law.distance, seen.n
    needs = [
        condition("k > 0", push > 0.0, push, f"k = {push:g}", remedy="raise k above 0"),
        condition("two agents or more", n > 1, detail=f"n = {n}"),
    ]
    if unmet(needs):
        return needs, []
    pairs = np.triu_indices(n, 1)
    first = float(np.sqrt(np.min(np.sum((seen.given.q[0][pairs[0]] - seen.given.q[0][pairs[1]]) ** 2, axis=1))))
    margin = Enclosure.around(first / far - 1.0, 4.0 * EPS * first / far)
    needs.append(positive_room("all pairs start farther apart than δ", margin, f"{first:.6g} against δ = {far:g}"))
    if unmet(needs):
        return needs, []
    level = seen.series(lambda run: np.array([law.functional(q, p) for q, p in zip(run.q, run.p, strict=True)]))
    level = level.widened(64.0 * n * EPS * np.abs(level.mid)).clip(0.0)
    start = level[0]
    bound = ((push * far / (2.0 * start)) + 1.0).sqrt() * far
    distance = least_distance(seen)
    phi = AlignmentRate(law.weight, n * law.weight.strength, np.sqrt(2.0))
    guarantee = Guarantee(seen, phi, seen.spread, spread_over(seen).max(), level, _PROOF, ("‖x{}‖", "E{}"))
    slow_claim = guarantee.hypothesis("E(0) < n∫a(√2 s) from ‖x(0)‖ on")
    bound_claims = [claim for claim in guarantee.claims([*needs, slow_claim])[1] if claim.name == "bounded"]
    v = seen.velocity_spread.mid
    return [*needs, slow_claim], [
        judged("functional", 1.0 - level.max() / start, needs, proof=_PROOF).described(
            computed=float(level.mid.max()), stated=f"E never exceeds E(0) = {start.mid:.6g}"
        ),
        judged("apart", distance / bound - 1.0, needs, proof=_PROOF, computed=float(distance.mid)).described(
            stated=f"no two agents are nearer than {bound.mid:.6g}, δ = {far:g}",
            detail=f"the least distance is {distance.mid:.6g}",
        ),
        *bound_claims,
        limit_claim("flock", [*needs, slow_claim], proof=_PROOF, computed=float(v[-1])).described(
            stated="V -> 0, and every q_j - q_i has a limit",
            detail=f"V goes from {v[0]:.4g} to {v[-1]:.4g} at t = {seen.t[-1]:g}",
        ),
    ]
