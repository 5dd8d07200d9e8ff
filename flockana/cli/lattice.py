"""`flockana lattice`: measure a configuration, check Theorem 5 on it, draw it."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Annotated, Any

import typer

from flockana.cli.command_output import OK, show_facts, show_files
from flockana.cli.shared_options import AsJson, Plot, Time

if TYPE_CHECKING:
    from flockana.cli.positions_source import Source
    from flockana.measures.nets import LinkArray
    from flockana.theorems import Tolerances, Verdict

_CROSSING = "each decided exactly, for the positions as stored"


def lattice_command(
    source: Annotated[str, typer.Argument(metavar="SOURCE", help="A file, or a builder with its size.")],
    d: Annotated[float | None, typer.Option("--d", help="Desired distance; by default the run's, else 7.")] = None,
    r: Annotated[float | None, typer.Option("--r", help="Range; by default the run's, else 1.2 d.")] = None,
    tol: Annotated[
        float | None,
        typer.Option(
            metavar="SHARE",
            help="Largest |link - d|/d of an α-lattice, at most 0.1; by default 1e-6. Positions that are rounded to "
            "two decimals need about 0.001.",
        ),
    ] = None,
    time: Time = None,
    plot: Plot = None,
    as_json: AsJson = False,
) -> int:
    """Measure a configuration: α-lattice or not, links, crossings, planarity, rigidity, defects, Theorem 5.

    SOURCE is a run that was saved (.nc), a CSV of positions (a row for each agent, one to three columns, a header or
    none), an equilibrium's file (.json), or a builder with its size:

    \b
    line:5         triangular:25           hexagonal-spiral:19
    square:4x5     honeycomb:3x4 (cells)   hexagonal-patch:2 (rings)
    fcc:2x2x2, hcp:2x2x2, bcc:2x2x2 (cells), simple-cubic:2x2x2

    Exit status: 0 measured, 2 bad input, 130 interrupted.
    """
    from flockana.cli.picture_file import ensure_file, write_picture
    from flockana.cli.positions_source import read_source
    from flockana.lattice import links
    from flockana.report.console import details
    from flockana.theorems import verify

    ensure_file(plot)
    start = read_source(source, d=d, r=r, time=time)
    pairs = links(start.q, start.r)
    tolerances = _tolerances(tol)
    verdict = verify("os-5", q=start.q, d=start.d, r=start.r, subject=start.name, tolerances=tolerances)
    facts = lattice_facts(start, pairs, verdict)
    extra_facts, hint = {"verdict": verdict.to_dict()}, _hint(facts, tolerances)
    show_facts(facts | extra_facts, as_json, start.name, _rows(facts), details(verdict), *hint)
    write_picture(lambda ax: _draw(ax, start, pairs), plot, m=start.q.shape[1])
    show_files(as_json, picture=plot)
    return OK


def _tolerances(tol: float | None) -> Tolerances:
    """Return the tolerances with `tol` for an α-lattice; raise if it exceeds a quasi-α-lattice's."""
    from flockana.base.errors import ArgumentError
    from flockana.theorems import Tolerances

    if tol is not None and not 0.0 < tol <= Tolerances().quasi:
        raise ArgumentError(f"--tol {tol:g}: expected more than 0 and at most {Tolerances().quasi:g}")
    return Tolerances() if tol is None else Tolerances(lattice=tol)


def _hint(facts: dict[str, Any], tolerances: Tolerances) -> list[str]:
    """Return the option that would count this quasi-α-lattice as an α-lattice, as a hint."""
    from math import ceil, floor, log10

    error = facts["edge-length error"]
    if error is None or not tolerances.lattice < (strain := error / facts["d"]) < tolerances.quasi:
        return []
    unit = 10.0 ** floor(log10(strain))
    return [f"as an α-lattice, for Theorem 5: --tol {ceil(strain / unit) * unit:.1g}\n"]


def _draw(ax: Any, given: Source, pairs: LinkArray) -> None:
    from flockana import plots
    from flockana.lattice import coordination
    from flockana.measures.nets import link_lengths

    q, d, r = given.q, given.d, given.r
    strain = (link_lengths(q, pairs) - d) / d
    title = f"{given.name}: n = {len(q)}, {len(pairs)} links"
    plots.defect_map(q, pairs, coordination(len(q), pairs), strain=strain, limit=r / d - 1.0, ax=ax, title=title)


def lattice_facts(given: Source, pairs: LinkArray, verdict: Verdict) -> dict[str, Any]:
    """Return scale, links, crossings, rigidity and defects of a configuration as plain data."""
    from flockana.lattice import classify, coordination, harborth, is_complete, planar_bound
    from flockana.lattice.classification import GUARD
    from flockana.lattice.crossings import LISTED
    from flockana.measures.metrics import deviation_energy, min_distance
    from flockana.measures.nets import components, link_lengths

    q, d, r = given.q, given.d, given.r
    (n, m), distances = q.shape, link_lengths(q, pairs)
    error = float(abs(distances - d).max()) if len(pairs) else None
    strain = float("nan") if error is None else error / d
    graph, crossings = verdict.claim("i-graph"), verdict.claim("i").computed
    neighbours = Counter(coordination(n, pairs).tolist())
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
        "shortest link": float(distances.min()) if len(pairs) else None,
        "longest link": float(distances.max()) if len(pairs) else None,
        "least distance": min_distance(q) if n > 1 else None,
        "components": int(components(n, pairs).max()) + 1,
        "complete": is_complete(n, pairs),
        "crossings": LISTED if isinstance(crossings, str) else crossings,  # a text says that there are more
        "crossings listed at most": LISTED,
        "planar graph": graph.computed == "planar",
        "kuratowski": None if witness is None else {"kind": witness["kind"], "links": len(witness["links"])},
        "planar bound": planar_bound(n),
        "harborth": harborth(n) if m == 2 else None,
        "rigidity": _rigidity(q, pairs),
        "coordination": {str(k): count for k, count in sorted(neighbours.items())},
        "defects": _defects(q, pairs) if m == 2 else None,
    }


def _rigidity(q: Any, pairs: LinkArray) -> dict[str, Any]:
    from flockana.base.errors import SolverError
    from flockana.lattice import rigidity

    try:
        rigidity_facts = rigidity(q, pairs)
    except SolverError as error:
        return {"undecided": str(error)}
    return vars(rigidity_facts) | {"infinitesimally rigid": rigidity_facts.infinitesimally_rigid}


def _defects(q: Any, pairs: LinkArray) -> dict[str, Any]:
    from flockana.lattice import defects

    flaws = defects(q, pairs)
    inside = {str(k): v for k, v in flaws.counts.items()}
    return {"interior": int(flaws.interior.sum()), "interior coordination": inside, "charge": int(flaws.charge.sum())}


def _rows(facts: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the table rows of measured lattice facts."""
    kappa, largest = facts["r"] / facts["d"], facts["largest ratio of the pattern"]
    scale = f"{facts['d']:g} and {facts['r']:g}, κ = {kappa:.5g}"
    if largest is not None:
        scale += f"; this pattern is an α-lattice up to κ = {largest:.5g}"
    linked, error = facts["links"] > 0, facts["edge-length error"]
    harborth = "" if facts["harborth"] is None else f", an α-lattice of the plane {facts['harborth']} (Harborth)"
    counted = f"{'at least ' if facts['crossings'] >= facts['crossings listed at most'] else ''}{facts['crossings']}"
    witness = facts["kuratowski"]
    contained = f": contains a subdivision of {witness['kind']} with {witness['links']} links" if witness else ""
    rows = [
        ("agents, dimension", f"n = {facts['n']}, m = {facts['m']}"),
        ("d and r", scale),
        ("kind", f"{facts['kind']}, δ = {error:.4g}, δ/d = {error / facts['d']:.4g}" if linked else "no links"),
        ("deviation energy E", f"{facts['deviation energy']:.6g}"),
        ("links", f"{facts['links']}; a planar graph has at most {facts['planar bound']}{harborth}"),
        ("shortest, longest link", f"{facts['shortest link']:.8g}, {facts['longest link']:.8g}" if linked else "none"),
        ("least distance", "one agent" if facts["least distance"] is None else f"{facts['least distance']:.8g}"),
        ("components", f"{facts['components']}; {'' if facts['complete'] else 'not '}complete"),
        ("crossings", f"{counted if facts['crossings'] else 'none'}; {_CROSSING}"),
        ("graph", "planar" if facts["planar graph"] else f"not planar{contained}"),
        ("rigidity", _rigidity_text(facts["rigidity"])),
        ("neighbours: agents", ", ".join(f"{k}: {count}" for k, count in facts["coordination"].items())),
    ]
    if (inner := facts["defects"]) is not None:
        off = inner["interior"] - inner["interior coordination"].get("6", 0)
        text = f"{off} of {inner['interior']} interior agents without six neighbours, charge {inner['charge']}"
        rows.append(("defects", text if inner["interior"] else "no interior agents"))
    if facts["time"] is not None:
        rows.insert(0, ("time", f"{facts['time']:g}"))
    return rows


def _rigidity_text(rigidity: dict[str, Any]) -> str:
    if "undecided" in rigidity:
        return f"undecided: {rigidity['undecided']}"
    plural = "" if rigidity["flexes"] == 1 else "es"
    kind = "infinitesimally rigid" if rigidity["infinitesimally rigid"] else f"{rigidity['flexes']} flex{plural}"
    soft_text = f", {rigidity['soft']} soft" if rigidity["soft"] else ""
    stresses = rigidity["self_stresses"]
    return f"{kind}{soft_text}; rank {rigidity['rank']}, {stresses} self-stress{'' if stresses == 1 else 'es'}"
