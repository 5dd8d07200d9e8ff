"""`flockana explore`: a page on this machine where a flock is chosen, dragged and changed."""

from __future__ import annotations

from typing import Annotated

import typer

from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.cli.command_output import OK
from flockana.cli.shared_options import OWN


def explore_command(
    name: Annotated[
        str,
        typer.Argument(metavar="[CASE]", help=f"A scenario, law, saved run (.nc), counterexample (.json), or {OWN}."),
    ] = "paper-flocking",
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port; 0 picks a free one.")] = 8642,
    seconds: Annotated[float, typer.Option(help="Longest computing time of a run; a longer one is refused.")] = 60.0,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Print the address, open nothing.")] = False,
) -> int:
    """Open an interactive page for building, dragging and changing a flock.

    The page is reachable by this user on this machine only: the server listens on the loopback address, and the page's
    address holds a token, kept in ~/.flockana so that an open page finds a restarted server. Ctrl-C ends it. Needs
    `pip install 'flockana[explore]'`.
    """
    import asyncio
    import tempfile
    import webbrowser

    from flockana.base.value_checks import ensure_positive

    ensure_positive("--seconds", seconds)
    folder = tempfile.TemporaryDirectory(prefix="flockana-")
    first_case = _first(name, folder.name)
    try:
        from flockana.explore.page_server import Server, kept_token, serve
    except ModuleNotFoundError as error:
        raise ArgumentError(f"{error.name} is not installed: pip install 'flockana[explore]'") from error

    def opened(address: str) -> None:
        typer.echo(f"{name} is explored at\n{address}\nCtrl-C ends it")
        if not no_browser:
            webbrowser.open(address)

    with folder:
        asyncio.run(serve(Server(kept_token(), first_case, seconds), port, opened))
    return OK


def _first(name: str, folder: str) -> dict[str, str]:
    """Return the kind and name of the scenario, law, run or flock that `flockana explore` opens."""
    import os
    from pathlib import Path

    from flockana.cli.command_subject import is_own, read_case
    from flockana.explore.own_flock import save_case
    from flockana.explore.page_starts import FILES, from_file, law_names
    from flockana.scenarios import scenarios

    if is_own(name):
        return save_case(read_case(name), folder)
    if name in scenarios():
        return {"kind": "scenario", "name": name}
    if name in law_names():
        return {"kind": "law", "name": name}
    if Path(name).suffix not in FILES and not os.path.exists(name):
        raise UnknownNameError("scenario, law or file", name, (*scenarios(), *law_names()))
    path = str(Path(name).resolve())
    from_file(path)
    return {"kind": "file", "name": path}
