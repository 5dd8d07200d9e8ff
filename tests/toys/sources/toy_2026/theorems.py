"""All speeds end below a tenth of the largest at the start; and erratum T1."""

import numpy as np
from flockana.sources.toy_2026.laws import ToyDrag, ToySwarm

from flockana.theorems.claims import erratum, exact, judged
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


@erratum("T1", expected={"refuted": "printed"})
def keeps_energy(tolerances):
    """Under drag alone the energy is said to stay, though its rate is −k Σ‖p_i‖²."""
    q, p = np.zeros((1, 1)), np.ones((1, 1))
    rate = ToyDrag(2.0).act(0.0, q, p, np.zeros((1, 1)))
    return [exact("printed", rate == 0.0, computed=rate, stated=0.0)]
