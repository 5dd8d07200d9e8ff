"""How a command ends: its exit status, and what is wrong in one line."""

from __future__ import annotations

import typer

OK, BAD_INPUT, UNEXPECTED, INTERRUPTED = 0, 2, 3, 130


def complain(message: object) -> None:
    """Print what is wrong, in one line on the error stream."""
    typer.echo(f"flockana: {' '.join(str(message).split())}", err=True)
