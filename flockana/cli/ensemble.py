"""`flockana ensemble`: run a scenario over many seeds and print the share in which each claim holds."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from flockana.base.errors import ArgumentError
from flockana.base.files import write_atomic
from flockana.cli.command_output import INTERRUPTED, OK, UNEXPECTED, show, show_files, show_json
from flockana.cli.shared_options import AsJson, Jobs, Plot, ScenarioName, output

if TYPE_CHECKING:
    import xarray
    from rich.table import Table

_MESSAGES = 3  # kinds of errors that are printed
_MOST = 7  # curves in one picture


def ensemble_command(
    scenario: ScenarioName,
    *,
    seeds: Annotated[int, typer.Option(min=1, help="Number of seeds.")] = 100,
    first: Annotated[int, typer.Option("--first-seed", min=0, help="First seed.")] = 0,
    theorem: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="Theorem, FILE.py:NAME (a claim of yours), or 'source' for the source's reports. May be repeated.",
        ),
    ] = None,
    options: Annotated[
        list[str] | None, typer.Option("--set", metavar="OPTION=V1,V2,…", help="Values of an option. May be repeated.")
    ] = None,
    store: Annotated[Path | None, typer.Option(metavar="FILE", help="File that stores finished runs.")] = None,
    retry: Annotated[bool, typer.Option("--retry", help="Retry failed runs of the store.")] = False,
    jobs: Jobs = None,
    level: Annotated[float, typer.Option(help="Confidence of the intervals.")] = 0.95,
    save_to: Annotated[Path | None, output("netCDF file to write.")] = None,
    plot: Plot = None,
    as_json: AsJson = False,
) -> int:
    """Run and verify a scenario for many seeds, and print in which share of the runs each claim holds.

    With --store, finished runs are kept: after Ctrl-C or a crash, the same command continues from there.
    --plot draws the shares; over one --set option with several values, against it; over two, the phase diagram.

    Exit status: 0 done, 2 bad input, 3 some run did not complete, 130 interrupted.
    """
    from flockana.base.binomial_intervals import ensure_level
    from flockana.cli.command_subject import is_own, read_own, read_theorem
    from flockana.cli.picture_file import ensure_file, write_picture
    from flockana.ensemble import ensemble, shares

    if retry and store is None:
        raise ArgumentError("--retry: without a store no failed runs are known; give --store FILE too, or leave it out")
    parameters = read_options(options or [])
    axes = [name for name, values in parameters.items() if isinstance(values, list)]
    ensure_level(level)
    ensure_file(save_to, (".nc",))
    ensure_file(plot)
    if plot is not None and len(axes) > 2:
        raise ArgumentError(f"--plot: {len(axes)} options have several values; expected two at most")
    checked_theorems = [read_theorem(name) for name in theorem or ()] or None
    request: dict[str, Any] = {"theorems": checked_theorems, "parameters": parameters, "jobs": jobs, "store": store}
    try:
        case = read_own(scenario) if is_own(scenario) else scenario
        runs = ensemble(case, range(first, first + seeds), **request, retry=retry, progress=True)
    except KeyboardInterrupt as stopped:
        typer.echo(stopped, err=True)
        return INTERRUPTED
    table = shares(runs, level=level)
    if as_json:
        show_json(share_rows(table))
    else:
        _show(runs, table)
    if save_to is not None:  # in memory first: HDF5 tears itself apart on a disk that fills
        write_atomic(save_to, runs.to_netcdf(None, engine="h5netcdf"))
    write_picture(lambda ax: _draw(ax, runs, table, axes), plot)
    show_files(as_json, store=store, saved=save_to, picture=plot)
    return UNEXPECTED if (runs.run != 0).any() else OK


def read_options(texts: list[str]) -> dict[str, Any]:
    """Parse options ``NAME=VALUES``: numbers, truth values or texts, and lists of several."""
    options: dict[str, Any] = {}
    for text in texts:
        name, _, values = text.partition("=")
        words = [word.strip() for word in values.split(",")]
        if not name or not all(words):
            raise ArgumentError(f"--set {text}: expected OPTION=VALUE or OPTION=VALUE,VALUE,…, such as n=20,40")
        if name in options:
            raise ArgumentError(f"--set {text}: {name} is set already; give all its values at once")
        option_values = [_value(word) for word in words]
        options[name] = option_values if len(option_values) > 1 else option_values[0]
    return options


def _value(word: str) -> int | float | bool | str:
    if word.lower() in ("true", "false"):
        return word.lower() == "true"
    for kind in (int, float):
        try:
            return kind(word)
        except ValueError:
            continue
    return word


def _draw(ax: Any, runs: xarray.Dataset, table: xarray.Dataset, axes: list[str]) -> None:
    from flockana import plots
    from flockana.ensemble import phases

    title = runs.attrs["scenario"]
    if len(axes) == 2:
        plots.phase_diagram(phases(runs), axes[0], axes[1], ax=ax, title=title)
    elif axes:
        plots.share_against(table, axes[0], claims=_most_varying(table), ax=ax, title=title)
    else:
        is_judged = (table.verified + table.refuted).values > 0  # the others have nothing to show
        plots.share_bars(table, claims=table.claim.values[is_judged].tolist(), ax=ax, title=title)


def _most_varying(table: xarray.Dataset) -> list[str]:
    """Return the claims whose verified fraction of runs varies most with the parameters."""
    import numpy as np

    share = table.share.sel(of="verified").fillna(0.0)
    other_dimensions = [name for name in share.dims if name != "claim"]
    change = (share.max(other_dimensions) - share.min(other_dimensions)).values
    varying_claims = np.argsort(-change, kind="stable")[:_MOST]
    return [str(table.claim.values[k]) for k in sorted(varying_claims.tolist())]


def _show(runs: xarray.Dataset, table: xarray.Dataset) -> None:
    is_failed = runs.run.values != 0
    tables = [share_table(table)] if table.claim.size else []
    console = show(f"{runs.attrs['scenario']}: {is_failed.size} runs", *tables)
    if tables:
        console.print(
            f"shares of the runs on which a claim was checked, vacuous (vac.) and inconclusive (inc.) ones included, "
            f"with their {100 * table.attrs['level']:g} % Clopper-Pearson intervals",
            style="bright_black",
        )
    seconds = runs.seconds.values
    console.print(f"{seconds.sum():.1f} s of computing, {seconds.mean():.3g} s a run", markup=False)
    if is_failed.any():
        messages = list(dict.fromkeys(runs.message.values[is_failed].tolist()))
        console.print(f"{is_failed.sum()} did not complete:", style="bold red", markup=False)
        more_texts = [f"… and {len(messages) - _MESSAGES} more kinds"] if len(messages) > _MESSAGES else []
        for text in messages[:_MESSAGES] + more_texts:
            console.print(f"  {text}", markup=False)


def share_rows(table: xarray.Dataset) -> list[dict[str, Any]]:
    """Return a table of claims' shares of runs as records, for all combinations of parameters."""
    rows = []
    for values in table.to_dataframe().reset_index().to_dict("records"):
        plain_values = {str(key): value.item() if hasattr(value, "item") else value for key, value in values.items()}
        rows.append({key: None if value != value else value for key, value in plain_values.items()})
    return rows


def share_table(table: xarray.Dataset) -> Table:
    """Return a table, to be printed, of the runs that verify and refute each claim, for all parameters."""
    from rich.text import Text

    from flockana.ensemble.shares import share_cells
    from flockana.report.tables import column, headed_table

    columns = (column(heading, right=True) for heading in ("runs", "verified, %", "refuted, %", "vac.", "inc."))
    grid = headed_table(column("claim", wraps=True), *columns, collapse_padding=True)
    point = last_theorem = ""
    for point_text, label, *cells in share_cells(table):
        theorem, _, claim = label.partition(":")
        if point_text != point:
            grid.add_row(Text(point_text, style="bold"))
        if (point_text, theorem) != (point, last_theorem):
            grid.add_row(Text(theorem))
        point, last_theorem = point_text, theorem
        grid.add_row(f"  {claim}", *cells)
    return grid
