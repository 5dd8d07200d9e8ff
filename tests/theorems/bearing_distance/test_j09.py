"""Erratum J9: an agent runs through an alien as printed, and stops before it as corrected."""

import pytest


def test_an_agent_runs_through_the_alien(verdict_of):
    assert verdict_of("J9").claim("printed").computed < -10.0  # the agent is far beyond the alien
    assert verdict_of("J9").claim("corrected").computed == pytest.approx(3.0, abs=1e-6)
