"""Command line: commands, one-line errors and exit status.

Heavy modules are imported inside the commands, so that ``--help`` and ``--version`` answer at once. Exit status: 0 all
as expected, 2 bad input, 3 some verdict differs from the expected, 130 interrupted.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Annotated, Any

import typer

from flockana._version import __version__
from flockana.base.errors import FlockanaError, UnknownNameError
from flockana.base.garbage import freeze_gc, relaxed_gc
from flockana.base.interrupts import restore_interrupts
from flockana.cli.animate import animate_command
from flockana.cli.catalogue import scenarios_command, theorems_command
from flockana.cli.check import check_command
from flockana.cli.command import Command
from flockana.cli.course import course_command
from flockana.cli.ensemble import ensemble_command
from flockana.cli.equilibrium import equilibrium_command
from flockana.cli.explore import explore_command
from flockana.cli.export import export_command
from flockana.cli.falsify import falsify_command
from flockana.cli.groups import Groups, example
from flockana.cli.home import prepare_home
from flockana.cli.lattice import lattice_command
from flockana.cli.observe import observe_command
from flockana.cli.prove import prove_command
from flockana.cli.run import run_command
from flockana.cli.stability import stability_command
from flockana.cli.status import BAD_INPUT, INTERRUPTED, OK, print_error
from flockana.cli.streams import finish_output, prepare_output
from flockana.cli.verify import verify_command

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

_NAME = "flockana"
_COMMANDS: dict[str, Callable[..., Any]] = {
    "verify": verify_command,
    "run": run_command,
    "animate": animate_command,
    "scenarios": scenarios_command,
    "theorems": theorems_command,
    "lattice": lattice_command,
    "equilibrium": equilibrium_command,
    "stability": stability_command,
    "prove": prove_command,
    "check": check_command,
    "ensemble": ensemble_command,
    "falsify": falsify_command,
    "export": export_command,
    "course": course_command,
    "explore": explore_command,
    "observe": observe_command,
}


def _flockana(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False,
) -> None:
    if version:
        typer.echo(f"flockana {__version__}")
    elif context.invoked_subcommand is None:
        typer.echo(context.get_help())


def _app(asked: str) -> typer.Typer:
    """Return the program with the requested command only, or with all."""
    app = typer.Typer(
        name=_NAME,
        cls=Groups,
        help="Do these flocks do what the theorems say?",
        no_args_is_help=False,
        rich_markup_mode=None,  # its tables break sentences, and name types that say nothing
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(invoke_without_command=True)(_flockana)
    for name in [asked] if asked in _COMMANDS else _COMMANDS:
        app.command(name, cls=Command, epilog=f"Example: {example(name)}")(_COMMANDS[name])
    return app


def _asked(arguments: Sequence[str]) -> str:
    """Return the requested command or global option, or nothing; raise on an unknown command."""
    first = arguments[0] if arguments else ""
    if arguments and not first.startswith("-") and first not in _COMMANDS:
        raise UnknownNameError("command", first, _COMMANDS)
    return first


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit with its status."""
    prepare_output()
    prepare_home()
    try:
        with restore_interrupts(), relaxed_gc():
            given = list(sys.argv[1:] if arguments is None else arguments)
            code = _app(_asked(given))(args=given, prog_name=_NAME, standalone_mode=False)
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
