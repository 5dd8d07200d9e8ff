"""Wang, Ames and Egerstedt (2017): barriers that start positive stay positive, and braking is feasible."""

import numpy as np

from flockana.sources.wang_ames_egerstedt_2017.laws import SafetyFilter
from flockana.theorems.claims import judged, run_theorem, vacuous
from flockana.theorems.theorem import Checked, Tolerances, unmet
from flockana.theorems.theorem_toolkit import EPS, Enclosure, FloatArray, Observed, condition, law_is, positive_room

_PROOF = "safety-filter"


def _at_start(law: SafetyFilter, q: FloatArray, p: FloatArray) -> tuple[Enclosure, Enclosure]:
    """Return the barrier h and the excess distance r - D of all pairs at the start, with rounding errors."""
    i, j = np.triu_indices(len(q), 1)
    h, size = law.barriers(q, p)[0], 16.0 * EPS
    r, speed = np.linalg.norm(q[i] - q[j], axis=1), np.abs(p[i]).sum(axis=1) + np.abs(p[j]).sum(axis=1)
    far = size * (np.abs(q[i]).sum(axis=1) + np.abs(q[j]).sum(axis=1) + law.distance)
    margin, c = r - law.distance, 2.0 * law.acceleration_limit
    root = np.sqrt(2.0 * c * np.maximum(margin, 0.0))
    rounding_width = np.sqrt(2.0 * c * (np.maximum(margin, 0.0) + far)) - root + size * (root + speed * (1.0 + far / r))
    return Enclosure.around(h, rounding_width + size * speed), Enclosure.around(margin, far)


@run_theorem(
    _PROOF,
    title="A filter by barriers of pairs keeps agents apart that can still brake",
    source="Wang, Ames and Egerstedt 2017, in our words; too-late ours",
    law=law_is("the safety filter", SafetyFilter),
    claims=("apart", "braking", "too-late"),
    ours=("too-late",),
    references=("wang-ames-egerstedt-2017", "flockana"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let h_ij = √(2c(r - D)) + r', c = 2α, of each pair at the distance r, and h_ij' >= -γh_ij³ by the inputs. If all
    pairs start farther apart than D with h_ij > 0, this is so for ever. Wherever h_ij >= 0, two agents that brake with
    α each meet the condition. Ours: on a line two agents with h_ij < 0 come nearer than D whatever inputs up to α they
    have.
    """
    law: SafetyFilter = seen.law
    q, p = seen.given.q[0], seen.given.p[0]
    i, j = np.triu_indices(seen.n, 1)
    count_claim = condition("two agents or more", seen.n > 1, detail=f"n = {seen.n}")
    if seen.n < 2:
        return [count_claim], []
    h, margin = _at_start(law, q, p)
    k = int(h.mid.argmin())
    text = f"agents {i[k]} and {j[k]} have h = {h.mid[k]:.6g}"
    distance_text = f"the least r - D is {margin.mid.min():.6g}"
    far = positive_room("all pairs start farther apart than D", margin.min(), distance_text, remedy="lower D")
    safe_claim = positive_room("h > 0 for all pairs at the start", h.min(), text, remedy="start slower")
    line = condition("agents move on a line", seen.m == 1, detail=f"m = {seen.m}")
    start_violation = positive_room("h < 0 for a pair at the start", -h.min(), text)
    distances = seen.distances(i, j).min(axis=1)
    limits = f"2α = {2.0 * law.acceleration_limit:g}"
    unmet_hypothesis = unmet([far, line, start_violation])
    late_claim = (
        judged("too-late", Enclosure.of(0.0), [far, line, start_violation], about="all", proof=_PROOF).described(
            stated="with inputs up to α the pair comes nearer than D", detail=text
        )
        if unmet_hypothesis is None
        else vacuous("too-late", unmet_hypothesis)
    )
    return [count_claim], [
        judged("apart", distances / law.distance - 1.0, [far, safe_claim], proof=_PROOF).described(
            computed=float(distances.mid.min()),
            stated=f"all pairs stay farther apart than D = {law.distance:g}",
            witness={"time": float(seen.t[int(distances.mid.argmin())])},
            detail=f"the least distance at a sample is {distances.mid.min():.6g}",
        ),
        judged("braking", Enclosure.of(0.0), [far, safe_claim], about="all", proof=_PROOF).described(
            stated=f"of a pair never more than {limits} is asked", detail=text
        ),
        late_claim,
    ]
