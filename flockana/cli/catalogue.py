"""`flockana scenarios` and `flockana theorems`: what there is."""

from __future__ import annotations

import typer


def register(app: typer.Typer) -> None:
    """Add the commands to the command line."""
    app.command("scenarios")(_scenarios)
    app.command("theorems")(_theorems)


def _scenarios() -> None:
    """List the catalogue of published simulations."""
    from rich.console import Console

    from flockana.report.console import scenario_table

    Console(highlight=False).print(scenario_table())


def _theorems() -> None:
    """List the theorems and errata that can be checked."""
    from rich.console import Console

    from flockana.report.console import theorem_table

    Console(highlight=False).print(theorem_table())
