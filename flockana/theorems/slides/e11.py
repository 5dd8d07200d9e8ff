"""Erratum E11: Algorithm 2 yields a lattice only while c1γ/c1α is small."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from math import isnan, log, sqrt
from typing import Any

from flockana.base.errors import SolverError
from flockana.dynamics.trajectory import Trajectory
from flockana.equilibria.collapse import CONTACT, natural_ratio, nudged, squeezed, threshold
from flockana.equilibria.gradient_flow import gradient_flow
from flockana.equilibria.terminal import TerminalState, surroundings, terminal_state
from flockana.interactions import AlphaInteraction
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm2, paper_pair
from flockana.measures.metrics import coincident_pairs, velocity_mismatch
from flockana.theorems.claims import of_state
from flockana.theorems.hypotheses import condition, law_is
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, unmet

_RINGS = (1, 2, 3)  # hexagons of 7, 19 and 37 agents
_SAFE, _FACTOR = 1.2, 1.3  # where the search for one ring starts, of `natural_ratio`, and its steps
_HALVINGS = 3


def collapses(law: Algorithm2, rings: int, ratio: float) -> bool:
    """Whether a hexagonal patch, slightly disturbed, flows to coincident agents at this c1γ/c1α."""
    pressed = squeezed(paper_pair(law), ratio)
    limit = gradient_flow(pressed, nudged(hexagonal_patch(rings, law.alpha.length), law.alpha.length))
    if not limit.converged:
        raise SolverError(f"at c1γ/c1α = {ratio:.4g} the gradient flow did not settle (force {limit.force:.2g})")
    return coincident_pairs(limit.q, CONTACT * law.alpha.length) > 0


def collapse_threshold(law: Algorithm2, rings: int) -> tuple[float, float]:
    """(largest ratio c1γ/c1α at which the gradient flow of a hexagonal patch was seen safe, least seen to collapse)."""
    lowest = _SAFE * natural_ratio(paper_pair(law)) / rings**2  # what presses on the middle adds up over the radius
    return threshold(lambda ratio: collapses(law, rings, ratio), lowest=lowest, factor=_FACTOR, halvings=_HALVINGS)


def _gains(run: Trajectory) -> Hypothesis:
    gains = run.law.gains
    if gains.per_agent:
        return Hypothesis("one c1γ for all agents", "unmet", detail="gains are given per agent")
    least = min(gains.c1_alpha, gains.c1_gamma)
    return condition("c1α > 0 and c1γ > 0", least > 0.0, least)


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    needs = [_gains(run)]
    if unmet(needs):
        return needs, []
    end = terminal_state(run.law, run.q[-1], run.p[-1], contact=tolerances.contact)
    caught = _caught(run, end, tolerances)
    return needs, [_printed(run, end, caught, tolerances), _minimum(end, caught, tolerances), _thresholds(run.law)]


def _caught(run: Trajectory, end: TerminalState, tolerances: Tolerances) -> bool:
    """Whether the last state is at rest beside a strict minimum that it has not the energy to leave."""
    still = end.mismatch <= tolerances.velocity * run.law.scales.energy and end.force <= tolerances.force
    around = surroundings(run.law, run.q[-1], force=end.force * run.law.scales.force * sqrt(run.n))
    return bool(still and around is not None and around.holds(velocity_mismatch(run.p[-1])))


def _printed(run: Trajectory, end: TerminalState, caught: bool, tolerances: Tolerances) -> Claim:
    """The claim as printed, by the strain of the limit, where a distance differs by √2 of that to it at most."""
    margin, error = tolerances.quasi - end.strain, sqrt(2.0) * end.distance
    ratio = run.law.gains.c1_gamma / run.law.gains.c1_alpha
    at_rest = "" if caught else "; it is not known to rest there"
    lengths = f"{end.coincident} coincident pairs; its shortest link is {end.shortest:.3g}"
    return of_state(
        "printed",
        margin,
        error,
        verifies=caught,
        refutes=caught,
        computed=end.strain,
        stated=f"the limit is a quasi-α-lattice at least: |link - d|/d <= {tolerances.quasi:g}",
        witness={"coincident pairs": end.coincident, "shortest link": end.shortest},
        detail=f"with c1γ/c1α = {ratio:.3g} the limit has {'no links' if isnan(end.strain) else lengths}{at_rest}",
    )


def _minimum(end: TerminalState, caught: bool, tolerances: Tolerances) -> Claim:
    return of_state(
        "minimum",
        end.curvature - tolerances.curvature,
        end.curvature_error,
        verifies=caught,
        about="limit",
        computed=end.curvature,
        stated="the limit is a strict local minimum of U_λ off the rotations, so that it attracts an open set",
        witness={"force": end.force, "K̃": end.mismatch},
        detail=f"least curvature {end.curvature:.3g} of the largest, residual force {end.force:.1g}",
    )


@lru_cache(maxsize=32)
def _brackets(alpha: AlphaInteraction) -> dict[int, tuple[float, float]] | str:
    """Brackets of the ratio by number of agents; or why there are none."""
    law = squeezed(alpha, natural_ratio(alpha))
    try:
        return {len(hexagonal_patch(rings, alpha.d)): collapse_threshold(law, rings) for rings in _RINGS}
    except SolverError as error:
        return str(error)


def _thresholds(law: Algorithm2) -> Claim:
    """The claim that the ratio falls: the brackets' middles differ by more than their widths, as logarithms."""
    brackets = _brackets(law.alpha)
    about: dict[str, Any] = {
        "stated": "the ratio c1γ/c1α at which a hexagonal patch begins to collapse falls with n",
        "witness": "hexagonal patches relaxed by gradient flow, ratio bisected",
    }
    if isinstance(brackets, str):
        return Claim("threshold", "inconclusive", detail=f"no threshold was found: {brackets}", **about)
    spans = [(log(low), log(high)) for low, high in brackets.values()]
    # from the middle of one bracket to that of the next, and half of both widths
    falls = [(0.5 * (a + b - c - d), 0.5 * (b - a + d - c)) for (a, b), (c, d) in pairwise(spans)]
    margin, error = min(falls, key=lambda fall: fall[0] - fall[1])
    table = ", ".join(f"n = {n}: {low:.3g} to {high:.3g}" for n, (low, high) in brackets.items())
    return of_state(
        "threshold",
        margin,
        error,
        computed={n: list(pair) for n, pair in brackets.items()},
        detail=f"a hexagonal patch collapses from c1γ/c1α on: {table}",
        **about,
    )


THEOREM = Theorem(
    id="E11",
    title="Algorithm 2 collapses when c1γ/c1α is too large",
    statement=(
        "The sources take Algorithm 2 to yield a lattice. The γ-agent presses on every link: beyond a ratio c1γ/c1α "
        "that falls with n, agents coincide for good, in a strict local minimum of U_λ."
    ),
    source="slides, summary of Theorem 3; both student projects",
    kind="trajectory",
    law=law_is("Algorithm 2", Algorithm2),
    check=_check,
    claims=("printed", "minimum", "threshold"),
    reason="not so: {name}",
    references=("geschwender-2016", "isola-2024", "notebook-r2"),
)
