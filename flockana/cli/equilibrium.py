"""`flockana equilibrium`: find an equilibrium of a law, name its kind, save it."""

from __future__ import annotations

import json
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from flockana.cli.options import OK, Seed

if TYPE_CHECKING:
    from flockana.equilibria import Equilibrium

_HELP = """Find an equilibrium near a configuration by IPOPT, and say what kind of critical point it is.

SOURCE is a scenario of the catalogue (its law, from the end of its run or from its start), a run that was saved (.nc),
an equilibrium's file (.json), a CSV of positions, or a builder such as hexagonal-spiral:19 (see flockana lattice
--help). A CSV and a builder bring no law: it is Algorithm 1 or 2 with its usual parameters, and --d and --r.
A γ-agent that moves is held where it is at that time. A law that a scenario or a run steps by semi-implicit Euler has
the equilibria that it has without. Under dead-zone flocking the strain is that of contacts, pairs closer than d1.

Exit status: 0 found, 2 bad input, 3 no equilibrium found, 130 interrupted.
"""
_FAILED = 3
_LOWEST = 6  # eigenvalues that are printed


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command("equilibrium", help=_HELP)(_equilibrium)


def _equilibrium(
    source: Annotated[str, typer.Argument(metavar="SOURCE", help="A scenario, a file, or a builder with its size.")],
    start: Annotated[
        Literal["end", "start"], typer.Option(help="Of a scenario: begin at the end of its run, or at its start.")
    ] = "end",
    seed: Seed = 0,
    algorithm: Annotated[
        int | None, typer.Option(min=1, max=2, help="Where no law comes with the positions; by default 1.")
    ] = None,
    d: Annotated[float | None, typer.Option("--d", help="Scale, where no law comes with the positions.")] = None,
    r: Annotated[float | None, typer.Option("--r", help="Range, likewise; by default 1.2 d.")] = None,
    time: Annotated[float | None, typer.Option(help="Time in a saved run; by default its end.")] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="JSON file to save it to.")
    ] = None,
    picture: Annotated[Path | None, typer.Option(metavar="PICTURE", help="PNG, SVG or PDF to draw to.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, and nothing else.")] = False,
) -> int:
    from flockana.base.errors import SolverError
    from flockana.cli.flock import read_flock
    from flockana.cli.picture import KINDS, ensure_file, write_picture
    from flockana.equilibria import find_equilibrium
    from flockana.equilibria.record import write_equilibrium

    for path, kinds in ((output, (".json",)), (picture, KINDS)):
        if path is not None:
            ensure_file(path, kinds)
    try:
        law, q = read_flock(source, start=start, seed=seed, algorithm=algorithm, d=d, r=r, time=time)
        found = find_equilibrium(law, q)
    except SolverError as error:
        typer.echo(f"flockana: {' '.join(str(error).split())}", err=True)
        return _FAILED
    if output is not None:
        write_equilibrium(found, output)
    if picture is not None:
        write_picture(lambda ax: _draw(ax, found, source), picture, m=found.q.shape[1])
    if as_json:
        typer.echo(json.dumps(summary(found, source), indent=1, ensure_ascii=False, allow_nan=False))
    else:
        _print(found, source, (("saved", output), ("picture", picture)))
    return OK


def summary(found: Equilibrium, name: str) -> dict[str, Any]:
    """What was found, as plain data."""
    from flockana.equilibria.potential import Potential
    from flockana.measures.metrics import coincident_pairs

    n, m = found.q.shape
    strain = found.strain()
    return {
        "source": name,
        "law": type(found.law).__name__,
        "n": n,
        "m": m,
        "kind": found.kind,
        "energy": found.energy,
        "residual": found.residual,
        "links": len(found.links),
        "strain": None if isnan(strain) else strain,
        "coincident pairs": coincident_pairs(found.q, 1e-6 * Potential(found.law).pair.length),
        "solver": found.message,
        "rigid modes": found.rigid_modes,
        "soft modes": found.zero_modes,
        "index": found.index,
        "hessian eigenvalues": found.hessian_eigenvalues.tolist(),
        "q": found.q.tolist(),
    }


def _draw(ax: Any, found: Equilibrium, name: str) -> None:
    from flockana import plots
    from flockana.cli.source import law_scales
    from flockana.equilibria.potential import Potential
    from flockana.measures.nets import links

    law, (d, r) = found.law, law_scales(found.law)
    plots.configuration(
        found.q,
        d=d,
        r=r,
        target=Potential(law).target,
        obstacles=law.obstacles,
        beta=None if law.obstacle_field is None else law.obstacle_field.beta,
        ax=ax,
        title=f"{name}: {found.kind}, {len(links(found.q, r))} links up to {r:.4g}",
    )


def _print(found: Equilibrium, name: str, files: tuple[tuple[str, Path | None], ...]) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    facts = summary(found, name)
    console = Console(highlight=False)
    console.print(f"{name}: {found.kind}", style="bold", markup=False)
    table = Table(box=box.SIMPLE, show_header=False, pad_edge=False, padding=(0, 1))
    table.add_column(no_wrap=True, style="bright_black")
    table.add_column()
    lowest = ", ".join(f"{value:.4g}" for value in found.hessian_eigenvalues[:_LOWEST])
    contacts = found.law.lattice is None
    scale, length = ("a contact's force", "contact − d1|/d1") if contacts else ("the law's force scale", "link − d|/d")
    strain = "" if facts["strain"] is None else f", |{length} at most {facts['strain']:.4g}"
    rows = (
        ("law", f"{facts['law']}, n = {facts['n']}, m = {facts['m']}"),
        ("energy", f"{found.energy:.10g}"),
        ("residual force", f"{found.residual:.2g} of {scale}"),
        ("links", f"{facts['links']}{strain}"),
        ("coincident pairs", str(facts["coincident pairs"])),
        ("solver", found.message),
        ("zero modes", f"{found.rigid_modes} rigid, {found.zero_modes} soft; {found.index} negative"),
        ("lowest eigenvalues", f"{lowest or 'none'} (off the rigid motions)"),
    )
    for label, value in rows:
        table.add_row(label, Text(value))
    console.print(table)
    for label, path in files:
        if path is not None:
            console.print(f"{label}: {path}", markup=False, soft_wrap=True)
