"""Run and verify many scenarios, in several processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

from flockana.base.errors import ArgumentError, FlockanaError, SolverError, UnknownNameError
from flockana.base.interrupts import restore_interrupts
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.ensemble.batches import map_in_batches
from flockana.ensemble.executors import worker_pool
from flockana.report.page_data import Page, fixed_page, scenario_page
from flockana.report.section_request import MANY_LAWS, Section
from flockana.report.seed_surveys import Survey, SurveyResult, make_survey
from flockana.scenarios import scenario, scenarios
from flockana.theorems import theorem, theorems, verify

if TYPE_CHECKING:
    from flockana.report.comparison import ComparisonSection
    from flockana.report.stability import LinearisedFlocks

ERRATA = "errata"


@dataclass(frozen=True)
class Task:
    """Scenario or theorem to verify, as plain names and numbers that can be sent to another process."""

    name: str  # of the scenario or the theorem
    fixed: bool = False  # true for a theorem by itself
    seed: int = 0  # of the scenario's random start
    # theorems to check on the scenario; empty for all of its own and what its source reports
    only: tuple[str, ...] = ()
    figures: bool = True  # draw the scenario's figures


Work = Task | Survey | Section
Done: TypeAlias = "Page | SurveyResult | ComparisonSection | LinearisedFlocks"


def plan(name: str | None = None, *, seed: int = 0, figures: bool = True) -> tuple[Task, ...]:
    """Return the verification tasks for a name: scenarios in catalogue order, then theorems without a run."""
    if name in scenarios():
        return (Task(name, seed=seed, figures=figures),)
    if name is None:
        names: tuple[str, ...] = theorems()
    elif name == ERRATA:
        names = tuple(erratum for erratum in theorems() if erratum[0].isupper())
    elif name in theorems():
        names = (name,)
    else:
        raise UnknownNameError("scenario or theorem", name, (*scenarios(), *theorems(), ERRATA))
    fixed_tasks = [Task(t, fixed=True) for t in names if theorem(t).kind == "fixed"]
    runs = []
    for subject in scenarios() if len(fixed_tasks) < len(names) else ():  # to build them all takes a second
        shared_theorems = () if name is None else tuple(t for t in scenario(subject, seed).theorems if t in names)
        if name is None or shared_theorems:
            runs.append(Task(subject, seed=seed, only=shared_theorems, figures=figures))
    if not runs and not fixed_tasks:
        raise ArgumentError(
            f"{name} is checked on a {theorem(names[0]).kind}, and no scenario names it: "
            "use flockana.verify from Python, or --on with a saved run"
        )
    return (*runs, *fixed_tasks)


def check(task: Work) -> Done:
    """Run and verify one task of the report in this process; an error names the task."""
    try:
        with restore_interrupts():
            if isinstance(task, Survey):
                return make_survey(task)
            if isinstance(task, Section):
                return _section(task)
            if task.fixed:
                return fixed_page(verify(task.name))
            item = scenario(task.name, task.seed)
            run = ensure_uninterrupted(item.run())
            verdicts = tuple(item.verdict(name, run) for name in task.only) or item.verify(run)
            return scenario_page(item, run, verdicts, figures=task.figures)
    except FlockanaError as error:
        # one plain kind: errors with constructors of their own do not survive the way between processes
        raise FlockanaError(f"{task.name}: {error}") from None


def _section(task: Section) -> ComparisonSection | LinearisedFlocks:
    from flockana.report.comparison import comparison_section
    from flockana.report.stability import linearised_flocks

    return comparison_section(task.seed) if task.name == MANY_LAWS else linearised_flocks()


def check_all(
    tasks: Sequence[Work], *, jobs: int = 1, watch: Callable[[tuple[Work, ...]], None] = lambda under_way: None
) -> Iterator[Done]:
    """Run and verify tasks in parallel; yield results as completed, and raise on Ctrl-C."""
    # A task that ends its process (for want of memory, say) is named in an error, when all others are done.
    if not tasks:
        return
    lost_tasks: list[str] = []
    with worker_pool(jobs=min(jobs, len(tasks))) as workers:
        for batch in map_in_batches(_execution_order(tasks), _check_batch, workers, watch=watch):
            yield from (result for _, result in batch if result is not None)
            lost_tasks += [task.name for task, result in batch if result is None]
    if lost_tasks:
        raise SolverError(f"{', '.join(lost_tasks)}: the worker process ended; if memory is short, try --jobs 1")


def _execution_order(tasks: Sequence[Work]) -> list[Work]:
    """Return the report's tasks in the order of execution: one flow first, then maps, then the others."""
    # Two workers that compile for the first time then compile different kernels, the one an integrator with its checks,
    # the other the loops of maps, and seldom wait for each other (`flockana.jit`).
    subjects = {_subject(task) for task in tasks}.intersection(scenarios())
    of_maps = {subject for subject in subjects if scenario(subject).law.is_map}
    maps = [task for task in tasks if _subject(task) in of_maps]
    other_tasks = [task for task in tasks if _subject(task) not in of_maps]
    return [*other_tasks[:1], *maps, *other_tasks[1:]]


def _subject(task: Work) -> str:
    return task.scenario if isinstance(task, Survey) else task.name


def _check_batch(tasks: tuple[Work, ...]) -> tuple[Done, ...]:
    return tuple(map(check, tasks))
