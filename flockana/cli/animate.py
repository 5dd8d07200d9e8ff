"""`flockana animate`: simulate a scenario and write a film of it."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from flockana.base.files import ensure_target
from flockana.base.progress import progress_bar
from flockana.cli.options import ScenarioName, Seed, output
from flockana.cli.show import show_files
from flockana.cli.status import INTERRUPTED, OK, UNEXPECTED


def animate_command(
    name: ScenarioName,
    film: Annotated[Path, output("GIF or MP4 file to write.")],
    seed: Seed = 0,
    fps: Annotated[float, typer.Option(help="Frames per second.")] = 15.0,
    seconds: Annotated[float, typer.Option(help="Length of the film.")] = 10.0,
    ranges: Annotated[bool, typer.Option("--ranges", help="Draw circles at the range of interaction.")] = False,
) -> int:
    """Simulate a scenario and write a film of it: GIF, or MP4 where ffmpeg is installed."""
    from flockana.plots.animation import animate, ensure_film, frame_count
    from flockana.report.build import ensure_directory
    from flockana.scenarios import scenario

    item = scenario(name, seed)
    ensure_target(film)
    ensure_directory(film.parent)
    ensure_film(film, seconds=seconds, fps=fps)
    run = item.run(progress=sys.stdout.isatty())
    if run.status == "interrupted":
        return INTERRUPTED
    with progress_bar(frame_count(seconds, fps)) as advance:
        animate(
            run, film, seconds=seconds, fps=fps, ranges=ranges, progress=lambda done, total: advance(done, "drawing")
        )
    typer.echo(f"{item.name}, {run.status}: {run.message}")
    show_files(written=film)
    return OK if run.status == "complete" else UNEXPECTED
