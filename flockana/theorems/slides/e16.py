"""Erratum E16: whether Algorithm 2 works is not decided by whose coefficients are greater."""

from __future__ import annotations

from functools import lru_cache
from math import sqrt

from flockana.base.errors import SolverError
from flockana.equilibria.collapse import perturbed, pulled_law
from flockana.equilibria.gradient_flow import gradient_flow
from flockana.equilibria.terminal import TerminalState, terminal_state
from flockana.interactions import AlphaInteraction
from flockana.lattice import hexagonal_patch
from flockana.theorems.basin import Basin
from flockana.theorems.claims import counted, erratum, judged, of_state
from flockana.theorems.enclosure import Enclosure, stacked
from flockana.theorems.olfati_saber.attraction import attraction
from flockana.theorems.theorem import Claim, Tolerances

_ALPHA = AlphaInteraction(d=15.0, r=18.0, eps=0.1, h=0.1, a=3.0, b=3.0)  # the project's
_RATIO, _REVERSED = 0.7, 2.0  # c1γ/c1α: the project's own 70 : 100, and one of γ over α
_MANY, _FEW = 4, 1  # rings of the patches: 61 and 7 agents


@lru_cache(maxsize=8)
def pressed_patch(rings: int, ratio: float, contact: float) -> tuple[TerminalState, Basin]:
    """Return where a hexagonal patch, slightly disturbed, rests downhill under the project's pair law."""
    law = pulled_law(_ALPHA, ratio)
    limit = gradient_flow(law, perturbed(hexagonal_patch(rings, _ALPHA.d), _ALPHA.d))
    if not limit.converged:
        raise SolverError(f"at c1γ/c1α = {ratio:.4g} the gradient flow did not settle (force {limit.force:.2g})")
    still = 0.0 * limit.q
    return terminal_state(law, limit.q, still, contact=contact), attraction(law, limit.q, still)


def _check(tolerances: Tolerances) -> list[Claim]:
    """61 agents at the project's coefficients, and seven with the γ coefficient the greater."""
    cases = ((_MANY, _RATIO), (_FEW, _REVERSED))
    (many, at_many), (few, at_few) = (pressed_patch(*case, tolerances.contact) for case in cases)
    off = sqrt(2.0) * at_few.distance / _ALPHA.d  # two agents move apart by √2 of the distance to the minimum at most
    basins = [Enclosure.around(basin.certificate.margin, basin.certificate.error) for basin in (at_many, at_few)]
    return [
        counted(
            "sufficient",
            0,
            many.coincident if at_many.certificate.certain else 0,
            many.coincident,
            about="all",
            computed=many.coincident,
            stated="no pair coincides as long as c1α > c1γ",
            witness="a hexagonal patch of 61 agents relaxed by gradient flow, c1γ/c1α = 0.7",
            detail=f"at the project's 100 : 70, {many.coincident} pairs of 61 agents end in the same place (of its own "
            "100 agents more: scenario msn-static)",
        ),
        of_state(
            "necessary",
            tolerances.contact - few.shortest / _ALPHA.d,
            off,
            about="all",
            computed=few.shortest / _ALPHA.d,
            stated="pairs coincide unless c1α > c1γ",
            witness="a hexagonal patch of 7 agents relaxed by gradient flow, c1γ/c1α = 2",
            detail=f"with c1γ = 2 c1α seven agents rest {few.shortest:.3g} or more apart, where d = {_ALPHA.d:g}",
        ),
        judged(
            "minima",
            stacked(basins),
            computed=min(many.curvature, few.curvature),
            stated="both are strict local minima of U_λ off the rotations, so that they attract open sets",
            detail=f"least curvatures {many.curvature:.3g} and {few.curvature:.3g} of the largest; of 61 agents "
            f"{at_many.certificate.text}",
        ),
        of_state(
            "lattice",
            few.strain - tolerances.quasi,
            off,
            computed=few.strain,
            stated="a flock that stays apart is no lattice yet: |link - d|/d > the tolerance of a quasi-lattice",
            detail=f"the seven are strained by {few.strain:.0%}; from which c1γ/c1α on, and that it falls with n: E11",
        ),
    ]


THEOREM = erratum(
    "E16",
    title="That α exceeds γ neither makes Algorithm 2 work nor is needed for agents to stay apart",
    statement=(
        "The MSN project holds that Algorithm 2 works if its α coefficients exceed its γ coefficients. At its own "
        "100 : 70 pairs of agents coincide for good in a flock of 61, while seven stay apart with c1γ = 2 c1α. What "
        "counts is the ratio c1γ/c1α against a threshold that depends on n and on the pair law (E11)."
    ),
    source="MSN project, Alpha Agent and Gamma Agent",
    check=_check,
    references=("isola-2024", "olfati-saber-2006"),
    expected={"sufficient": "refuted", "necessary": "refuted", "minima": "verified", "lattice": "verified"},
)
