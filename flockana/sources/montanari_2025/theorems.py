"""Speed-up of a flock's settling by per-agent gains."""

from typing import Any

import numpy as np

from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_spiral
from flockana.stability.design import GainDesign, design_gains
from flockana.stability.eigenvalue_errors import eigenvalues
from flockana.stability.gain_problems import gain_problem
from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, spectral, undecided

_WORTH = 0.01  # least relative improvement that counts: both searches end only near the best, where roots coalesce
_CUSP = 1e-4  # relative error of a rate at coalescing roots
_DESIGNS: tuple[tuple[str, int, dict[str, Any], str], ...] = (
    ("printed", 12, {"rotation": "counted"}, "matrix as printed, rotation counted"),
    ("apart", 12, {"rotation": "apart"}, "rotation not counted"),
    ("simplified", 30, {"form": "simplified"}, "simplified form, without ∇²V"),
)


def _design(name: str, n: int, options: dict[str, Any], words: str) -> Claim:
    """Return the claim that per-agent gains from a search speed up decay; a small speed-up refutes nothing."""
    alpha = AlphaInteraction()
    problem = gain_problem(hexagonal_spiral(n, alpha.d), alpha=alpha, gains=Gains(), **options)
    best = design_gains(problem, starts=1)
    margin, error = best.ratio - 1.0 - _WORTH, _ratio_error(best)
    is_certain = margin > error  # else another search may find more
    claim = spectral(name, margin, error) if is_certain else undecided(name, "", margin=margin, error=error)
    return claim.described(
        computed={"n": n, "alike": best.rate_homogeneous, "per agent": best.rate_heterogeneous},
        stated="gains of its own for each agent make the slowest mode die out faster than one pair for all, by "
        f"more than {_WORTH:.0%}",
        witness={"ratio": best.ratio},
        detail=f"n = {n}, {words}, gains within [0, 5]: decay rate {best.rate_homogeneous:.4f} with equal gains, at "
        f"least {best.rate_heterogeneous:.4f} with gains for each agent, {100.0 * (best.ratio - 1.0):.2g} % faster",
    )


def _ratio_error(design: GainDesign) -> float:
    """Return the error of the ratio of two rates, from the rounding of their eigenvalues."""
    # At the best gains roots coalesce, and a rate depends on them as a root: where they are found to 2e-9, it is to
    # 1e-4.
    error_ratios = []
    for gains in (design.homogeneous, design.heterogeneous):
        values, errors = eigenvalues(design.problem.matrix(gains))
        k = int(np.argmax(values.real))
        error_ratios.append(float(errors[k]) / abs(float(values[k].real)))
    return design.ratio * (sum(error_ratios) + _CUSP)


@erratum(
    "heterogeneous-gains",
    title="Do gains of its own for each agent make a faster flock?",
    source="Montanari, Barioni, Duan, Motter, Optimal flock formation induced by agent heterogeneity",
    references=("montanari-2025", "olfati-saber-2006"),
    expected={"verified": "printed simplified", "inconclusive": "apart"},
    ours=("apart",),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Per-agent c1γ and c2γ within bounds can make the slowest mode of the linearised flock decay faster than any
    common gains. The printed matrix resists the flock's rotation, which no law of a flock at rest does: without the
    rotation the improvement nearly vanishes.
    """
    return [_design(*case) for case in _DESIGNS]
