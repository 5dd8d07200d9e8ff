"""Each faulty implementation is found out by one sentence of `compare`."""

import pytest

import flockana as fl
from flockana.recorded.faulty_laws import CODES, faulty_recording, intended_law

FINDINGS = {
    "A": "the pull to the γ-agent is proportional to each coordinate's σ₁, not to the vector",
    "B": "velocity consensus is c2α = 30 here, 10.95 in the law",
    "C": "the pair force's direction n_ij is taken coordinate by coordinate",
    "D": "steps are explicit Euler of 0.02",
}


@pytest.mark.slow
@pytest.mark.parametrize("name", list(CODES))
def test_the_error_is_the_only_finding(name):
    seen = fl.compare(faulty_recording(name), intended_law())
    assert len(seen.findings) == 1
    assert seen.findings[0].startswith(FINDINGS[name])
    if name != "D":  # whose accelerations are right
        assert seen.explained < 0.99 < seen.explained_refitted
