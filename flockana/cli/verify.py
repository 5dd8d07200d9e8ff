"""`flockana verify`: run scenarios, check theorems, print the verdicts, write the report."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from flockana.base.errors import ArgumentError, FlockanaError
from flockana.base.progress import progress_bar
from flockana.cli.command_output import BAD_INPUT, INTERRUPTED, OK, UNEXPECTED, show_files
from flockana.cli.command_subject import is_own, read_theorem
from flockana.cli.output_streams import in_output_encoding
from flockana.cli.shared_options import AnySeed, AsJson, Jobs, On, output
from flockana.cli.thread_limit import one_thread_for_matrices

if TYPE_CHECKING:
    from collections.abc import Sequence

    from flockana.report.page_data import Page
    from flockana.report.seed_surveys import Survey
    from flockana.report.statistics import StatisticsSection
    from flockana.report.verify_catalogue import Done, Work
    from flockana.theorems import Theorem


@one_thread_for_matrices()
def verify_command(
    name: Annotated[
        str | None,
        typer.Argument(
            help="A scenario, a theorem, 'errata', or FILE.py:NAME, a flock of yours, with --on a claim of yours; "
            "by default the whole catalogue.",
            metavar="[NAME]",
        ),
    ] = None,
    seed: AnySeed = None,
    on: On = None,
    report: Annotated[
        Path | None,
        output("Folder of the report; by default report, or report/NAME beside one on the catalogue.", metavar="DIR"),
    ] = None,
    no_report: Annotated[bool, typer.Option("--no-report", help="Write no report.")] = False,
    as_json: AsJson = False,
    seeds: Annotated[
        int | None,
        typer.Option(min=0, help="Seeds for success rates; 0 = none. By default as scenarios ask, on all of them."),
    ] = None,
    jobs: Jobs = None,
) -> int:
    """Run scenarios, check theorems, print the verdicts, write a report.

    With --on, NAME is the theorem to check on that case, or the scenario that a saved run is of.

    Exit status: 0 all as expected, 2 bad input, 3 some verdict differs from the expected, 130 interrupted.
    """
    from flockana.ensemble.worker_processes import cores
    from flockana.report.page_data import Page
    from flockana.report.report_writer import ensure_directory, report_folder, verdicts_json
    from flockana.report.seed_surveys import SurveyResult
    from flockana.report.statistics import gather

    started, name = time.perf_counter(), _id_of(name)
    if is_own(name) and on is None:
        return _verify_own(str(name), seed, None if no_report else report or Path("report"), seeds, as_json=as_json)
    if no_report and report is not None:
        raise ArgumentError(f"--output {report}: --no-report writes none; leave out one of them")
    if on is not None:
        _ensure_checkable(name, on, seeds, seed)
    checked = None if name is None else read_theorem(name)
    seed, name = seed or 0, getattr(checked, "id", name)
    tasks, many = ((), ()) if on is not None else _planned(name, seeds, seed, figures=not no_report)
    folder = None if no_report else ensure_directory(report or report_folder(name))
    saved = [] if on is None else [_case_page(checked, on, seed, not no_report)]
    results, code, failure = (saved, OK, None) if saved else _check_all(tasks, jobs or cores())
    pages = [result for result in results if isinstance(result, Page)]
    surveyed = [result for result in results if isinstance(result, SurveyResult)]
    if code == OK and any(page.surprises for page in pages):
        code = UNEXPECTED
    run: dict[str, Any] = {"seed": seed, "seconds": time.perf_counter() - started, "complete": code in (OK, UNEXPECTED)}
    run |= {"statistics": gather(many, surveyed, figures=not no_report)}
    written = None
    if folder is not None and (pages or run["complete"]):
        try:
            written = _write(folder, results, pages, of=name, **run)
        except FlockanaError as error:  # the verdicts are still printed
            failure = failure or error
    if as_json:
        typer.echo(in_output_encoding(verdicts_json(pages, **run)), nl=False)
    else:
        _print_verdicts(pages, run["statistics"], run["seconds"], written, name)
    if failure is not None:
        raise failure
    return code


def _verify_own(name: str, seed: int | None, folder: Path | None, seeds: int | None, *, as_json: bool) -> int:
    """Check every theorem about the law of a flock that a Python file defines."""
    from flockana.cli.command_subject import read_own
    from flockana.report.own_report import own_pages
    from flockana.report.report_writer import verdicts_json, write_report

    if seeds:
        raise ArgumentError(f"{name}: a flock in a file is run once; leave out --seeds, or use flockana ensemble")
    start_time = time.perf_counter()
    (page,) = own_pages(read_own(name), seed=seed or 0, figures=folder is not None)
    facts: Any = {"seed": seed or 0, "seconds": time.perf_counter() - start_time}
    written_report = None if folder is None else write_report([page], folder, of=page.name, **facts)
    if as_json:
        typer.echo(in_output_encoding(verdicts_json([page], **facts)), nl=False)
    else:
        _print_verdicts([page], None, facts["seconds"], written_report, name)
    return OK


def _id_of(name: str | None) -> str | None:
    """Return the id of a theorem named as in its source, such as "Theorem 3"; other names unchanged."""
    from flockana.base.errors import UnknownNameError
    from flockana.report.verify_catalogue import ERRATA
    from flockana.scenarios import scenarios
    from flockana.theorems import theorem, theorems

    if name is None or name in (*scenarios(), *theorems(), ERRATA):
        return name
    try:
        return theorem(name).id
    except UnknownNameError:
        return name  # refused where the tasks are planned, with scenarios among what is suggested


def _planned(
    name: str | None, seeds: int | None, seed: int, *, figures: bool
) -> tuple[tuple[Work, ...], tuple[Survey, ...]]:
    """Return the tasks of all scenarios to verify, and the surveys among them."""
    from flockana.report.section_request import DECAYS, LINEARISED, MANY_LAWS, MARGINS, Section
    from flockana.report.seed_surveys import surveys
    from flockana.report.verify_catalogue import plan

    tasks = plan(name, seed=seed, figures=figures)
    seed_surveys = surveys(name, seeds, seed=seed) if figures or seeds is not None else ()
    linear = (LINEARISED,) if name in (None, *DECAYS, *MARGINS) else ()
    sections = (Section(item, seed) for item in (*([MANY_LAWS] if name is None else []), *linear) if figures)
    return (*tasks, *sections, *seed_surveys), seed_surveys


def _write(folder: Path, results: Sequence[Done], pages: Sequence[Page], **run: Any) -> Path:
    from flockana.report.comparison import ComparisonSection
    from flockana.report.report_writer import write_report
    from flockana.report.stability import NO_FLOCKS, LinearisedFlocks

    comparison = next((result for result in results if isinstance(result, ComparisonSection)), None)
    flocks = next((result for result in results if isinstance(result, LinearisedFlocks)), NO_FLOCKS)
    return write_report(pages, folder, comparison=comparison, flocks=flocks, **run)


def _check_all(tasks: Sequence[Work], jobs: int) -> tuple[list[Done], int, FlockanaError | None]:
    """Return results in task order, exit status and error; completed results survive an error or Ctrl-C."""
    from flockana.report.verify_catalogue import check_all

    results: dict[str, Done] = {}
    code, failure = OK, None
    try:
        with progress_bar(len(tasks)) as advance:

            def watch(under_way: Sequence[Work]) -> None:
                advance(len(results), ", ".join(task.name for task in under_way))

            for result in check_all(tasks, jobs=jobs, watch=watch):
                results[result.name] = result
    except KeyboardInterrupt:
        code = INTERRUPTED
    except FlockanaError as error:
        code, failure = BAD_INPUT, error
    return [results[task.name] for task in tasks if task.name in results], code, failure


def _ensure_checkable(name: str | None, on: str, seeds: int | None, seed: int | None) -> None:
    from flockana.base.value_checks import ensure_known
    from flockana.report.verify_catalogue import ERRATA
    from flockana.scenarios import scenarios
    from flockana.theorems import theorem, theorems

    if seeds:
        raise ArgumentError(f"--seeds {seeds}: a case has one seed; leave out --seeds or --on")
    if seed is not None and on.endswith(".nc"):
        raise ArgumentError(f"--seed {seed}: a saved run has its start; leave out --seed or --on")
    if name is None:
        raise ArgumentError("--on CASE needs a NAME: the theorem to check, or the scenario that was run")
    if name == ERRATA:
        text = f"{name} --on CASE: a case is checked by one scenario or theorem"
        raise ArgumentError(f"{text}; name one, such as os-1")
    if is_own(name):
        return
    ensure_known("scenario or theorem", name, (*scenarios(), *theorems()))
    if name in theorems() and theorem(name).kind != "trajectory":
        raise ArgumentError(f"{name} is not about a run: expected a theorem about motion, such as os-1")


def _case_page(checked: str | Theorem | None, on: str, seed: int, figures: bool) -> Page:
    """Return the page with the verdict of one theorem on a scenario or a saved run."""
    from flockana.cli.command_subject import read_case
    from flockana.dynamics.trajectory import Trajectory
    from flockana.report.own_report import own_pages
    from flockana.report.page_data import scenario_page
    from flockana.scenarios import Scenario, scenario, scenarios
    from flockana.theorems import Theorem, verify

    run, path = read_case(on, seed), Path(on)
    assert checked is not None  # before
    name = checked if isinstance(checked, str) else ""
    claims = {checked.id: checked} if isinstance(checked, Theorem) else {}
    if not isinstance(run, Trajectory):
        if name in scenarios():
            raise ArgumentError(f"{name} --on {on}: expected a theorem to check on it, or a saved run of {name}")
        return own_pages(run, theorems=[checked], figures=figures)[0]
    if name in scenarios():
        item = scenario(name)
        if type(item.law) is not type(run.law) or item.q0.shape != run.q[0].shape:
            raise ArgumentError(f"{path} holds no run of {name}: its law or its number of agents differs")
        return scenario_page(item, run, item.verify(run), figures=figures)
    span = (float(run.t[0]), float(run.t[-1]))
    item = Scenario(path.name, "A saved run", f"Read from {path.name}.", run.law, run.q[0], run.p[0], span)
    return scenario_page(item, run, (verify(checked, run, subject=path.name),), figures=figures, own=claims)


def _print_verdicts(
    pages: Sequence[Page], statistics: StatisticsSection | None, seconds: float, written: Path | None, name: str | None
) -> None:
    from rich.console import Console

    from flockana.report.console import details, errata_table, statistics_table, summary, verdict_table
    from flockana.report.verify_catalogue import ERRATA

    console, is_full = Console(highlight=False, emoji=False), name not in (None, ERRATA)
    if is_full:
        for finding in (finding for page in pages for finding in page.findings):
            console.print(details(finding.verdict))
    console.print(verdict_table(pages, width=console.width))
    if name == ERRATA:
        console.print(errata_table(pages))
    for page in pages:
        for text in page.surprises:
            console.print(f"  {page.name}: {text}", style="bold red", markup=False)
    if statistics is not None and (is_full or written is None):
        console.print(statistics_table(statistics))
    elif statistics is not None:
        console.print("shares of runs over many seeds: in the report")
    console.print(summary(pages, seconds), markup=False)
    show_files(report=written)
