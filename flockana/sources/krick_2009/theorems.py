"""Krick, Broucke and Francis (2009): formations held by distances, reached from near starts."""

from fractions import Fraction
from math import sqrt

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.sources.krick_2009.laws import DistanceFormation
from flockana.theorems.claims import judged, run_theorem
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.hypotheses import condition, law_is, positive_room
from flockana.theorems.limit_certificates import limit_claim
from flockana.theorems.observed_run import Observed
from flockana.theorems.rounding_bounds import EPS
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances

_PROOF = "distance-formation"


def _near(law: DistanceFormation, q: FloatArray) -> tuple[Hypothesis, float, float]:
    """Return the hypothesis σ² > 4 √Δ ‖e‖ of a start, with error ‖e‖ and least singular value σ."""
    rows, e = law.rows(q), float(np.linalg.norm(law.errors(q)))
    values, magnitude = np.linalg.svd(rows, compute_uv=False), float(np.linalg.norm(rows))
    smallest = float(values[-1]) if len(rows) <= rows.shape[1] else 0.0
    share = 4.0 * sqrt(float(np.bincount(np.ravel(law.edges)).max()))
    sigma = Enclosure.around(smallest, 64.0 * max(rows.shape) * EPS * magnitude).clip(0.0)
    rounding_width = 64.0 * len(rows) * EPS * (e + magnitude * magnitude + float(np.sum(np.square(law.lengths))))
    margin = (sigma.square() - share * Enclosure.around(e, rounding_width)) / float(np.max(law.lengths)) ** 2
    text = f"σ² = {smallest**2:.6g}, 4 √Δ ‖e‖ = {share * e:.6g}"
    name = "σ² > 4 √Δ ‖e‖: independent links, near their lengths"
    return positive_room(name, margin, text, remedy="start nearer, or remove links that depend on others"), e, smallest


def _collinear(q: FloatArray) -> Hypothesis:
    """Return the hypothesis that all agents start on one line, decided exactly; unmet in one dimension."""
    name = "all agents start on one line of a plane or of space"
    z = [[Fraction(x) - Fraction(y) for x, y in zip(row, q[0].tolist(), strict=True)] for row in q.tolist()]
    way = max(z, key=lambda row: sum(x * x for x in row))
    is_on_line = all(row[a] * way[b] == row[b] * way[a] for row in z for a in range(len(way)) for b in range(a))
    return condition(name, is_on_line and q.shape[1] > 1, detail=f"m = {q.shape[1]}")


def _share(name: str, stated: str, seen: Observed, off: Enclosure, tolerances: Tolerances) -> Claim:
    share = off.clip(0.0) / (float(np.max(seen.law.lengths)) + float(seen.radius.mid[0]))
    k = int(share.mid.argmax())
    requirements = [_collinear(seen.run.q[0])] if name == "collinear" else []
    return judged(name, tolerances.energy - share, requirements, proof=_PROOF, computed=float(share.mid[k])).described(
        stated=f"{stated}, to {tolerances.energy:g} of the size",
        witness={"time": float(seen.t[k])},
        detail=f"off by {share.mid[k]:.2g} of the size at most",
    )


def _off_line(seen: Observed) -> Enclosure:
    """Return the agents' largest distance from their starting line at each time, relative to the centroid."""
    z = seen.run.q - seen.run.q.mean(axis=1, keepdims=True)
    start_q = z[0]
    direction = start_q[np.linalg.norm(start_q, axis=1).argmax()]
    direction = direction / (float(np.linalg.norm(direction)) or 1.0)
    transverse_part = z - (z @ direction)[..., None] * direction
    return Enclosure.around(np.linalg.norm(transverse_part, axis=2).max(axis=1), seen.shape_error.max(axis=1))


@run_theorem(
    "distance-formation",
    title="A formation by distances is reached from near enough; from a line none leaves the line",
    source="Krick, Broucke and Francis 2009, in our words",
    law=law_is("formation by distances", DistanceFormation),
    claims=("centroid", "rest", "collinear", "formation", "nearby"),
    ours=("formation", "nearby"),
    references=("krick-2009", "flockana"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let agents move by q_i' = k Σ_j (‖q_j - q_i‖² - d_ij²)(q_j - q_i) along the links of a net. The centroid never
    moves, all come to rest, and agents that start on one line stay on it. Ours: let e be the errors of the squared
    lengths at the start, R half their slopes with independent rows, σ its least singular value, and Δ the largest
    number of links of an agent. If σ² > 4 √Δ ‖e‖, all lengths tend to d_ij, ‖e‖ falls at the rate kσ²/2 at least, and
    no agent ever is farther than ‖e‖/σ from its start.
    """
    law, q = seen.law, seen.run.q
    near_claim, e, sigma = _near(law, q[0])
    deviation = Enclosure.around(np.linalg.norm(q.mean(axis=1) - q[0].mean(axis=0), axis=1), seen.centre_error)
    distances = np.linalg.norm(q - q[0], axis=2).max(axis=1)
    distances = Enclosure.around(distances, seen.shape_error.max(axis=1) + seen.centre_error).clip(0.0)
    limit = e / sigma if sigma > 0.0 else np.inf
    left = float(seen.run.metric("length_error")[-1])
    end_text = f"the largest error of a squared length is {left:.3g} at the end"
    claims = [
        _share("centroid", "the centroid stays", seen, deviation, tolerances),
        limit_claim("rest", [], proof=_PROOF, computed=left).described(stated="velocities tend to 0", detail=end_text),
        _share("collinear", "agents stay on their line", seen, _off_line(seen), tolerances),
        limit_claim("formation", [near_claim], proof=_PROOF, computed=left).described(
            stated=f"all lengths tend to d at the rate {0.5 * law.gain * sigma**2:.6g}", detail=end_text
        ),
        judged(
            "nearby", (limit - distances) / float(np.max(law.lengths)) if np.isfinite(limit) else Enclosure.of(0.0),
            [near_claim], proof=_PROOF,
        ).described(
            computed=float(distances.mid.max()),
            stated=f"no agent is farther than {limit:.6g} from its start",
            detail=f"an agent moves by {distances.mid.max():.6g} at most",
        ),
    ]  # fmt: skip
    return [], claims
