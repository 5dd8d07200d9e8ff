"""`flockana scenarios` and `flockana theorems`: the catalogues."""

from __future__ import annotations

from flockana.cli.threads import one_thread_for_matrices


@one_thread_for_matrices()
def scenarios_command() -> None:
    """List the catalogue of published simulations."""
    from rich.console import Console

    from flockana.report.catalogues import scenario_table

    Console(highlight=False).print(scenario_table())


@one_thread_for_matrices()
def theorems_command() -> None:
    """List the theorems and errata that can be checked."""
    from rich.console import Console

    from flockana.report.catalogues import theorem_table

    Console(highlight=False).print(theorem_table())
