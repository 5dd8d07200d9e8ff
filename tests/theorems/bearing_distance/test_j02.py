"""Erratum J2: the eigenvalues known beforehand."""

import pytest


def test_the_eigenvalues(verdict_of):
    verdict = verdict_of("J2")
    assert verdict.claim("hurwitz").margin == pytest.approx(-(5**0.5 - 1) / 2)
    assert verdict.claim("hurwitz").witness["largest real part of the law's Jacobian there"] == pytest.approx(0.618034)
    assert verdict.claim("positive-definite").margin == pytest.approx(1 - 5**0.5 / 2)
