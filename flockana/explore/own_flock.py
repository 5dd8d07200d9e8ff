"""Explorer for a user's own flock."""

import asyncio
import tempfile
import threading
import webbrowser
from pathlib import Path
from typing import Any

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import TimeSpan, ensure_flag, ensure_known, ensure_seed
from flockana.dynamics.trajectory import Trajectory
from flockana.scenarios.flock import as_scenario, chosen
from flockana.scenarios.scenario import Scenario, scenarios

_LAST_PORT = 65535


def save_case(case: Scenario | Trajectory, folder: str) -> dict[str, str]:
    """Return the case that the explorer's page opens with: a run, or a scenario's run, saved in a folder."""
    run, name = (case, "run") if isinstance(case, Trajectory) else (case.run(), case.name.replace(" ", "-"))
    return {"kind": "file", "name": str(run.save(Path(folder) / f"{name}.nc"))}


def explore(
    scenario: Any = None,
    *,
    law: Any = None,
    q0: Any = None,
    p0: Any = None,
    t_span: TimeSpan | None = None,
    seed: int = 0,
    port: int = 0,
    browser: bool = True,
) -> None:
    """Open the explorer's page with a flock; Ctrl-C ends it, and in a notebook it lives as long as the kernel.

    Parameters
    ----------
    scenario : str, Scenario or Flock, optional
        What to explore.
    law, q0, p0, t_span : optional
        Instead of a scenario: the parts of a `Flock`.
    seed : int
        Seed of its start.
    port : int
        Port of the page; 0 picks a free one.
    browser : bool
        Open the page in the browser; its address is printed in any case.
    """
    try:
        from flockana.explore.page_server import Server, kept_token, serve
    except ModuleNotFoundError as error:
        raise ArgumentError(f"{error.name} is not installed: pip install tornado") from error
    flock = chosen(scenario, law=law, q0=q0, p0=p0, t_span=t_span)
    ensure_seed(seed)
    ensure_flag("browser", browser)
    if isinstance(port, bool) or not isinstance(port, int) or not 0 <= port <= _LAST_PORT:
        raise ArgumentError(f"port = {format_value(port)}: expected a whole number from 0 (any) to {_LAST_PORT}")
    folder = tempfile.TemporaryDirectory(prefix="flockana-")
    first_case = {"kind": "scenario", "name": flock}
    if isinstance(flock, str):
        ensure_known("scenario", flock, scenarios())
    else:
        first_case = save_case(as_scenario(flock, seed), folder.name)

    def opened(address: str) -> None:
        print(f"the flock is explored at {address}")  # noqa: T201  # a page without an address cannot be opened
        if browser:
            webbrowser.open(address)

    def serving() -> None:
        with folder:
            asyncio.run(serve(Server(kept_token(), first_case, 60.0), port, opened))

    try:
        asyncio.get_running_loop()
    except RuntimeError:
        serving()
    else:
        threading.Thread(target=serving, daemon=True).start()
