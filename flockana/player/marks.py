"""Instants to mark in a player: those that the claims of verdicts point to."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from flockana.dynamics.trajectory import Trajectory
    from flockana.theorems import Verdict

Marks = list[tuple[float, str]]


def marks_of(
    run: Trajectory, verdicts: Iterable[Verdict], instants: Iterable[float] = (), *, named: str = "as in the source"
) -> Marks:
    """Instants of a run, in order, each once, with the claims whose witness it is.

    Examples
    --------
    >>> from flockana import scenario, verify
    >>> run = scenario("hexagon").run()
    >>> [name for _, name in marks_of(run, [verify("os-1", run)])]
    ['os-1 iii, os-1 iii-barrier', 'os-1 ii']
    """
    found: dict[float, list[str]] = {float(time): [named] for time in instants}
    for verdict in verdicts:
        for claim in verdict.claims:
            time = claim.witness.get("time") if isinstance(claim.witness, Mapping) else None
            if isinstance(time, float | int) and run.t[0] <= time <= run.t[-1]:
                found.setdefault(float(time), []).append(f"{verdict.theorem} {claim.name}")
    return [(time, ", ".join(names)) for time, names in sorted(found.items())]
