"""Enclosures hold the exact value of every formula, stay exact where they can, and say nothing of a quotient by 0."""

from fractions import Fraction

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana.base.errors import ArgumentError
from flockana.theorems.enclosure import Enclosure, stacked

numbers = st.floats(-1e6, 1e6, allow_nan=False)
widths = st.floats(0.0, 1e3)
shares = st.floats(0.0, 1.0)


def drawn(value, width, share):
    """An enclosure of half a width, and a number that certainly lies in it."""
    x = Enclosure.around(value, width)
    inside = Fraction(float(x.lo)) + Fraction(share) * (Fraction(float(x.hi)) - Fraction(float(x.lo)))
    return x, inside


def holds(x, exact):
    low, high = float(x.lo), float(x.hi)
    return (low == -np.inf or Fraction(low) <= exact) and (high == np.inf or exact <= Fraction(high))


@given(numbers, widths, shares, numbers, widths, shares)
def test_sums_products_and_quotients_hold_the_exact_value(a, u, s, b, v, t):
    (x, exact_x), (y, exact_y) = drawn(a, u, s), drawn(b, v, t)
    assert holds(x + y, exact_x + exact_y)
    assert holds(x - y, exact_x - exact_y)
    assert holds(x * y, exact_x * exact_y)
    assert holds(x.square(), exact_x**2)
    assert holds(abs(x), abs(exact_x))
    if exact_y != 0:
        assert holds(x / y, exact_x / exact_y)


@given(st.floats(1e-6, 1e6), st.floats(0.0, 0.5), shares)
def test_functions_hold_the_value_that_mpmath_computes(value, width, share):
    x, exact = drawn(value, width * value, share)
    with mpmath.workdps(40):
        at = mpmath.mpf(exact.numerator) / exact.denominator
        for found, true in (
            (x.sqrt(), mpmath.sqrt(at)),
            (x.log(), mpmath.log(at)),
            ((x / 1e4).exp(), mpmath.exp(at / 10**4)),
        ):
            assert mpmath.mpf(float(found.lo)) <= true <= mpmath.mpf(float(found.hi))


@given(st.lists(numbers, min_size=1, max_size=30))
def test_a_sum_holds_the_exact_sum_of_its_terms(values):
    assert holds(Enclosure.of(np.array(values)).sum(), sum(map(Fraction, values)))


def test_nothing_is_known_of_a_quotient_by_what_may_be_0_and_its_logarithm():
    noise = Enclosure.around(1e-12, 1e-10)
    quotient = 1.0 / noise
    assert (quotient.lo, quotient.hi) == (-np.inf, np.inf)
    assert noise.log().lo == -np.inf
    assert np.isfinite(noise.log().hi)
    far = 0.1 / noise.clip(0.0)
    assert far.lo > 0.0  # a quotient of numbers of one sign keeps it
    assert far.hi == np.inf


def test_0_stays_0_an_exact_number_exact_and_an_unknown_half_width_encloses_everything():
    zero = Enclosure.of(0.0)
    assert [float(end) for x in (zero + zero, zero * 3.0, zero.sqrt(), abs(zero)) for end in (x.lo, x.hi)] == [0.0] * 8
    three = Enclosure.around(3.0, 0.0)
    assert three.lo == three.hi == 3.0
    for width in (np.inf, np.nan):
        x = Enclosure.around(1.0, width)
        assert (x.lo, x.hi) == (-np.inf, np.inf)
    assert float((Enclosure.around(1.0, np.inf) * 0.0).hi) == 0.0


def test_the_most_certain_failure_decides_or_else_the_least_sure_and_ends_are_in_order():
    margins = Enclosure([-1.0, 0.5, -3.0], [1.0, 2.0, -2.0], [2.0, 3.0, -1.0])
    assert margins.worst_index == 2
    assert margins[:2].worst_index == 0
    assert Enclosure.of(np.empty(0)).worst.lo == 1.0
    with pytest.raises(ArgumentError, match=r"lo = 2 above hi = 1: expected lo <= hi"):
        Enclosure(2.0, 1.5, 1.0)


def test_running_and_stacked_extremes():
    x = Enclosure.around(np.array([1.0, 3.0, 2.0]), 0.5)
    assert x.largest_so_far().mid.tolist() == [1.0, 3.0, 3.0]
    assert stacked([x[0], x[2]]).max().hi == np.nextafter(2.5, 3.0)
    assert x.min().lo == np.nextafter(0.5, 0.0)
