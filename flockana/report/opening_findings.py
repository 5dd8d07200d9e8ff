"""Opening findings of the report: plain sentences, each based on a verdict of the catalogue."""

from collections.abc import Iterable
from typing import NamedTuple

from flockana.report.coverage.report_anchors import verdict_id
from flockana.report.page_data import Finding, ScenarioPage

FINDINGS = (
    ("hexagon", "os-1", "Seven agents settle on a hexagon, and stay: Theorem 1 holds, certified for t → ∞."),
    ("three-agents-1d", "os-3", "One agent runs through two others in turn: Theorem 3(iv) as printed fails over time."),
    ("collapse", "E11", "Equal gains squeeze 150 agents until pairs coincide: Algorithm 2 needs a weak γ-agent."),
    ("dead-zone-wide-start", "dead-zone-1-printed", "From a wide start the dead-zone flock stays in pieces."),
    ("zone-tree", "zone-1-printed", "On a tree, edges take their desired lengths and do not vanish, as was printed."),
)


_TELLING = ("refuted", "verified", "inconclusive", "vacuous")


class FrontFinding(NamedTuple):
    """Finding shown at the top of the report: text, status, link to the verdict, and a thumbnail of the flock."""

    text: str
    status: str
    address: str  # of the verdict in the page
    thumbnail: str  # SVG of the flock at the end; empty without figures


def front_findings(pages: Iterable[object]) -> tuple[FrontFinding, ...]:
    """Return the opening findings whose verdicts are present and as expected."""
    by_name = {page.name: page for page in pages if isinstance(page, ScenarioPage)}
    findings = []
    for scenario, theorem, text in FINDINGS:
        page = by_name.get(scenario)
        verdicts = [] if page is None else [f for f in page.findings if f.verdict.theorem == theorem]
        if page is not None and verdicts and verdicts[0].as_expected:
            address = verdict_id(scenario, theorem)
            findings.append(FrontFinding(text, verdicts[0].verdict.status, address, page.thumbnail))
    return tuple(findings)


def opening_sentence(findings: Iterable[Finding]) -> str:
    """Return a sentence with the numbers of refuted printed claims and verified theorems; empty without any."""
    expected = [f.verdict for f in findings if f.as_expected]
    false = sum(item.status == "refuted" and item.author == "source" for item in expected)
    count_verified = sum(item.status == "verified" for item in expected)
    claims = "1 printed claim was" if false == 1 else f"{false} printed claims were"
    return f"{claims} found false on these cases, as expected; verified as expected: {count_verified}." if false else ""


def most_telling(pages: Iterable[object]) -> list[tuple[ScenarioPage, list[Finding]]]:
    """Return scenarios with findings: unexpected verdicts first, then opening findings, then refuted claims."""
    shown_pairs = {(scenario, theorem) for scenario, theorem, _ in FINDINGS}

    def rank(page: ScenarioPage, finding: Finding) -> tuple[bool, bool, int]:
        is_front = (page.name, finding.verdict.theorem) in shown_pairs
        return not finding.surprises, not is_front, _TELLING.index(finding.verdict.status)

    ranked = []
    for page in (page for page in pages if isinstance(page, ScenarioPage)):
        findings = sorted(page.findings, key=lambda finding: rank(page, finding))
        ranked.append((page, findings, rank(page, findings[0]) if findings else (not page.surprises, True, 9)))
    return [(page, findings) for page, findings, _ in sorted(ranked, key=lambda entry: entry[2])]
