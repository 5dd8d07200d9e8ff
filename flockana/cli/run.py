"""`flockana run`: simulate a scenario and save the run."""

from __future__ import annotations

import os
from math import isfinite
from pathlib import Path
from typing import Annotated

import typer

from flockana.base.errors import ArgumentError
from flockana.base.files import ensure_folder_of, ensure_target
from flockana.cli.command_output import INTERRUPTED, OK, UNEXPECTED, show, show_files, show_json
from flockana.cli.shared_options import AsJson, CaseName, Seed, output


def run_command(
    name: CaseName,
    save_to: Annotated[Path, output("netCDF file to write.")],
    seed: Seed = 0,
    progress: Annotated[bool, typer.Option("--progress", help="Show a progress bar.")] = False,
    as_json: AsJson = False,
) -> int:
    """Simulate a case and save the run, its law included, as netCDF; a saved run is made anew from its start."""
    from flockana.cli.command_subject import read_flock
    from flockana.report.console import run_table

    item = read_flock(name, seed)
    if os.path.isdir(save_to):
        raise ArgumentError(f"{save_to} is a folder: expected a file name, such as {save_to / item.name}.nc")
    ensure_target(save_to)
    ensure_folder_of(save_to)
    run = item.run(progress=progress)
    if as_json:
        end_values = {key: [float(series[k]) for k in (0, -1)] for key, series in run.metrics().items()}
        finite = {key: [value if isfinite(value) else None for value in pair] for key, pair in end_values.items()}
        facts = {"scenario": item.name, "seed": seed, "status": run.status, "message": run.message}
        show_json({**facts, "t": [float(run.t[0]), float(run.t[-1])], "file": str(save_to), "metrics": finite})
    else:
        console = show(f"{item.name}: {item.title}", run_table(run))
        console.print(f"{run.status}: {run.message}; {run.stats['seconds']:.2f} s", markup=False)
    run.save(save_to)  # last: results are printed even if they cannot be written
    show_files(as_json, saved=save_to)
    return {"complete": OK, "interrupted": INTERRUPTED}.get(run.status, UNEXPECTED)
