"""Distance of the sources' time steps from instability."""

from typing import Any

from flockana.environment.targets import StaticTarget
from flockana.equilibria.solve import find_equilibrium
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_spiral
from flockana.laws.discrete import DiscreteLaw
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.solvers.taylor_step import TaylorStep
from flockana.sources.isola_2024 import MSNDiscretisation
from flockana.sources.jond_2025 import MinimalFlocking
from flockana.stability.law_studies import sampling_margin
from flockana.stability.linearise import linearise
from flockana.stability.unstable_steps import CLOSE
from flockana.theorems.theorem_toolkit import Claim, FloatArray, Tolerances, erratum, spectral

_MSN = AlphaInteraction(d=15.0, r=18.0, eps=0.1, h=0.1, a=3.0, b=3.0)
_MSN_GAINS = Gains(c1_alpha=100.0, c2_alpha=20.0, c1_gamma=70.0, c2_gamma=2.0 * 70.0**0.5)
_NOTEBOOK_1 = AlphaInteraction(d=1.9, r=2.8, eps=0.1, h=0.4, a=7.0, b=9.0)
_NOTEBOOK_2 = AlphaInteraction(d=1.7, r=2.5, eps=0.01, h=0.2, a=7.0, b=15.0)
_UNIT = Gains(c1_alpha=1.0, c2_alpha=1.0, c1_gamma=0.0, c2_gamma=0.5)
_TREE = ((0, 1), (1, 2), (1, 3))


def _steps() -> tuple[tuple[str, str, DiscreteLaw, FloatArray], ...]:
    """Return name, source, map, and equilibrium (or a start for finding one) of each source's map."""
    rest = StaticTarget((0.0, 0.0))
    msn = Algorithm2(_MSN, _MSN_GAINS, rest)
    at_once = MSNDiscretisation(msn, 0.009, in_place=False)
    first_law, second_law = Algorithm1(_NOTEBOOK_1, _UNIT), Algorithm2(_NOTEBOOK_2, _UNIT, rest)
    tree = MinimalFlocking(edges=_TREE, spacing=2.0)
    tree_positions = hexagonal_spiral(4, 1.0)[[1, 0, 2, 3]]
    few, large_lattice, small = hexagonal_spiral(19, _MSN.d), hexagonal_spiral(100, _MSN.d), hexagonal_spiral(7, 1.0)
    return (
        ("msn-few", "MSN project, cases 3 and 4, 19 agents, all at once", at_once, few),
        ("msn-few-in-place", "MSN project, cases 3 and 4, 19 agents, in place", MSNDiscretisation(msn, 0.009), few),
        ("msn", "MSN project, cases 3 and 4, its 100 agents, all at once", at_once, large_lattice),
        ("notebook-1", "R² notebook, Algorithm 1, 7 agents", TaylorStep(first_law, 0.05), _NOTEBOOK_1.d * small),
        ("notebook-2", "R² notebook, Algorithm 2, 7 agents", TaylorStep(second_law, 0.1), _NOTEBOOK_2.d * small),
        ("minimal", "bearing-distance paper, minimal model on a tree of 4", tree.discrete(0.1), 2.0 * tree_positions),
    )


def _claim(name: str, words: str, step: DiscreteLaw, q: FloatArray) -> Claim:
    """Return the claim that all modes decay at a source's time step, by the largest stable step or multipliers."""
    law: Any = step.continuous
    equilibrium = q if isinstance(law, MinimalFlocking) else find_equilibrium(law, q).q
    bound, dt = sampling_margin(step, equilibrium), step.dt
    if bound.certified:
        margin, error = bound.times(dt) - 1.0, CLOSE
    else:
        worst = linearise(step, equilibrium).modes[0]
        margin, error = worst.decay_per_step, worst.error
    return spectral(name, margin, error).described(
        computed={"n": len(equilibrium), "dt": dt, "margin": bound.period, "margin over dt": bound.times(dt)},
        stated=f"at dt = {dt:g} every mode of the flock at its equilibrium decays",
        witness={"lost at z": str(bound.first and bound.first.multiplier)},
        detail=f"{words}: dt = {dt:g}, stable up to {bound.period:.4g}, {bound.times(dt):.3g} times dt",
    )


@erratum(
    "sampling-margins",
    title="How far from instability the sources' time steps are",
    source="ours, on the steps of the MSN project, the R² notebook and the bearing-distance paper",
    author="flockana",
    references=("isola-2024", "notebook-r2", "jond-2025"),
    expected={"verified": "msn-few msn-few-in-place notebook-1 notebook-2 minimal", "refuted": "msn"},
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """A source that prints a step and simulates with it runs a map. Linearised about an equilibrium of the law, the map
    is stable if all its multipliers but those of neutral motions lie in the unit disc. The MSN project's 0.009 is
    stable for small flocks and not for its 100 agents, whose many links damp too strongly for the step; the R²
    notebook's 0.05 is half of the largest stable step, and its 0.1 nearly all of it.
    """
    return [_claim(*step) for step in _steps()]
