"""Integrals of the weight, and what the theorems make of starts on both sides of their thresholds."""

from math import asinh, atan, inf, pi, sqrt

import mpmath
import numpy as np
import pytest

import flockana as fl
from flockana.interactions.weights import RationalWeight
from flockana.measures.metrics import spreads
from flockana.sources.cucker_smale_2007.theorems.spread_functional import guarantee_of
from flockana.theorems.alignment_bounds import QUADRATURE, AlignmentRate
from flockana.theorems.observed_run import Observed


@pytest.mark.parametrize("start", [-2.0, 0.0, 0.7])
def test_integrals_in_closed_form(start):
    line = AlignmentRate(RationalWeight(decay=1.0, length=2.0), 3.0, 1.0)
    assert line.between(start, 5.0) == pytest.approx(6.0 * (atan(2.5) - atan(start / 2.0)), rel=1e-12)
    assert line.beyond(start) == pytest.approx(6.0 * (pi / 2.0 - atan(start / 2.0)), rel=1e-12)
    half = AlignmentRate(RationalWeight(decay=0.5), 1.0, 2.0)
    assert half.between(start, 5.0) == pytest.approx(0.5 * (asinh(10.0) - asinh(2.0 * start)), rel=1e-12)
    assert half.beyond(start) == inf


@pytest.mark.parametrize("decay", [0.51, 0.8, 3.0])
def test_the_tail_by_quadrature(decay):
    exact = mpmath.quad(lambda w: mpmath.cosh(w) ** (1 - 2 * mpmath.mpf(decay)), [asinh(2.0), 50, 2000, mpmath.inf])
    assert AlignmentRate(RationalWeight(decay=decay), 1.0, 1.0).beyond(2.0) == pytest.approx(float(exact), rel=1e-9)


@pytest.mark.parametrize("decay", [0.0, 0.25, 0.5, 1.0])
def test_the_bound_is_where_the_integral_is_the_speed(decay):
    line = AlignmentRate(RationalWeight(decay=decay), 2.0, sqrt(2.0))
    speed = 0.9 * min(line.beyond(0.3), 4.0)
    assert line.between(0.3, line.reached(0.3, speed)) == pytest.approx(speed, rel=1e-11)
    assert line.reached(0.3, 0.0) == 0.3
    if decay > 0.5:
        assert line.reached(0.3, 1.01 * line.beyond(0.3)) == inf


def test_a_flock_of_two_shows_that_the_larger_integral_is_sharp():
    """The threshold of two agents on a line, π/4 here, is that of φ(s) = λψ(√2 s), and above that as printed."""
    weight, start = RationalWeight(decay=1.0), 1.0 / sqrt(2.0)
    sharp, printed = (AlignmentRate(weight, 1.0, c).beyond(start) for c in (sqrt(2.0), 2.0))
    assert sharp * sqrt(2.0) == pytest.approx(pi / 4.0, rel=1e-12)
    assert printed * sqrt(2.0) == pytest.approx((pi / 2.0 - atan(sqrt(2.0))) / sqrt(2.0), rel=1e-12)


def test_an_approaching_pair_counts_the_way_past_each_other():
    law = fl.CuckerSmale(RationalWeight(1.0, 1.0), mean=True)
    for speed, fate in ((0.74 * pi, "bounded"), (0.76 * pi, "parts")):
        run = fl.simulate(law, [[0.0], [-1.0]], [[0.0], [speed]], (0.0, 3.0))  # 3π/4 from −1 on
        assert fl.verify("cucker-smale-pair", run).claim(fate).status == "verified"


def test_a_matched_start_one_at_one_point_and_another_law():
    run = fl.simulate(fl.CuckerSmale(), [[0.0], [1.0]], [[1.0], [1.0]], (0.0, 1.0))
    assert fl.verify("cucker-smale-pair", run).status == "vacuous"
    assert fl.verify("ha-liu", run).claim("rate").status == "inconclusive"
    other = fl.simulate(fl.Algorithm1(), [[0.0], [7.0]], [[1.0], [1.0]], (0.0, 1.0))
    assert fl.verify("ha-liu", other).status == fl.verify("tanner-fixed", other).status == "vacuous"
    run = fl.simulate(fl.CuckerSmale(), [[1.0, 2.0]] * 2, [[3.0, 0.0]] * 2, (0.0, 1.0))
    bounded = fl.verify("ha-liu", run).claim("bounded")
    assert (bounded.status, bounded.rigour, bounded.margin, bounded.error) == ("verified", "smt", 0.0, inf)
    assert "x_M = 0" in bounded.detail


def test_sums_that_are_not_divided_count_every_agent():
    """λ = nK: the same flock in both forms has the same integral, with K a third of it."""
    q, p = [[0.0], [1.0], [3.0]], [[0.5], [0.0], [-0.5]]
    laws = fl.CuckerSmale(RationalWeight(1.0, 1.0)), fl.CuckerSmale(RationalWeight(3.0, 1.0), mean=True)
    one, other = (fl.verify("ha-liu", fl.simulate(law, q, p, (0.0, 0.1))).hypotheses[-1].margin for law in laws)
    assert one == pytest.approx(other, rel=1e-12)


def test_how_exactly_a_fall_is_known_far_from_rest():
    """ln(v0/v)/t of velocities with an error e is off by (1/v + 1/v0) e/t; here e is the rounding of 10⁶ and more.

    The rate φ(x_M) that it is compared with is off, too: by φ'/φ of the error of x_M, which is that of
    v0 - ∫φ over φ(x_M), and of quadrature.
    """
    law = fl.CuckerSmale(RationalWeight(strength=1.0, decay=0.25))
    q, p = np.array([[0.0], [1.0]]), np.array([[0.0], [1.0]])
    run = fl.simulate(law, q, p + 1e6, (0.0, 2.0), t_eval=[0.0, 2.0])
    v0, v = np.sqrt(2.0 * spreads(run.p))
    phi, x0 = AlignmentRate(law.weight, 2.0, sqrt(2.0)), np.sqrt(2.0 * spreads(run.q)[0])
    x_m = phi.reached(x0, v0)
    rate = phi(x_m)
    claim = guarantee_of(Observed.alone(run), sqrt(2.0)).claims([])[1][1]
    assert claim.computed == pytest.approx(np.log(v0 / v) / 2.0, rel=1e-9)
    assert claim.margin == pytest.approx(np.log(v0 / v) / (2.0 * rate) - 1.0, rel=1e-6)
    x_blur, v_blur = (sqrt(2.0) * (2 + 4) * np.finfo(float).eps * np.abs(z).max() for z in (run.q, run.p))
    slope = 2.0 * 0.25 * 2.0 * x_m / (1.0 + 2.0 * x_m**2)  # −φ'/φ of (1 + 2 s²)^−β
    of_rate = slope * ((v_blur + phi(x0) * x_blur) / rate + QUADRATURE * x_m)
    expected = v_blur * (1.0 / v + 1.0 / v0) / (2.0 * rate) + of_rate * claim.computed / rate
    assert claim.error == pytest.approx(expected, rel=1e-6)
