"""Erratum E2: refuted as printed, in three ways; exact as corrected."""

import pytest

from flockana.theorems import theorem


def test_the_figures_of_the_erratum(verdict_of):
    verdict, expected = verdict_of("E2"), dict(theorem("E2").expected)
    assert expected.pop("E2") == verdict.status == "refuted"
    assert {f"E2:{claim.name}": claim.status for claim in verdict.claims} == expected
    assert verdict.claim("printed-state").computed == pytest.approx(1.6048889531, rel=1e-9)
    run = verdict.claim("printed-run")
    assert run.computed > 100.0 * run.error
    assert 0.0 < run.witness["time"] < 0.1
    assert verdict.claim("corrected").computed == "residual 0"
    assert "phi_alpha" in verdict.claim("printed").witness
