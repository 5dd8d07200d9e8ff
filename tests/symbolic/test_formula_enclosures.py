"""Enclosures of formulas and of their derivatives, against mpmath; where they must refuse."""

import random

import mpmath
import pytest
import sympy as sp
from flint import arb, fmpq

from flockana.symbolic.formula_enclosures import NONNEGATIVE, OPEN, POSITIVE, Enclosed, germ, interval, precision

S = sp.Symbol("s", positive=True)
FORMULAS = [
    "s*exp(s)", "(1 - s/3)**2", "(s - 13/10)**-2", "atan(tan(s))", "tanh(1000000*(s - 1))", "asin(s/4)", "acosh(1 + s)",
    "atanh(s/4)", "asinh(s)", "cosh(s) + sinh(s)", "s**(3/2)", "s**s", "s**-12 - s**-6", "acos(s/5)", "sqrt(1 + s)",
    "sin(7*s)*cos(s**2)", "(s - 1)**-3", "log(s)/(1 + s**2)", "exp(-1/s)", "s**2 - 2.6*s + 1.69",
]  # fmt: skip


def exactly(text):
    return sp.nsimplify(sp.sympify(text, locals={"s": S}), rational=True)


@pytest.mark.slow
@pytest.mark.parametrize("text", FORMULAS)
def test_values_and_derivatives_lie_in_their_enclosures(text):
    """On 60 random intervals, at both ends and inside, up to the third Taylor coefficient."""
    formula, rng, enclosed = exactly(text), random.Random(1), 0
    of = Enclosed(formula, S)
    exact = [sp.lambdify(S, sp.diff(formula, S, k) / sp.factorial(k), "mpmath") for k in range(4)]
    for _ in range(60):
        start, width = rng.uniform(0.05, 2.0), 10.0 ** rng.uniform(-6.0, 0.0)
        with precision(80, 4), mpmath.workdps(40):
            found = of.series(interval(fmpq(*start.as_integer_ratio()), fmpq(*(start + width).as_integer_ratio())))
            if found is None:
                continue
            enclosed += 1
            for t in (start, start + 0.3 * width, start + width):
                for k in range(4):
                    value = mpmath.mpf(exact[k](mpmath.mpf(t)))
                    assert (found[k] + arb(0, 1e-30)).overlaps(arb(str(value)) + arb(0, 1e-18 * (1.0 + abs(value))))
    assert enclosed > 40


@pytest.mark.parametrize(
    "text",
    ["1/(s - 1)", "log(s - 1)", "sqrt(s - 1)", "tan(pi*s/2)", "asin(s)", "acos(s)", "acosh(s)", "atanh(s)",
     "atan(1/(s - 1))", "asin(sin(pi*s/2))", "exp(s)/(s - 1)", "(s - 1)**-2", "atan(tan(pi*s/2))"],
)  # fmt: skip
def test_nothing_is_enclosed_across_a_point_where_an_operation_is_not_analytic(text):
    with precision(80, 2):
        assert Enclosed(exactly(text), S).series(interval(fmpq(1, 2), fmpq(3, 2))) is None


@pytest.mark.parametrize(
    ("text", "sign"),
    [("(s - 1)**2", NONNEGATIVE), ("(s - 1)**2*exp(s)", NONNEGATIVE), ("(s - 1)**3", OPEN),
     ("1 + (s - 1)**2", POSITIVE),
     ("s - 3/4", OPEN), ("exp(-s)", POSITIVE), ("(s - 1)**2*(s - 5)", OPEN)],
)  # fmt: skip
def test_signs_follow_from_what_a_formula_is_made_of(text, sign):
    with precision(80, 2):
        assert Enclosed(exactly(text), S).sign(interval(fmpq(1, 2), fmpq(3, 2))) == sign


def test_the_leading_power_of_a_potential_at_contact():
    found = germ(S**-12 - S**-6, S, fmpq(1, 2))
    assert int(found.power) == -12
    assert 0.984 <= float(found.factor.lower()) <= float(found.factor.upper()) <= 1.001
