"""The terminal's view: tables that read well at 80 columns, in colour or in a pipe."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from rich.console import Group
from rich.markup import escape
from rich.padding import Padding
from rich.table import Column, Table
from rich.text import Text

from flockana.dynamics.trajectory import Trajectory
from flockana.report.pages import Finding, Page, ScenarioPage
from flockana.report.statistics import StatisticsSection
from flockana.report.tables import WholeTable, column, fact_table, headed_table
from flockana.report.text import MARKS, deciding_claim, show
from flockana.theorems import Claim, Verdict, theorem, theorems

_NARROW = 72  # columns below which a table of verdicts leaves out how they are known
_COLOURS = {"verified": "green", "refuted": "dark_orange3", "vacuous": "bright_black", "inconclusive": "yellow"}


def _status(status: str) -> Text:
    return Text(f"{MARKS[status]} {status}", style=_COLOURS[status])


def _expectation(finding: Finding) -> Text:
    if finding.as_expected is None:
        return Text("—", style="bright_black")
    return Text("yes", style="bright_black") if finding.as_expected else Text("NO", style="bold red")


def verdict_table(pages: Iterable[Page], *, width: int = 80) -> Table:
    """Return a table of verdicts grouped by run; names are never cut."""
    pages = list(pages)
    longest = max((len(f.verdict.theorem) for page in pages for f in page.findings), default=0) + 2
    widths = {"theorem": longest, "status": 14, "rigour": 8, "decided by": None, "expected": 8}
    if width < _NARROW:
        del widths["rigour"], widths["decided by"]
    columns = (column(heading, width=width, wraps=width is None) for heading, width in widths.items())
    table = headed_table(*columns, collapse_padding=True)
    for page in pages:
        if isinstance(page, ScenarioPage):
            table.add_row(Text(page.name, style="bold"))
        for finding in page.findings:
            verdict, claim = finding.verdict, deciding_claim(finding.verdict)
            indent = "  " if isinstance(page, ScenarioPage) else ""
            cells = {
                "theorem": Text(indent + verdict.theorem),
                "status": _status(verdict.status),
                "rigour": Text(verdict.rigour),
                "decided by": Text("" if claim is None else claim.name, style="bright_black"),
                "expected": _expectation(finding),
            }
            table.add_row(*(cells[heading] for heading in widths))
    return table


def titles(pages: Iterable[Page]) -> Table:
    """Return the titles of the theorems checked, by name."""
    names = dict.fromkeys(finding.verdict.theorem for page in pages for finding in page.findings)
    return fact_table((name, theorem(name).title) for name in names if name in theorems())


def statistics_table(section: StatisticsSection) -> Table:
    """Return a table of the shares of seeds in which each claim is verified and refuted, with intervals."""
    table = headed_table(column("claim"), column("verified", right=True), column("refuted", right=True))
    for entry in section.entries:
        left_out = f", {entry.incomplete} incomplete" if entry.incomplete else ""
        table.add_row(Text.assemble((entry.scenario, "bold"), f", {entry.runs} seeds{left_out}"))
        for row in entry.rows:
            table.add_row(Text(f"  {row.claim}"), str(row.verified), str(row.refuted))
    return table


def details(verdict: Verdict) -> Group:
    """Return the hypotheses and claims of a verdict, each with its finding in words."""
    on = f" on {verdict.subject}" if verdict.subject else ""
    title = Text.assemble((verdict.theorem, "bold"), on, ": ", _status(verdict.status))
    columns = Column(max_width=26, overflow="fold"), Column(no_wrap=True), Column(ratio=1, overflow="fold")
    table = WholeTable(*columns, box=None, show_header=False, pad_edge=False, padding=(0, 1))
    for h in verdict.hypotheses:
        table.add_row(Text(f"given: {h.name}", style="bright_black"), h.status, Text(h.detail))
    for c in _told_once(verdict):
        margin = "" if c.margin is None else f" (margin {show(c.margin)}, error {show(c.error)})"
        table.add_row(Text(c.name), _status(c.status), Text(c.detail + margin))
    return Group(title, Padding(table, (0, 0, 1, 2)))


def _told_once(verdict: Verdict) -> Iterable[Claim]:
    """Yield the claims of a verdict; those that are vacuous for one reason as one, with all their names."""
    groups: dict[tuple[str, ...], list[Claim]] = {}
    for claim in verdict.claims:
        key = ("vacuous", claim.detail) if claim.status == "vacuous" else (claim.name,)
        groups.setdefault(key, []).append(claim)
    for first, *others in groups.values():
        yield replace(first, name=", ".join(claim.name for claim in (first, *others)))


def summary(pages: Sequence[Page], seconds: float) -> str:
    """Return the numbers of verdicts by status, of expected ones, and the time taken."""
    findings = [finding for page in pages for finding in page.findings]
    kinds = ((s, sum(f.verdict.status == s for f in findings)) for s in MARKS)
    counts = ", ".join(f"{count} {status}" for status, count in kinds if count)
    surprises = sum(len(page.surprises) for page in pages)
    judged = "all as expected" if not surprises else f"{surprises} different from the expected"
    if not any(f.expected for f in findings):
        judged = "nothing was expected"
    plural = "" if len(findings) == 1 else "s"
    return f"{len(findings)} verdict{plural} in {seconds:.1f} s: {counts or 'none'}; {judged}"


def run_table(run: Trajectory) -> Table:
    """Return a table of a run's metrics at its start and end."""
    times = (column(f"t = {run.t[k]:g}", right=True) for k in (0, -1))
    table = headed_table(column("measure", wraps=True), *times)
    for name, series in run.metrics().items():
        label = f"{series.attrs['long_name']}"
        table.add_row(escape(f"{name}: {label}"), *(f"{float(series[k]):.5g}" for k in (0, -1)))
    energy = run.energy()
    if np.isfinite(energy).any():
        table.add_row("energy H", *(f"{energy[k]:.6g}" for k in (0, -1)))
    if "work" in run.extra:
        table.add_row("residual of the energy balance", "0", f"{run.energy_residual[-1]:.2g}")
    return table
