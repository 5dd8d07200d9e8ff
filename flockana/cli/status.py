"""Exit status of commands, and one-line errors."""

from __future__ import annotations

import typer

OK, BAD_INPUT, UNEXPECTED, INTERRUPTED = 0, 2, 3, 130


def print_error(message: object) -> None:
    """Print an error in one line on the error stream."""
    typer.echo(f"flockana: {' '.join(str(message).split())}", err=True)
