"""`flockana equilibrium`: find an equilibrium of a law, name its kind, save it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

if TYPE_CHECKING:
    from flockana.checks import FloatArray
    from flockana.equilibria import Equilibrium

_HELP = """Find an equilibrium near a configuration by IPOPT, and say what kind of critical point it is.

SOURCE is a scenario of the catalogue (its law, from the end of its run or from its start), a run that was saved (.nc),
an equilibrium's file (.json), a CSV of positions, or a builder such as hexagonal-spiral:19 (see flockana lattice
--help). A CSV and a builder bring no law: it is Algorithm 1 or 2 with its usual parameters, and --d and --r.
A γ-agent that moves is held where it is at that time.

Exit status: 0 found, 2 bad input, 3 no equilibrium found, 130 interrupted.
"""
_FAILED = 3
_LOWEST = 6  # eigenvalues that are printed


def register(app: typer.Typer) -> None:
    """Add the command to the command line.

    Parameters
    ----------
    app : typer.Typer
        Of flockana.
    """
    app.command("equilibrium", help=_HELP)(_equilibrium)


def _equilibrium(
    source: Annotated[str, typer.Argument(metavar="SOURCE", help="A scenario, a file, or a builder with its size.")],
    start: Annotated[
        Literal["end", "start"], typer.Option(help="Of a scenario: begin at the end of its run, or at its start.")
    ] = "end",
    seed: Annotated[int, typer.Option(min=0, help="Seed of a scenario's random start.")] = 0,
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
    from flockana.commands.picture import KINDS, ensure_file, write_picture
    from flockana.commands.source import ensure_source
    from flockana.equilibria import find_equilibrium
    from flockana.equilibria.record import write_equilibrium
    from flockana.errors import SolverError
    from flockana.scenarios import scenarios

    for path, kinds in ((output, (".json",)), (picture, KINDS)):
        if path is not None:
            ensure_file(path, kinds)
    try:
        if source in scenarios():
            _ensure_free(source, time=time, algorithm=algorithm, d=d, r=r)
            law, q = _of_scenario(source, start, seed)
        else:
            ensure_source(source, scenarios())
            law, q = _of_source(source, algorithm=algorithm, d=d, r=r, time=time)
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
    return 0


def _ensure_free(name: str, **given: object) -> None:
    from flockana.errors import ArgumentError

    for option, value in given.items():
        if value is not None:
            raise ArgumentError(f"--{option} {value}: {name} has a law of its own, and no such choice; leave it out")


def _of_scenario(name: str, start: str, seed: int) -> tuple[Any, FloatArray]:
    from flockana.equilibria.classify import ensure_small
    from flockana.equilibria.potential import ensure_flock_law
    from flockana.errors import SolverError
    from flockana.scenarios import scenario

    item = scenario(name, seed)
    law = ensure_flock_law(item.law, item.q0.shape[1])
    ensure_small(*item.q0.shape)
    if start == "start":
        return _held(law, item.t_span[0]), item.q0
    run = item.run()
    if run.status == "interrupted":
        raise KeyboardInterrupt
    if run.status != "complete":
        raise SolverError(f"the run of {name} {run.status}: {run.message}; use --start start")
    return _held(law, float(run.t[-1])), run.q[-1]


def _of_source(name: str, *, algorithm: int | None, d: float | None, r: float | None, time: float | None) -> Any:
    """(law, q): the law of the file, or Algorithm 1 or 2 with the user's scale and range."""
    from flockana.commands.source import read_source
    from flockana.equilibria.potential import ensure_flock_law
    from flockana.interactions import AlphaInteraction
    from flockana.laws.olfati_saber import Algorithm1, Algorithm2

    given = read_source(name, d=d, r=r, time=time)
    if given.law is not None:
        _ensure_free(name, algorithm=algorithm, d=d, r=r)
        return _held(ensure_flock_law(given.law, given.q.shape[1]), given.t), given.q
    alpha = AlphaInteraction(d=given.d, r=given.r)
    if algorithm != 2:
        return Algorithm1(alpha), given.q
    from flockana.environment.targets import StaticTarget

    return Algorithm2(alpha, target=StaticTarget(given.q.mean(axis=0))), given.q


def _held(law: Any, t: float) -> Any:
    """The law with its γ-agent held where it is at t: the same potential, and one that a file can hold."""
    from flockana.environment.targets import StaticTarget

    target = getattr(law, "target", None)
    return law if target is None else replace(law, target=StaticTarget(tuple(target.position(t).tolist())))


def summary(found: Equilibrium, name: str) -> dict[str, Any]:
    """What was found, as plain data.

    Parameters
    ----------
    found : Equilibrium
        The equilibrium.
    name : str
        What was asked for.
    """
    from flockana.metrics import coincident_pairs

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
        "strain": strain if len(found.links) else None,
        "coincident pairs": coincident_pairs(found.q, 1e-6 * found.law.alpha.d),
        "solver": found.message,
        "rigid modes": found.rigid_modes,
        "soft modes": found.zero_modes,
        "index": found.index,
        "hessian eigenvalues": found.hessian_eigenvalues.tolist(),
        "q": found.q.tolist(),
    }


def _draw(ax: Any, found: Equilibrium, name: str) -> None:
    from flockana import plots
    from flockana.laws.olfati_saber import Algorithm1

    law = found.law
    target = None if isinstance(law, Algorithm1) else law.target.position(0.0)
    plots.configuration(
        found.q,
        d=law.alpha.d,
        r=law.alpha.r,
        target=target,
        obstacles=getattr(law, "obstacles", ()),
        beta=getattr(law, "beta", None),
        ax=ax,
        title=f"{name}: {found.kind}, {len(found.links)} links",
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
    strain = "" if facts["strain"] is None else f", |link − d|/d at most {facts['strain']:.4g}"
    rows = (
        ("law", f"{facts['law']}, n = {facts['n']}, m = {facts['m']}"),
        ("energy", f"{found.energy:.10g}"),
        ("residual force", f"{found.residual:.2g} of c1α b/√ε"),
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
