"""Runs that are made up, judged as if they were orbits of their maps."""

import pytest

from flockana.theorems.observed_run import Observed


@pytest.fixture
def exact(monkeypatch):
    """Take runs as exact: what is made up is no orbit of its map, and nothing would be known of it."""
    monkeypatch.setattr(Observed, "of", Observed.alone)
