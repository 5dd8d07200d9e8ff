"""Cucker-Smale law in discrete time: flocking as in continuous time for short steps."""

from math import sqrt

from flockana.solvers.fixed_steps import FixedSteps
from flockana.sources.cucker_smale_2007.laws import CuckerSmale
from flockana.sources.cucker_smale_2007.theorems.spread_functional import guarantee_of
from flockana.theorems.hypotheses import condition, positive_room
from flockana.theorems.theorem_toolkit import Checked, Enclosure, Hypothesis, Observed, Tolerances, run_theorem

_ROUNDING = 1e-14  # relative, of a product of three numbers


def _law(seen: Observed) -> Hypothesis:
    """Return the hypothesis that a run is of the discrete law, with positions moved by old, new or mean velocities."""
    law = seen.law
    steps = type(law) is FixedSteps and law.position_factor in (0.0, 0.5, 1.0) and type(law.law) is CuckerSmale
    name = law.title + (f" of {law.law.title}" if hasattr(law, "law") else "")
    return condition("steps of the Cucker-Smale law are applied", steps, detail=name)


@run_theorem(
    "cucker-smale-steps",
    title="The Cucker-Smale law in steps of time flocks as the continuous one, if steps are short",
    source="Cucker and Smale 2007, discrete time; condition and bounds ours, after Ha and Liu 2009",
    law=_law,
    claims=("bounded", "rate", "velocities"),
    references=("cucker-smale-2007", "ha-liu-2009", "flockana"),
    author="flockana",
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """With steps h of the Cucker-Smale law, p' = p + h u and positions moved by h times p, p' or their mean, let h λ <=
    1, where λ = nK of plain sums and K of means. If ‖v(0)‖ < ∫φ from ‖x(0)‖ on, as always for β <= ½, then ‖x‖ <= x_M
    at all steps and ‖v‖ <= ‖v(0)‖ (1 - hφ(x_M))^k <= ‖v(0)‖ exp(-φ(x_M) t). In our words, after the discrete-time
    theorem of Cucker and Smale, who bound the step too.
    """
    guarantee = guarantee_of(seen, sqrt(2.0))
    step_strength = seen.law.dt * guarantee.phi.strength  # at most 1, no step reverses a relative velocity
    margin = 1.0 + 2.0 * _ROUNDING - Enclosure.around(step_strength, _ROUNDING * step_strength)
    short = positive_room("h λ <= 1", margin, f"h λ = {step_strength:.6g}")
    return guarantee.claims([short, guarantee.hypothesis("‖v(0)‖ < ∫φ from ‖x(0)‖ on")])
