"""Two agents of the Cucker-Smale law on a line: an invariant decides which pairs match and which separate."""

import numpy as np

from flockana.sources.cucker_smale_2007.laws import CuckerSmale
from flockana.theorems.alignment_bounds import QUADRATURE, AlignmentRate
from flockana.theorems.claims import judged, run_theorem, vacuous
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Needs, Tolerances, unmet
from flockana.theorems.theorem_toolkit import Enclosure, Observed, condition, law_is, limit_claim, positive_room


def _invariant(
    seen: Observed, psi: AlignmentRate, x: Enclosure, w: Enclosure, needs: list[Hypothesis], tolerances: Tolerances
) -> Claim:
    """Return the claim that w + ∫λψ is conserved, where w is the relative velocity of a pair."""
    start = float(x.mid[0])
    passed_integral = x.rising(np.vectorize(lambda at: psi.between(start, at), otypes=[float])).scaled_out(QUADRATURE)
    deviation = abs((w + passed_integral) / w[0] - 1.0)
    k = int(deviation.mid.argmax())
    return judged("invariant", tolerances.energy - deviation, needs, proof="cucker-smale").described(
        computed=float(deviation.mid[k]),
        stated=f"w + ∫λψ from x(0) to x is w(0), to {tolerances.energy:g} of it",
        witness={"time": float(seen.t[k])},
        detail=f"the invariant is off by {deviation.mid[k]:.2g} of w(0) at most",
    )


def _side(name: str, need: Hypothesis, needs: Needs, computed: float, stated: str, text: str) -> Claim:
    """Return the claim for pairs on one side of the critical speed; vacuous for pairs on the other."""
    if need.status == "unmet":
        return vacuous(name, need)
    claim = limit_claim(name, [*needs, need], computed=computed, stated=stated, proof="cucker-smale")
    return claim.described(detail=f"{need.detail}: {text}")


@run_theorem(
    "cucker-smale-pair",
    title="Two agents on a line match velocities below a critical relative speed, and separate permanently above it",
    source="Ours, on Cucker and Smale 2007 and Ha and Liu 2009",
    law=law_is("the Cucker-Smale law", CuckerSmale),
    claims=("invariant", "bounded", "parts"),
    references=("cucker-smale-2007", "ha-liu-2009", "flockana"),
    author="flockana",
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Of two agents on a line under the Cucker-Smale law, x apart along their relative velocity w > 0, w + ∫λψ(s) ds
    from x(0) to x never changes; λψ is K(1 + s²/ℓ²)^-β, or twice that where no sum is divided by n. If w(0) < ∫λψ from
    x(0) on, velocities match at the distance up to which the integral is w(0); if w(0) is more, as it can be for β > ½
    only, they separate permanently, at a relative speed of at least w(0) minus the integral: the condition of Ha and
    Liu cannot be left out.
    """
    needs = [condition("two agents on a line", (seen.n, seen.m) == (2, 1), detail=f"n = {seen.n}, m = {seen.m}")]
    if unmet(needs):
        return needs, []
    way = float(np.sign(seen.run.p[0, 1, 0] - seen.run.p[0, 0, 0]))
    x, w = (
        Enclosure.around(way * (series[:, 1, 0] - series[:, 0, 0]), error.sum(axis=1))
        for series, error in ((seen.run.q, seen.shape_error), (seen.run.p, seen.speed_error))
    )
    needs.append(condition("different velocities", way != 0.0, float(w.mid[0]), f"w(0) = {w.mid[0]:g}"))
    if unmet(needs):
        return needs, []
    weight = seen.law.weight
    psi = AlignmentRate(weight, weight.strength * (1.0 if seen.law.mean else 2.0), 1.0)
    rest = psi.beyond_enclosed(x[0])
    detail = f"w(0) = {w.mid[0]:.6g}, the integral {rest.mid:.6g}"
    slow_claim = positive_room("w(0) < ∫λψ from x(0) on", rest - w[0], detail)
    fast_need = positive_room("w(0) > ∫λψ from x(0) on", w[0] - rest, detail)
    far, smallest, end = psi.reached(float(x.mid[0]), float(w.mid[0])), float((w[0] - rest).mid), float(w.mid[-1])
    bound_text = f"x along w tends to {far:.6g}, and is {x.mid[-1]:.6g} at the end of the run"
    parts = f"their relative speed is {end:.6g} at the end and never below {smallest:.6g}"
    match_text = "the two match, and their distance tends to a known one"
    return needs, [
        _invariant(seen, psi, x, w, needs, tolerances),
        _side("bounded", slow_claim, needs, float(x.mid[-1]), match_text, bound_text),
        _side("parts", fast_need, needs, end, "the two never match and separate", parts),
    ]
