"""Erratum E11: Algorithm 2 yields a lattice only while c1γ/c1α is small."""

from __future__ import annotations

from flockana.equilibria.collapse import nudged, squeezed, threshold
from flockana.gradient_flow import gradient_flow
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm2
from flockana.terminal import terminal_state
from flockana.theorems.asymptotics import settled
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances
from flockana.trajectory import Trajectory

_RINGS = (1, 2, 3)  # hexagons of 7, 19 and 37 agents
_LOWEST, _FACTOR = 0.1, 1.3  # where the search starts, and its steps
_HALVINGS = 3
_NAMES = ("printed", "minimum", "threshold")


def collapses(law: Algorithm2, rings: int, ratio: float) -> bool:
    """Whether a hexagonal patch, slightly disturbed, flows to coincident agents at this c1γ/c1α.

    Parameters
    ----------
    law : Algorithm2
        Its pair law is used; gains and target are set here.
    rings : int
        Rings of the patch.
    ratio : float
        c1γ/c1α.
    """
    pressed = squeezed(law.alpha, ratio)
    limit = gradient_flow(pressed, nudged(hexagonal_patch(rings, law.alpha.d), law.alpha.d))
    return terminal_state(pressed, limit.q, 0.0 * limit.q).coincident > 0


def collapse_threshold(law: Algorithm2, rings: int) -> tuple[float, float]:
    """Bracket the least ratio c1γ/c1α at which the gradient flow of a hexagonal patch collapses.

    Parameters
    ----------
    law : Algorithm2
        Its pair law is used.
    rings : int
        Rings of the patch.

    Returns
    -------
    tuple of float
        (largest ratio seen safe, least ratio seen to collapse).
    """
    return threshold(lambda ratio: collapses(law, rings, ratio), lowest=_LOWEST, factor=_FACTOR, halvings=_HALVINGS)


def _check(run: Trajectory, tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    applies = type(run.law) is Algorithm2
    law = Hypothesis("Algorithm 2 is applied", "met" if applies else "unmet", detail=type(run.law).__name__)
    if not applies:
        return [law], [Claim(name, "vacuous", detail="another law") for name in _NAMES]
    if run.law.gains.per_agent:
        single = Hypothesis("one c1γ for all agents", "unmet", detail="gains are given per agent")
        return [law, single], [Claim(name, "vacuous", detail=single.detail) for name in _NAMES]
    end = terminal_state(run.law, run.q[-1], run.p[-1], contact=tolerances.contact)
    at_rest = settled(end, tolerances, run.scales)
    ratio = run.law.gains.c1_gamma / run.law.gains.c1_alpha
    printed = Claim(
        "printed",
        ("refuted" if end.strain > tolerances.quasi else "verified") if at_rest else "inconclusive",
        computed=end.strain,
        stated=f"the limit is a quasi-α-lattice at least: |link - d|/d <= {tolerances.quasi:g}",
        margin=tolerances.quasi - end.strain,
        error=end.force,
        witness={"coincident pairs": end.coincident, "shortest link": end.shortest},
        detail=f"with c1γ/c1α = {ratio:.3g} the limit has {end.coincident} coincident pairs; its shortest link is "
        f"{end.shortest:.3g}",
    )
    minimum = Claim(
        "minimum",
        "verified" if at_rest and end.curvature > tolerances.curvature else "inconclusive",
        computed=end.curvature,
        stated="the limit is a strict local minimum of U_λ off the rotations, so that it attracts an open set",
        margin=end.curvature - tolerances.curvature,
        error=0.0,
        witness={"force": end.force, "K̃": end.mismatch},
        detail=f"least curvature {end.curvature:.3g} of the largest, residual force {end.force:.1g}",
    )
    return [law], [printed, minimum, _thresholds(run.law)]


def _thresholds(law: Algorithm2) -> Claim:
    found = {len(hexagonal_patch(rings, law.alpha.d)): collapse_threshold(law, rings) for rings in _RINGS}
    highs = [high for _, high in found.values()]
    falling = highs == sorted(highs, reverse=True)
    table = ", ".join(f"n = {n}: {low:.3g} to {high:.3g}" for n, (low, high) in found.items())
    return Claim(
        "threshold",
        "verified" if falling else "refuted",
        computed={n: list(pair) for n, pair in found.items()},
        stated="the ratio c1γ/c1α at which a hexagonal patch begins to collapse falls with n",
        witness="hexagonal patches relaxed by gradient flow, ratio bisected",
        detail=f"a hexagonal patch collapses from c1γ/c1α on: {table}",
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
    check=_check,
    references=("geschwender-2016", "isola-2024", "notebook-r2"),
)
