"""Erratum L2: the force on two agents 3 apart, and how long they would fall, by hand."""

from math import sqrt

import mpmath
import pytest


def test_the_force_and_the_fall(verdict_of):
    """F = −(400/ρ² + 1.3) ρ/√(1 + ρ²) has the potential 400 asinh(1/ρ) − 1.3 √(1 + ρ²); ½ρ'² is twice what is lost."""
    share = (400.0 / 9.0 + 1.3) * 3.0 / sqrt(10.0) / ((400.0 / 3.5**2 + 1.3) * 3.5 / sqrt(13.25))

    def psi(rho):
        return 400 * mpmath.asinh(1 / rho) - mpmath.mpf("1.3") * mpmath.sqrt(1 + rho * rho)

    fall = mpmath.quad(lambda rho: 1 / (2 * mpmath.sqrt(psi(rho) - psi(mpmath.mpf(3)))), mpmath.linspace(0, 3, 4))
    printed, corrected = (verdict_of("L2").claim(name) for name in ("printed", "corrected"))
    assert (printed.status, corrected.status) == ("refuted", "verified")
    assert (printed.margin, corrected.margin) == (pytest.approx(-share, rel=1e-12), pytest.approx(share, rel=1e-12))
    assert printed.error == pytest.approx(1e-12, rel=1e-3)
    assert (printed.rigour, printed.disproof, corrected.rigour) == ("smt", "dead-zone", "numeric")
    assert printed.computed == pytest.approx(float(fall), rel=1e-8)
    assert "at rest 3 apart" in printed.detail
