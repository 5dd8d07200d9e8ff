"""Collect ratios against baselines timed in the same run, and print them at the end."""

from __future__ import annotations

import timeit
from collections.abc import Callable

import pytest

_ROWS: list[tuple[str, float, str]] = []


def best(function: Callable[[], object], *, repeat: int = 5, number: int = 1) -> float:
    """Seconds per call: the least of several repetitions, which noise can only make worse."""
    function()
    return min(timeit.repeat(function, repeat=repeat, number=number)) / number


@pytest.fixture
def ratio():
    """Record a ratio with what it means."""

    def record(name: str, value: float, meaning: str) -> float:
        _ROWS.append((name, value, meaning))
        return value

    return record


def pytest_terminal_summary(terminalreporter):
    if _ROWS:
        terminalreporter.section("ratios of this run")
        for name, value, meaning in _ROWS:
            terminalreporter.write_line(f"{value:10.3g}  {name}: {meaning}")
