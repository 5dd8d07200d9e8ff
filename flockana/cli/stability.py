"""`flockana stability`: linearise a law about an equilibrium; poles, modes, margins, norms."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from flockana.cli.options import OK, Seed

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rich.table import Table

    from flockana.stability import Linearisation, Mode

_HELP = """Linearise a law about the equilibrium nearest to a configuration: zero modes, slowest modes, margins, norms.

SOURCE is a scenario of the catalogue (its law, from the end of its run or from its start), a run that was saved (.nc),
an equilibrium's file (.json), a CSV of positions, or a builder such as hexagonal-patch:2 (see flockana lattice --help).
A CSV and a builder bring no law: it is Algorithm 1 or 2 with its usual parameters, and --d and --r.
A γ-agent that moves is held where it is at that time.

Exit status: 0 done, 2 bad input, 3 no equilibrium found, 130 interrupted.
"""
_FAILED = 3
_DENSE = 1200  # n m above which only the slowest modes are sought, without a dense matrix


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command("stability", help=_HELP)(_stability)


def _stability(
    source: Annotated[str, typer.Argument(metavar="SOURCE", help="A scenario, a file, or a builder with its size.")],
    start: Annotated[
        Literal["end", "start"], typer.Option(help="Of a scenario: begin at the end of its run, or at its start.")
    ] = "end",
    seed: Seed = 0,
    algorithm: Annotated[
        int | None,
        typer.Option("--algorithm", "--law", min=1, max=2, help="Where no law comes with the positions; by default 1."),
    ] = None,
    d: Annotated[float | None, typer.Option("--d", help="Scale, where no law comes with the positions.")] = None,
    r: Annotated[float | None, typer.Option("--r", help="Range, likewise; by default 1.2 d.")] = None,
    time: Annotated[float | None, typer.Option(help="Time in a saved run; by default its end.")] = None,
    as_given: Annotated[
        bool, typer.Option("--as-given", help="Linearise here, equilibrium or not, as if the flock stood still.")
    ] = False,
    modes: Annotated[int, typer.Option(min=1, metavar="N", help="How many of the slowest modes.")] = 8,
    delay: Annotated[bool, typer.Option("--delay", help="Delay margin: all terms, and those between agents.")] = False,
    norms: Annotated[bool, typer.Option("--norms", help="H2 and Hinf norms from forces to the shape.")] = False,
    plot: Annotated[
        Path | None, typer.Option(metavar="PICTURE", help="PNG, SVG or PDF: poles, slowest modes, Bode plot.")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, and nothing else.")] = False,
) -> int:
    from flockana.base.errors import SolverError
    from flockana.cli.flock import read_flock
    from flockana.cli.picture import KINDS, ensure_file, write_figure
    from flockana.equilibria import find_equilibrium
    from flockana.equilibria.rest import resting_state
    from flockana.stability import linearise

    if plot is not None:
        ensure_file(plot, KINDS)
    try:
        law, q = read_flock(source, start=start, seed=seed, algorithm=algorithm, d=d, r=r, time=time, potential=False)
        here = q if as_given else find_equilibrium(law, q) if law.conservative else resting_state(law, q)
        found = linearise(law, here, allow_residual=as_given)
        slow = slowest(found, modes)
        facts = summary(found, slow, source) | measures(found, delay=delay, norms=norms, strict=not as_given)
    except SolverError as error:
        typer.echo(f"flockana: {' '.join(str(error).split())}", err=True)
        return _FAILED
    if plot is not None:
        write_figure(lambda figure: _draw(figure, found, slow), plot, size=(10.4, 7.6))
    if as_json:
        typer.echo(json.dumps(facts, indent=1, ensure_ascii=False, allow_nan=False))
    else:
        _print(facts, slow, plot)
    return OK


def slowest(found: Linearisation, count: int) -> tuple[Mode, ...]:
    """The slowest modes; of a large flock without its whole spectrum."""
    from flockana.stability import slowest_modes

    return found.modes[:count] if found.q.size <= _DENSE else slowest_modes(found, count).modes


def summary(found: Linearisation, slow: Iterable[Mode], name: str) -> dict[str, Any]:
    """What the linearisation says, as plain data."""
    from flockana.stability.translational import CentreOfMass

    slow, (n, m) = tuple(slow), found.q.shape
    whole = found.q.size <= _DENSE
    invariant = found.second_order.invariant if whole else found.second_order.rigid_invariant
    law: Any = found.law
    centre = CentreOfMass(law.gains) if _follows(law) else None
    poles = None if centre is None else [[pole.real, pole.imag] for pole in centre.poles.tolist()]
    return {
        "source": name,
        "law": type(law).__name__,
        "n": n,
        "m": m,
        "links": len(found.links),
        "residual": found.residual,
        "zero modes": [mode.name for mode in invariant.zero],
        "zero modes sought": "all" if whole else "rigid motions only",
        "drifting": list(invariant.drifting),
        "spectral abscissa": -slow[0].decay_rate if slow else None,
        "splits into shape and centre": found.second_order.split.exact,
        "centre poles": poles,
        "modes": [
            {
                "name": mode.name,
                "eigenvalue": [mode.eigenvalue.real, mode.eigenvalue.imag],
                "decay rate": mode.decay_rate,
                "frequency": mode.frequency,
                "damping ratio": mode.damping_ratio,
            }
            for mode in slow
        ],
    }


def measures(found: Linearisation, *, delay: bool, norms: bool, strict: bool) -> dict[str, Any]:
    """Delay margins and norms, where asked for, as plain data; None where there is no bound."""
    from math import isfinite

    from flockana.stability.blocks import law_blocks
    from flockana.stability.delay import DELAYED, delay_margin, delay_system
    from flockana.stability.norms import disturbance_system, h2_norm, hinf_norm

    def finite(value: float) -> float | None:
        return value if isfinite(value) else None

    told: dict[str, Any] = {}
    law: Any = found.law
    if delay:
        for kind in DELAYED:
            margin = delay_margin(delay_system(law, found.q, delayed=kind, strict=strict))
            told[f"delay margin, {kind}"] = {"delay": finite(margin.delay), "frequency": finite(margin.frequency)}
    if norms:
        system = disturbance_system(law_blocks(law, found.q, strict=strict))
        assert system is not None  # shapes are always bounded
        peak = hinf_norm(system)
        told["H2"], told["Hinf"] = finite(h2_norm(system)), finite(peak[0])
        told["Hinf at"] = finite(peak[1])
    return told


def _draw(figure: Any, found: Linearisation, slow: tuple[Mode, ...]) -> None:
    """Pole map, the slowest modes of the shape, and the centre's Bode plot where there is one."""
    import numpy as np

    from flockana import plots
    from flockana.stability.translational import CentreOfMass

    law: Any = found.law
    space = "3d" if found.q.shape[1] == 3 else None
    follows = _follows(law)
    target = None if law.target is None else law.target.position(found.t)
    known = found.modes if found.q.size <= _DENSE else slow
    inner = [mode for mode in known if not mode.name.startswith("translation")] or list(known)
    halves = figure.subfigures(1, 2)
    left = halves[0].subfigures(2, 1) if follows else [halves[0]]
    poles = (
        found.eigenvalues
        if found.q.size <= _DENSE
        else [v for m in slow for v in (m.eigenvalue, np.conj(m.eigenvalue))]
    )
    plots.pole_map(poles, ax=left[0].subplots())
    if follows:
        centre = CentreOfMass(law.gains)
        omega = centre.natural_frequency * np.geomspace(0.03, 30.0, 200)
        plots.bode(
            {"centre of mass, q_r to q_c": centre.frequency_response(omega)}, axes=left[1].subplots(2, 1, sharex=True)
        )
    for k, mode in enumerate(inner[:2]):
        ax = halves[1].add_subplot(2, 1, k + 1, projection=space)
        plots.mode_shape(found.q, found.links, mode.shape, target=target, ax=ax, title=plots.mode_title(mode))


def _print(facts: dict[str, Any], slow: tuple[Mode, ...], picture: Path | None) -> None:
    from rich import box
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console(highlight=False)
    abscissa = facts["spectral abscissa"]
    kind = "no modes" if abscissa is None else "unstable" if abscissa > 0.0 else "stable off its zero modes"
    console.print(f"{facts['source']}: {kind}", style="bold", markup=False)
    table = Table(box=box.SIMPLE, show_header=False, pad_edge=False, padding=(0, 1))
    table.add_column(no_wrap=True, style="bright_black")
    table.add_column()
    for label, value in _rows(facts):
        table.add_row(label, Text(value))
    console.print(table)
    if slow:
        console.print(_modes(slow))
    if picture is not None:
        console.print(f"picture: {picture}", markup=False, soft_wrap=True)


def _rows(facts: dict[str, Any]) -> list[tuple[str, str]]:
    """Facts in words."""
    drifts = f"; drifting: {', '.join(facts['drifting'])}" if facts["drifting"] else ""
    abscissa = facts["spectral abscissa"]
    rows = [
        ("law", f"{facts['law']}, n = {facts['n']}, m = {facts['m']}, {facts['links']} links"),
        ("residual", f"{facts['residual']:.2g} of the force scale"),
        ("zero modes", f"{', '.join(facts['zero modes']) or 'none'} ({facts['zero modes sought']}){drifts}"),
        ("spectral abscissa", "—" if abscissa is None else f"{abscissa:.6g} per time unit, off the zero modes"),
    ]
    if facts["centre poles"] is not None:
        poles = ", ".join(f"{re:.5g}{f' {im:+.5g}i' if im else ''}" for re, im in facts["centre poles"])
        rows.append(("centre's poles", poles))
    for kind, words in (("all", "all terms delayed"), ("pairs", "terms between agents delayed")):
        margin = facts.get(f"delay margin, {kind}")
        if margin is not None:
            at = "" if margin["frequency"] is None else f", then a swing at {margin['frequency']:.4g} rad per time unit"
            rows.append(("delay margin", f"{words}: {_or_none(margin['delay'])}{at}"))
    for name, unit in (("H2", "time^(3/2)"), ("Hinf", "time²")):
        if name in facts:
            value = facts[name]
            rows.append((name, "infinite" if value is None else f"{value:.5g} {unit}, from forces to the shape"))
    return rows


def _or_none(value: float | None) -> str:
    return "none" if value is None else f"{value:.5g}"


def _modes(slow: tuple[Mode, ...]) -> Table:
    from rich import box
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1))
    table.add_column("mode", no_wrap=True)
    for heading in ("decay rate", "frequency (rad)", "damping ratio"):
        table.add_column(heading, justify="right", no_wrap=True)
    for mode in slow:
        table.add_row(mode.name, f"{mode.decay_rate:.5g}", f"{mode.frequency:.5g}", f"{mode.damping_ratio:.4g}")
    return table


def _follows(law: Any) -> bool:
    """Whether the centre of mass follows a γ-agent by a linear equation of its own."""
    return law.target is not None and law.splits
