"""`flockana ensemble`: many runs of a scenario, the share of them in which each claim holds."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    import xarray
    from rich.table import Table

_HELP = """Run and verify a scenario for many seeds, and print in which share of the runs each claim holds.

With --store, runs are kept as they are done: after Ctrl-C, or anything worse, the same command goes on from there.
--plot draws the shares; over one --set option with several values, against it; over two, the phase diagram.

Exit status: 0 done, 2 bad input, 3 some run did not complete, 130 interrupted.
"""
_INCOMPLETE = 3
_TOLD = 3  # errors that are printed
_MOST = 7  # curves in one picture


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command("ensemble", help=_HELP)(_ensemble)


def _ensemble(
    scenario: Annotated[str, typer.Argument(metavar="SCENARIO", help="Its name in the catalogue.")],
    seeds: Annotated[int, typer.Option(min=1, help="How many seeds.")] = 100,
    first: Annotated[int, typer.Option("--first-seed", min=0, help="The first of them.")] = 0,
    theorem: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="Check only this; 'source' is what the source reports. May be repeated."),
    ] = None,
    options: Annotated[
        list[str] | None, typer.Option("--set", metavar="OPTION=V1,V2,…", help="Values of an option. May be repeated.")
    ] = None,
    store: Annotated[Path | None, typer.Option(metavar="FILE", help="Keeps runs as they are done.")] = None,
    retry: Annotated[bool, typer.Option("--retry", help="Make runs anew that the store holds as failed.")] = False,
    cluster: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="A Dask scheduler's address, or 'local' to start one.")
    ] = None,
    jobs: Annotated[
        int | None, typer.Option(min=1, help="Processes; by default the number of cores.", show_default=False)
    ] = None,
    level: Annotated[float, typer.Option(help="Confidence of the intervals.")] = 0.95,
    output: Annotated[Path | None, typer.Option("--output", "-o", metavar="FILE", help="netCDF file to write.")] = None,
    plot: Annotated[Path | None, typer.Option(metavar="PICTURE", help="PNG, SVG or PDF to draw to.")] = None,
) -> int:
    from flockana.base.binomial import ensure_level
    from flockana.cli.picture import KINDS, ensure_file, write_picture
    from flockana.ensemble import ensemble, shares

    parameters = read_options(options or [])
    axes = [name for name, values in parameters.items() if isinstance(values, list)]
    ensure_level(level)
    for path, kinds in ((output, (".nc",)), (plot, KINDS)):
        if path is not None:
            ensure_file(path, kinds)
    if plot is not None:
        _ensure_drawable(axes)
    found = ensemble(
        scenario,
        range(first, first + seeds),
        theorems=theorem or None,
        parameters=parameters,
        cluster=cluster,
        jobs=jobs,
        store=store,
        retry=retry,
        progress=True,
    )
    table = shares(found, level=level)
    if output is not None:
        _write(found, output)
    _print(found, table, axes)
    if plot is not None:
        write_picture(lambda ax: _draw(ax, found, table, axes), plot, m=2)
    for label, file in (("store", store), ("saved", output), ("picture", plot)):
        if file is not None:
            typer.echo(f"{label}: {file}")
    return _INCOMPLETE if (found.run != 0).any() else 0


def read_options(texts: list[str]) -> dict[str, Any]:
    """Values by option: a number, a truth value or a text if there is one, a list of them if there are several.

    Examples
    --------
    >>> read_options(["n=20,40", "push=true", "ratio=1e-3"])
    {'n': [20, 40], 'push': True, 'ratio': 0.001}
    """
    from flockana.base.errors import ArgumentError

    found: dict[str, Any] = {}
    for text in texts:
        name, _, values = text.partition("=")
        words = [word.strip() for word in values.split(",")]
        if not name or not all(words):
            raise ArgumentError(f"--set {text}: expected OPTION=VALUE or OPTION=VALUE,VALUE,…, such as n=20,40")
        if name in found:
            raise ArgumentError(f"--set {text}: {name} is set already; give all its values at once")
        given = [_value(word) for word in words]
        found[name] = given if len(given) > 1 else given[0]
    return found


def _value(word: str) -> int | float | bool | str:
    if word.lower() in ("true", "false"):
        return word.lower() == "true"
    for kind in (int, float):
        try:
            return kind(word)
        except ValueError:
            continue
    return word


def _ensure_drawable(axes: list[str]) -> None:
    from flockana.base.errors import ArgumentError

    if len(axes) > 2:
        raise ArgumentError(f"--plot: {len(axes)} options have several values; expected two at most")


def _write(found: xarray.Dataset, path: Path) -> None:
    from flockana.base.files import replacing

    with replacing(path) as partial:
        found.to_netcdf(partial, engine="h5netcdf")


def _draw(ax: Any, found: xarray.Dataset, table: xarray.Dataset, axes: list[str]) -> None:
    from flockana import plots
    from flockana.ensemble import phases

    title = found.attrs["scenario"]
    if len(axes) == 2:
        plots.phase_diagram(phases(found), axes[0], axes[1], ax=ax, title=title)
    elif axes:
        plots.share_against(table, axes[0], claims=_telling(table), ax=ax, title=title)
    else:
        judged = (table.verified + table.refuted).values > 0  # the others have nothing to show
        plots.share_bars(table, claims=table.claim.values[judged].tolist(), ax=ax, title=title)


def _telling(table: xarray.Dataset) -> list[str]:
    """The claims whose share changes most with the parameter, as many as can be told apart, in their order."""
    import numpy as np

    share = table.share.sel(of="verified").fillna(0.0)
    others = [name for name in share.dims if name != "claim"]
    change = (share.max(others) - share.min(others)).values
    most = np.argsort(-change, kind="stable")[:_MOST]
    return [str(table.claim.values[k]) for k in sorted(most.tolist())]


def _print(found: xarray.Dataset, table: xarray.Dataset, axes: list[str]) -> None:
    from rich.console import Console

    console = Console(highlight=False)
    bad = found.run.values != 0
    console.print(f"{found.attrs['scenario']}: {bad.size} runs", style="bold", markup=False)
    if table.claim.size:
        console.print(share_table(table, axes))
        console.print(
            f"shares of the runs on which a claim was checked, vacuous and inconclusive ones included, with their "
            f"{100 * table.attrs['level']:g} % Clopper-Pearson intervals",
            style="bright_black",
        )
    seconds = found.seconds.values
    console.print(f"{seconds.sum():.1f} s of computing, {seconds.mean():.3g} s a run", markup=False)
    if bad.any():
        told = list(dict.fromkeys(found.message.values[bad].tolist()))
        console.print(f"{bad.sum()} did not complete:", style="bold red", markup=False)
        for message in told[:_TOLD]:
            console.print(f"  {message}", markup=False)
        if len(told) > _TOLD:
            console.print(f"  … and {len(told) - _TOLD} more kinds", markup=False)


def share_table(table: xarray.Dataset, axes: list[str]) -> Table:
    """A row per claim, for every combination of the parameters: how often verified, how often refuted."""
    from itertools import product

    from rich import box
    from rich.table import Table
    from rich.text import Text

    grid = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1))
    # on a narrow terminal names give way, findings do not
    for heading, width in (("claim", None), ("runs", 4), ("verified, %", 19), ("refuted, %", 19), ("vacuous", 7)):
        grid.add_column(heading, justify="left" if width is None else "right", no_wrap=True, min_width=width)
    for values in product(*(table[name].values.tolist() for name in axes)):
        part = table.sel(dict(zip(axes, values, strict=True)))
        if axes:
            point = ", ".join(f"{name} = {value}" for name, value in zip(axes, values, strict=True))
            grid.add_row(Text(point, style="bold"))
        before = ""
        for label in table.claim.values.tolist():
            one = part.sel(claim=label)
            theorem, _, claim = label.partition(":")
            if not int(one.runs):
                continue
            if theorem != before:
                grid.add_row(Text(theorem))
            before = theorem
            cells = [interval_text(one.sel(of=of)) for of in ("verified", "refuted")]
            grid.add_row(f"  {claim}", str(int(one.runs)), *cells, str(int(one.vacuous) or ""))
    return grid


def interval_text(entry: xarray.Dataset) -> str:
    """A share and its interval in per cent."""
    share, low, high = (100.0 * float(entry[name]) for name in ("share", "low", "high"))
    return f"{share:.1f} [{low:.1f}, {high:.1f}]"
