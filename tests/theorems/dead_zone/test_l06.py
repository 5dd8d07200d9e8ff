"""Erratum L6: how near two agents come that run head on at three speeds."""

import pytest


def test_the_closest_approaches(verdict_of):
    distances = verdict_of("L6").claim("printed").computed
    assert distances == pytest.approx([2.8460, 0.60128, 0.02761], rel=1e-3)
