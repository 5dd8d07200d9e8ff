"""Ha and Liu (2009): flocks of the Cucker-Smale law whose velocity spread is below an integral of the weight."""

from math import sqrt

from flockana.sources.cucker_smale_2007.laws import CuckerSmale
from flockana.sources.cucker_smale_2007.theorems.spread_functional import guarantee_of
from flockana.theorems.theorem_toolkit import Checked, Observed, Tolerances, law_is, run_theorem

_NAMES = ("bounded", "rate", "flock")


def _checked(seen: Observed, stretch: float) -> Checked:
    guarantee = guarantee_of(seen, stretch)
    return guarantee.claims([guarantee.hypothesis("‖v(0)‖ < ∫φ from ‖x(0)‖ on")], limit="flock")


@run_theorem(
    "ha-liu",
    title="A velocity spread below an integral of the weight makes a flock",
    source="Ha and Liu 2009",
    law=law_is("the Cucker-Smale law", CuckerSmale),
    claims=_NAMES,
    references=("ha-liu-2009",),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Under the Cucker-Smale law with sums λ/n Σ ψ(‖q_j - q_i‖)(p_j - p_i), let ‖x‖² = Σ‖q_i - q̄‖², ‖v‖² =
    Σ‖p_i - p̄‖² and φ(s) = λψ(2s). If ‖v(0)‖ < ∫φ(s) ds from ‖x(0)‖ on, which always holds for β <= ½, then ‖x(t)‖ <=
    x_M, where ∫φ from ‖x(0)‖ to x_M is ‖v(0)‖, and ‖v(t)‖ <= ‖v(0)‖ exp(-φ(x_M) t).
    """
    return _checked(seen, 2.0)


@run_theorem(
    "ha-liu-sharp",
    title="The same below a larger integral, which is sharp for two agents on a line",
    source="Ours, on Ha and Liu 2009",
    law=law_is("the Cucker-Smale law", CuckerSmale),
    claims=_NAMES,
    references=("ha-liu-2009", "flockana"),
    author="flockana",
)
def sharp(seen: Observed, tolerances: Tolerances) -> Checked:
    """As the theorem of Ha and Liu, with φ(s) = λψ(√2 s): no two agents are farther apart than √2 ‖x‖. For two agents
    that part on a line the condition is necessary too, but for equality.
    """
    return _checked(seen, sqrt(2.0))
