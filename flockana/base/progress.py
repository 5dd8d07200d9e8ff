"""Progress bars on a terminal or in a notebook; elsewhere a line every minute."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

_EVERY = 60.0  # seconds between lines off a terminal
_PART: ContextVar[Callable[[str], None]] = ContextVar("part", default=lambda text: None)
_BASIS = 0.1  # share of the total from which on the remaining time is estimated


@contextmanager
def progress_bar(
    total: float, *, enabled: bool = True, counted: bool = True, steady: bool = False
) -> Iterator[Callable[[float, str], None]]:
    """Show a progress bar; yield a function that reports progress and a text."""
    # Off a terminal, where a bar would be rubbish, work that takes long is told in a line a minute. `counted` shows
    # both numbers, for a total of runs or tasks; `steady` shows the time left and, if counted, the rate, for work of
    # which each part takes about as long.
    from flockana.base.value_checks import ensure_flag  # and numpy, which to list needs not

    console = _console() if ensure_flag("progress", enabled) else None
    if console is None:
        yield _lines(total) if enabled else lambda done, text: None
        return
    with _bar(console, counted, steady) as bar:
        task, shown = bar.add_task("starting", total=total), ""

        def advance(done: float, text: str) -> None:
            nonlocal shown
            elapsed = bar.tasks[0].elapsed
            rate = f", {done / elapsed:.3g}/s" if counted and steady and elapsed else ""
            shown = text + rate
            bar.update(task, completed=done, description=shown)

        token = _PART.set(lambda text: bar.update(task, description=", ".join(filter(None, (shown, text)))))
        try:
            yield advance
        finally:
            _PART.reset(token)


def show_part(text: str) -> None:
    """Show the name of the current part of a task beside the progress bar; remove it once the part is done."""
    _PART.get()(text)


def _lines(total: float) -> Callable[[float, str], None]:
    """Return a function that prints progress to stderr at fixed intervals."""
    start_time = printed = time.monotonic()

    def advance(done: float, text: str) -> None:
        nonlocal printed
        current_time = time.monotonic()
        if current_time - printed < _EVERY or not 0.0 < done < total:
            return
        printed = current_time
        elapsed_time = current_time - start_time
        left = elapsed_time * (total - done) / done
        # before a tenth is done, parts that take longer than others would lead far off
        time_text = f", about {left:.0f} s left" if done >= _BASIS * total else ""
        sys.stderr.write(f"{done:.4g} of {total:.4g} in {elapsed_time:.0f} s{time_text}: {text}\n")
        sys.stderr.flush()

    return advance


def _console() -> Any:
    """Return the terminal or notebook to show a bar in; None elsewhere."""
    from rich.console import Console

    console = Console(stderr=True)
    return console if console.is_terminal or console.is_jupyter else None


def _bar(console: Any, counted: bool, steady: bool) -> Any:
    """Return a transient progress bar of rich, with counts and remaining time on request."""
    from rich import progress as rich

    columns = [rich.BarColumn(24), *[rich.MofNCompleteColumn()] * counted, rich.TimeElapsedColumn()]
    columns += [rich.TextColumn("left"), rich.TimeRemainingColumn()] * steady
    text = rich.TextColumn("{task.description}", markup=False)
    return rich.Progress(*columns, text, console=console, transient=True)
