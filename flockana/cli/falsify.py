"""`flockana falsify`: search for a run that breaks a theorem's claim; replay one that was found."""

from __future__ import annotations

from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from flockana.base.errors import ArgumentError
from flockana.cli.command_output import INTERRUPTED, OK, UNEXPECTED, show, show_files, show_json
from flockana.cli.shared_options import AsJson, On, Plot, output

if TYPE_CHECKING:
    from rich.table import Table

    from flockana.falsify import Falsification
    from flockana.theorems import Theorem


def falsify_command(
    theorem: Annotated[
        str | None,
        typer.Argument(metavar="[THEOREM]", help="Theorem, such as os-3, or FILE.py:NAME, a claim of yours."),
    ] = None,
    *,
    on: On = None,
    budget: Annotated[int, typer.Option(min=1, help="Largest number of runs.")] = 200,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the scenario and of the search.")] = 0,
    claim: Annotated[
        str | None, typer.Option(metavar="NAME", help="Claim to break; by default the nearest to failing.")
    ] = None,
    vary: Annotated[str, typer.Option(help="Part of the start to vary: 'q', 'p', 'q,p' or 'none'.")] = "q,p",
    region: Annotated[float | None, typer.Option(help="Largest change of a coordinate.")] = None,
    speed: Annotated[float | None, typer.Option(help="Largest component of a velocity.")] = None,
    parameters: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=LOW,HIGH", help="Bounds of a parameter, as gains.c1_gamma=0.1,10."),
    ] = None,
    deepen: Annotated[bool, typer.Option("--deepen", help="Search on after a claim is broken.")] = False,
    save_to: Annotated[Path | None, output("JSON file to write.")] = None,
    plot: Plot = None,
    replay: Annotated[Path | None, typer.Option(metavar="FILE", help="Check this counterexample instead.")] = None,
    as_json: AsJson = False,
) -> int:
    """Search initial states, and parameters if asked to, for a run that breaks a claim of a theorem.

    THEOREM must be about runs. The search covers a box about the start of the case. -o writes a counterexample as JSON;
    --replay simulates such a file again and checks it, with FILE.py:NAME before it if the claim is yours. A search that
    finds nothing proves nothing.

    Exit status: 0 nothing found, or a claim broken that is known to be false; 2 bad input; 3 a claim broken that is not
    known to be false, or a replay on which the claim holds; 130 interrupted, after printing the worst run.
    """
    from flockana.cli.command_subject import is_own, read_flock, read_theorem
    from flockana.cli.picture_file import ensure_file, write_picture
    from flockana.falsify import falsify
    from flockana.plots.falsify import falsification

    if replay is not None:
        own_claim = read_theorem(str(theorem)) if is_own(theorem) else None
        if (theorem if own_claim is None else None, on, claim, save_to, plot) != (None,) * 5:
            raise ArgumentError("--replay FILE brings its own theorem and start: expected no other")
        return _replay(replay, own_claim, as_json=as_json)
    if theorem is None or on is None:
        raise ArgumentError("expected THEOREM --on CASE, such as os-3 --on three-agents-1d, or --replay FILE")
    ensure_file(save_to, (".json",))
    ensure_file(plot)
    search = falsify(
        read_theorem(theorem),
        read_flock(on, seed),
        budget=budget,
        seed=seed,
        claim=claim,
        vary=[] if vary == "none" else vary.split(","),
        region=region,
        speed=speed,
        parameters=read_ranges(parameters or []),
        deepen=deepen,
        progress=True,
    )
    if as_json:
        show_json(search_facts(search))
    else:
        _show(search)
    saved_path = search.save(save_to) if save_to is not None and search.found else None
    write_picture(lambda ax: falsification(search, ax=ax), plot)
    show_files(as_json, counterexample=saved_path, picture=plot)
    if search.ended == "interrupted":
        return INTERRUPTED
    return OK if all(known_false(search.theorem, name) for name in search.broken) else UNEXPECTED


def read_ranges(texts: list[str]) -> dict[str, tuple[float, float]]:
    """Return the bounds of the parameters to vary, by name, from the option's text."""
    ranges: dict[str, tuple[float, float]] = {}
    for text in texts:
        name, _, bounds = text.partition("=")
        try:
            low, high = (float(word) for word in bounds.split(","))
        except ValueError:
            name = ""
        if not name or name in ranges:
            raise ArgumentError(f"--set {text}: expected NAME=LOW,HIGH once for each name, such as gains.c1_alpha=1,50")
        ranges[name] = low, high
    return ranges


def search_facts(search: Falsification) -> dict[str, Any]:
    """Return a search for counterexamples to a theorem, with its result, as plain data."""
    names = ("theorem", "claim", "scenario", "found", "status", "margin", "error")
    facts = {name: getattr(search, name) for name in names}
    facts |= {name: facts[name] if isfinite(facts[name]) else None for name in ("margin", "error")}
    facts["known to be false"] = search.found and known_false(search.theorem, search.claim)
    facts |= {name: getattr(search, name) for name in ("evaluations", "failures", "ended")}
    facts["unmet"] = list(search.unmet)
    return facts | {"broken": list(search.broken), "parameters": dict(search.parameters)}


def _replay(path: Path, own: Theorem | None, *, as_json: bool) -> int:
    from rich.console import Console

    from flockana.falsify import Counterexample
    from flockana.report.console import details

    counterexample = Counterexample.load(path)
    verdict = counterexample.check(theorem=own)
    status = {claim.name: claim.status for claim in verdict.claims}.get(counterexample.claim, "not judged")
    replay_text = "it breaks again" if status == "refuted" else f"it does not break here: {status}"
    claim = f"{counterexample.theorem}:{counterexample.claim}"
    if as_json:
        show_json(verdict.to_dict())
    else:
        Console(highlight=False, emoji=False).print(details(verdict))
        typer.echo(f"{claim}, found by flockana {counterexample.version}: {replay_text}")
    return OK if status == "refuted" else UNEXPECTED


def known_false(theorem: str, claim: str) -> bool:
    """Return whether the catalogue expects a claim to be refuted."""
    from flockana.scenarios import scenario, scenarios

    if "corrected" in theorem + claim:
        return False
    if "printed" in theorem + claim:
        return True
    for statuses in (scenario(name).expected for name in scenarios()):
        # where a scenario says that the theorem breaks, and not by which claim, it may be by any
        is_named = any(key.startswith(f"{theorem}:") for key in statuses)
        if statuses.get(f"{theorem}:{claim}" if is_named else theorem) == "refuted":
            return True
    return False


def _show(search: Falsification) -> None:
    console = show(f"{search.theorem} on {search.scenario}, seed {search.seed}", claim_table(search))
    runs = f"{search.evaluations} of {search.budget} runs"
    if search.failures:
        runs += f", {search.failures} failed ({search.message})"
    if search.found:
        knowledge = "known to be false" if known_false(search.theorem, search.claim) else "NOT known to be false"
        text = f"found: {search.claim} is broken, and it is {knowledge}; {runs}"
    elif search.unmet:
        text = f"nothing to refute: no run meets {', '.join(search.unmet)}; vary what they depend on; {runs}"
    else:
        text = f"nothing found, which proves nothing: {search.claim} came nearest; {runs}"
    console.print(text + ("; interrupted" if search.ended == "interrupted" else ""), markup=False)
    claims_text = ", ".join(name for name in search.broken if name != search.claim)
    lines = [f"broken on the way: {claims_text}; search them by --claim"] if claims_text else []
    lines += [f"{name} = {value:.6g}" for name, value in search.parameters.items()]
    if search.found and search.verdict is not None:
        lines.append(search.verdict.claim(search.claim).detail)
    for line in lines:
        console.print(f"  {line}", markup=False)


def claim_table(search: Falsification) -> Table:
    """Return a table of claims: margin at the start and at worst, worst status, number of runs judged."""
    import numpy as np
    from rich.text import Text

    from flockana.report.tables import column, headed_table
    from flockana.report.value_texts import MARKS
    from flockana.report.value_texts import show as number

    headings = "claim", "margin at the start", "at worst", "worst status", "judged on"
    table = headed_table(*(column(text, right=text not in ("claim", "worst status")) for text in headings))
    for name, margins in search.margins.items():
        judged_count = sum(status not in ("vacuous", "failed") for status in search.statuses[name])
        margin_range = (margins[0], search.least(name)[-1])
        cells = ["—" if np.isnan(value) else number(float(value)) for value in margin_range]
        style = "bold" if name == search.claim else ""
        worst = search.worst_status(name)
        table.add_row(Text(name, style=style), *cells, f"{MARKS.get(worst, '!')} {worst}", f"{judged_count} runs")
    return table
