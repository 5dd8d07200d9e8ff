"""`flockana prove`: check the executable proofs of a checkout, and write certificates."""

from __future__ import annotations

import importlib
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from flockana.base.errors import ArgumentError
from flockana.base.progress import progress_bar
from flockana.cli.command_output import OK, UNEXPECTED, show_files, show_json
from flockana.cli.shared_options import AsJson, Jobs, output

if TYPE_CHECKING:
    from rich.table import Table

_STYLES = {"proved": "green", "failed": "bold red", "unknown": "yellow"}


def prove_command(
    wanted: Annotated[list[str] | None, typer.Argument(metavar="[ID]...", help="Proofs; by default all.")] = None,
    folder: Annotated[Path, output("Folder of the certificates.", metavar="DIR")] = Path("certificates"),
    jobs: Jobs = None,
    time_limit: Annotated[
        float | None, typer.Option(min=0.0, metavar="SECONDS", help="For each proof, instead of its own limit.")
    ] = None,
    as_json: AsJson = False,
) -> int:
    """Check the executable proofs, print what each proves, and write certificates (Markdown with LaTeX, and JSON).

    A proof whose steps all hold is `proved`. One with a step that does not hold is `FAILED`. One that takes too long,
    lacks a library or cannot decide is `unknown`, which does not mean false, and fails the run too.

    Exit status: 0 all proved, 2 bad input, 3 some proof failed or is unknown, 130 interrupted.
    """
    from flockana.base.value_checks import ensure_known
    from flockana.ensemble.worker_processes import cores
    from flockana.report.report_writer import ensure_directory

    proof, run, certificates = (_module(name) for name in ("proof", "run", "certificates"))
    proof_names = proof.names()
    for name in wanted or ():
        ensure_known("proof", name, proof_names)
    chosen_names = tuple(dict.fromkeys(wanted or proof_names))
    ensure_directory(folder)
    start_time = time.perf_counter()
    outcomes: list[Any] = []
    with progress_bar(len(chosen_names)) as advance:
        for outcome in run.check(
            chosen_names,
            jobs=jobs or cores(),
            time_limit=time_limit,
            watch=lambda under_way: advance(len(outcomes), ", ".join(under_way)),
        ):
            certificates.write(outcome, folder)
            outcomes.append(outcome)
    outcomes.sort(key=lambda outcome: chosen_names.index(outcome.id))
    certificates.write_index(outcomes, folder)
    if as_json:
        names = ("id", "title", "statement", "rigour", "status", "seconds")
        show_json([{name: getattr(outcome, name) for name in names} for outcome in outcomes])
    else:
        _show(outcomes, time.perf_counter() - start_time, folder)
    return OK if all(outcome.status == "proved" for outcome in outcomes) else UNEXPECTED


def _module(name: str) -> Any:
    """Import a module of the checkout's `proofs`, which is not part of the installed package.

    A course's folder has a `proofs` too, without what runs them, and may come first where modules are looked for.
    """
    for root in (Path(__file__).parents[2], Path.cwd()):
        if (root / "proofs" / "run.py").is_file():
            if sys.path[:1] != [str(root)]:
                sys.path.insert(0, str(root))
            return importlib.import_module(f"proofs.{name}")
    raise ArgumentError(
        "the proofs are not installed with flockana: clone its repository and run `flockana prove` in that folder"
    )


def _show(outcomes: Sequence[Any], seconds: float, folder: Path) -> None:
    from rich.console import Console

    console = Console(highlight=False, emoji=False)
    console.print(_table(outcomes))
    for outcome in outcomes:
        for objection in outcome.objections():
            console.print(f"  {outcome.id}: {objection}", style=_STYLES[outcome.status], markup=False)
    proved, steps = sum(o.status == "proved" for o in outcomes), sum(len(o.steps) for o in outcomes)
    console.print(f"{proved} of {len(outcomes)} proved, {steps} steps, in {seconds:.0f} s", markup=False)
    show_files(certificates=folder)


def _table(outcomes: Sequence[Any]) -> Table:
    from rich.table import Column
    from rich.text import Text

    from flockana.report.tables import column, headed_table

    other_columns = (column(name, right=name in ("steps", "time")) for name in ("rigour", "steps", "status", "time"))
    table = headed_table(Column("theorem, and what exactly is proved", ratio=1, overflow="fold"), *other_columns)
    for outcome in outcomes:
        title = f" · {outcome.title}" if outcome.title else ""
        table.add_row(
            Text.assemble((outcome.id, "bold"), title, f"\n{outcome.statement}\n"),
            outcome.rigour,
            str(len(outcome.steps)),
            Text(outcome.status.replace("failed", "FAILED"), style=_STYLES[outcome.status]),
            f"{outcome.seconds:.1f} s",
        )
    return table
