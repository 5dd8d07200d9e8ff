"""`flockana course`: write the lectures as notebooks."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from flockana.base.errors import ArgumentError
from flockana.cli.show import show_files
from flockana.cli.status import OK


def course_command(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder to write to.")],
    solutions: Annotated[bool, typer.Option("--solutions", help="With our solutions, and checks that grade.")] = False,
    self_study: Annotated[
        bool, typer.Option("--self-study", help="Without solutions, but with checks that grade, and so hold values.")
    ] = False,
) -> int:
    """Write the lectures as notebooks that run wherever flockana is installed; a student's by default.

    A student's copy checks the form of an answer only. Needs `pip install 'flockana[course]'`, which brings Jupyter.
    """
    if solutions and self_study:
        raise ArgumentError("--solutions and --self-study: expected one of them; leave the other out")
    version: Literal["student", "self-study", "solutions"] = (
        "solutions" if solutions else "self-study" if self_study else "student"
    )
    try:
        from flockana.course.build import write
    except ModuleNotFoundError as error:
        raise ArgumentError(f"{error.name} is not installed: pip install 'flockana[course]'") from error
    for written in write(folder, version):
        show_files(notebook=written)
    return OK
