"""`flockana scenarios` and `flockana theorems`: the catalogues."""

from __future__ import annotations

import gc
import os
from collections.abc import Iterator
from contextlib import contextmanager


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
    """Start no threads of linear algebra, of which a list needs none, and look for no garbage in what is imported."""
    collects, threads = gc.isenabled(), os.environ.get("OPENBLAS_NUM_THREADS")
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()
        if threads is None:
            os.environ.pop("OPENBLAS_NUM_THREADS")
