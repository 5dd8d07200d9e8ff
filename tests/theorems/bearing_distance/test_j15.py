"""Erratum J15: distances at which pairs and flocks rest."""

import pytest


def test_distances(verdict_of):
    assert verdict_of("J15").claim("printed").computed == pytest.approx(2.5, rel=1e-12)
    low, high = verdict_of("J15").claim("sliding").computed
    assert 1.5 * (1.0 - 5e-3) < low < 1.5 < high < 1.5 * (1.0 + 5e-3)  # not at c w/(w + g) = 1
    assert verdict_of("J15").claim("alone").computed == pytest.approx(3.0, rel=1e-6)
    assert max(verdict_of("J15").claim("flock").witness["least distance by seed"]) < 3.0
