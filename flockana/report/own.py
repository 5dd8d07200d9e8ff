"""Report on a flock, a scenario or a run of the user's own: the page that the catalogue's have."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from flockana.base.checks import ensure_seed
from flockana.base.errors import ArgumentError, format_value
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.trajectory import Trajectory
from flockana.report import build
from flockana.report.pages import ScenarioPage, scenario_page
from flockana.scenarios import Scenario
from flockana.scenarios.flock import Flock
from flockana.theorems import Theorem, Verdict, verify


def write_report(
    subject: Any, directory: str | os.PathLike[str], *, theorems: Sequence[str | Theorem] = (), seed: int = 0
) -> Path:
    """Write a page with the player, hypotheses, claims with margins, figures and energies of a flock or a run.

    Parameters
    ----------
    subject : Flock, Scenario or Trajectory
        What is run and judged; a run is judged as it is.
    directory : path
        Folder for ``index.html`` and ``verdicts.json``; made if it is not there.
    theorems : sequence of str or Theorem
        What is checked, own claims too (`flockana.claim`); by default all theorems about the law, or those that a
        scenario names.
    seed : int
        Of a flock whose start is drawn.

    Returns
    -------
    pathlib.Path
        The page.

    Raises
    ------
    ArgumentError
        If the subject is none of these.

    Examples
    --------
    >>> import tempfile
    >>> from flockana import Algorithm1, Flock
    >>> flock = Flock(Algorithm1(), [[0.0, 0.0], [8.0, 0.0]], t_span=(0.0, 1.0), name="a pair")
    >>> write_report(flock, tempfile.mkdtemp(), theorems=["energy"]).name
    'index.html'
    """
    started, seed = time.perf_counter(), ensure_seed(seed)
    page = own_page(subject, theorems=theorems, seed=seed)
    return build.write_report([page], directory, seed=seed, seconds=time.perf_counter() - started, of=page.name)


def own_page(
    subject: Any, *, theorems: Sequence[str | Theorem] = (), seed: int = 0, figures: bool = True
) -> ScenarioPage:
    """Return the page of a flock, a scenario or a run."""
    theorems = _ensure_theorems(theorems)
    if isinstance(subject, Trajectory):
        span, run = (float(subject.t[0]), float(subject.t[-1])), subject
        item = Scenario("run", "A run", "A run of the user's own.", run.law, run.q[0], run.p[0], span)
    elif isinstance(subject, (Flock, Scenario)):
        item = subject.scenario(seed) if isinstance(subject, Flock) else subject
        run = ensure_uninterrupted(item.run())
    else:
        raise ArgumentError(
            f"subject = {format_value(subject)}: expected a Flock, a Scenario or a run; a recording's verdicts are in "
            "verify(None, recording, law=law).to_dataframe(), those of many runs in the Dataset of ensemble(...)"
        )
    catalogued = isinstance(subject, Scenario) and not theorems
    verdicts = item.verify(run) if catalogued else _judge(item.name, run, theorems)
    own = {each.id: each for each in theorems if isinstance(each, Theorem)}
    return scenario_page(item, run, verdicts, figures=figures, own=own)


def _ensure_theorems(theorems: Any) -> tuple[str | Theorem, ...]:
    """Return theorems as a tuple; raise unless they are names or theorems."""
    given = (theorems,) if isinstance(theorems, (str, Theorem)) else theorems
    if not isinstance(given, Sequence) or not all(isinstance(each, (str, Theorem)) for each in given):
        got = format_value(theorems)
        raise ArgumentError(
            f"theorems = {got}: expected a list of names or own claims, such as ['os-1', fl.claim(...)]"
        )
    return tuple(given)


def _judge(name: str, run: Trajectory, theorems: Sequence[str | Theorem]) -> tuple[Verdict, ...]:
    if theorems:
        return tuple(verify(each, run, subject=name) for each in theorems)
    return tuple(verify(None, run, subject=name))
