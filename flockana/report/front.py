"""Findings that stand first in the report: plain sentences, each on a verdict of the catalogue."""

from collections.abc import Iterable
from typing import NamedTuple

from flockana.report.coverage.anchors import verdict_id
from flockana.report.pages import ScenarioPage

FINDINGS = (
    ("hexagon", "os-1", "Seven agents settle on a hexagon, and stay: Theorem 1 holds, certified for t → ∞."),
    ("three-agents-1d", "os-3", "One agent runs through two others in turn: Theorem 3(iv) as printed fails over time."),
    ("collapse", "E11", "Equal gains squeeze 150 agents until pairs coincide: Algorithm 2 needs a weak γ-agent."),
    ("dead-zone-wide-start", "dead-zone-1-printed", "From a wide start the dead-zone flock stays in pieces."),
    ("zone-tree", "zone-1-printed", "On a tree, edges take their desired lengths and do not vanish, as was printed."),
)


class FrontFinding(NamedTuple):
    """A finding of the first screen."""

    text: str
    status: str
    address: str  # of the verdict in the page
    thumbnail: str  # SVG of the flock at the end; empty without figures


def front_findings(pages: Iterable[object]) -> tuple[FrontFinding, ...]:
    """Return the findings whose verdicts are in the report and as expected."""
    by_name = {page.name: page for page in pages if isinstance(page, ScenarioPage)}
    found = []
    for scenario, theorem, text in FINDINGS:
        page = by_name.get(scenario)
        verdicts = [] if page is None else [f for f in page.findings if f.verdict.theorem == theorem]
        if page is not None and verdicts and verdicts[0].as_expected:
            address = verdict_id(scenario, theorem)
            found.append(FrontFinding(text, verdicts[0].verdict.status, address, page.thumbnail))
    return tuple(found)
