"""`flockana scenarios` and `flockana theorems`: the catalogues."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

from flockana.cli.threads import one_thread_for_matrices


def scenarios_command() -> None:
    """List the catalogue of published simulations."""
    with _at_once():
        from rich.console import Console

        from flockana.report.catalogues import scenario_table

        Console(highlight=False).print(scenario_table())


def theorems_command() -> None:
    """List the theorems and errata that can be checked."""
    with _at_once():
        from rich.console import Console

        from flockana.report.catalogues import theorem_table

        Console(highlight=False).print(theorem_table())


@contextmanager
def _at_once() -> Iterator[None]:
    """Start no threads, of which a list needs none, and look for no garbage in what is imported."""
    collects = gc.isenabled()
    gc.disable()
    try:
        with one_thread_for_matrices():
            yield
    finally:
        if collects:
            gc.enable()
