"""Erratum J10: how many random starts violate the least distance at once."""

import pytest


def test_starts_violate_the_distance_at_once(verdict_of):
    separated = verdict_of("J10").claim("distances").computed
    assert 1.0 - separated["holds"] / separated["of"] == pytest.approx(0.96, abs=0.01)
