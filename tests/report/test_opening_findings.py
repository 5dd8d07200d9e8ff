from dataclasses import replace

import pytest

from flockana import scenario, theorem
from flockana.report.opening_findings import FINDINGS, front_findings, most_telling, opening_sentence
from flockana.report.page_data import Finding, ScenarioPage, scenario_page
from flockana.theorems import Claim, Verdict


@pytest.mark.parametrize(("name", "id_"), [(name, id_) for name, id_, _ in FINDINGS])
def test_what_stands_first_is_in_the_catalogue_and_expected(name, id_):
    assert scenario(name).expected[id_] in ("verified", "refuted")
    assert theorem(id_).id == id_


def test_a_finding_has_its_verdict_its_place_and_a_picture():
    item = scenario("hexagon")
    run = item.run()
    made = scenario_page(item, run, (item.verdict("os-1", run),))
    (found,) = front_findings([made])
    assert (found.status, found.address) == ("verified", "scenario-hexagon--os-1")
    assert found.thumbnail.startswith("<svg ")
    assert found.thumbnail.count("<svg ") == 1
    width = float(found.thumbnail.split('viewBox="0 0 ')[1].split()[0])
    dots = found.thumbnail.split('class="agents"')[1].split('d="M')[1].split('"')[0].removesuffix("h0").split("h0M")
    x = [float(dot.split()[0]) for dot in dots]
    assert max(x) - min(x) > 0.85 * width  # the flock at the end fills the picture
    other = tuple(replace(finding, expected={"os-1": "refuted"}) for finding in made.findings)
    assert len(front_findings([replace(made, findings=other)])) <= 1


def test_the_report_opens_with_what_was_found_false_and_lists_it_first():
    def finding(theorem, status, expected=True, by="source"):
        verdict = Verdict(theorem, (), (Claim("x", status, by=by),), author=by)
        return Finding(verdict, "", "", "", {theorem: "verified"}, () if expected else ("differs",))

    quiet, loud = finding("os-1", "verified"), finding("energy", "refuted")
    ours, odd = finding("os-3", "refuted", by="flockana"), finding("os-4", "vacuous", expected=False)
    said = opening_sentence([quiet, loud, loud, ours, odd, finding("os-5", "refuted", expected=False)])
    assert said == "2 printed claims were found false on these cases, as expected; verified as expected: 1."
    assert opening_sentence([quiet]) == ""
    shown = finding("E11", "verified")
    pages = [
        ScenarioPage(name, "", "", (), findings)
        for name, findings in (("a", (quiet,)), ("b", (quiet, loud)), ("c", (quiet, odd)), ("collapse", (loud, shown)))
    ]
    assert [(page.name, findings[0].verdict.theorem) for page, findings in most_telling(pages)] == [
        ("c", "os-4"),
        ("collapse", "E11"),
        ("b", "energy"),
        ("a", "os-1"),
    ]
