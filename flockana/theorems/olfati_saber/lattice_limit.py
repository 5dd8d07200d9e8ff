"""The slides' summaries of Theorems 1 and 3, of one run: it converges to an α-lattice. Erratum E3 says when not."""

from __future__ import annotations

from flockana.dynamics.trajectory import Trajectory
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.theorems.asymptotics import lattice_limit
from flockana.theorems.hypotheses import vacuous, with_alpha_gain
from flockana.theorems.leads import strained
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    needs = with_alpha_gain(run, "Algorithm 1 or 2", Algorithm1, Algorithm2)
    nothing = vacuous(needs, ["lattice"])
    return needs, nothing or [lattice_limit(run, needs, tolerances, name="lattice")]


THEOREM = Theorem(
    id="lattice-limit-printed",
    title="The flock converges to an α-lattice, as the summaries print it",
    statement=(
        "Under Algorithms 1 and 2 almost every solution converges to an α-lattice. False (E3): a strict minimum of V "
        "with strained links has an open basin, and λJ strains every lattice of Algorithm 2. A run refutes it where "
        "it has come to rest at such a minimum."
    ),
    source="slides, Theorems 1(i) and 3(ii) and their summaries",
    kind="trajectory",
    check=_check,
    references=("geschwender-2016", "olfati-saber-2006"),
    leads={"lattice": strained},
    limits=("lattice",),
)
