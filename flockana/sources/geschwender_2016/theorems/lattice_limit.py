"""Printed summaries of Theorems 1 and 3 on a run: convergence to an α-lattice (false, erratum E3)."""

from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.theorems.hypotheses import alpha_gain
from flockana.theorems.limit_claims import lattice_limit
from flockana.theorems.search_objectives import strained
from flockana.theorems.theorem_toolkit import Checked, Observed, Tolerances, law_is, run_theorem, unmet


@run_theorem(
    "lattice-limit-printed",
    title="The flock converges to an α-lattice, as the summaries print it",
    source="slides, Theorems 1(i) and 3(ii) and their summaries",
    law=law_is("Algorithm 1 or 2", Algorithm1, Algorithm2),
    claims=("lattice",),
    references=("geschwender-2016", "olfati-saber-2006"),
    leads={"lattice": strained},
)
def theorem(run: Observed, tolerances: Tolerances) -> Checked:
    """Under Algorithms 1 and 2 almost every solution converges to an α-lattice. False (E3): a strict minimum of V with
    strained links has an open basin, and λJ strains every lattice of Algorithm 2. A run refutes it where it has come to
    rest at such a minimum.
    """
    requirements = alpha_gain(run)
    return requirements, [] if unmet(requirements) else [lattice_limit(run, requirements, tolerances, name="lattice")]
