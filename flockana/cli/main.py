"""The command line: its commands, their errors in one line, and its exit status.

Heavy modules are imported inside the commands, so that ``--help`` and ``--version`` answer at once. Exit status: 0 all
as expected, 2 bad input, 3 some verdict differs from the expected, 130 interrupted.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated

import typer

from flockana._version import __version__
from flockana.base.errors import FlockanaError
from flockana.base.interrupts import interrupts_recognised
from flockana.cli import animate, catalogue, ensemble, equilibrium, falsify, lattice, prove, run, stability, verify
from flockana.cli.options import BAD_INPUT, INTERRUPTED, OK

if TYPE_CHECKING:
    from collections.abc import Sequence

app = typer.Typer(
    name="flockana", help="Do these flocks do what the theorems say?", no_args_is_help=False, add_completion=False
)


@app.callback(invoke_without_command=True)
def _flockana(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    if version:
        typer.echo(f"flockana {__version__}")
    elif context.invoked_subcommand is None:
        typer.echo(context.get_help())


for _command in (verify, run, animate, catalogue, lattice, equilibrium, stability, prove, ensemble, falsify):
    _command.register(app)


def _complain(message: str) -> None:
    typer.echo(f"flockana: {' '.join(message.split())}", err=True)


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit with its status."""
    try:
        with interrupts_recognised():
            code = app(args=None if arguments is None else list(arguments), standalone_mode=False)
    except FlockanaError as error:
        _complain(str(error))
        code = BAD_INPUT
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except Exception as error:
        # a usage error: typer raises its own kinds, or click's, depending on its version
        message = getattr(error, "format_message", None)
        if message is None:
            raise
        _complain(message())
        code = BAD_INPUT
    if code == INTERRUPTED:  # by us, or by typer, which returns this status itself when it sees Ctrl-C first
        _complain("interrupted")
    sys.exit(code or OK)
