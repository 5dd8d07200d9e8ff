from flockana.report.coverage.report_anchors import anchors
from flockana.report.page_data import Finding, FixedPage, ScenarioPage
from flockana.theorems import Claim, Verdict


def finding(theorem, *claims):
    return Finding(Verdict(theorem, (), tuple(Claim(name, "verified") for name in claims)), "t", "s", "p")


def test_what_a_report_shows_is_found_there():
    pages = [
        ScenarioPage("pair", "t", "s", (), (finding("os-3", "i"), finding("source", "saw"))),
        ScenarioPage("other", "t", "s", (), (finding("os-3", "i", "ii"), finding("E12", "printed"))),
        FixedPage(finding("E8", "corrected")),
        FixedPage(finding("delay-margin")),
    ]
    assert anchors(pages) == {
        "scenario:pair": "scenario-pair",
        "theorem:os-3": "scenario-pair--os-3",  # the first run
        "claim:os-3/i": "scenario-pair--os-3",
        "report:pair/saw": "scenario-pair--source",
        "scenario:other": "scenario-other",
        "claim:os-3/ii": "scenario-other--os-3",
        "erratum:E12": "scenario-other--E12",
        "claim:E12/printed": "scenario-other--E12",
        "erratum:E8": "fixed-E8",
        "claim:E8/corrected": "fixed-E8",
        "theorem:delay-margin": "fixed-delay-margin",
    }
