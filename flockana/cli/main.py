"""Command line: commands, one-line errors and exit status.

Heavy modules are imported inside the commands, so that ``--help`` and ``--version`` answer at once. Exit status: 0 all
as expected, 2 bad input, 3 some verdict differs from the expected, 130 interrupted.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Annotated, Any

import typer

from flockana._version import __version__
from flockana.base.errors import FlockanaError, UnknownNameError
from flockana.base.garbage_collection import freeze_gc, relaxed_gc
from flockana.base.interrupts import restore_interrupts
from flockana.cli.command import Command
from flockana.cli.command_output import BAD_INPUT, INTERRUPTED, OK, print_error
from flockana.cli.matplotlib_folder import prepare_home
from flockana.cli.output_streams import finish_output, prepare_output
from flockana.cli.root_help import EXAMPLES, Groups

_NAME = "flockana"
_CATALOGUES = ("scenarios", "theorems")  # commands that share a module; every other has one of its name


def _flockana(
    context: typer.Context, version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False
) -> None:
    if version:
        typer.echo(f"flockana {__version__}")
    elif context.invoked_subcommand is None:
        typer.echo(context.get_help())


def _command(name: str) -> Any:
    module = import_module(f"flockana.cli.{'catalogue' if name in _CATALOGUES else name}")
    return getattr(module, f"{name}_command")


def _app(asked: str) -> typer.Typer:
    """Return the command-line program with the requested command alone, or with all."""
    app = typer.Typer(
        name=_NAME,
        cls=Groups,
        help="Do these flocks do what the theorems say?",
        no_args_is_help=False,
        rich_markup_mode=None,  # its tables break sentences, and name types that say nothing
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(invoke_without_command=True)(_flockana)
    for name in [asked] if asked in EXAMPLES else EXAMPLES:
        app.command(name, cls=Command, epilog=f"Example: {EXAMPLES[name]}")(_command(name))
    return app


def _asked(arguments: Sequence[str]) -> str:
    """Return the requested command or global option from the arguments; raise on an unknown command."""
    first_argument = arguments[0] if arguments else ""
    if arguments and not first_argument.startswith("-") and first_argument not in EXAMPLES:
        raise UnknownNameError("command", first_argument, EXAMPLES)
    return first_argument


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit with its status."""
    prepare_output()
    prepare_home()
    try:
        with restore_interrupts(), relaxed_gc():
            words = list(sys.argv[1:] if arguments is None else arguments)
            code = _app(_asked(words))(args=words, prog_name=_NAME, standalone_mode=False)
            if arguments is None:
                freeze_gc()
        finish_output()
    except FlockanaError as error:
        print_error(error)
        code = BAD_INPUT
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except Exception as error:
        # a usage error: typer raises its own kinds, or click's, depending on its version
        message = getattr(error, "format_message", None)
        if message is None:
            raise
        print_error(message())
        code = BAD_INPUT
    if code == INTERRUPTED:  # by us, or by typer, which returns this status itself when it sees Ctrl-C first
        print_error("interrupted")
    sys.exit(code or OK)
