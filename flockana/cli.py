"""The command line: `flockana verify | run | animate | scenarios | theorems`, and what `commands` registers.

Heavy modules are imported inside the commands, so that ``--help`` and ``--version`` answer at once. Exit status: 0 all
as expected, 2 bad input, 3 some verdict differs from the expected, 130 interrupted.
"""

from __future__ import annotations

import os
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from flockana._version import __version__
from flockana.commands import ensemble, equilibrium, falsify, lattice, prove, stability
from flockana.errors import ArgumentError, FlockanaError
from flockana.interrupts import interrupts_recognised

if TYPE_CHECKING:
    from collections.abc import Sequence

    from flockana.report.pages import Page
    from flockana.report.statistics import StatisticsSection, Survey, Surveyed
    from flockana.report.work import Task

OK, BAD_INPUT, UNEXPECTED, INTERRUPTED = 0, 2, 3, 130

app = typer.Typer(
    name="flockana", help="Do these flocks do what the theorems say?", no_args_is_help=False, add_completion=False
)

Seed = Annotated[int, typer.Option(min=0, help="Seed of the random starts.")]


@app.callback(invoke_without_command=True)
def _flockana(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    if version:
        typer.echo(f"flockana {__version__}")
    elif context.invoked_subcommand is None:
        typer.echo(context.get_help())


@app.command("verify")
def _verify(
    name: Annotated[
        str | None,
        typer.Argument(help="A scenario, a theorem, or 'errata'; by default the whole catalogue.", metavar="[NAME]"),
    ] = None,
    seed: Seed = 0,
    on: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Check a saved run instead of simulating; NAME says what to check."),
    ] = None,
    report: Annotated[Path, typer.Option(metavar="DIR", help="Folder of the report.")] = Path("report"),
    no_report: Annotated[bool, typer.Option("--no-report", help="Write no report.")] = False,
    json: Annotated[bool, typer.Option("--json", help="Print the verdicts as JSON, and nothing else.")] = False,
    seeds: Annotated[
        int | None,
        typer.Option(
            min=0,
            help="From how many seeds to tell shares of runs; 0 for no shares. By default as many as scenarios ask "
            "for, in a report on the whole catalogue only.",
            show_default=False,
        ),
    ] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Processes; by default the number of cores.", show_default=False)] = (
        os.cpu_count() or 1
    ),
) -> int:
    """Run scenarios, check theorems, print the verdicts, write a report.

    Exit status: 0 all as expected, 2 bad input, 3 some verdict differs from the expected, 130 interrupted.
    """
    from flockana.report.build import ensure_directory, verdicts_json, write_report
    from flockana.report.statistics import Surveyed, gather, surveys
    from flockana.report.work import plan

    started = time.perf_counter()
    if on is not None:
        tasks: tuple[Task, ...] = ()
        many: tuple[Survey, ...] = ()
        _ensure_checkable(name, seeds)
    else:
        tasks = plan(name, seed=seed, figures=not no_report)
        many = () if no_report and seeds is None else surveys(name, seeds, seed=seed)
    if not no_report:
        ensure_directory(report)
    results, code, failure = ([_saved(name, on, not no_report)], OK, None) if on else _perform((*tasks, *many), jobs)
    pages = [one for one in results if not isinstance(one, Surveyed)]
    statistics = gather(many, [one for one in results if isinstance(one, Surveyed)], figures=not no_report)
    if code == OK and any(page.surprises for page in pages):
        code = UNEXPECTED
    seconds, complete = time.perf_counter() - started, code in (OK, UNEXPECTED)
    written = None
    if not no_report and (pages or complete):
        written = write_report(pages, report, seed=seed, seconds=seconds, complete=complete, statistics=statistics)
    if json:
        text = verdicts_json(pages, seed=seed, seconds=seconds, complete=complete, statistics=statistics)
        typer.echo(text, nl=False)
    else:
        _print_verdicts(pages, statistics, seconds, written, in_full=name is not None and name != "errata")
    if failure is not None:
        raise failure
    return code


def _perform(tasks: Sequence[Task | Survey], jobs: int) -> tuple[list[Page | Surveyed], int, FlockanaError | None]:
    """Carry tasks out under a progress bar; what was done before an interrupt or an error is kept."""
    from rich.console import Console

    from flockana.report.console import progress_bar
    from flockana.report.work import perform

    done: dict[str, Page | Surveyed] = {}
    code, failure = OK, None
    try:
        with progress_bar(Console(stderr=True), len(tasks), enabled=True) as advance:
            for one in perform(tasks, jobs=jobs, watch=lambda names: advance(len(done), names)):
                done[one.name] = one
    except KeyboardInterrupt:
        code = INTERRUPTED
    except FlockanaError as error:
        code, failure = BAD_INPUT, error
    return [done[task.name] for task in tasks if task.name in done], code, failure


def _ensure_checkable(name: str | None, seeds: int | None) -> None:
    from flockana.errors import UnknownNameError
    from flockana.scenarios import scenarios
    from flockana.theorems import theorem, theorems

    if seeds:
        raise ArgumentError(f"--seeds {seeds}: a saved run has one seed; leave out --seeds or --on")
    if name is None:
        raise ArgumentError("--on FILE needs a NAME: the scenario that was run, or the theorem to check")
    if name not in (*scenarios(), *theorems()):
        raise UnknownNameError("scenario or theorem", name, (*scenarios(), *theorems()))
    if name in theorems() and theorem(name).kind != "trajectory":
        raise ArgumentError(f"{name} is not about a run: expected a theorem about motion, such as os-1")


def _saved(name: str | None, path: Path, figures: bool) -> Page:
    """Check a saved run, as one of its scenario or against one theorem."""
    from flockana.report.pages import ScenarioResult, page
    from flockana.scenarios import Scenario, scenario, scenarios
    from flockana.theorems import verify
    from flockana.trajectory import Trajectory

    run = Trajectory.load(path)
    assert name is not None  # checked before
    if name in scenarios():
        item = scenario(name)
        if type(item.law) is not type(run.law) or item.q0.shape != run.q[0].shape:
            raise ArgumentError(f"{path} holds no run of {name}: its law or its number of agents differs")
        return page(ScenarioResult(item, run, item.verify(run)), figures=figures)
    span = (float(run.t[0]), float(run.t[-1]))
    item = Scenario(path.name, "A saved run", f"Read from {path.name}.", run.law, run.q[0], run.p[0], span)
    return page(ScenarioResult(item, run, (verify(name, run, subject=path.name),)), figures=figures)


def _print_verdicts(
    pages: Sequence[Page],
    statistics: StatisticsSection | None,
    seconds: float,
    written: Path | None,
    *,
    in_full: bool,
) -> None:
    from rich.console import Console

    from flockana.report.console import details, statistics_table, summary, verdict_table

    console = Console(highlight=False)
    if in_full:
        for page in pages:
            for finding in page.findings:
                console.print(details(finding.verdict))
    console.print(verdict_table(pages))
    for page in pages:
        for text in page.surprises:
            console.print(f"  {page.name}: {text}", style="bold red", markup=False)
    if statistics is not None and (in_full or written is None):
        console.print(statistics_table(statistics))
    elif statistics is not None:
        console.print("shares of runs over many seeds: in the report")
    console.print(summary(pages, seconds), markup=False)
    if written is not None:
        console.print(f"report: {written}", markup=False, soft_wrap=True)


@app.command("run")
def _run(
    name: Annotated[str, typer.Argument(metavar="SCENARIO", help="Its name in the catalogue.")],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="netCDF file to write.")],
    seed: Seed = 0,
    progress: Annotated[bool, typer.Option("--progress", help="Show a progress bar.")] = False,
) -> int:
    """Simulate a scenario and save the run, its law included, as netCDF."""
    from rich.console import Console

    from flockana.report.build import ensure_directory
    from flockana.report.console import run_table
    from flockana.scenarios import scenario

    item = scenario(name, seed)
    if output.is_dir():
        raise ArgumentError(f"{output} is a folder: expected a file name, such as {output / name}.nc")
    ensure_directory(output.parent)
    run = item.run(progress=progress)
    run.save(output)
    console = Console(highlight=False)
    console.print(f"{item.name}: {item.title}", style="bold", markup=False)
    console.print(run_table(run))
    console.print(f"{run.status}: {run.message}; {run.stats['seconds']:.2f} s", markup=False)
    console.print(f"saved: {output}", markup=False, soft_wrap=True)
    return {"complete": OK, "interrupted": INTERRUPTED}.get(run.status, UNEXPECTED)


@app.command("animate")
def _animate(
    name: Annotated[str, typer.Argument(metavar="SCENARIO", help="Its name in the catalogue.")],
    output: Annotated[Path, typer.Option("--output", "-o", metavar="FILE", help="GIF or MP4 file to write.")],
    seed: Seed = 0,
    fps: Annotated[float, typer.Option(help="Frames per second.")] = 15.0,
    seconds: Annotated[float, typer.Option(help="Length of the film.")] = 10.0,
) -> int:
    """Simulate a scenario and write a film of it: GIF, or MP4 where ffmpeg is installed."""
    from rich.console import Console

    from flockana.plots.animation import animate, ensure_film, frame_count
    from flockana.report.build import ensure_directory
    from flockana.report.console import progress_bar
    from flockana.scenarios import scenario

    item = scenario(name, seed)
    ensure_directory(output.parent)
    ensure_film(output, seconds=seconds, fps=fps)
    run = item.run(progress=sys.stdout.isatty())
    if run.status == "interrupted":
        return INTERRUPTED
    with progress_bar(Console(stderr=True), frame_count(seconds, fps), enabled=True) as advance:
        animate(run, output, seconds=seconds, fps=fps, progress=lambda done, total: advance(done, ("drawing",)))
    typer.echo(f"{item.name}, {run.status}: {run.message}")
    typer.echo(f"written: {output}")
    return OK if run.status == "complete" else UNEXPECTED


@app.command("scenarios")
def _scenarios() -> None:
    """List the catalogue of published simulations."""
    from rich.console import Console

    from flockana.report.console import scenario_table

    Console(highlight=False).print(scenario_table())


@app.command("theorems")
def _theorems() -> None:
    """List the theorems and errata that can be checked."""
    from rich.console import Console

    from flockana.report.console import theorem_table

    Console(highlight=False).print(theorem_table())


for _command in (lattice, equilibrium, stability, prove, ensemble, falsify):
    _command.register(app)


def _complain(message: str) -> None:
    typer.echo(f"flockana: {' '.join(message.split())}", err=True)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit with its status.

    Parameters
    ----------
    arguments : sequence of str, optional
        Instead of those of the process.

    Raises
    ------
    SystemExit
        Always, with the exit status.
    """
    try:
        with interrupts_recognised():
            code = app(args=None if arguments is None else list(arguments), standalone_mode=False)
    except FlockanaError as error:
        _complain(str(error))
        code = BAD_INPUT
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except Exception as error:
        # a usage error: typer raises its own kinds, or click's, depending on its version
        message = getattr(error, "format_message", None)
        if message is None:
            raise
        _complain(message())
        code = BAD_INPUT
    if code == INTERRUPTED:  # by us, or by typer, which returns this status itself when it sees Ctrl-C first
        _complain("interrupted")
    sys.exit(code or OK)
