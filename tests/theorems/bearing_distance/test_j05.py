"""Erratum J5: the path of three that accelerates for ever."""

from __future__ import annotations

import pytest


def test_the_runaway(verdict_of):
    runaway = verdict_of("J5").claim("runaway").computed
    assert runaway["acceleration"] == pytest.approx(2 / 3, abs=1e-6)
    assert runaway["edges"] == pytest.approx(5 / 3, abs=1e-6)
    assert runaway["ends apart"] < 1e-6
