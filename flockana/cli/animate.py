"""`flockana animate`: simulate a scenario and write a film of it."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from flockana.base.errors import ArgumentError
from flockana.base.progress import progress_bar
from flockana.cli.options import AsJson, Seed, output
from flockana.cli.show import INTERRUPTED, OK, UNEXPECTED, show_files, show_json


def animate_command(
    name: Annotated[str | None, typer.Argument(metavar="[SCENARIO|FILE]", help="A scenario or a saved run.")] = None,
    film: Annotated[Path, output("GIF or MP4 file to write.")] = ...,  # type: ignore[assignment]  # required
    on: Annotated[Path | None, typer.Option(metavar="FILE", help="Saved run to draw instead of simulating.")] = None,
    seed: Seed = 0,
    fps: Annotated[float, typer.Option(help="Frames per second.")] = 15.0,
    seconds: Annotated[float, typer.Option(help="Length of the film.")] = 10.0,
    ranges: Annotated[bool, typer.Option("--ranges", help="Draw circles at the range of interaction.")] = False,
    as_json: AsJson = False,
) -> int:
    """Simulate a scenario, or read a saved run, and write a film of it: GIF, or MP4 where ffmpeg is installed."""
    from flockana.dynamics.trajectory import Trajectory
    from flockana.plots.animation import animate, ensure_film, frame_count
    from flockana.scenarios import scenario

    file = on if on is not None else Path(name) if name is not None and name.endswith(".nc") else None
    if (name is None) == (on is None):
        raise ArgumentError("expected a scenario, or --on with a saved run (.nc), and not both")
    item = None if file is not None else scenario(str(name), seed)
    ensure_film(film, seconds=seconds, fps=fps)
    run = Trajectory.load(file) if item is None else item.run(progress=sys.stdout.isatty())  # type: ignore[arg-type]
    if item is not None and run.status == "interrupted":
        return INTERRUPTED
    with progress_bar(frame_count(seconds, fps)) as advance:
        look: dict[str, Any] = {"seconds": seconds, "fps": fps, "ranges": ranges}
        animate(run, film, **look, progress=lambda done, total: advance(done, "drawing"))
    subject = str(file) if item is None else item.name
    if as_json:
        show_json({"subject": subject, "status": run.status, "message": run.message, "file": str(film)})
    else:
        typer.echo(f"{subject}, {run.status}: {run.message}")
        show_files(written=film)
    return OK if run.status == "complete" else UNEXPECTED
