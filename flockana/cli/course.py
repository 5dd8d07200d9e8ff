"""`flockana course`: write the lectures as notebooks."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from flockana.base.errors import ArgumentError
from flockana.cli.command_output import OK, show_json
from flockana.cli.shared_options import AsJson


def course_command(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder to write to.")],
    solutions: Annotated[bool, typer.Option("--solutions", help="With solutions, and checks that grade.")] = False,
    self_study: Annotated[bool, typer.Option("--self-study", help="No solutions; checks that grade.")] = False,
    slides: Annotated[bool, typer.Option("--slides", help="Slides for `nbconvert --to slides --execute`.")] = False,
    grader: Annotated[
        Literal["otter", "nbgrader"] | None,
        typer.Option(help="Assignments with hidden tests, for `otter assign` or nbgrader's folder source."),
    ] = None,
    address: Annotated[
        str, typer.Option(help="Source to install flockana from in notebooks: git+https://HOST/PATH.")
    ] = "",
    student: Annotated[
        str | None, typer.Option(metavar="NAME", help="Exercises with this student's own numbers; solutions follow.")
    ] = None,
    as_json: AsJson = False,
) -> int:
    """Write the lectures as notebooks that run wherever flockana is installed; a student's by default.

    A student's copy checks the form of an answer only. If a file in DIR differs from what would be written, such as a
    notebook with answers, nothing is written; files that are the same are kept.

    Needs `pip install 'flockana[course]'`, which brings Jupyter.
    """
    if solutions + self_study + slides + (grader is not None) > 1:
        raise ArgumentError("--solutions, --self-study, --slides, --grader: expected one of them; leave the others out")
    if student is not None and (slides or not student.strip()):
        raise ArgumentError(f"--student {student!r}: expected a name, and exercises to number; slides have none")
    try:
        from flockana.course.build import write
        from flockana.course.export import write_for
        from flockana.course.slides import write_slides
    except ModuleNotFoundError as error:
        raise ArgumentError(f"{error.name} is not installed: pip install 'flockana[course]'") from error
    from flockana.report.report_writer import ensure_directory

    ensure_directory(folder)
    if grader is not None:
        notebooks = write_for(folder, grader, student=student or "")
    elif slides:
        notebooks = write_slides(folder)
    else:
        version = "solutions" if solutions else "self-study" if self_study else "student"
        notebooks = write(folder, version, address=address, student=student or "")
    if as_json:
        show_json({"notebooks": [str(path) for path in notebooks]})
    else:
        typer.echo("\n".join(f"notebook: {path}" for path in notebooks))
    return OK
