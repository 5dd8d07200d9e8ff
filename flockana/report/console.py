"""Terminal output: tables readable at 80 columns, in colour or in a pipe."""

from collections.abc import Iterable, Sequence

import numpy as np
from rich.console import Group
from rich.markup import escape
from rich.padding import Padding
from rich.table import Column, Table
from rich.text import Text

from flockana.dynamics.trajectory import Trajectory
from flockana.report.page_data import Finding, Page, ScenarioPage
from flockana.report.statistics import StatisticsSection
from flockana.report.tables import FoldingTable, column, headed_table
from flockana.report.value_texts import MARKS, show
from flockana.theorems import Verdict
from flockana.theorems.claim import BYLINES
from flockana.theorems.errata import SORTS, errata, erratum_of
from flockana.theorems.verdict_summary import merged

_NARROW = 72  # columns below which a table of verdicts leaves out how they are known
_COLOURS = {"verified": "green", "refuted": "dark_orange3", "vacuous": "bright_black", "inconclusive": "yellow"}


def _status(status: str) -> Text:
    return Text(f"{MARKS[status]} {status}", style=_COLOURS[status])


def _expectation(finding: Finding) -> Text:
    text = {None: "—", True: "yes", False: "NO"}[finding.as_expected]
    return Text(text, style="bold red" if text == "NO" else "bright_black")


def verdict_table(pages: Iterable[Page], *, width: int = 80) -> Table:
    """Return a table of verdicts grouped by run; names are never cut."""
    pages = list(pages)
    longest = max((len(f.verdict.theorem) for page in pages for f in page.findings), default=0) + 2
    widths = {"theorem": longest, "status": 14, "claims": 8, "rigour": 8, "expected": 8}
    if width < _NARROW:
        del widths["claims"], widths["rigour"]
    columns = (column(heading, width=width, wraps=width is None) for heading, width in widths.items())
    table = headed_table(*columns, collapse_padding=True)
    for page in pages:
        indent = "  " if isinstance(page, ScenarioPage) else ""
        if indent:
            table.add_row(Text(page.name, style="bold"))
        for finding in page.findings:
            verdict, name = finding.verdict, Text(indent + finding.verdict.theorem)
            how = Text(_share(verdict), style="bright_black"), Text(verdict.rigour)
            table.add_row(name, _status(verdict.status), *(how if "claims" in widths else ()), _expectation(finding))
    return table


def _share(verdict: Verdict) -> str:
    """Return as text how many of the author's claims have the verdict's status, such as 2 of 3."""
    claims = verdict.main_claims
    return f"{sum(claim.status == verdict.status for claim in claims)} of {len(claims)}" if claims else ""


def errata_table(pages: Iterable[Page]) -> Table:
    """Return a table of checked errata by sort: printed form and correct form."""
    checked_errata = {finding.verdict.theorem for page in pages for finding in page.findings}
    table = headed_table(column("erratum"), column("printed, and right", wraps=True))
    for sort, meaning in SORTS.items():
        table.add_row(Text(sort, style="bold"), Text(meaning, style="bright_black"))
        for item in (item for item in errata() if item.sort == sort and item.id in checked_errata):
            table.add_row(Text(f"  {item.id}"), f"{item.mark} {item.printer}: {item.printed}")
            table.add_row("", f"{item.right_mark} right: {item.right}")
    return table


def statistics_table(section: StatisticsSection) -> Table:
    """Return a table of the shares of seeds in which each claim is verified and refuted, with intervals."""
    table = headed_table(column("claim"), column("verified", right=True), column("refuted", right=True))
    for entry in section.entries:
        incomplete_text = f", {entry.incomplete} incomplete" if entry.incomplete else ""
        table.add_row(Text.assemble((entry.scenario, "bold"), f", {entry.runs} seeds{incomplete_text}"))
        for row in entry.rows:
            table.add_row(Text(f"  {row.claim}"), str(row.verified), str(row.refuted))
    return table


def details(verdict: Verdict) -> Group:
    """Return the hypotheses and claims of a verdict, each with its finding in words."""
    subject_text = f" on {verdict.subject}" if verdict.subject else ""
    title = Text.assemble((verdict.theorem, "bold"), subject_text, ": ", _status(verdict.status))
    pair = erratum_of(verdict.theorem)
    lines = [*([] if pair is None else [str(pair)]), verdict.summary]
    columns = Column(max_width=26, overflow="fold"), Column(no_wrap=True), Column(ratio=1, overflow="fold")
    table = FoldingTable(*columns, box=None, show_header=False, pad_edge=False, padding=(0, 1))
    for h in verdict.hypotheses:
        table.add_row(Text(f"given: {h.name}", style="bright_black"), h.status, Text(h.detail))
    author_text = verdict.author
    for name, c in merged(sorted(verdict.claims, key=lambda claim: (claim.by != verdict.author, claim.by))):
        if c.by != author_text:
            table.add_row(Text(f"{BYLINES[author_text := c.by]}:", style="bright_black"))
        margin = "" if c.margin is None else f" (margin {show(c.margin)}, error {show(c.error)})"
        table.add_row(Text(name), _status(c.status), Text(c.explanation + margin))
    return Group(title, *(Padding(Text(line), (0, 0, 0, 2)) for line in lines), Padding(table, (0, 0, 1, 2)))


def summary(pages: Sequence[Page], seconds: float) -> str:
    """Return a line with the numbers of verdicts by status and of differences from the expected, and the time."""
    findings = [finding for page in pages for finding in page.findings]
    kinds = ((s, sum(f.verdict.status == s for f in findings)) for s in MARKS)
    counts = ", ".join(f"{count} {status}" for status, count in kinds if count)
    surprises = sum(len(page.surprises) for page in pages)
    outcome_text = "all as expected" if not surprises else f"{surprises} different from the expected"
    if not any(f.expected for f in findings):
        outcome_text = "nothing was expected"
    plural = "" if len(findings) == 1 else "s"
    return f"{len(findings)} verdict{plural} in {seconds:.1f} s: {counts or 'none'}; {outcome_text}"


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
