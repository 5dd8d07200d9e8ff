"""Conversion of balls to decimals, rounded to the safe side.

The ends of a ball are binary fractions; what is rounded are these, in whole numbers.
"""

from fractions import Fraction
from math import ceil, floor

from flint import arb, fmpq


def at_least(x: arb, places: int = 6) -> str:
    """Return the largest decimal of `places` places certainly not above x."""
    return _shifted(floor(_end(x.lower()) * 10**places), places) if x.is_finite() else "-∞"


def at_most(x: arb, places: int = 6) -> str:
    """Return the smallest decimal of `places` places certainly not below x."""
    return _shifted(ceil(_end(x.upper()) * 10**places), places) if x.is_finite() else "∞"


def interval(x: arb, places: int = 6) -> str:
    """Return the text [lower, upper] of an interval, rounded outwards."""
    return f"[{at_least(x, places)}, {at_most(x, places)}]"


def small(x: arb, digits: int = 2) -> str:
    """Return an upper bound of a small positive number, rounded up, in scientific notation."""
    top = _end(x.upper())
    exponent = _exponent(top)
    mantissa = ceil(top * Fraction(10) ** (digits - 1 - exponent))
    if mantissa == 10**digits:  # 9.99 became 10.0
        mantissa, exponent = mantissa // 10, exponent + 1
    return f"{_shifted(mantissa, digits - 1)}e{exponent:d}"


def round_down(x: arb | fmpq, digits: int) -> fmpq:
    """Return the largest decimal of `digits` significant digits certainly not above x."""
    low = fraction(x) if isinstance(x, fmpq) else _end(x.lower())
    unit = Fraction(10) ** (_exponent(abs(low)) + 1 - digits)
    rounded_value = floor(low / unit) * unit
    return fmpq(rounded_value.numerator, rounded_value.denominator)


def round_up(x: arb | fmpq, digits: int) -> fmpq:
    """Return the smallest decimal of `digits` significant digits certainly not below x."""
    return -round_down(-x, digits)


def fraction(x: fmpq) -> Fraction:
    """Return a rational number of Arb (fmpq) as a Fraction of Python."""
    return Fraction(int(x.p), int(x.q))


def _exponent(size: Fraction) -> int:
    """Return the exponent of 10 of a number in scientific notation; 0 for the number 0."""
    exponent = 0
    while size >= Fraction(10) ** (exponent + 1):
        exponent += 1
    while size and size < Fraction(10) ** exponent:
        exponent -= 1
    return exponent


def first_digits(x: arb, places: int) -> str | None:
    """Return the leading decimal digits common to all numbers of a positive ball; None without any."""
    low, high = at_least(x, places), at_least(x.upper(), places)
    return low if low == high else None


def plus_minus(x: arb, digits: int) -> str:
    """Return LaTeX of a decimal ± radius that covers the ball."""
    return str(x.str(digits)).strip("[]").replace(" +/- ", r" \pm ")


def decimal(x: Fraction | fmpq) -> str:
    """Return a finite decimal as text, without rounding."""
    x = fraction(x) if isinstance(x, fmpq) else x
    digit_count = next(k for k in range(400) if (x * 10**k).denominator == 1)
    return _shifted(int(x * 10**digit_count), digit_count)


def _end(x: arb) -> Fraction:
    """Return the exact value of a ball of radius 0."""
    mantissa, exponent = x.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def _shifted(whole: int, places: int) -> str:
    """Return the digits of a whole number with the decimal point moved to the left."""
    digits = str(abs(whole)).rjust(places + 1, "0")
    return "-" * (whole < 0) + (f"{digits[:-places]}.{digits[-places:]}" if places else digits)
