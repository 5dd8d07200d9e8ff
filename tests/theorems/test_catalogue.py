"""The errata that need no run: what is printed fails, what is corrected holds, and each claim says why."""

from __future__ import annotations

import pytest

from flockana.scenarios.scenario import differences
from flockana.theorems import theorem, theorems


@pytest.mark.parametrize("name", [n for n in theorems() if theorem(n).kind == "fixed"])
def test_every_fixed_erratum_reads_as_expected(name, verdict_of):
    verdict = verdict_of(name)
    assert theorem(name).expected
    assert differences(verdict, theorem(name).expected) == ()
    assert all(claim.detail for claim in verdict.claims)
