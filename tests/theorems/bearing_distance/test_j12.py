"""Erratum J12: the distance at which agents stop before walls and each other."""

import pytest


def test_the_stand_off(verdict_of):
    claim = verdict_of("J12").claim("stand-off")
    assert claim.computed.keys() == claim.stated.keys()
    for case, distance in claim.computed.items():
        assert distance == pytest.approx(claim.stated[case], abs=1e-9)
    assert 0.9e-6 < claim.margin <= 1e-6  # what is left of 1e-6, in units of c
    assert abs(verdict_of("J12").claim("contact").computed["distance from the wall"]) < 1e-6
