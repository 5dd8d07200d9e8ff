"""`flockana run`: simulate a scenario and save the run."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

import typer

from flockana.base.errors import ArgumentError
from flockana.base.files import ensure_target
from flockana.cli.options import ScenarioName, Seed, output
from flockana.cli.show import show, show_files
from flockana.cli.status import INTERRUPTED, OK, UNEXPECTED


def run_command(
    name: ScenarioName,
    save_to: Annotated[Path, output("netCDF file to write.")],
    seed: Seed = 0,
    progress: Annotated[bool, typer.Option("--progress", help="Show a progress bar.")] = False,
) -> int:
    """Simulate a scenario and save the run, its law included, as netCDF."""
    from flockana.report.build import ensure_directory
    from flockana.report.console import run_table
    from flockana.scenarios import scenario

    item = scenario(name, seed)
    if os.path.isdir(save_to):
        raise ArgumentError(f"{save_to} is a folder: expected a file name, such as {save_to / name}.nc")
    ensure_target(save_to)
    ensure_directory(save_to.parent)
    run = item.run(progress=progress)
    console = show(f"{item.name}: {item.title}", run_table(run))
    console.print(f"{run.status}: {run.message}; {run.stats['seconds']:.2f} s", markup=False)
    run.save(save_to)  # last: what was computed is told even if it cannot be written
    show_files(saved=save_to)
    return {"complete": OK, "interrupted": INTERRUPTED}.get(run.status, UNEXPECTED)
