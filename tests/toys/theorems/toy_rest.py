"""All speeds end below a tenth of the largest at the start: a theorem of one file, with a lead of its own."""

from flockana.laws.toy_swarm import ToySwarm

from flockana.theorems.claims import judged
from flockana.theorems.hypotheses import law_is
from flockana.theorems.theorem import Theorem


def check(seen, tolerances):
    speed = seen.series(lambda run: run.metric("toy_speed"), floor=1e-12)
    return [], [judged("slow", 0.1 - speed[-1] / speed.max())]


THEOREM = Theorem(
    id="toy-rest",
    title="All come to rest",
    statement="The largest speed at the end is below a tenth of the largest ever.",
    source="a toy",
    kind="trajectory",
    check=check,
    references=(),
    law=law_is("the toy law", ToySwarm),
    claims=("slow",),
    leads={"slow": lambda run, claim: 0.5},
)
