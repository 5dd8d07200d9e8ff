"""`flockana scenarios` and `flockana theorems`: the catalogues."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from flockana.cli.shared_options import AsJson
from flockana.cli.thread_limit import one_thread_for_matrices

if TYPE_CHECKING:
    from collections.abc import Callable

Words = Annotated[list[str] | None, typer.Argument(metavar="[WORD]...", help="Only entries with all these words.")]
Source = Annotated[str, typer.Option(help="Only this source, or part of its name.", show_default=False)]
Statuses = Literal["verified", "refuted", "vacuous", "inconclusive"]
Status = Annotated[Statuses | None, typer.Option(help="Only entries with this expected status.")]
For = Annotated[
    str | None,
    typer.Option("--for", metavar="FLOCK", help="Which claims hold of FILE.py:NAME, or a scenario, by law and start."),
]
Long = Annotated[bool, typer.Option("--long", help="Print all details of each.")]


@one_thread_for_matrices()
def scenarios_command(
    words: Words = None, source: Source = "", status: Status = None, long: Long = False, as_json: AsJson = False
) -> None:
    """List the catalogue of published simulations, by source."""
    from flockana.report.catalogues import scenario_entries, scenario_table, select

    entries = select(scenario_entries(), words or (), source=source, status=status or "")
    _show(entries, scenario_table, "scenarios", long=long, as_json=as_json)


@one_thread_for_matrices()
def theorems_command(
    words: Words = None,
    source: Source = "",
    status: Status = None,
    long: Long = False,
    flock: For = None,
    as_json: AsJson = False,
) -> None:
    """List the theorems and errata that can be checked, by source; or, with --for, which hold of a flock."""
    if flock is not None:
        _show_applicable(flock, words, source=source, status=status, long=long, as_json=as_json)
        return
    from flockana.report.catalogues import select, theorem_entries, theorem_table

    entries = select(theorem_entries(), words or (), source=source, status=status or "")
    _show(entries, theorem_table, "theorems", long=long, as_json=as_json)


def _show_applicable(flock: str, words: Any, *, as_json: bool, **others: Any) -> None:
    """Print which theorems' claims hold of a flock by its law and its start."""
    from flockana.base.errors import ArgumentError
    from flockana.cli.command_output import show, show_json
    from flockana.cli.command_subject import is_own, read_own
    from flockana.report.tables import column, headed_table
    from flockana.scenarios import scenario
    from flockana.theorems.applicability import applicable_to
    from flockana.theorems.verdict_summary import plain

    if words or any(others.values()):
        raise ArgumentError(f"--for {flock}: expected no words and no other option but --json beside it")
    table = applicable_to(read_own(flock) if is_own(flock) else scenario(flock))
    if as_json:
        show_json(plain(table.to_dict("records")))
        return
    rows = headed_table("claim", "status", column("need, and what would meet it", wraps=True))
    for row in table.itertuples():
        rows.add_row(f"{row.theorem}:{row.claim}", row.status, "; ".join(filter(None, (row.need, row.remedy))))
    show(flock, rows)
    counts = table["status"].value_counts()
    typer.echo(f"{len(table)} claims: " + ", ".join(f"{count} {status}" for status, count in counts.items()))


def _show(
    found: list[dict[str, Any]], table: Callable[[list[str]], Any], kind: str, *, long: bool, as_json: bool
) -> None:
    from flockana.cli.command_output import show, show_json, show_lines
    from flockana.report.catalogues import short_list

    if as_json:
        show_json(found)
        return
    if long:
        show(kind, table([entry["name"] for entry in found]))
    elif found:
        show_lines(short_list(found))
    note = "" if long or not found else "; --long prints more of each"
    typer.echo(f"{len(found)} {kind}{note}")
