"""A page for each scenario of the catalogue: its run in the player, stills, how it was run, its verdicts."""

from __future__ import annotations

from pathlib import Path

from flockana.base.progress import progress_bar
from flockana.report.coverage.report_anchors import verdict_id
from flockana.scenarios import Scenario, scenario, scenarios
from tools.site.runs import ran
from tools.site.verdicts import Verdicts
from tools.site.words import contents, plain, table

FIRST = "paper-split-rejoin"
TRIED = "without-installing"
TWELVE = (
    *("hexagon", "three-agents-1d", FIRST, "collapse", "dead-zone-wide-start", "zone-tree", "headings-meet"),
    *("cucker-smale-critical-above", "net-ring-below", "links-kept", "head-on-collision", "minimal-2d"),
)
FIRST_SHOWN = "A flock of 150 agents meets six discs, splits, and rejoins"


def checked_on(theorem: str) -> tuple[str, ...]:
    """Scenarios of the catalogue that a theorem is checked on."""
    return tuple(name for name in scenarios() if theorem in scenario(name).theorems)


def first(*, images: bool) -> str:
    """What the first page shows: a flock that moves, or its picture."""
    if images:
        return f'<iframe class="run" title="{FIRST_SHOWN}" src="runs/{FIRST}.html"></iframe>\n'
    return f"![{FIRST_SHOWN}](split-rejoin.png)\n"


def page(case: Scenario, verdicts: Verdicts, *, images: bool, report: bool) -> str:
    """The page of one."""
    parts = [f"# {plain(case.name)}: {plain(case.title)}", f"*{plain(case.source)}*"]
    if images:
        parts += player(case.name)
        told = ran(case.name)
        shown = " ".join(
            f"![{case.name} at {label}](images/{case.name}-{k}.svg){{.still}}"
            for k, (label, _) in enumerate(told["stills"])
        )
        parts += [shown, "Stills: " + ", ".join(plain(label) for label, _ in told["stills"]) + "."]
    parts += ["## Verdicts", verdicts_table(case, verdicts, report=report)]
    if images:
        parts += ["## How it was run", table(("what", "value"), [(plain(a), plain(b)) for a, b in told["facts"]])]
    return "\n\n".join([*parts, f"`flockana verify {case.name}` runs it again, checks it and writes a report."]) + "\n"


def player(name: str) -> list[str]:
    """The frame in which a run plays; none if its numbers have no room in the player."""
    frame = f'<iframe class="run" title="The run of {name}" loading="lazy" src="../../runs/{name}.html"></iframe>'
    return [frame] if ran(name)["play"] else []


def twelve(verdicts: Verdicts, *, images: bool, report: bool) -> str:
    """The page on which twelve flocks play, with their verdicts."""
    parts = [
        "# Twelve flocks, without installing anything",
        "Each plays here: press play, drag the time, turn what has three dimensions. Below stands what its source or "
        "theory says of it, and what flockana found.",
    ]
    for case in map(scenario, TWELVE):
        parts += [f"## [{plain(case.title)}]({case.name}.md)", *(player(case.name) if images else [])]
        parts.append(verdicts_table(case, verdicts, report=report))
    return "\n\n".join(parts) + "\n"


def verdicts_table(case: Scenario, verdicts: Verdicts, *, report: bool) -> str:
    """What was asked of it, expected and found."""
    rows = []
    for theorem in case.theorems:
        found = verdicts.status.get((theorem, case.name), "—")
        rows.append(
            (
                f"[{plain(theorem)}](../theorems/{theorem}.md)",
                case.expected.get(theorem, "—"),
                in_report(verdict_id(case.name, theorem), found) if report else found,
            )
        )
    header = ("theorem", "expected", "measured")
    if not rows:
        return "No theorem of the catalogue is asked of it."
    return table(header if verdicts.status else header[:2], rows if verdicts.status else [row[:2] for row in rows])


def in_report(address: str, words: str) -> str:
    """A link into the report that the site carries."""
    return f'<a href="../../report/index.html#{address}">{words}</a>'


def write(folder: Path, extra: Path, verdicts: Verdicts, *, images: bool, report: bool) -> None:
    """Write all pages and their index; images beside them, and what plays into the folder `extra`."""
    (folder / "images").mkdir(parents=True)
    (extra / "runs").mkdir(parents=True)
    rows = []
    with progress_bar(len(scenarios())) as advance:
        for done, name in enumerate(scenarios()):
            advance(done, name)
            case = scenario(name)
            if images:
                _write_run(name, folder / "images", extra / "runs")
            (folder / f"{name}.md").write_text(page(case, verdicts, images=images, report=report), encoding="utf-8")
            rows.append((*([thumbnail(name)] if images else []), f"[{plain(name)}]({name}.md)", plain(case.title)))
    (folder / f"{TRIED}.md").write_text(twelve(verdicts, images=images, report=report), encoding="utf-8")
    opening = (
        "# Scenarios\n\nPublished simulations, and cases that decide a theorem: each page plays the run and lists what "
        "was found."
    )
    if report:
        opening += ' The whole is in <a href="../../report/index.html">the report</a>, as `flockana verify` wrote it.'
    listed = contents((TRIED, *(f"{name} <{name}>" for name in scenarios()))).replace(":maxdepth: 1", ":hidden:")
    header = (*(["at the end"] if images else []), "scenario", "title")
    (folder / "index.md").write_text(f"{opening}\n\n{table(header, rows)}\n\n{listed}\n", encoding="utf-8")


def _write_run(name: str, images: Path, runs: Path) -> None:
    told = ran(name)
    for k, (_, svg) in enumerate(told["stills"]):
        (images / f"{name}-{k}.svg").write_text(svg, encoding="utf-8")
    (images / f"{name}-end.svg").write_text(told["end"], encoding="utf-8")
    if told["play"]:
        (runs / f"{name}.html").write_text(told["play"], encoding="utf-8")


def thumbnail(name: str, *, folder: str = "images") -> str:
    """A small picture of the end."""
    return f"![{name}, at the end]({folder}/{name}-end.svg){{.thumbnail}}"
