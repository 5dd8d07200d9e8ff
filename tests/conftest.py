"""Shared settings: hypothesis runs the same examples every time, and never judges by the clock."""

from __future__ import annotations

import signal

import pytest
from hypothesis import HealthCheck, settings

settings.register_profile(
    "flockana",
    deadline=None,
    derandomize=True,
    max_examples=40,
    database=None,
    suppress_health_check=[HealthCheck.too_slow],  # the clock of a busy machine
)
settings.load_profile("flockana")


@pytest.fixture
def answering():
    """Ctrl-C is answered here, even if whoever started the tests ignores it, which is inherited."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
