"""`flockana check`: verify a certificate without the code that made it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from flockana.cli.command_output import OK, UNEXPECTED, print_error, show_json
from flockana.cli.shared_options import AsJson


def check_command(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A certificate (.json).")], as_json: AsJson = False
) -> int:
    """Verify a certificate, such as a basin's, and print what it proves, step by step.

    The checker shares only the scalar functions in ball arithmetic with the prover. It rejects a file that was changed,
    or that claims more than it proves.

    Exit status: 0 it holds, 2 bad input, 3 it is rejected, 130 interrupted.
    """
    from dataclasses import asdict

    from flockana.certified.certificate_check import RejectedError, check_certificate

    try:
        result = check_certificate(file)
    except RejectedError as error:
        print_error(f"{file} is rejected: {error}")
        return UNEXPECTED
    if as_json:
        show_json(asdict(result))
        return OK
    head = f"{file}: a certificate of kind {result.kind} that holds\n\n{result.statement}\n"
    typer.echo("\n  ".join([f"{head}\nVerified:", *result.steps]))
    typer.echo("\n  ".join(["Not checked by machine:", *result.prose]))
    return OK
