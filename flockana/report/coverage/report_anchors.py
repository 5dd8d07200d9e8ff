"""Anchors of references in a report: scenarios, verdicts and source reports."""

from collections.abc import Iterable

from flockana.report.page_data import Page, ScenarioPage
from flockana.scenarios.option_checks import SOURCE


def anchors(pages: Iterable[Page]) -> dict[str, str]:
    """Return HTML ids in the report by reference; a theorem checked on several runs leads to the first."""
    link: dict[str, str] = {}
    for page in pages:
        if isinstance(page, ScenarioPage):
            link[f"scenario:{page.name}"] = scenario_id(page.name)
        for verdict in (finding.verdict for finding in page.findings):
            anchor = verdict_id(page.subject, verdict.theorem)
            if verdict.theorem == SOURCE:
                link |= {f"report:{page.subject}/{claim.name}": anchor for claim in verdict.claims}
                continue
            link.setdefault(f"{'erratum' if is_erratum(verdict.theorem) else 'theorem'}:{verdict.theorem}", anchor)
            for claim in verdict.claims:
                link.setdefault(f"claim:{verdict.theorem}/{claim.name}", anchor)
    return link


def verdict_id(subject: str, theorem: str) -> str:
    """Return the id of a verdict in the report."""
    if subject == "fixed":
        return f"fixed-{theorem}".replace(" ", "-")
    return f"{scenario_id(subject)}--{theorem.replace(' ', '-')}"  # another's name may be this one's with a theorem's


def scenario_id(name: str) -> str:
    """Return the id of a scenario's section in the report."""
    return f"scenario-{name}".replace(" ", "-")


def is_erratum(name: str) -> bool:
    """Return whether an id is an erratum's: errata ids begin with a capital letter."""
    return name[:1].isupper()
