"""Erratum E8: connectivity is the rank of the Laplacian: the figures, as printed and as corrected."""

import pytest


def test_the_figures_of_the_source(verdict_of):
    verdict = verdict_of("E8")
    assert verdict.claim("printed").computed == pytest.approx(2.0 / 3.0)
    assert verdict.claim("corrected").computed == 1.0
