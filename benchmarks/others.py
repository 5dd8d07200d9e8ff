"""The studies that are written as tests with the fixture `ratio` (test_*.py): each ratio is a row."""

from __future__ import annotations

import io
from contextlib import redirect_stdout
from pathlib import Path

import pytest

from benchmarks.rows import Found, Row

STUDY = "Further ratios"
_SLOW = ("test_ensemble.py", "test_equilibria.py", "test_stability.py")


class Collector:
    """Gives the tests their fixture and keeps what they record."""

    def __init__(self) -> None:
        self.rows: list[Row] = []
        self.failed: list[str] = []

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Remember what failed."""
        if report.failed:
            self.failed.append(report.nodeid)

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        """Take the ratios over from the conftest."""
        for name, value, meaning in getattr(terminalreporter.config, "ratios", ()):
            self.rows.append(Row(STUDY, f"{name}: {meaning}", None, value, ""))


def study(*, quick: bool) -> Found:
    """All of them; the slow ones are left out where a few minutes must do."""
    here = Path(__file__).parent
    files = [path for path in sorted(here.glob("test_*.py")) if not (quick and path.name in _SLOW)]
    collector = Collector()
    with redirect_stdout(io.StringIO()):
        options = ["--benchmark-disable", "-p", "no:xdist", "-p", "no:cacheprovider", "-q"]
        pytest.main([*map(str, files), *options], plugins=[collector])
    return Found(collector.rows, [f"failed: {name}" for name in collector.failed])
