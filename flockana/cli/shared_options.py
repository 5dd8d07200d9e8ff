"""Arguments and options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import typer

# what to start from
OWN = "FILE.py:NAME, a flock of yours"
CaseName = Annotated[str, typer.Argument(metavar="CASE", help=f"A scenario, a saved run (.nc), or {OWN}.")]
ScenarioName = Annotated[str, typer.Argument(metavar="SCENARIO", help=f"A scenario, or {OWN}.")]
SourceName = Annotated[
    str, typer.Argument(metavar="SOURCE", help=f"A scenario, a file, a builder with its size, or {OWN}.")
]
At = Annotated[
    str | None, typer.Option("--at", metavar="SOURCE", help="Positions of a law of FILE.py: a file or a builder.")
]
Start = Annotated[
    Literal["end", "start"] | None, typer.Option(help="Use the end of a scenario's run (by default), or its start.")
]
AnySeed = Annotated[int | None, typer.Option("--seed", min=0, help="Seed of a scenario's random start; by default 0.")]
Seed = Annotated[int, typer.Option(min=0, help="Seed of the random starts.")]
On = Annotated[str | None, typer.Option("--on", metavar="CASE", help=f"A scenario, a saved run (.nc), or {OWN}.")]
Time = Annotated[float | None, typer.Option(help="Time in a saved run; by default its end.")]

# the law, if the source has none
Algorithm = Annotated[
    int | None,
    typer.Option("--algorithm", "--law", min=1, max=2, help="Algorithm 1 (default) or 2, if the source has no law."),
]
Scale = Annotated[float | None, typer.Option("--d", help="Desired distance d, if the source has no law.")]
Range = Annotated[float | None, typer.Option("--r", help="Range r, if the source has no law; by default 1.2 d.")]

# processes, and what is printed and written
Jobs = Annotated[int | None, typer.Option(min=1, help="Processes; by default the number of cores.")]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON, and nothing else.")]
Plot = Annotated[Path | None, typer.Option("--plot", metavar="PICTURE", help="PNG, SVG or PDF to draw to.")]


def output(text: str, *, metavar: str = "FILE") -> Any:
    """Return the option -o of a command, with its help text."""
    return typer.Option("--output", "-o", metavar=metavar, help=text)
