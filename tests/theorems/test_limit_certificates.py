"""Evidence of a limit is told and decides nothing; the best certificate is the surest."""

import numpy as np
import pytest

from flockana.theorems.limit_certificates import Certificate, best_of, evidence, limit_claim, without_assumed
from flockana.theorems.theorem import Hypothesis

T = np.linspace(0.0, 80.0, 801)


@pytest.mark.parametrize(
    ("amplitude", "said"),
    [
        (np.exp(-T), "in this run v falls by a factor of 2.5e+30"),  # e^70, to the start of the last eighth
        (np.abs(np.cos(T)), "v does not fall"),
        (np.exp(0.1 * T), "v does not fall"),
        (np.zeros(801), "v does not fall"),
        (1.0 / (1.0 + T), "in this run v falls by a factor of 71"),
    ],
    ids=["decay", "swing", "growth", "rest", "power"],
)
def test_evidence_tells_by_how_much_an_amplitude_has_fallen(amplitude, said):
    assert evidence(T, amplitude, "v") == said


def test_the_surest_certificate_counts_and_one_that_is_nan_does_not():
    lost, wide, sure = Certificate(np.nan, "NaN"), Certificate(0.5, "wide", 0.6), Certificate(0.2, "sure", 0.1)
    assert best_of([lost, wide, sure]).text == "sure"
    assert [each.certain for each in (lost, wide, sure)] == [False, False, True]
    assert best_of([lost]).certain is False


def test_a_limit_that_a_proof_alone_verifies_has_no_margin():
    proved = limit_claim("i", [], [Certificate(-0.5, "no basin")], proof="cohesion", detail="x", evidence="falls")
    assert (proved.status, proved.margin, proved.error) == ("verified", None, None)
    assert proved.detail == "x; proved for every start"
    caught = limit_claim("i", [], [Certificate(0.5, "a basin")], proof="cohesion", detail="x", evidence="falls")
    assert (caught.margin, caught.detail) == (0.5, "x; a basin")
    parted = limit_claim("i", [], escape=Certificate(0.5, "they part"), proof="cohesion")
    assert (parted.status, parted.contradicts, parted.margin) == ("inconclusive", "cohesion", -0.5)


def test_a_certificate_rests_on_no_assumption_and_a_refutation_would():
    needs = [Hypothesis("all solutions stay together", "assumed")]
    basin, parted = Certificate(0.5, "a basin"), Certificate(0.5, "parted")
    assert without_assumed(needs, lambda given: limit_claim("i", given, [basin])).status == "verified"
    assert without_assumed(needs, lambda given: limit_claim("i", given, escape=parted)).status == "inconclusive"
