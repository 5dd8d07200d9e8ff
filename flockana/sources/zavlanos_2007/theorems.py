"""Links kept by tension: below an energy level no link reaches the range, so the net stays connected and agrees."""

import numpy as np

from flockana.measures.nets import components
from flockana.measures.path_bounds import ROUNDING
from flockana.sources.zavlanos_2007.laws import LinkKeeping
from flockana.theorems.bounds_between_samples import polygons
from flockana.theorems.energy import balance, never_rises
from flockana.theorems.limit_claims import velocities_match
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances
from flockana.theorems.theorem_toolkit import EPS, Enclosure, Observed, condition, judged, law_is, lengths, run_theorem

_PROOF = "links-kept"


def _joined(seen: Observed) -> Hypothesis:
    """Return the hypothesis that the links connect all agents."""
    link_ends = np.array(seen.law.links, dtype=np.int32).reshape(-1, 2)
    parts = len({*components(seen.n, link_ends).tolist()})
    text = f"{parts} component(s), {len(link_ends)} links"
    return condition("the links join all agents", parts == 1, float(1 - parts), text)


def longest_link(seen: Observed) -> Enclosure:
    """Return an enclosure of the longest link over the run, also between samples."""
    link_ends = np.array(seen.law.links, dtype=np.int64).reshape(-1, 2)
    if not len(link_ends):
        return Enclosure.of(0.0)
    sample_distances = seen.distances(link_ends[:, 0], link_ends[:, 1]).max()
    bound = float(sample_distances.hi)
    for _, points, path_error in polygons(seen.run):
        link_lengths = lengths(points[link_ends[:, 1]] - points[link_ends[:, 0]]).max(axis=1)
        bound = max(bound, float((link_lengths + 2.0 * np.max(path_error)).max(initial=0.0)))
    error = 2.0 * float(seen.between_error.max(initial=0.0)) + ROUNDING * float(np.abs(seen.run.q).max())
    return Enclosure(sample_distances.lo, sample_distances.mid, bound + error + 64.0 * EPS * seen.law.r)


def _below(longest: Enclosure, r: float, name: str, most: Enclosure, stated: str, needs: list[Hypothesis]) -> Claim:
    """Return the claim that no link is longer than `most`; only a sample refutes it."""
    return judged(name, (most - longest) / r, needs, proof=_PROOF, computed=float(longest.mid)).described(
        stated=stated,
        detail=f"the longest link is {longest.mid:.4g} at a sample and at most {longest.hi:.4g} between; r = {r:g}",
    )


@run_theorem(
    "links-kept",
    title="A tension without bound at the range keeps the links of the start, and velocities agree",
    source=(
        "ours, after Zavlanos, Jadbabaie and Pappas 2007, with the tension of Ji and Egerstedt 2007; the net is that "
        "of the start, without the links that both add"
    ),
    law=law_is("link-keeping", LinkKeeping),
    claims=("rate", "balance", "links", "connected", "velocities"),
    references=("zavlanos-2007", "ji-egerstedt-2007"),
    author="flockana",
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Along u_i = -Σ_j ∇_i ψ + c Σ_j (p_j - p_i) over links, with ψ(s) = k s²/(r - s) and c >= 0, the energy H = Σ ψ +
    ½ Σ‖p_i‖² never rises. So no link that is shorter than r at the start is ever longer than the length at which it
    alone has H(0), which is below r; if the links join all agents, they do so at all times, and with c > 0 all
    velocities tend to one. Zavlanos, Jadbabaie and Pappas have a potential that is unbounded at contact too, so that
    neighbours do not collide, and add links with hysteresis; Ji and Egerstedt steer a first-order rendezvous. This is a
    part of both results, in our words.
    """
    law, joined, energy = seen.law, _joined(seen), seen.energy[0]
    most, longest = energy.rising(np.vectorize(law.longest, otypes=[float])).scaled_out(64.0 * EPS), longest_link(seen)
    level = f"no link is longer than {most.mid:.5g}, at which one link alone has the energy H(0) = {energy.mid:.5g}"
    whole = "the links, all shorter than r, always join all agents"
    damped = condition("c > 0", law.c > 0.0, law.c, f"c = {law.c:g}")
    return [joined, damped], [
        never_rises(seen, [], proof=_PROOF),
        balance(seen, [], tolerances, proof=_PROOF),
        _below(longest, law.r, "links", most, level, []),
        _below(longest, law.r, "connected", Enclosure.of(law.r), whole, [joined]),
        velocities_match(seen, [joined, damped], name="velocities", proof="matched-velocities"),
    ]
