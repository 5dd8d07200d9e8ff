"""Erratum E2: refuted as printed, in three ways; exact as corrected."""

from __future__ import annotations

import pytest

from flockana.theorems import verify
from flockana.theorems.catalogue import theorem


def test_e2_reads_as_expected() -> None:
    verdict, expected = verify("E2"), dict(theorem("E2").expected)
    assert expected.pop("E2") == verdict.status == "refuted"
    assert {f"E2:{claim.name}": claim.status for claim in verdict.claims} == expected
    assert verdict.claim("printed-state").computed == pytest.approx(1.6048889531, rel=1e-9)
    run = verdict.claim("printed-run")
    assert run.computed > 100.0 * run.error
    assert 0.0 < run.witness["time"] < 0.1
    assert verdict.claim("corrected").computed == "residual 0"
    assert "phi_alpha" in verdict.claim("printed").witness
