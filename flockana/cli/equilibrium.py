"""`flockana equilibrium`: find an equilibrium of a law, name its kind, save it."""

from __future__ import annotations

from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from flockana.cli.command_output import OK, UNEXPECTED, print_error, show_facts, show_files
from flockana.cli.shared_options import Algorithm, AnySeed, AsJson, Plot, Range, Scale, SourceName, Start, Time, output

if TYPE_CHECKING:
    from flockana.equilibria import Equilibrium

_LOWEST = 6  # eigenvalues that are printed


def equilibrium_command(
    source: SourceName,
    *,
    start: Start = None,
    seed: AnySeed = None,
    algorithm: Algorithm = None,
    d: Scale = None,
    r: Range = None,
    time: Time = None,
    save_to: Annotated[Path | None, output("JSON file to write.")] = None,
    plot: Plot = None,
    as_json: AsJson = False,
) -> int:
    """Find an equilibrium near a configuration with IPOPT, and classify it.

    SOURCE is a scenario of the catalogue (its law, from the end of its run or from its start), a run that was saved
    (.nc), an equilibrium's file (.json), FILE.py:NAME, a CSV of positions, or a builder such as hexagonal-spiral:19
    (see flockana lattice --help). For a CSV or a builder the law is Algorithm 1 or 2 with default parameters, --d and
    --r. A moving γ-agent is fixed at its position at that time. Semi-implicit Euler has the equilibria of its law.
    Under dead-zone flocking strain is measured on contacts, pairs closer than d1.

    Exit status: 0 found, 2 bad input, 3 no equilibrium found, 130 interrupted.
    """
    from flockana.base.errors import SolverError
    from flockana.cli.flock_arguments import announce_time, read_motion
    from flockana.cli.picture_file import ensure_file, write_picture
    from flockana.equilibria import find_equilibrium
    from flockana.equilibria.equilibrium_files import write_equilibrium

    ensure_file(save_to, (".json",))
    ensure_file(plot)
    try:
        read_options: Any = {"start": start, "seed": seed, "algorithm": algorithm, "d": d, "r": r, "time": time}
        law, q, _ = read_motion(source, **read_options, potential=True)
        announce_time(len(q))
        equilibrium = find_equilibrium(law, q)
    except SolverError as error:
        print_error(error)
        return UNEXPECTED
    facts = summary(equilibrium, source)
    show_facts(facts, as_json, f"{source}: {equilibrium.kind}", _rows(equilibrium, facts))
    if save_to is not None:
        write_equilibrium(equilibrium, save_to)
    write_picture(lambda ax: _draw(ax, equilibrium, source), plot, m=equilibrium.q.shape[1])
    show_files(as_json, saved=save_to, picture=plot)
    return OK


def summary(equilibrium: Equilibrium, name: str) -> dict[str, Any]:
    """Return the equilibrium and its kind as plain data."""
    from flockana.equilibria.potential import Potential
    from flockana.measures.metrics import coincident_pairs

    (n, m), strain = equilibrium.q.shape, equilibrium.strain()
    facts = {"source": name, "law": type(equilibrium.law).__name__, "n": n, "m": m}
    facts |= {key: getattr(equilibrium, key) for key in ("kind", "energy", "residual")}
    return facts | {
        "links": len(equilibrium.links),
        "strain": None if isnan(strain) else strain,
        "coincident pairs": coincident_pairs(equilibrium.q, 1e-6 * Potential(equilibrium.law).pair.length),
        "solver": equilibrium.message,
        "rigid modes": equilibrium.rigid_modes,
        "soft modes": equilibrium.zero_modes,
        "index": equilibrium.index,
        "hessian eigenvalues": equilibrium.hessian_eigenvalues.tolist(),
        "q": equilibrium.q.tolist(),
    }


def _draw(ax: Any, equilibrium: Equilibrium, name: str) -> None:
    from flockana import plots
    from flockana.cli.positions_source import law_scales
    from flockana.equilibria.potential import Potential
    from flockana.measures.nets import links

    law, (d, r) = equilibrium.law, law_scales(equilibrium.law)
    plots.configuration(
        equilibrium.q,
        d=d,
        r=r,
        target=Potential(law).target,
        obstacles=law.obstacles,
        beta=None if law.obstacle_field is None else law.obstacle_field.beta,
        ax=ax,
        title=f"{name}: {equilibrium.kind}, {len(links(equilibrium.q, r))} links up to {r:.4g}",
    )


def _rows(equilibrium: Equilibrium, facts: dict[str, Any]) -> tuple[tuple[str, str], ...]:
    """Return the equilibrium's facts as table rows."""
    lowest = ", ".join(f"{value:.4g}" for value in equilibrium.hessian_eigenvalues[:_LOWEST])
    contacts = equilibrium.law.lattice is None
    scale, length = ("a contact's force", "contact − d1|/d1") if contacts else ("the law's force scale", "link − d|/d")
    strain = "" if facts["strain"] is None else f", |{length} at most {facts['strain']:.4g}"
    return (
        ("law", f"{facts['law']}, n = {facts['n']}, m = {facts['m']}"),
        ("energy", f"{equilibrium.energy:.10g}"),
        ("residual force", f"{equilibrium.residual:.2g} of {scale}"),
        ("links", f"{facts['links']}{strain}"),
        ("coincident pairs", str(facts["coincident pairs"])),
        ("solver", equilibrium.message),
        ("zero modes", f"{equilibrium.rigid_modes} rigid, {equilibrium.zero_modes} soft; {equilibrium.index} negative"),
        ("lowest eigenvalues", f"{lowest or 'none'} (off the rigid motions)"),
    )
