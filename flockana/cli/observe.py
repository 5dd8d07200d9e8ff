"""`flockana observe`: measure a recorded flock, compare it with a law, fit gains, judge theorems, write a page."""

from __future__ import annotations

from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from flockana.base.errors import ArgumentError
from flockana.cli.options import AsJson, output
from flockana.cli.show import OK, UNEXPECTED, show, show_files, show_json

if TYPE_CHECKING:
    from flockana.recorded.recording import Recording


def observe_command(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="CSV, TSV, npz, mat, netCDF or a dump of LAMMPS.")],
    *,
    law: Annotated[
        str | None, typer.Option("--law", metavar="NAME", help="Law to compare with: a scenario's, or algorithm-1.")
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
    clock: Annotated[float | None, typer.Option(help="Seconds in one time unit, if times are dates.")] = None,
    page: Annotated[Path | None, output("HTML page to write, with a player.")] = None,
    as_json: AsJson = False,
) -> int:
    """Measure a recorded flock, compare it with a law, judge theorems on it.

    For example: flockana observe tracks.csv --law square-root --sd 0.05 --fit -o report.html

    Exit status: 0 done, 2 bad input, 3 the recording does not follow the law, 130 interrupted.
    """
    from flockana.base.files import ensure_target, write_atomic
    from flockana.recorded.read import read_recording
    from flockana.report.recording import measure_rows, recording_page

    if page is not None:
        ensure_target(page)
    if law is not None and formula is not None:
        raise ArgumentError("--law and --formula are both given: expected one of them")
    rec = read_recording(file, dt=dt, clock=clock, bound=bound, sd=sd)
    chosen = _law(law, formula, d, r)
    if fit and chosen is None:
        raise ArgumentError("--fit: expected --law or --formula, whose gains are fitted")
    scale, reach = _scales(chosen, d, r)
    whole, notes = _complete(rec)
    seen = rec.metrics(d=scale, r=reach)
    results = _results(whole, chosen, fit, scale, reach)
    if as_json:
        show_json(_plain(rec, seen, results))
    else:
        _print(rec, measure_rows(seen), results, notes)
    if page is not None:
        shown = None if whole is None else whole.trajectory(chosen, d=scale, r=reach)
        write_atomic(page, recording_page(rec, seen, trajectory=shown, notes=notes, **results))
        show_files(as_json, page=page)
    follows = [v.hypotheses[0].status for v in results["verdicts"] if v.hypotheses]
    return UNEXPECTED if chosen is not None and "unmet" in follows[:1] else OK


def _law(name: str | None, formula: str | None, d: float | None, r: float | None) -> Any:
    """Return the law to compare the recording with; None if none is given."""
    from flockana.interactions import pair_law
    from flockana.laws import Algorithm1
    from flockana.recorded.recording import scaled_alpha
    from flockana.scenarios import scenario

    if formula is not None:
        if d is None or r is None:
            raise ArgumentError(f"--formula {formula!r}: expected --d and --r, its length and its range")
        return Algorithm1(alpha=pair_law(formula, adjacency="(1 - s/r)**2", range=r, length=d))
    if name is None:
        return None
    if name == "algorithm-1":
        return Algorithm1() if d is None and r is None else Algorithm1(alpha=scaled_alpha(d, r))
    return scenario(name).law


def _scales(law: Any, d: float | None, r: float | None) -> tuple[float, float]:
    from flockana.cli.source import law_scales
    from flockana.recorded.recording import scaled_alpha

    if d is not None or r is not None:
        alpha = scaled_alpha(d, r)
        return alpha.length, alpha.range
    if law is None:
        raise ArgumentError("no law, --d or --r: expected --law NAME, or --d, the desired distance of neighbours")
    return law_scales(law)


def _complete(rec: Recording) -> tuple[Recording | None, list[str]]:
    """Return the recording with short gaps filled and incomplete agents removed, and a note on what was done."""
    import numpy as np

    if not rec.gaps:
        return rec, []
    filled = rec.filled()
    notes = [f"{rec.gaps - filled.gaps} of {rec.gaps} missing positions are filled by splines, with their errors."]
    if not filled.gaps:
        return filled, notes
    samples = np.flatnonzero(filled.present.all(axis=1))
    runs = np.split(samples, np.flatnonzero(np.diff(samples) > 1) + 1) if samples.size else []
    longest = max(runs, key=len, default=samples)
    if len(longest) < 4:
        notes.append("At no time all agents are known: no law is compared and no theorem judged.")
        return None, notes
    start, end = float(rec.t[longest[0]]), float(rec.t[longest[-1]])
    notes.append(f"All agents are known from t = {start:g} to {end:g}: laws and theorems are held against this part.")
    return filled.window(start, end), notes


def _results(rec: Recording | None, law: Any, fit: bool, d: float, r: float) -> dict[str, Any]:
    """Return comparison, fit and verdicts, as `recording_page` takes them."""
    from flockana.recorded.compare import compare
    from flockana.recorded.fit import fit as fitted
    from flockana.theorems import verify

    if rec is None:
        return {"verdicts": []}
    if law is None:
        return {"verdicts": verify(None, rec, d=d, r=r) if len(rec.t) > 1 else []}
    found: dict[str, Any] = {"comparison": compare(rec, law)}
    if fit:
        found["fitted"] = fitted(rec, law)
    return found | {"verdicts": verify(None, rec, law=law)}


def _print(rec: Recording, rows: list[tuple[str, str, str]], results: dict[str, Any], notes: list[str]) -> None:
    from flockana.report.tables import fact_table

    facts = tuple((name, f"{first} to {last}") for name, first, last in rows)
    console = show(repr(rec).strip("<>"), fact_table(facts))
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
    """Return all results as plain data for JSON."""
    series = {str(name): seen[name].values.astype(float).tolist() for name in seen.data_vars}
    measures = {name: [x if isfinite(x) else None for x in values] for name, values in series.items()}
    plain: dict[str, Any] = {"recording": repr(rec), "time": rec.t.tolist(), "measures": measures}
    if "comparison" in results:
        plain["comparison"] = results["comparison"].to_dict()
    if "fitted" in results:
        plain["fit"] = {"values": dict(results["fitted"].values), "intervals": results["fitted"].intervals}
    return plain | {"verdicts": [verdict.to_dict() for verdict in results["verdicts"]]}
