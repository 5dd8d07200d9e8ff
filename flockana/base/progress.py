"""A progress bar on the terminal's error stream, or in a notebook; elsewhere there is none."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def progress_bar(
    total: float, *, enabled: bool = True, counted: bool = True, steady: bool = False
) -> Iterator[Callable[[float, str], None]]:
    """Show a bar; gives a function to call with how much of the total is done, and with a text beside the bar.

    `counted` shows both numbers, for a total of runs or tasks; `steady` shows the time left and, if counted, the rate,
    for work of which each part takes about as long.

    Examples
    --------
    >>> with progress_bar(2, enabled=False) as advance:
    ...     advance(1, "second run")
    """
    console = _console() if enabled else None
    if console is None:
        yield lambda done, text: None
        return
    with _bar(console, counted, steady) as bar:
        task = bar.add_task("starting", total=total)

        def advance(done: float, text: str) -> None:
            elapsed = bar.tasks[0].elapsed
            rate = f", {done / elapsed:.3g}/s" if counted and steady and elapsed else ""
            bar.update(task, completed=done, description=text + rate)

        yield advance


def _console() -> Any:
    """The terminal or notebook to show a bar in; None elsewhere."""
    from rich.console import Console

    console = Console(stderr=True)
    return console if console.is_terminal or console.is_jupyter else None


def _bar(console: Any, counted: bool, steady: bool) -> Any:
    """A bar of rich with these columns, which vanishes at the end."""
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = [BarColumn(24), *[MofNCompleteColumn()] * counted, TimeElapsedColumn()]
    columns += [TextColumn("left"), TimeRemainingColumn()] * steady
    return Progress(*columns, TextColumn("{task.description}", markup=False), console=console, transient=True)
