"""Erratum E11: Algorithm 2 yields a lattice only while c1γ/c1α is small."""

from functools import lru_cache
from math import isnan
from typing import Any

import numpy as np

from flockana.base.errors import SolverError
from flockana.equilibria.final_state import TerminalState, terminal_state
from flockana.equilibria.gradient_flow import gradient_flow
from flockana.equilibria.lattice_collapse import CONTACT, natural_ratio, perturbed, pulled_law, threshold
from flockana.interactions import AlphaInteraction
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm2, paper_pair
from flockana.measures.metrics import coincident_pairs
from flockana.theorems.attraction_basin import final_basin
from flockana.theorems.claims import judged, run_theorem, undecided
from flockana.theorems.limit_claims import limit_strain
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances, unmet
from flockana.theorems.theorem_toolkit import (
    Certificate,
    Enclosure,
    FloatArray,
    Observed,
    condition,
    law_is,
    limit_claim,
)

_RINGS = (1, 2, 3)  # hexagons of 7, 19 and 37 agents
_SAFE, _FACTOR = 1.2, 1.3  # where the search for one ring starts, of `natural_ratio`, and its steps
_HALVINGS = 3


def resting_place(alpha: AlphaInteraction, ratio: float, q: FloatArray) -> FloatArray:
    """Return the equilibrium positions reached by gradient flow from a start, at a given ratio c1γ/c1α."""
    limit = gradient_flow(pulled_law(alpha, ratio), q)
    if not limit.converged:
        raise SolverError(f"at c1γ/c1α = {ratio:.4g} the gradient flow did not settle (force {limit.force:.2g})")
    return limit.q


def collapses(law: Algorithm2, rings: int, ratio: float) -> bool:
    """Return whether a slightly disturbed hexagonal patch collapses at this ratio c1γ/c1α."""
    start = perturbed(hexagonal_patch(rings, law.alpha.length), law.alpha.length)
    return coincident_pairs(resting_place(paper_pair(law), ratio, start), CONTACT * law.alpha.length) > 0


def collapse_threshold(law: Algorithm2, rings: int) -> tuple[float, float]:
    """Return (largest safe ratio c1γ/c1α of a hexagonal patch under the gradient flow, least collapsing ratio)."""
    lowest = _SAFE * natural_ratio(paper_pair(law)) / rings**2  # what presses on the middle adds up over the radius
    return threshold(lambda ratio: collapses(law, rings, ratio), lowest=lowest, factor=_FACTOR, halvings=_HALVINGS)


def _gains(run: Observed) -> Hypothesis:
    gains = run.law.gains
    if gains.per_agent:
        return Hypothesis("one c1γ for all agents", "unmet", detail="gains are given per agent")
    gain = min(gains.c1_alpha, gains.c1_gamma)
    return condition("c1α > 0 and c1γ > 0", gain > 0.0, gain)


def _printed(seen: Observed, end: TerminalState, needs: list[Hypothesis], tolerances: Tolerances) -> Claim:
    """Return the claim that the limit is a quasi-α-lattice, decided by the strain of the certified minimum."""
    caught = final_basin(seen)
    margin, is_certain = tolerances.quasi - limit_strain(seen, end, caught), caught.certificate.certain
    ratio = seen.law.gains.c1_gamma / seen.law.gains.c1_alpha
    length_text = f"{end.coincident} coincident pairs; its shortest link is {end.shortest:.3g}"
    return limit_claim(
        "printed",
        needs,
        [Certificate(float(margin.lo), caught.certificate.text, 0.0)] if is_certain else [],
        escape=Certificate(float(-margin.hi), caught.certificate.text, 0.0) if is_certain else None,
        computed=end.strain,
        stated=f"the limit is a quasi-α-lattice at least: |link - d|/d <= {tolerances.quasi:g}",
        witness={"coincident pairs": end.coincident, "shortest link": end.shortest},
        detail=f"with c1γ/c1α = {ratio:.3g} the last state has {'no links' if isnan(end.strain) else length_text}"
        + ("" if is_certain else f"; {caught.certificate.text}"),
    )


def _minimum(seen: Observed, end: TerminalState, needs: list[Hypothesis]) -> Claim:
    return limit_claim("minimum", needs, [final_basin(seen).certificate], computed=end.curvature).described(
        stated="the limit is a strict local minimum of U_λ off the rotations, so that it attracts an open set",
        witness={"force": end.force, "K̃": end.mismatch},
        detail=f"least curvature {end.curvature:.3g} of the largest, residual force {end.force:.1g}",
    )


@lru_cache(maxsize=32)
def _brackets(alpha: AlphaInteraction) -> dict[int, tuple[float, float]] | str:
    """Return brackets of the collapse ratio c1γ/c1α by number of agents, or a text saying why none was found."""
    law = pulled_law(alpha, natural_ratio(alpha))
    try:
        return {len(hexagonal_patch(rings, alpha.d)): collapse_threshold(law, rings) for rings in _RINGS}
    except SolverError as error:
        return str(error)


def _thresholds(law: Algorithm2) -> Claim:
    """Return the claim that the ratio c1γ/c1α at which a hexagonal patch collapses falls with its size."""
    brackets = _brackets(law.alpha)
    claim_details: dict[str, Any] = {
        "stated": "the ratio c1γ/c1α at which a hexagonal patch begins to collapse falls with n",
        "witness": "hexagonal patches relaxed by gradient flow, ratio bisected",
    }
    if isinstance(brackets, str):
        return undecided("threshold", f"no threshold was found: {brackets}", **claim_details)
    log_brackets = Enclosure.between(*np.log(list(brackets.values())).T)
    table = ", ".join(f"n = {n}: {low:.3g} to {high:.3g}" for n, (low, high) in brackets.items())
    return judged("threshold", log_brackets[:-1] - log_brackets[1:], **claim_details).described(
        computed={n: list(pair) for n, pair in brackets.items()},
        detail=f"ratio c1γ/c1α from which on a hexagonal patch collapses: {table}",
    )


@run_theorem(
    "E11",
    law=law_is("Algorithm 2", Algorithm2),
    claims=("printed", "minimum", "threshold"),
    reason="not so: {name}",
    references=("geschwender-2016", "isola-2024", "notebook-r2"),
    ours=("minimum", "threshold"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """The sources take Algorithm 2 to yield a lattice. The γ-agent presses on every link: beyond a ratio c1γ/c1α that
    falls with n, agents coincide permanently, in a strict local minimum of U_λ.
    """
    if unmet(needs := [_gains(seen)]):
        return needs, []
    end = terminal_state(seen.law, *seen.end[:2], contact=tolerances.contact)
    return needs, [_printed(seen, end, needs, tolerances), _minimum(seen, end, needs), _thresholds(seen.law)]
