"""Run and verify many scenarios, in processes of their own where that pays."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass

from flockana.base.errors import ArgumentError, FlockanaError, SolverError, UnknownNameError
from flockana.base.interrupts import interrupts_recognised
from flockana.ensemble.processes import ProcessPool
from flockana.report.pages import FixedResult, Page, ScenarioResult, page
from flockana.report.statistics import Survey, Surveyed, carry_out
from flockana.scenarios import scenario, scenarios
from flockana.theorems import theorem, theorems, verify

ERRATA = "errata"
_TICK = 0.2  # seconds between looks at what is running


@dataclass(frozen=True)
class Task:
    """A scenario to run and verify, or a theorem to check by itself; names and numbers only, so it can be sent.

    Parameters
    ----------
    name : str
        Of the scenario or the theorem.
    fixed : bool
        True for a theorem by itself.
    seed : int
        Of the scenario's random start.
    only : tuple of str
        Theorems to check on the scenario; empty for all of its own and what its source reports.
    figures : bool
        Draw the scenario's figures.
    """

    name: str
    fixed: bool = False
    seed: int = 0
    only: tuple[str, ...] = ()
    figures: bool = True


def plan(name: str | None = None, *, seed: int = 0, figures: bool = True) -> tuple[Task, ...]:
    """What to do for a name: scenarios in the order of the catalogue, then theorems by themselves.

    Examples
    --------
    >>> plan("E8")
    (Task(name='E8', fixed=True, seed=0, only=(), figures=True),)
    """
    if name in scenarios():
        return (Task(name, seed=seed, figures=figures),)
    if name is None:
        wanted: tuple[str, ...] = theorems()
    elif name == ERRATA:
        wanted = tuple(one for one in theorems() if one[0].isupper())
    elif name in theorems():
        wanted = (name,)
    else:
        raise UnknownNameError("scenario or theorem", name, (*scenarios(), *theorems(), ERRATA))
    runs = []
    for one in scenarios():
        shared = tuple(t for t in scenario(one, seed).theorems if t in wanted)
        if name is None or shared:
            runs.append(Task(one, seed=seed, only=() if name is None else shared, figures=figures))
    fixed = [Task(one, fixed=True) for one in wanted if theorem(one).kind == "fixed"]
    if not runs and not fixed:
        raise ArgumentError(
            f"{name} is checked on a {theorem(wanted[0]).kind}, and no scenario names it: "
            "use flockana.verify from Python, or --on with a saved run"
        )
    return (*runs, *fixed)


def do(task: Task | Survey) -> Page | Surveyed:
    """Carry out one task in this process."""
    with interrupts_recognised():
        if isinstance(task, Survey):
            return carry_out(task)
        if task.fixed:
            return page(FixedResult(theorem(task.name), verify(task.name)))
        item = scenario(task.name, task.seed)
        run = item.run()
        if run.status == "interrupted":
            raise KeyboardInterrupt
        verdicts = tuple(verify(one, run, subject=item.name) for one in task.only) or item.verify(run)
        return page(ScenarioResult(item, run, verdicts), figures=task.figures)


def perform(
    tasks: Sequence[Task | Survey], *, jobs: int = 1, watch: Callable[[tuple[str, ...]], None] = lambda names: None
) -> Iterator[Page | Surveyed]:
    """Carry out tasks, yielding what each finds as it is done; on Ctrl-C, stop what runs and raise."""
    jobs = min(jobs, len(tasks))
    if jobs <= 1:
        for task in tasks:
            watch((task.name,))
            yield do(task)
        return
    pool = ProcessPool(jobs)
    try:
        with _explained():
            futures = {pool.submit(_do_for_parent, task): task.name for task in tasks}
        pending = set(futures)
        while pending:
            done, pending = wait(pending, timeout=_TICK, return_when=FIRST_COMPLETED)
            for future in done:
                with _explained():
                    result = future.result()
                yield result
            watch(tuple(futures[f] for f in futures if f in pending and f.running())[:jobs])
        pool.shutdown()
    except BaseException:
        pool.stop()
        raise


def _do_for_parent(task: Task | Survey) -> Page | Surveyed:
    try:
        return do(task)
    except FlockanaError as error:
        # sent as one plain kind: errors with constructors of their own do not survive the way between processes
        raise FlockanaError(f"{task.name}: {error}") from None


@contextmanager
def _explained() -> Iterator[None]:
    """A pool that broke, which a submission may be the first to meet, as our error with a remedy."""
    try:
        yield
    except BrokenProcessPool as error:
        raise SolverError("a worker process died; if memory is short, try --jobs 1") from error
