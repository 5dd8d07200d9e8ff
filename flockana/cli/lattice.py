"""`flockana lattice`: measure a configuration, check Theorem 5 on it, draw it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from flockana.cli.options import OK

if TYPE_CHECKING:
    from rich.table import Table

    from flockana.cli.source import Source
    from flockana.measures.nets import LinkArray
    from flockana.theorems import Verdict

_HELP = """Measure a configuration: α-lattice or not, links, crossings, planarity, rigidity, defects, Theorem 5.

SOURCE is a run that was saved (.nc), a CSV of positions (a row for each agent, one to three columns, a header or none),
an equilibrium's file (.json), or a builder with its size: line:5, triangular:25, hexagonal-spiral:19, hexagonal-patch:2
(rings), square:4x5, honeycomb:3x4 (cells), simple-cubic:2x2x2, fcc:2x2x2, hcp:2x2x2, bcc:2x2x2 (cells).

Exit status: 0 measured, 2 bad input, 130 interrupted.
"""
_CROSSING = "each decided exactly, for the positions as stored"
_MANY = 1000  # crossings from which on they are not counted: the theorem's check lists so many


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command("lattice", help=_HELP)(_lattice)


def _lattice(
    source: Annotated[str, typer.Argument(metavar="SOURCE", help="A file, or a builder with its size.")],
    d: Annotated[float | None, typer.Option("--d", help="Scale; by default the run's, else 7.")] = None,
    r: Annotated[float | None, typer.Option("--r", help="Range; by default the run's, else 1.2 d.")] = None,
    time: Annotated[float | None, typer.Option(help="Time in a run; by default its end.")] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="PICTURE", help="PNG, SVG or PDF to draw to.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, and nothing else.")] = False,
) -> int:
    from flockana.cli.picture import KINDS, ensure_file, write_picture
    from flockana.cli.source import read_source
    from flockana.lattice import links
    from flockana.theorems import verify

    if output is not None:
        ensure_file(output, KINDS)
    given = read_source(source, d=d, r=r, time=time)
    pairs = links(given.q, given.r)
    verdict = verify("os-5", q=given.q, d=given.d, r=given.r, subject=given.name)
    found = measures(given, pairs, verdict)
    if output is not None:
        write_picture(lambda ax: _draw(ax, given, pairs), output, m=given.q.shape[1])
    if as_json:
        typer.echo(json.dumps(found | {"verdict": verdict.to_dict()}, indent=1, ensure_ascii=False, allow_nan=False))
        return OK
    _print(found, verdict, output)
    return OK


def _draw(ax: Any, given: Source, pairs: LinkArray) -> None:
    from flockana import plots
    from flockana.lattice import coordination
    from flockana.measures.nets import link_lengths

    q, d, r = given.q, given.d, given.r
    strain = (link_lengths(q, pairs) - d) / d
    title = f"{given.name}: n = {len(q)}, {len(pairs)} links"
    plots.defect_map(q, pairs, coordination(len(q), pairs), strain=strain, limit=r / d - 1.0, ax=ax, title=title)


def measures(given: Source, pairs: LinkArray, verdict: Verdict) -> dict[str, Any]:
    """All that is measured of a configuration, as plain data; None where there is nothing to measure."""
    from flockana.lattice import classify, harborth, is_complete, planar_bound
    from flockana.lattice.measure import GUARD
    from flockana.measures.metrics import deviation_energy, min_distance
    from flockana.measures.nets import components, link_lengths

    q, d, r = given.q, given.d, given.r
    (n, m), lengths = q.shape, link_lengths(q, pairs)
    error = float(abs(lengths - d).max()) if len(pairs) else None
    strain = float("nan") if error is None else error / d
    graph, crossings = verdict.claim("i-graph"), verdict.claim("i").computed
    witness = graph.witness
    return {
        "source": given.name,
        "n": n,
        "m": m,
        "d": d,
        "r": r,
        "time": given.t if given.name.endswith(".nc") else None,
        "largest ratio of the pattern": given.max_ratio,
        "kind": classify(strain, lattice=verdict.tolerances.lattice, quasi=verdict.tolerances.quasi),
        "edge-length error": error,
        "deviation energy": deviation_energy(q, d, r * (1.0 - GUARD)),
        "links": len(pairs),
        "shortest link": float(lengths.min()) if len(pairs) else None,
        "longest link": float(lengths.max()) if len(pairs) else None,
        "least distance": min_distance(q) if n > 1 else None,
        "components": int(components(n, pairs).max()) + 1,
        "complete": is_complete(n, pairs),
        "crossings": crossings,
        "crossings listed at most": _MANY,
        "planar graph": graph.computed == "planar",
        "kuratowski": None if witness is None else {"kind": witness["kind"], "links": len(witness["links"])},
        "planar bound": planar_bound(n),
        "harborth": harborth(n) if m == 2 else None,
        "rigidity": _rigidity(q, pairs),
        "coordination": _histogram(n, pairs),
        "defects": _defects(q, pairs) if m == 2 else None,
    }


def _rigidity(q: Any, pairs: LinkArray) -> dict[str, Any]:
    from flockana.base.errors import SolverError
    from flockana.lattice import rigidity

    try:
        found = rigidity(q, pairs)
    except SolverError as error:
        return {"undecided": str(error)}
    return vars(found) | {"infinitesimally rigid": found.infinitesimally_rigid}


def _histogram(n: int, pairs: LinkArray) -> dict[str, int]:
    import numpy as np

    from flockana.lattice import coordination

    sizes, numbers = np.unique(coordination(n, pairs), return_counts=True)
    return {str(k): int(v) for k, v in zip(sizes.tolist(), numbers.tolist(), strict=True)}


def _defects(q: Any, pairs: LinkArray) -> dict[str, Any]:
    from flockana.lattice import defects

    found = defects(q, pairs)
    inside = {str(k): v for k, v in found.counts.items()}
    return {"interior": int(found.interior.sum()), "interior coordination": inside, "charge": int(found.charge.sum())}


def _print(found: dict[str, Any], verdict: Verdict, output: Path | None) -> None:
    from rich.console import Console

    from flockana.report.console import details

    console = Console(highlight=False)
    console.print(found["source"], style="bold", markup=False)
    console.print(_table(found))
    console.print(details(verdict))
    if output is not None:
        console.print(f"picture: {output}", markup=False, soft_wrap=True)


def _table(found: dict[str, Any]) -> Table:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE, show_header=False, pad_edge=False, padding=(0, 1))
    table.add_column(no_wrap=True, style="bright_black")
    table.add_column()
    for name, value in _rows(found):
        table.add_row(name, Text(value))
    return table


def _rows(found: dict[str, Any]) -> list[tuple[str, str]]:
    """The measures in words."""
    kappa, largest = found["r"] / found["d"], found["largest ratio of the pattern"]
    scale = f"{found['d']:g} and {found['r']:g}, κ = {kappa:.5g}"
    if largest is not None:
        scale += f"; this pattern is an α-lattice up to κ = {largest:.5g}"
    linked, error = found["links"] > 0, found["edge-length error"]
    harborth = "" if found["harborth"] is None else f", an α-lattice of the plane {found['harborth']} (Harborth)"
    counted = f"at least {found['crossings']}" if found["crossings"] >= _MANY else f"{found['crossings'] or 'none'}"
    rows = [
        ("agents, dimension", f"n = {found['n']}, m = {found['m']}"),
        ("d and r", scale),
        ("kind", f"{found['kind']}, δ = {error:.4g}, δ/d = {error / found['d']:.4g}" if linked else "no links"),
        ("deviation energy E", f"{found['deviation energy']:.6g}"),
        ("links", f"{found['links']}; a planar graph has at most {found['planar bound']}{harborth}"),
        ("shortest, longest link", f"{found['shortest link']:.8g}, {found['longest link']:.8g}" if linked else "none"),
        ("least distance", "one agent" if found["least distance"] is None else f"{found['least distance']:.8g}"),
        ("components", f"{found['components']}; {'' if found['complete'] else 'not '}complete"),
        ("crossings", f"{counted}; {_CROSSING}"),
        ("graph", _planarity(found)),
        ("rigidity", _rigidity_text(found["rigidity"])),
        ("neighbours: agents", _counts(found["coordination"])),
    ]
    if (inner := found["defects"]) is not None:
        off = inner["interior"] - inner["interior coordination"].get("6", 0)
        text = f"{off} of {inner['interior']} interior agents without six neighbours, charge {inner['charge']}"
        rows.append(("defects", text if inner["interior"] else "no interior agents"))
    if found["time"] is not None:
        rows.insert(0, ("time", f"{found['time']:g}"))
    return rows


def _planarity(found: dict[str, Any]) -> str:
    if found["planar graph"]:
        return "planar"
    one = found["kuratowski"]
    return "not planar" + ("" if one is None else f": holds a subdivided {one['kind']} of {one['links']} links")


def _rigidity_text(found: dict[str, Any]) -> str:
    if "undecided" in found:
        return f"undecided: {found['undecided']}"
    plural = "" if found["flexes"] == 1 else "es"
    kind = "infinitesimally rigid" if found["infinitesimally rigid"] else f"{found['flexes']} flex{plural}"
    soft = f", {found['soft']} soft" if found["soft"] else ""
    stresses = found["self_stresses"]
    return f"{kind}{soft}; rank {found['rank']}, {stresses} self-stress{'' if stresses == 1 else 'es'}"


def _counts(numbers: dict[str, int]) -> str:
    return ", ".join(f"{k}: {v}" for k, v in numbers.items())
