"""`flockana animate`: simulate a scenario and write a film of it."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from flockana.cli.command_output import INTERRUPTED, OK, UNEXPECTED, show_files, show_json
from flockana.cli.shared_options import AsJson, CaseName, Seed, output


def animate_command(
    name: CaseName,
    film: Annotated[Path, output("GIF or MP4 file to write.")],
    seed: Seed = 0,
    fps: Annotated[float, typer.Option(help="Frames per second.")] = 15.0,
    seconds: Annotated[float, typer.Option(help="Length of the film.")] = 10.0,
    ranges: Annotated[bool, typer.Option("--ranges", help="Draw circles at the range of interaction.")] = False,
    as_json: AsJson = False,
) -> int:
    """Simulate a scenario, or read a saved run, and write a film of it: GIF, or MP4 where ffmpeg is installed."""
    from flockana.cli.command_subject import read_case
    from flockana.dynamics.trajectory import Trajectory
    from flockana.plots.animation import animate, ensure_film

    case = read_case(name, seed)
    ensure_film(film, seconds=seconds, fps=fps)
    run = case if isinstance(case, Trajectory) else case.run(progress=sys.stdout.isatty())
    if run is not case and run.status == "interrupted":
        return INTERRUPTED
    animate(run, film, seconds=seconds, fps=fps, ranges=ranges)
    if as_json:
        show_json({"subject": name, "status": run.status, "message": run.message, "file": str(film)})
    else:
        typer.echo(f"{name}, {run.status}: {run.message}")
        show_files(written=film)
    return OK if run.status == "complete" else UNEXPECTED
