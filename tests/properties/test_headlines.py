"""Statuses of verdicts.json against their claims, and whose those are."""

import json

import pytest

from flockana import scenario, verify
from flockana.report.page_data import fixed_page, scenario_page
from flockana.report.report_writer import verdicts_json

ORDER = ("refuted", "inconclusive", "verified", "vacuous")


@pytest.fixture(scope="module")
def verdicts():
    """Of a run that ends in no α-lattice, of one that does, and of an erratum."""
    pages = [fixed_page(verify("E1"))]
    for name in ("three-agents-1d", "hexagon"):
        entry = scenario(name)
        run = entry.run()
        pages.append(scenario_page(entry, run, entry.verify(run), figures=False))
    return json.loads(verdicts_json(pages))["verdicts"]


def test_the_status_is_that_of_the_authors_claims(verdicts):
    assert len(verdicts) > 6
    for one in verdicts:
        own = [claim["status"] for claim in one["claims"] if claim["by"] == one["author"]]
        assert one["status"] == next((status for status in ORDER if status in own), "vacuous"), one["theorem"]
        assert one["summary"].startswith(f"{own.count(one['status'])} of {len(own)} {one['status']}")


def test_none_is_verified_where_all_claims_of_its_source_are_vacuous(verdicts):
    for one in verdicts:
        if all(claim["status"] == "vacuous" for claim in one["claims"] if claim["by"] == one["author"]):
            assert one["status"] == "vacuous", one["theorem"]
    (terminal,) = (one for one in verdicts if (one["theorem"], one["subject"]) == ("os-5-terminal", "three-agents-1d"))
    by_name = {claim["name"]: claim for claim in terminal["claims"]}
    assert by_name["extension"]["status"] == "verified"
    assert (terminal["status"], by_name["extension"]["by"]) == ("vacuous", "flockana")
    assert "our extension: no two links cross, verified" in terminal["summary"]
