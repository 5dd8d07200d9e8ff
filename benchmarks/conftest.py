"""Collect ratios against baselines timed in the same run: `python -m benchmarks` takes them, and pytest prints them."""

from __future__ import annotations

import time
import timeit
from collections.abc import Callable

import pytest


def best(function: Callable[[], object], *, repeat: int = 5, number: int = 1) -> float:
    """CPU seconds per call: the least of several repetitions, which noise can only make worse."""
    function()
    return min(timeit.repeat(function, repeat=repeat, number=number, timer=time.process_time)) / number


def pytest_configure(config):
    config.ratios = []


@pytest.fixture
def ratio(request):
    """Record a ratio with what it means."""

    def record(name: str, value: float, meaning: str) -> float:
        request.config.ratios.append((name, value, meaning))
        return value

    return record


def pytest_terminal_summary(terminalreporter, config):
    if config.ratios:
        terminalreporter.section("ratios of this run")
        for name, value, meaning in config.ratios:
            terminalreporter.write_line(f"{value:10.3g}  {name}: {meaning}")
