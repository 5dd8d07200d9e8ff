"""Arguments and options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

import typer

# what to start from
ScenarioName = Annotated[str, typer.Argument(metavar="SCENARIO", help="Its name in the catalogue.")]
SourceName = Annotated[str, typer.Argument(metavar="SOURCE", help="A scenario, a file, or a builder with its size.")]
Start = Annotated[
    Literal["end", "start"] | None,
    typer.Option(help="Of a scenario: begin at the end of its run (by default), or at its start.", show_default=False),
]
AnySeed = Annotated[
    int | None,
    typer.Option("--seed", min=0, help="Seed of a scenario's random start; by default 0.", show_default=False),
]
Seed = Annotated[int, typer.Option(min=0, help="Seed of the random starts.")]
Time = Annotated[float | None, typer.Option(help="Time in a saved run; by default its end.")]

# the law, where none comes with the positions
Algorithm = Annotated[
    int | None,
    typer.Option("--algorithm", "--law", min=1, max=2, help="Where no law comes with the positions; by default 1."),
]
Scale = Annotated[float | None, typer.Option("--d", help="Scale, where no law comes with the positions.")]
Range = Annotated[float | None, typer.Option("--r", help="Range, likewise; by default 1.2 d.")]

# who works, and what is printed and written
Jobs = Annotated[int | None, typer.Option(min=1, help="Processes; by default the number of cores.", show_default=False)]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON, and nothing else.")]
Drawing = Annotated[Path | None, typer.Option(metavar="PICTURE", help="PNG, SVG or PDF to draw to.")]


def output(text: str, *, metavar: str = "FILE") -> Any:
    """Return the option -o of a command, with its help text."""
    return typer.Option("--output", "-o", metavar=metavar, help=text)
