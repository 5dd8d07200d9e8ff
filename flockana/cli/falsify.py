"""`flockana falsify`: search for a run that breaks a theorem's claim; replay one that was found."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from flockana.cli.options import INTERRUPTED, OK, UNEXPECTED

if TYPE_CHECKING:
    from rich.table import Table

    from flockana.falsify import Falsification

_HELP = """Search initial states, and parameters if asked to, for a run that breaks a claim of a theorem.

THEOREM is one about runs; the search begins at the scenario's start, in a box about it. With -o, a counterexample that
is found is written as JSON; --replay simulates such a file again and checks it. That nothing is found proves nothing.

Exit status: 0 nothing found, or a claim broken that is known to be false; 2 bad input; 3 a claim broken that is not
known to be false, or a replay on which the claim holds; 130 interrupted, with the worst so far printed.
"""


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command("falsify", help=_HELP)(_falsify)


def _falsify(
    theorem: Annotated[str | None, typer.Argument(metavar="[THEOREM]", help="Such as os-3.")] = None,
    on: Annotated[str | None, typer.Option(metavar="SCENARIO", help="Where the search begins.")] = None,
    budget: Annotated[int, typer.Option(min=1, help="Runs to make at most.")] = 200,
    seed: Annotated[int, typer.Option(min=0, help="Of the scenario and of the search.")] = 0,
    claim: Annotated[
        str | None, typer.Option(metavar="NAME", help="The claim to break; by default whichever comes nearest.")
    ] = None,
    vary: Annotated[str, typer.Option(help="What of the state is varied: 'q', 'p', 'q,p' or 'none'.")] = "q,p",
    region: Annotated[float | None, typer.Option(help="How far a position may be moved on each axis.")] = None,
    speed: Annotated[float | None, typer.Option(help="Largest component of a velocity.")] = None,
    parameters: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="NAME=LOW,HIGH", help="Bounds of a parameter, as gains.c1_gamma=0.1,10."),
    ] = None,
    deepen: Annotated[bool, typer.Option("--deepen", help="Use up the budget after a claim is broken.")] = False,
    output: Annotated[Path | None, typer.Option("--output", "-o", metavar="FILE", help="JSON file to write.")] = None,
    plot: Annotated[Path | None, typer.Option(metavar="PICTURE", help="PNG, SVG or PDF of the search.")] = None,
    replay: Annotated[Path | None, typer.Option(metavar="FILE", help="Check a counterexample, search none.")] = None,
) -> int:
    from flockana.base.errors import ArgumentError
    from flockana.cli.picture import KINDS, ensure_file, write_picture
    from flockana.falsify import falsify

    if replay is not None:
        if (theorem, on, claim, output, plot) != (None,) * 5:
            raise ArgumentError("--replay FILE brings its own theorem and start: expected no other")
        return _replay(replay)
    if theorem is None or on is None:
        raise ArgumentError("expected THEOREM --on SCENARIO, such as os-3 --on three-agents-1d, or --replay FILE")
    for path, kinds in ((output, (".json",)), (plot, KINDS)):
        if path is not None:
            ensure_file(path, kinds)
    found = falsify(
        theorem,
        on,
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
    _print(found)
    if output is not None and found.found:
        typer.echo(f"counterexample: {found.save(output)}")
    if plot is not None:
        from flockana.plots.falsify import falsification

        write_picture(lambda ax: falsification(found, ax=ax), plot, m=2)
        typer.echo(f"picture: {plot}")
    if found.ended == "interrupted":
        return INTERRUPTED
    return UNEXPECTED if any(not _known_false(found.theorem, name) for name in found.broken) else OK


def read_ranges(texts: list[str]) -> dict[str, tuple[float, float]]:
    """Bounds by parameter.

    Examples
    --------
    >>> read_ranges(["gains.c1_gamma=0.1,10"])
    {'gains.c1_gamma': (0.1, 10.0)}
    """
    from flockana.base.errors import ArgumentError

    found: dict[str, tuple[float, float]] = {}
    for text in texts:
        name, _, bounds = text.partition("=")
        try:
            low, high = (float(word) for word in bounds.split(","))
        except ValueError:
            name = ""
        if not name or name in found:
            raise ArgumentError(f"--set {text}: expected NAME=LOW,HIGH once for each name, such as gains.c1_alpha=1,50")
        found[name] = low, high
    return found


def _replay(path: Path) -> int:
    from rich.console import Console

    from flockana.falsify import Counterexample
    from flockana.report.console import details

    found = Counterexample.load(path)
    verdict = found.check()
    status = next((one.status for one in verdict.claims if one.name == found.claim), "not judged")
    Console(highlight=False).print(details(verdict))
    again = "it breaks again" if status == "refuted" else f"it does not break here: {status}"
    typer.echo(f"{found.theorem}:{found.claim}, found by flockana {found.version}: {again}")
    return OK if status == "refuted" else UNEXPECTED


def _known_false(theorem: str, claim: str) -> bool:
    """Whether a claim is printed wrongly, or is no theorem: one of the catalogue's own runs is expected to break it."""
    from flockana.scenarios import scenario, scenarios

    if "corrected" in theorem + claim:
        return False
    if "printed" in theorem + claim:
        return True
    expected = [scenario(name).expected for name in scenarios()]
    if any(one.get(f"{theorem}:{claim}") == "refuted" for one in expected):
        return True
    # where a scenario says that the theorem breaks, and not by which claim, it may be by any
    return any(
        one.get(theorem) == "refuted" and not any(key.startswith(f"{theorem}:") for key in one) for one in expected
    )


def _print(found: Falsification) -> None:
    from rich.console import Console

    console = Console(highlight=False)
    console.print(f"{found.theorem} on {found.scenario}, seed {found.seed}", style="bold", markup=False)
    console.print(claim_table(found))
    runs = f"{found.evaluations} of {found.budget} runs"
    if found.failures:
        runs += f", {found.failures} failed ({found.message})"
    if found.found:
        known = "known to be false" if _known_false(found.theorem, found.claim) else "NOT known to be false"
        text = f"found: {found.claim} is broken, and it is {known}; {runs}"
    else:
        text = f"nothing found, which proves nothing: {found.claim} came nearest; {runs}"
    console.print(text + ("; interrupted" if found.ended == "interrupted" else ""), markup=False)
    others = [name for name in found.broken if name != found.claim]
    if others:
        console.print(f"  broken on the way: {', '.join(others)}; search them by --claim", markup=False)
    for name, value in found.parameters.items():
        console.print(f"  {name} = {value:.6g}", markup=False)
    if found.found and found.verdict is not None:
        console.print(f"  {found.verdict.claim(found.claim).detail}", markup=False)


def claim_table(found: Falsification) -> Table:
    """A row per claim: its margin at the scenario's start and at worst, the worst status, where it was judged."""
    import numpy as np
    from rich import box
    from rich.table import Table
    from rich.text import Text

    from flockana.report.text import MARKS, show

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1))
    table.add_column("claim", no_wrap=True)
    for heading in ("margin at the start", "at worst"):
        table.add_column(heading, justify="right", no_wrap=True)
    table.add_column("worst status", no_wrap=True)
    table.add_column("judged on", justify="right", no_wrap=True)
    for name, margins in found.margins.items():
        judged = sum(status not in ("vacuous", "failed") for status in found.statuses[name])
        ends = (margins[0], found.least(name)[-1])
        cells = ["—" if np.isnan(value) else show(float(value)) for value in ends]
        style = "bold" if name == found.claim else ""
        worst = found.worst_status(name)
        table.add_row(Text(name, style=style), *cells, f"{MARKS.get(worst, '!')} {worst}", f"{judged} runs")
    return table
