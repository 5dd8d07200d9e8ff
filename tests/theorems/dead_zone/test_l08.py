"""Erratum L8: the distance at which two agents rest."""

import pytest


def test_two_agents_rest_near_where_repulsion_ends(verdict_of):
    assert verdict_of("L8").claim("contact").computed == pytest.approx(3.49973, abs=1e-5)
