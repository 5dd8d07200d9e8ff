"""Three on a line: that no force acts on them, and by how much the middle one is on a hill, by differences."""

from math import hypot, log, sqrt

import pytest


def potential(s):
    return 1.0 / s**2 - 1.0 + 2.0 * log(s)


def test_three_at_rest_on_a_line(verdict_of):
    printed, corrected, second = verdict_of("tanner-minimum").claims
    spacing, h = 0.5 * sqrt(3.0), 1e-4
    hill = 2.0 * (2.0 * potential(hypot(spacing, h)) - 2.0 * potential(spacing)) / h**2
    pulls = [(potential(s + h) - potential(s - h)) / (2.0 * h) for s in (spacing, 2.0 * spacing)]
    assert sum(pulls) == pytest.approx(0.0, abs=1e-6)
    assert hill == pytest.approx(-16.0 / 9.0, rel=1e-6)
    assert (printed.status, printed.rigour, printed.computed) == ("refuted", "symbolic", "-16/9")
    assert "is -16/9 k/d² < 0" in printed.detail
    assert (second.status, second.rigour, second.by) == ("verified", "symbolic", "corrected")
    assert second.witness == ["0"] * 4
    assert (corrected.status, corrected.rigour, corrected.computed) == ("verified", "symbolic", "residual 0")
