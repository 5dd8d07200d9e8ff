"""`flockana observe`: measure a recorded flock, compare it with a law, fit gains, judge theorems, write a page."""

from __future__ import annotations

import re
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from flockana.base.errors import ArgumentError, FlockanaError
from flockana.cli.command_output import OK, UNEXPECTED, show, show_files, show_json
from flockana.cli.shared_options import AsJson, output

if TYPE_CHECKING:
    from flockana.recorded.recording import Recording


def observe_command(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE", help="CSV, TSV, npz, mat, netCDF or a dump of LAMMPS; example: the one shipped."
        ),
    ],
    *,
    law: Annotated[
        str | None,
        typer.Option("--law", metavar="NAME", help="Law to compare with: a scenario's, algorithm-1, or FILE.py:NAME."),
    ] = None,
    formula: Annotated[
        str | None,
        typer.Option(metavar="ψ(s)", help="Pair potential of Algorithm 1, instead of --law; needs --d, --r."),
    ] = None,
    fit: Annotated[bool, typer.Option("--fit", help="Fit the law's gains.")] = False,
    bound: Annotated[float | None, typer.Option(help="Largest error of a recorded position.")] = None,
    sd: Annotated[float | None, typer.Option(help="Standard deviation, instead of --bound.")] = None,
    d: Annotated[float | None, typer.Option("--d", help="Desired distance; by default the law's.")] = None,
    r: Annotated[float | None, typer.Option("--r", help="Range of nets; by default 1.2 d.")] = None,
    dt: Annotated[float | None, typer.Option(help="Time between frames, if the file has no times.")] = None,
    columns: Annotated[
        str | None,
        typer.Option(metavar="NAMES", help="Which column is what: t=when,id=bird,q=east+north; or all in order."),
    ] = None,
    axes: Annotated[
        str | None, typer.Option(metavar="NAMES", help="Axes of an array: time,agent,axis in its order.")
    ] = None,
    box: Annotated[
        str | None, typer.Option(metavar="L[,L..]", help="Periods of positions, which are unwrapped.")
    ] = None,
    m: Annotated[int | None, typer.Option("--m", help="Dimension; by default that of the positions.")] = None,
    jitter: Annotated[float | None, typer.Option(help="Stamps within this of each other are one instant.")] = None,
    interpolate: Annotated[
        float | None,
        typer.Option(help="Largest acceleration, to interpolate agents sampled at other times; 0 leaves gaps."),
    ] = None,
    missing: Annotated[
        str | None, typer.Option(metavar="X[,X..]", help="Numbers that stand for 'not seen', such as -9999; or none.")
    ] = None,
    window: Annotated[str | None, typer.Option(metavar="T0,T1", help="First and last time that count.")] = None,
    clock: Annotated[float | None, typer.Option(help="Seconds in one time unit, if times are dates.")] = None,
    page: Annotated[Path | None, output("HTML page to write, with a player.")] = None,
    as_json: AsJson = False,
) -> int:
    """Measure a recorded flock, compare it with a law, judge theorems on it.

    For example: flockana observe example --sd 0.05 --d 7 -o report.html

    Exit status: 0 done, 2 bad input, 3 the recording does not follow the law, 130 interrupted.
    """
    from flockana.base.files import ensure_target, write_atomic
    from flockana.recorded.example_recording import EXAMPLE_FILE
    from flockana.recorded.recording_reader import read_recording
    from flockana.report.recording import measure_rows, recording_page

    if page is not None:
        ensure_target(page)
    if law is not None and formula is not None:
        raise ArgumentError("--law and --formula are both given: expected one of them")
    try:
        rec = read_recording(
            EXAMPLE_FILE if str(file) == "example" and not file.exists() else file,
            columns=_columns(columns),
            axes=axes,
            box=None if box is None else _numbers("--box", box),
            m=m,
            jitter=jitter,
            interpolate=interpolate or (None if interpolate is None else False),
            missing=None if missing is None else [] if missing == "none" else _numbers("--missing", missing),
            dt=dt,
            clock=clock,
            bound=bound,
            sd=sd,
        )
    except FlockanaError as error:
        error.args = (_with_options(str(error)),)
        raise
    if window is not None:
        window_ends = _numbers("--window", window)
        if len(window_ends) != 2:
            raise ArgumentError(f"--window {window}: expected two times, such as 0,2.5")
        rec = rec.window(*window_ends)
    chosen_law = _law(law, formula, d, r)
    if fit and chosen_law is None:
        raise ArgumentError("--fit: expected --law or --formula, whose gains are fitted")
    scale, reach = _scales(chosen_law, d, r)
    complete_recording, notes = _complete(rec)
    metrics = rec.metrics(d=scale, r=reach)
    results = _results(complete_recording, chosen_law, fit, scale, reach)
    if as_json:
        show_json(_plain(rec, metrics, results))
    else:
        _print(rec, measure_rows(metrics), results, notes)
    if page is not None:
        reference = None if complete_recording is None else complete_recording.trajectory(chosen_law, d=scale, r=reach)
        write_atomic(page, recording_page(rec, metrics, trajectory=reference, notes=notes, **results))
        show_files(as_json, page=page)
    follow_statuses = [v.hypotheses[0].status for v in results["verdicts"] if v.hypotheses]
    return UNEXPECTED if chosen_law is not None and "unmet" in follow_statuses[:1] else OK


def _with_options(text: str) -> str:
    """Return an error message with command-line options in place of the arguments of `read_recording`."""

    def option(match: re.Match[str]) -> str:
        pairs = re.findall(r"""["']?(\w+)["']?: (\[[^]]*\]|[^,]+)""", match[1].replace("[...]", "NAME+NAME"))
        named_options = ((key, re.sub(r"[][' \"]", "", value)) for key, value in pairs)
        return "--columns " + ",".join(
            f"{key}={value.replace(',', '+').replace('...', 'NAME')}" for key, value in named_options
        )

    text = re.sub(r"columns={(.*?)}", option, text)
    text = text.replace("missing=()", "--missing none")
    return re.sub(r"\b(axes|bound|box|clock|columns|dt|interpolate|jitter|m|missing|sd)=,?", r"--\1 ", text)


def _law(name: str | None, formula: str | None, d: float | None, r: float | None) -> Any:
    """Return the law to compare the recording with; None if no option names one."""
    from flockana.cli.command_subject import is_own, read_law
    from flockana.interactions import FormulaInteraction
    from flockana.laws import Algorithm1
    from flockana.recorded.unknown_law import scaled_alpha
    from flockana.scenarios import scenario

    if formula is not None:
        if d is None or r is None:
            raise ArgumentError(f"--formula {formula!r}: expected --d and --r, its length and its range")
        return Algorithm1(alpha=FormulaInteraction(formula, adjacency_formula="(1 - s/r)**2", r=r, d=d))
    if name is None:
        return None
    if name == "algorithm-1":
        return Algorithm1() if d is None and r is None else Algorithm1(alpha=scaled_alpha(d, r))
    return read_law(name) if is_own(name) else scenario(name).law


def _scales(law: Any, d: float | None, r: float | None) -> tuple[float, float]:
    from flockana.cli.positions_source import law_scales
    from flockana.recorded.unknown_law import scaled_alpha

    if d is not None or r is not None:
        alpha = scaled_alpha(d, r)
        return alpha.length, alpha.range
    if law is None:
        raise ArgumentError("no law, --d or --r: expected --law NAME, or --d, the desired distance of neighbours")
    return law_scales(law)


def _columns(text: str | None) -> Any:
    """Return the names of table columns, as a list or by meaning, as `read_recording` takes them."""
    if text is None:
        return None
    parts = [part.strip() for part in text.split(",")]
    if not any("=" in part for part in parts):
        return parts
    pairs = [part.partition("=") for part in parts]
    if bad_columns := [part for part, (_, sign, names) in zip(parts, pairs, strict=True) if not sign or not names]:
        raise ArgumentError(f"--columns {bad_columns[0]!r}: expected MEANING=NAME, such as t=when,id=bird,q=east+north")
    return {key: names.split("+") if key in ("q", "p", "u", "agents") else names for key, _, names in pairs}


def _numbers(name: str, text: str) -> list[float]:
    try:
        return [float(piece_text) for piece_text in text.split(",")]
    except ValueError:
        raise ArgumentError(f"{name} {text}: expected numbers with commas between them") from None


def _complete(rec: Recording) -> tuple[Recording | None, list[str]]:
    """Return the complete part of a recording, and a sentence about the omitted part."""
    if not rec.gaps:
        return rec, []
    part = rec.complete()
    if len(part.t) < 4:
        return None, ["No part of four samples is complete: no law is compared and no theorem judged."]
    agents = f"{part.n} of {rec.n} agents" if part.n < rec.n else "All agents"
    note = f"{agents} are seen from t = {part.t[0]:g} to {part.t[-1]:g}: laws and theorems are held against this part."
    return part, [note]


def _results(rec: Recording | None, law: Any, fit: bool, d: float, r: float) -> dict[str, Any]:
    """Return comparison, fit and verdicts, in the form that `recording_page` expects."""
    from flockana.recorded.compare import compare
    from flockana.recorded.fit import fit as fitted
    from flockana.theorems import verify

    if rec is None:
        return {"verdicts": []}
    if law is None:
        return {"verdicts": verify(None, rec, d=d, r=r) if len(rec.t) > 1 else []}
    results: dict[str, Any] = {"comparison": compare(rec, law)}
    if fit:
        results["fitted"] = fitted(rec, law)
    return results | {"verdicts": verify(None, rec, law=law)}


def _print(rec: Recording, rows: list[tuple[str, str, str]], results: dict[str, Any], notes: list[str]) -> None:
    from flockana.report.tables import fact_table

    facts = tuple((name, f"{first} to {last_value}") for name, first, last_value in rows)
    console = show(repr(rec).strip("<>").partition("; read as ")[0], fact_table(facts))
    for text in rec.read_as:
        console.print(f"read: {text}", markup=False)
    for note in notes:
        console.print(note, markup=False)
    for key in ("comparison", "fitted"):
        if key in results:
            console.print(str(results[key]), markup=False)
    verdicts = results["verdicts"]
    if verdicts:
        first = verdicts[0].hypotheses[0]
        console.print(f"{first.name}: {first.status}. {first.detail}", markup=False)
        console.print(fact_table((v.theorem, f"{v.status} ({v.rigour}): {v.summary}") for v in verdicts))


def _plain(rec: Recording, seen: Any, results: dict[str, Any]) -> dict[str, Any]:
    """Return measures, comparison, fit and verdicts of a recorded flock as plain data for JSON."""
    series = {str(name): seen[name].values.astype(float).tolist() for name in seen.data_vars}
    measures = {name: [x if isfinite(x) else None for x in values] for name, values in series.items()}
    plain_values: dict[str, Any] = {
        "recording": repr(rec),
        "read_as": list(rec.read_as),
        "time": rec.t.tolist(),
        "measures": measures,
    }
    if "comparison" in results:
        plain_values["comparison"] = results["comparison"].to_dict()
    if "fitted" in results:
        fitted = results["fitted"]
        intervals = {name: [x if isfinite(x) else None for x in pair] for name, pair in fitted.intervals.items()}
        plain_values["fit"] = {"values": dict(fitted.values), "intervals": intervals, "doubts": list(fitted.doubts)}
    return plain_values | {"verdicts": [verdict.to_dict() for verdict in results["verdicts"]]}
