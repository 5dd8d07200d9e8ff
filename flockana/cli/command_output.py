"""Command output: tables or JSON, files written, one-line errors, exit status."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from flockana.cli.output_streams import in_output_encoding

if TYPE_CHECKING:
    from rich.console import Console, RenderableType


OK, BAD_INPUT, UNEXPECTED, INTERRUPTED = 0, 2, 3, 130


def show(title: str, *tables: RenderableType) -> Console:
    """Print a title in bold, and tables under it; return the console."""
    from rich.console import Console

    console = Console(highlight=False, emoji=False)
    console.print(title, style="bold", markup=False)
    for table in tables:
        console.print(table)
    return console


def show_facts(facts: Any, as_json: bool, title: str, rows: Any, *more: RenderableType) -> None:
    """Print facts as JSON, or as a title with a table and lines below it."""
    from flockana.report.tables import fact_table

    if as_json:
        show_json(facts)
    else:
        show(title, fact_table(rows), *more)


def show_lines(text: str) -> None:
    """Print lines unwrapped; letters missing in the encoding are escaped."""
    from rich.console import Console

    Console(highlight=False, emoji=False).print(text, markup=False, soft_wrap=True)


def show_files(quiet: bool = False, /, **files: Path | None) -> None:
    """Print the path of each file written, with its description."""
    for kind, path in files.items():
        if path is not None and not quiet:
            typer.echo(f"{kind}: {path}")


def show_json(data: Any) -> None:
    """Print plain data as JSON."""
    typer.echo(in_output_encoding(json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False)))


def print_error(message: object) -> None:
    """Print an error in one line on the error stream."""
    typer.echo(f"flockana: {' '.join(str(message).split())}", err=True)
