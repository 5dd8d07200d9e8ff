"""`flockana stability`: linearise a law about an equilibrium; poles, modes, margins, norms."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from flockana.cli.command_output import OK, UNEXPECTED, print_error, show_facts, show_files
from flockana.cli.shared_options import Algorithm, AnySeed, AsJson, At, Plot, Range, Scale, SourceName, Start, Time
from flockana.cli.thread_limit import one_thread_for_matrices

if TYPE_CHECKING:
    from collections.abc import Iterable

    from rich.table import Table

    from flockana.stability import Linearisation, Mode

DENSE = 1200  # n m above which only the slowest modes are sought, without a dense matrix


@one_thread_for_matrices()
def stability_command(
    source: SourceName,
    *,
    start: Start = None,
    seed: AnySeed = None,
    algorithm: Algorithm = None,
    d: Scale = None,
    r: Range = None,
    time: Time = None,
    at: At = None,
    as_given: Annotated[
        bool, typer.Option("--as-given", help="Linearise these positions at rest, equilibrium or not.")
    ] = False,
    side: Annotated[
        Literal["inner", "outer"] | None,
        typer.Option(help="Where pairs stand at a kink: the law just inside, or outside."),
    ] = None,
    modes: Annotated[int, typer.Option(min=1, metavar="N", help="Number of slowest modes.")] = 8,
    delay: Annotated[bool, typer.Option("--delay", help="Delay margins: of all terms, and of pair terms.")] = False,
    norms: Annotated[bool, typer.Option("--norms", help="H2 and Hinf norms from forces to the shape.")] = False,
    plot: Plot = None,
    as_json: AsJson = False,
) -> int:
    """Linearise a law about the equilibrium nearest to a configuration: zero modes, slowest modes, margins, norms.

    Any law is taken: of one with delays the rightmost roots are shown, of a map or a sampled law the multipliers, about
    the motion at hand where it has no rest of its own.

    SOURCE is a scenario of the catalogue (its law, from the end of its run or from its start), a flock, run or law of
    a Python file as FILE.py:NAME (a law with --at), a run that was saved (.nc), an equilibrium's file (.json), a CSV of
    positions, or a builder such as hexagonal-patch:2 (see flockana lattice --help). For a CSV or a builder the law is
    Algorithm 1 or 2 with default parameters, --d and --r. A moving γ-agent is fixed at its position at that time.

    Exit status: 0 done, 2 bad input, 3 no equilibrium found, 130 interrupted.
    """
    from flockana.base.errors import ArgumentError, SolverError
    from flockana.base.progress import progress_bar
    from flockana.cli.flock_arguments import announce_time, read_motion
    from flockana.cli.picture_file import KINDS, ensure_file, write_figure
    from flockana.stability import Linearisation, linearise

    ensure_file(plot, KINDS)
    try:
        law, q, p = read_motion(source, start=start, seed=seed, algorithm=algorithm, d=d, r=r, time=time, at=at)
        announce_time(len(q), as_given=as_given)
        with progress_bar(2, enabled=q.size > DENSE) as advance:
            advance(0, "equilibrium")
            rest_state = q if as_given else rest_of(law, q)
            linear: Any = linearise(law, rest_state, _velocities(law, p), allow_residual=as_given, side=side)
            advance(1, "slowest modes")
            if not isinstance(linear, Linearisation):
                return _show_loop(linear, source, modes, delay=delay, norms=norms, as_json=as_json, plot=plot)
            slow = slowest(linear, modes)
        facts = summary(linear, slow, source) | margins_and_norms(linear, delay=delay, norms=norms)
    except SolverError as error:
        print_error(error)
        return UNEXPECTED
    except ArgumentError as error:
        raise _with_flags(error) from None
    show_facts(facts, as_json, _title(facts, slow), _rows(facts), *([_mode_table(slow)] if slow else []))
    write_figure(lambda figure: _draw(figure, linear, slow), plot, size=(10.4, 7.6))
    show_files(as_json, picture=plot)
    return OK


_FLAGS = {
    "start from find_equilibrium(...), or ask for allow_residual=True": "--as-given linearises it all the same",
    "allow_residual=True": "--as-given",
    'side="inner" or side="outer"': "--side inner or --side outer",
    "give a larger limit": "ask in Python with a larger limit=",
}


def _with_flags(error: Exception) -> Exception:
    """Return an error message with command options in place of function arguments."""
    text = str(error)
    for argument, flag in _FLAGS.items():
        text = text.replace(argument, flag)
    return error if text == str(error) else type(error)(text)


def _velocities(law: Any, p: Any) -> Any:
    """Return the velocities of a map's state; None for laws linearised at rest."""
    from flockana.laws.discrete import is_own_map

    return p if is_own_map(law) else None


def rest_of(law: Any, q: Any) -> Any:
    """Return the equilibrium or rest of a law near given positions; for maps without a law, the positions."""
    from flockana.equilibria import find_equilibrium
    from flockana.equilibria.rest_without_potential import resting_state
    from flockana.laws.discrete import is_own_map
    from flockana.stability.wrapped_loops import instant_law

    if is_own_map(law):
        return q
    acting_law = law if law.continuous is None else instant_law(law.continuous)
    has_energy = acting_law.terms and acting_law.conservative
    return find_equilibrium(acting_law, q) if has_energy else resting_state(acting_law, q)


def _show_loop(
    linear: Any, name: str, count: int, *, delay: bool, norms: bool, as_json: bool, plot: Path | None
) -> int:
    """Show a delayed law by its rightmost roots, or a map by its slowest modes, without a picture."""
    from flockana.base.errors import ArgumentError
    from flockana.stability import DelayLinearisation, VelocityLinearisation

    if plot is not None:
        raise ArgumentError(
            f"--plot {plot}: expected a continuous law without a past or a clock, whose modes are drawn"
        )
    for flag, is_asked, method in (("--norms", norms, "norms"), ("--delay", delay, "delay_margin")):
        if is_asked and not hasattr(type(linear), method):
            raise ArgumentError(
                f"{flag}: a {type(linear).__name__} of {linear.law.title} has none; leave {flag} out, or ask it of "
                "the law without its past or clock"
            )
    facts: dict[str, Any] = {"source": name, "law": linear.law.title, "n": len(linear.q)}
    facts |= {"residual": linear.residual, "stable": linear.stable}
    if isinstance(linear, DelayLinearisation):
        facts["delays"] = list(linear.delays)
        facts["rightmost roots"] = [[s.real, s.imag] for s in linear.rightmost(count).tolist()]
        if delay:
            facts |= _finite_margin("delay margin", linear.delay_margin())
    elif isinstance(linear, VelocityLinearisation):
        facts |= {"zero modes": linear.zero_modes, "decay rate": linear.decay_rate}
        facts["poles"] = [[s.real, s.imag] for s in linear.eigenvalues[: linear.zero_modes + count].tolist()]
        if delay:
            facts |= _finite_margin("delay margin", linear.delay_margin())
    else:
        facts |= {"dt": linear.dt, "zero modes": [mode.name for mode in linear.zero_modes]}
        facts["spectral radius"] = linear.spectral_radius
        modes = linear.modes[:count]
        facts["multipliers"] = [[mode.multiplier.real, mode.multiplier.imag] for mode in modes]
    rows = [(key, _text(value)) for key, value in facts.items() if key not in ("source", "stable")]
    show_facts(facts, as_json, f"{name}: {'stable off its zero modes' if linear.stable else 'unstable'}", rows)
    return OK


def _text(value: Any) -> str:
    """Return a fact as table text: complex numbers, names, numbers."""
    if isinstance(value, dict):
        return ", ".join(f"{key} {_text(item)}" for key, item in value.items())
    if isinstance(value, list):
        pairs = value and isinstance(value[0], list)
        return ", ".join(
            f"{item[0]:.5g}{f' {item[1]:+.5g}i' if item[1] else ''}" if pairs else _text(item) for item in value
        )
    return f"{value:.5g}" if isinstance(value, float) else "none" if value is None else str(value)


def _finite_margin(name: str, margin: Any) -> dict[str, Any]:
    """Return a delay margin as plain data; None where unbounded."""
    from math import isfinite

    summary = {key: getattr(margin, key) for key in ("delay", "frequency", "least")}
    plain_values = {key: value if isfinite(value) else None for key, value in summary.items()}
    return {name: plain_values | {"certified": margin.certified}}


def slowest(linear: Linearisation, count: int) -> tuple[Mode, ...]:
    """Return the slowest modes; for a large flock without the whole spectrum."""
    from flockana.stability import slowest_modes

    return linear.modes[:count] if linear.q.size <= DENSE else slowest_modes(linear, count).modes


def summary(linear: Linearisation, slow: Iterable[Mode], name: str) -> dict[str, Any]:
    """Return the residual, zero modes, slow modes and stability of a linearisation as plain data."""
    from flockana.stability.centre_transfer import CentreOfMass

    slow, (n, m) = tuple(slow), linear.q.shape
    is_small = linear.q.size <= DENSE
    invariant = linear.second_order.invariant if is_small else linear.second_order.rigid_invariant
    law: Any = linear.law
    centre = CentreOfMass(law.gains) if _follows(law) else None
    poles = None if centre is None else [[pole.real, pole.imag] for pole in centre.poles.tolist()]
    return {
        "source": name,
        "law": law.title,
        "n": n,
        "m": m,
        "links": len(linear.links),
        "residual": linear.residual,
        "zero modes": [mode.name for mode in invariant.zero],
        "zero modes sought": "all" if is_small else "rigid motions only",
        "drifting": list(invariant.drifting),
        "stable": all(mode.decays for mode in slow) if slow else None,
        "spectral abscissa": -slow[0].decay_rate if slow else None,
        "splits into shape and centre": linear.second_order.split.exact,
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


def margins_and_norms(linear: Linearisation, *, delay: bool, norms: bool) -> dict[str, Any]:
    """Return the requested delay margins and norms as plain data; None where unbounded."""
    from math import isfinite

    from flockana.stability.delay import DELAYED

    facts: dict[str, Any] = {}
    if delay:
        for kind in DELAYED:
            margin = linear.delay_margin(delayed=kind, progress=sys.stderr.isatty())
            facts |= _finite_margin(f"delay margin, {kind}", margin)
    if norms:
        summary = zip(("H2", "Hinf", "Hinf at"), linear.norms(), strict=True)
        facts |= {key: value if isfinite(value) else None for key, value in summary}
    return facts


def _draw(figure: Any, linear: Linearisation, slow: tuple[Mode, ...]) -> None:
    """Draw the pole map, the slowest modes, and the centre's Bode plot where there is one."""
    import numpy as np

    from flockana import plots
    from flockana.stability.centre_transfer import CentreOfMass

    law: Any = linear.law
    space = "3d" if linear.q.shape[1] == 3 else None
    is_following = _follows(law)
    target = None if law.target is None else law.target.position(linear.t)
    modes = linear.modes if linear.q.size <= DENSE else slow
    inner = [mode for mode in modes if not mode.name.startswith("translation")] or list(modes)
    halves = figure.subfigures(1, 2)
    left = halves[0].subfigures(2, 1) if is_following else [halves[0]]
    poles = (
        linear.eigenvalues
        if linear.q.size <= DENSE
        else [v for m in slow for v in (m.eigenvalue, np.conj(m.eigenvalue))]
    )
    plots.pole_map(poles, ax=left[0].subplots())
    if is_following:
        centre = CentreOfMass(law.gains)
        omega = centre.natural_frequency * np.geomspace(0.03, 30.0, 200)
        plots.bode(
            {"centre of mass, q_r to q_c": centre.frequency_response(omega)}, ax=left[1].subplots(2, 1, sharex=True)
        )
    for k, mode in enumerate(inner[:2]):
        ax = halves[1].add_subplot(2, 1, k + 1, projection=space)
        plots.mode_shape(linear.q, linear.links, mode.shape, target=target, ax=ax, title=plots.mode_title(mode))


def _title(facts: dict[str, Any], slow: tuple[Mode, ...]) -> str:
    growth_text = "unstable" if any(mode.decay_rate < -mode.error for mode in slow) else "some modes do not decay"
    kind = {None: "no modes", True: "stable off its zero modes", False: growth_text}[facts["stable"]]
    return f"{facts['source']}: {kind}"


def _rows(facts: dict[str, Any]) -> list[tuple[str, str]]:
    """Return the linearisation's facts as table rows."""
    drift_text = f"; drifting: {', '.join(facts['drifting'])}" if facts["drifting"] else ""
    abscissa = facts["spectral abscissa"]
    rows = [
        ("law", f"{facts['law']}, n = {facts['n']}, m = {facts['m']}, {facts['links']} links"),
        ("residual", f"{facts['residual']:.2g} of the force scale"),
        ("zero modes", f"{', '.join(facts['zero modes']) or 'none'} ({facts['zero modes sought']}){drift_text}"),
        ("spectral abscissa", "—" if abscissa is None else f"{abscissa:.6g} per time unit, off the zero modes"),
    ]
    if facts["centre poles"] is not None:
        poles = ", ".join(f"{re:.5g}{f' {im:+.5g}i' if im else ''}" for re, im in facts["centre poles"])
        rows.append(("centre's poles", poles))
    for kind, words in (
        ("all", "all terms delayed"),
        ("pairs", "terms between agents delayed"),
        ("neighbours", "what is heard of others delayed"),
    ):
        margin = facts.get(f"delay margin, {kind}")
        if margin is not None:
            at = "" if margin["frequency"] is None else f", then a swing at {margin['frequency']:.4g} rad per time unit"
            limit_text = "" if margin["certified"] else "at most "
            delay = "none" if margin["delay"] is None else f"{margin['delay']:.5g}"
            rows.append(("delay margin", f"{words}: {limit_text}{delay}{at}"))
    for name, unit in (("H2", "time^(3/2)"), ("Hinf", "time²")):
        if name in facts:
            value = facts[name]
            rows.append((name, "infinite" if value is None else f"{value:.5g} {unit}, from forces to the shape"))
    return rows


def _mode_table(slow: tuple[Mode, ...]) -> Table:
    from flockana.report.tables import column, headed_table

    headings = ("decay rate (1/time)", "frequency (rad/time)", "damping ratio")
    table = headed_table(column("mode"), *(column(heading, right=True) for heading in headings))
    for mode in slow:
        table.add_row(mode.name, f"{mode.decay_rate:.5g}", f"{mode.frequency:.5g}", f"{mode.damping_ratio:.4g}")
    return table


def _follows(law: Any) -> bool:
    """Return whether the centre of mass follows a γ-agent by a linear equation of its own."""
    return law.target is not None and law.centre_decouples
