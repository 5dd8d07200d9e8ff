"""Balls as decimals: every number that is printed as a bound is one, rounded away from what it bounds.

The ends of a ball are binary fractions; what is rounded are these, in whole numbers.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, floor

from flint import arb, fmpq


def at_least(x: arb, places: int = 6) -> str:
    """The largest decimal of so many places that is certainly not above x: print it as a lower bound."""
    if not x.is_finite():
        return "-∞"
    return _shifted(floor(_end(x.lower()) * 10**places), places)


def at_most(x: arb, places: int = 6) -> str:
    """The smallest decimal of so many places that is certainly not below x: print it as an upper bound."""
    if not x.is_finite():
        return "∞"
    return _shifted(ceil(_end(x.upper()) * 10**places), places)


def interval(x: arb, places: int = 6) -> str:
    """[lower, upper], rounded outwards."""
    return f"[{at_least(x, places)}, {at_most(x, places)}]"


def small(x: arb, digits: int = 2) -> str:
    """An upper bound of a positive number in scientific notation, so many digits, rounded up."""
    top, exponent = _end(x.upper()), 0
    while top >= Fraction(10) ** (exponent + 1):
        exponent += 1
    while top < Fraction(10) ** exponent:
        exponent -= 1
    mantissa = ceil(top * Fraction(10) ** (digits - 1 - exponent))
    if mantissa == 10**digits:  # 9.99 became 10.0
        mantissa, exponent = mantissa // 10, exponent + 1
    return f"{_shifted(mantissa, digits - 1)}e{exponent:d}"


def round_down(x: arb | fmpq, digits: int) -> fmpq:
    """The largest decimal of so many significant digits that is certainly not above x, a ball or an exact number."""
    low = Fraction(int(x.p), int(x.q)) if isinstance(x, fmpq) else _end(x.lower())
    unit = _unit(abs(low), digits)
    return _rational(floor(low / unit) * unit)


def round_up(x: arb | fmpq, digits: int) -> fmpq:
    """The smallest decimal of so many significant digits that is certainly not below x."""
    return -round_down(-x, digits)


def format_decimal(x: fmpq) -> str:
    """A rational as the decimal that it is, nothing rounded."""
    return decimal(Fraction(int(x.p), int(x.q)))


def _unit(size: Fraction, digits: int) -> Fraction:
    """One in the last of so many significant digits."""
    exponent = 0
    while size and size >= Fraction(10) ** (exponent + 1):
        exponent += 1
    while size and size < Fraction(10) ** exponent:
        exponent -= 1
    return Fraction(10) ** (exponent + 1 - digits)


def _rational(x: Fraction) -> fmpq:
    return fmpq(x.numerator, x.denominator)


def first_digits(x: arb, places: int) -> str | None:
    """The decimal of so many places with which all of a positive ball begins; None if it has no such."""
    low, high = at_least(x, places), _shifted(floor(_end(x.upper()) * 10**places), places)
    return low if low == high else None


def plus_minus(x: arb, digits: int) -> str:
    """In LaTeX, a decimal and a radius that together hold the ball."""
    return str(x.str(digits)).strip("[]").replace(" +/- ", r" \pm ")


def decimal(x: Fraction) -> str:
    """A finite decimal as it is written, nothing rounded."""
    places = next(k for k in range(400) if (x * 10**k).denominator == 1)
    return _shifted(int(x * 10**places), places)


def _end(x: arb) -> Fraction:
    """The value of a ball of radius 0."""
    mantissa, exponent = x.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def _shifted(whole: int, places: int) -> str:
    """A whole number with its decimal point moved to the left."""
    digits = str(abs(whole)).rjust(places + 1, "0")
    return "-" * (whole < 0) + (f"{digits[:-places]}.{digits[-places:]}" if places else digits)
