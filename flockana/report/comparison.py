"""Report section on one start under many laws: the theorems' promises and the outcomes."""

from collections import namedtuple
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

from flockana.report.figures import Picture, drawn
from flockana.report.section_request import MANY_LAWS
from flockana.report.svg_figures import plots, svg
from flockana.scenarios.one_start import UNTIL, Outcome, compare
from flockana.theorems import Verdict
from flockana.theorems.theorem import unmet

_COLUMNS = 5
_SIZE = 3.1  # inches of a panel
_SETTLED = 1e-9  # of the start: what a table calls 0


# A law, its theorem and what happened, as text. Reason: what is refuted or open, or the first unmet hypothesis.
# Velocities, positions: diameters at the end over those at the start. Groups, nearest: components of the net at the
# end, and the least distance.
Row = namedtuple("Row", "name theorem promise status reason velocities positions groups nearest")


@dataclass(frozen=True)
class ComparisonSection:
    """Report section that compares one start under many laws: a row for each law, and pictures."""

    rows: tuple[Row, ...]  # one for each law
    pictures: tuple[Picture, ...]  # paths side by side, and velocity diameters
    name = MANY_LAWS  # of the task that makes the section


@cache
def comparison_section(seed: int = 0) -> ComparisonSection:
    """Return the section that runs and judges one start under every law; takes seconds, once per process."""
    outcomes = compare(seed=seed)
    return ComparisonSection(tuple(_row(outcome) for outcome in outcomes), _pictures(outcomes))


def _row(outcome: Outcome) -> Row:
    entry, verdict, share = outcome.entry, outcome.verdict, outcome.velocity_share
    velocities, positions = f"{share:.2g}" if share > _SETTLED else "0", f"{outcome.position_share:.3g}"
    cells = velocities, positions, str(outcome.groups), f"{outcome.least_distance:.3g}"
    return Row(entry.name, entry.theorem, entry.promise, verdict.status, _reason(verdict), *cells)


def _reason(verdict: Verdict) -> str:
    """Return why a theorem's verdict is not verified: a refuted or open claim, or an unmet hypothesis."""
    claims = [claim for claim in verdict.main_claims if claim.status == verdict.status]
    if verdict.status in ("refuted", "inconclusive"):
        return f"{', '.join(claim.name for claim in claims)}: {claims[0].detail}"
    unmet_hypothesis = unmet(verdict.hypotheses)
    return "" if unmet_hypothesis is None else f"{unmet_hypothesis.name}: {unmet_hypothesis.detail}"


def _pictures(outcomes: Sequence[Outcome]) -> tuple[Picture, ...]:
    columns = min(_COLUMNS, len(outcomes))
    rows = -(-len(outcomes) // columns)

    def paths(figure: Any) -> None:
        axes = figure.subplots(rows, columns, squeeze=False).ravel()
        for unused_axes in axes[len(outcomes) :]:
            unused_axes.remove()
        plots().side_by_side(outcomes, ax=axes[: len(outcomes)])

    names = ", ".join(outcome.entry.name for outcome in outcomes)
    return (
        Picture(
            f"The same start under each law, until t = {UNTIL:g}, all on one scale: hollow and grey at the start, dots "
            "with their links at the end. Above each the theorem and its verdict.",
            svg(paths, (_SIZE * columns, (_SIZE + 0.3) * rows)),
        ),
        drawn(
            f"Greatest difference of two velocities over that at the start: {names}. Flocking is its fall to 0.",
            (8.0, 4.2),
            plots().velocity_diameters,
            outcomes,
        ),
    )
