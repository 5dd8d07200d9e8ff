"""Report on a user's own flock, run, recording, verdicts or ensemble, in the catalogue's page format."""

from __future__ import annotations

import os
import time
from collections.abc import Sequence
from itertools import chain, count
from pathlib import Path
from typing import Any

import xarray

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import ensure_seed
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.trajectory import Trajectory
from flockana.recorded.recording import Recording
from flockana.report import report_writer
from flockana.report.page_data import ScenarioPage, scenario_page, verdicts_page
from flockana.report.statistics import section_of
from flockana.scenarios import Scenario
from flockana.scenarios.flock import Flock
from flockana.theorems import Theorem, Verdict, verify

_NONE: tuple[str | Theorem, ...] = ()  # theorems that were not given


def write_report(
    subject: Any,
    directory: str | os.PathLike[str],
    *,
    law: Any = None,
    theorems: Sequence[str | Theorem] = _NONE,
    seed: int = 0,
) -> Path:
    """Write a page with the player, hypotheses, claims with margins, figures and energies of a flock or a run.

    Parameters
    ----------
    subject : Flock, Scenario, Trajectory, Recording, Verdict, sequence of Verdict, or xarray.Dataset
        What is run and judged; a run or a recording is judged as it is. Of verdicts the page has hypotheses and claims,
        of an ensemble's dataset the shares of its runs, without a player.
    directory : path
        Folder for ``index.html`` and ``verdicts.json``; made if it is not there.
    law : Law, optional
        Of a recording: the law that it is held against.
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
        If the subject is none of these, or a recording has no law.

    Examples
    --------
    >>> import tempfile
    >>> from flockana import Algorithm1, Flock
    >>> flock = Flock(Algorithm1(), [[0.0, 0.0], [8.0, 0.0]], t_span=(0.0, 1.0), name="a pair")
    >>> write_report(flock, tempfile.mkdtemp(), theorems=["energy"]).name
    'index.html'
    """
    start_time, seed = time.perf_counter(), ensure_seed(seed)
    if isinstance(subject, xarray.Dataset):
        _ensure_unused("runs of an ensemble have", law=law, theorems=theorems)
        section = section_of(subject)
        return report_writer.write_report([], directory, seed=seed, statistics=section, of=section.entries[0].scenario)
    pages = own_pages(subject, law=law, theorems=theorems, seed=seed)
    return report_writer.write_report(
        pages, directory, seed=seed, seconds=time.perf_counter() - start_time, of=pages[0].name
    )


def own_pages(
    subject: Any, *, law: Any = None, theorems: Sequence[str | Theorem] = _NONE, seed: int = 0, figures: bool = True
) -> list[ScenarioPage]:
    """Return the page of a flock, scenario, run or recording, or the pages of verdicts by subject."""
    verdicts: tuple[Verdict, ...] = (subject,) if isinstance(subject, Verdict) else subject
    if isinstance(verdicts, (list, tuple)) and verdicts and all(isinstance(value, Verdict) for value in verdicts):
        _ensure_unused("verdicts have", law=law, theorems=theorems)
        return [verdicts_page(name, value) for name, value in _by_subject(verdicts).items()]
    theorems = _ensure_theorems(theorems)
    if isinstance(subject, Recording):
        if law is None:
            raise ArgumentError("a recording without a law: expected law=..., the law that it is held against")
        subject.ensure_complete("a report")
        run, evidence = subject.trajectory(law), subject
    else:
        _ensure_unused("flocks and runs have", law=law)
        run = evidence = subject
    if isinstance(run, Trajectory):
        name = "run" if run is subject else "recording"
        span = (float(run.t[0]), float(run.t[-1]))
        item = Scenario(name, f"A {name}", f"A {name} of the user's own.", run.law, run.q[0], run.p[0], span)
    elif isinstance(subject, (Flock, Scenario)):
        item = subject.scenario(seed) if isinstance(subject, Flock) else subject
        run = evidence = ensure_uninterrupted(item.run())
    else:
        raise ArgumentError(
            f"subject = {format_value(subject)}: expected a Flock, a Scenario, a run, a recording with law=..., "
            "verdicts, or what ensemble(...) returned"
        )
    catalogued = isinstance(subject, Scenario) and not theorems
    verdicts = item.verify(run) if catalogued else _judge(item.name, evidence, law, theorems)
    own_theorems = {value.id: value for value in theorems if isinstance(value, Theorem)}
    return [scenario_page(item, run, verdicts, figures=figures, own=own_theorems)]


def _by_subject(verdicts: Sequence[Verdict]) -> dict[str, tuple[Verdict, ...]]:
    """Return verdicts grouped by subject; a repeated theorem on one subject begins a new group."""
    pages: dict[str, dict[str, Verdict]] = {}
    for verdict in verdicts:
        name = verdict.subject or "verdicts"
        names = chain([name], (f"{name} ({k})" for k in count(2)))
        free_key = next(key for key in names if verdict.theorem not in pages.get(key, {}))
        pages.setdefault(free_key, {})[verdict.theorem] = verdict
    return {name: tuple(page.values()) for name, page in pages.items()}


def _ensure_unused(what: str, **given: Any) -> None:
    """Raise on an argument that this kind of report does not use."""
    for name in (name for name, value in given.items() if value is not None and value is not _NONE):
        raise ArgumentError(f"{name} = {format_value(given[name])}: {what} their own; leave {name} out")


def _ensure_theorems(theorems: Any) -> tuple[str | Theorem, ...]:
    """Return theorems as a tuple; raise unless they are names or theorems."""
    names = (theorems,) if isinstance(theorems, (str, Theorem)) else theorems
    if not isinstance(names, Sequence) or not all(isinstance(name, (str, Theorem)) for name in names):
        value_text = format_value(theorems)
        raise ArgumentError(
            f"theorems = {value_text}: expected a list of names or own claims, such as ['os-1', fl.claim(...)]"
        )
    return tuple(names)


def _judge(name: str, seen: Any, law: Any, theorems: Sequence[str | Theorem]) -> tuple[Verdict, ...]:
    if theorems:
        return tuple(verify(theorem, seen, law=law, subject=name) for theorem in theorems)
    return tuple(verify(None, seen, law=law, subject=name))
