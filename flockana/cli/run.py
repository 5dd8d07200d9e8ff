"""`flockana run`: simulate a scenario and save the run."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from flockana.base.errors import ArgumentError
from flockana.cli.options import INTERRUPTED, OK, UNEXPECTED, Seed


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command("run")(_run)


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
