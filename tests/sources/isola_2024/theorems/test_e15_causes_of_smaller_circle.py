"""Erratum E15: start, speed and the factor of p_r, against closed forms."""

from math import pi, sqrt

import numpy as np
import pytest
import sympy as sp

from flockana import Gains, scenario, verify
from flockana.stability.centre_transfer import CentreOfMass, predicted_gain
from flockana.stability.tracking import response_ratio
from flockana.symbolic import GainSymbols
from flockana.symbolic.parameter_symbols import GAINS
from flockana.symbolic.translational_dynamics import OMEGA, SQUARE, falling_condition, frequency_gain, gain_slope

# what an independent transcription of the project's system gave, to two digits, at ¼, ½, 1, 2 and 4 times the speed
TRUE = [1.01, 1.04, 1.11, 1.15, 0.92]


@pytest.mark.slow
def test_ratios_over_the_speed():
    verdict = verify("E15")
    assert verdict.claim("first-grows").computed == pytest.approx(TRUE, abs=6e-3)
    x = (2 * pi * 0.025 / 0.045 * np.array([0.25, 0.5, 1.0, 2.0, 4.0])) ** 2 / 70.0  # ω²/c1γ, critically damped:
    assert verdict.claim("first-grows").computed == pytest.approx(np.sqrt(1 + 4 * x) / (1 + x), rel=1e-7)
    told = np.sqrt(1 + 4 * 0.009**2 * x) / (1 + x)
    assert verdict.claim("faster").computed == pytest.approx(told, rel=1e-7)
    assert verdict.claim("printed-start").computed == pytest.approx(told[2], rel=1e-7)
    assert verdict.claim("printed-speed").computed == pytest.approx(np.delete(told, 2), rel=1e-7)
    assert all(claim.error < 1e-3 * abs(claim.margin) for claim in verdict.claims if "printed" in claim.name)


def test_the_symbolic_condition_is_that_of_the_slope():
    c1, c2, k = GAINS.c1_gamma, GAINS.c2_gamma, sp.Symbol("k", real=True)
    square = frequency_gain(k, omega=OMEGA) ** 2
    slope = sp.diff(square.subs(OMEGA, sp.sqrt(SQUARE)), SQUARE)
    denominator = (c1 - SQUARE) ** 2 + c2**2 * SQUARE
    assert sp.simplify(slope * denominator**2 - gain_slope(k)) == 0
    assert sp.expand(gain_slope(k).subs(SQUARE, 0) + c1**2 * falling_condition(k)) == 0
    critical = GainSymbols(c1_gamma=c1, c2_gamma=2 * sp.sqrt(c1))
    assert sp.solve(gain_slope(gains=critical), SQUARE) == [-c1, c1 / 2]  # of an ω² ≥ 0 the second
    assert sp.simplify(frequency_gain(gains=critical, omega=sp.sqrt(c1 / 2)) - 2 / sp.sqrt(3)) == 0  # 1.155


@pytest.mark.parametrize("factor", [0.0, 0.009, 0.7, 0.72, 1.0])
def test_the_gain_falls_exactly_where_the_margin_says(factor):
    gains = Gains(c1_gamma=70.0, c2_gamma=2.0 * sqrt(70.0))
    values = [predicted_gain(gains, omega, factor=factor) for omega in np.linspace(0.0, 40.0, 400)]
    assert (CentreOfMass(gains, factor).falling >= 1.0) is bool((np.diff(values) < 0.0).all())
    found = float(falling_condition(factor, gains=GainSymbols(c1_gamma=70, c2_gamma=2 * sp.sqrt(70))))
    assert found == pytest.approx(140.0 * (CentreOfMass(gains, factor).falling - 1.0), rel=1e-9)


@pytest.mark.parametrize("options", [{"away": 4.0}, {"speed": 2.0, "away": -3.0}])
def test_the_projects_hundred_agents_forget_their_start_and_follow_at_any_speed(options):
    entry = scenario("msn-case4", **options)
    omega = 2 * pi * 0.025 / 0.045 * options.get("speed", 1.0)
    assert (np.linalg.norm(entry.q0 - (50.0, 50.0), axis=1) > 100.0).all()
    gain = predicted_gain(entry.law.gains, omega, factor=0.009)
    assert response_ratio(entry.run())[0] == pytest.approx(gain, rel=1e-6)
    assert dict(entry.expected) == {"source:circle": "verified"}
