"""Erratum J15: distances at which pairs and flocks rest."""

from __future__ import annotations

import pytest


def test_distances(verdict_of):
    assert verdict_of("J15").claim("printed").computed == pytest.approx(2.5, rel=1e-12)
    assert verdict_of("J15").claim("alone").computed == pytest.approx(3.0, rel=1e-6)
    assert max(verdict_of("J15").claim("flock").witness["least distance by seed"]) < 3.0
