"""Marked instants of a player: times at which claims are decided."""

from collections.abc import Iterable, Mapping

from flockana.dynamics.trajectory import Trajectory
from flockana.theorems import Verdict

Marks = list[tuple[float, str]]


def marks_of(run: Trajectory, verdicts: Iterable[Verdict], instants: Iterable[float] = ()) -> Marks:
    """Return the marked instants of a run in order, each with its claims."""
    marks: dict[float, list[str]] = {float(time): ["as in the source"] for time in instants}
    for verdict in verdicts:
        for claim in verdict.claims:
            time = claim.witness.get("time") if isinstance(claim.witness, Mapping) else None
            if isinstance(time, float | int) and run.t[0] <= time <= run.t[-1]:
                marks.setdefault(float(time), []).append(f"{verdict.theorem} {claim.name}")
    return [(time, ", ".join(names)) for time, names in sorted(marks.items())]
