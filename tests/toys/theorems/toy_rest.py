"""All speeds end below a tenth of the largest at the start: a theorem of one file, with a lead of its own."""

from __future__ import annotations

from flockana.laws.toy_swarm import ToySwarm

from flockana.theorems.hypotheses import applied
from flockana.theorems.theorem import Claim, Theorem, judge


def check(run, tolerances):
    needs = [applied(run, "the toy law", ToySwarm)]
    if needs[0].status == "unmet":
        return needs, [Claim("slow", "vacuous")]
    speed = run.metric("toy_speed")
    margin, error = 0.1 - float(speed[-1] / speed.max()), 1e-6
    return needs, [Claim("slow", judge(margin, error, needs), margin=margin, error=error)]


THEOREM = Theorem(
    id="toy-rest",
    title="All come to rest",
    statement="The largest speed at the end is below a tenth of the largest ever.",
    source="a toy",
    kind="trajectory",
    check=check,
    references=(),
    leads={"slow": lambda run, claim: 0.5},
)
