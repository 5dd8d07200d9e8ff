"""Formulas as text: what the grammar reads, what it refuses, and that no short text takes long."""

import pytest
import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.symbolic.grammar import expression_size, read_formula, write_formula

S, K = sp.symbols("s k", positive=True)
NAMES = {"s": S, "k": K}
HOSTILE = [
    ("9**9**9**9", "power beyond 64"),
    ("((9**64)**64)**64", "more than 1024 bits"),
    ("().__class__.__bases__", "is no formula"),
    ("s.__class__", "is no formula"),
    ("__import__('os').system('true')", "is no formula"),
    ("__import__(s)", "unknown function"),
    ("open(s)", "unknown function"),
    ("[s for s in s]", "is no formula"),
    ("lambda: s", "is no formula"),
    ("s if s else k", "is no formula"),
    ("s := 1", "cannot be read"),
    ("s; s", "cannot be read"),
    ("'s'", "is no number"),
    ("s + 1j", "is no number"),
    ("1e400", "inf is no number of a formula"),
    ("9" * 3999, "expected"),
    ("s" * 1_000_000, "1000000 characters"),
    ("(" * 300 + "s" + ")" * 300, "cannot be read"),
    ("-" * 3999 + "s", "expected"),
    ("s" + "+s" * 1500, "nested more than 100"),
    ("exp(exp(exp(exp(1000))))", "at most 600"),
    ("Piecewise((1, s < exp(exp(exp(20)))), (0, True))", "at most 600"),
    ("1/0", "no real number"),
    ("log(0)", "no real number"),
    ("sqrt(-1)", "no real number"),
    ("s < 1", "is a condition"),
    ("1 < s < 2", "is no formula"),
    ("Piecewise(s, k)", "is no formula"),
    ("sin(s, k)", "2 arguments"),
    ("q*s", "unknown name 'q'"),
    ("\x00", "cannot be read"),
    ("", "cannot be read"),
    ("exp(exp(exp(exp(s))))", "exponentials within each other"),
    ("s**(s**(s**(s**s)))", "exponentials within each other"),
    ("2**(2**(2**(2**(2**s))))*s**2", "exponentials within each other"),
    ("cosh(sinh(cosh(exp(s))))", "exponentials within each other"),
    ("((s**64)**64)**64", "as its degree"),
    ("((((s + 1)**64 + 1)**64 + 1)**64)", "as its degree"),
    ("abs(" * 8 + "s" + " - 0.1)" * 8, "has pieces itself"),
    ("abs(abs(s - 1) - 0.5)", "has pieces itself"),
    ("sqrt((abs(s - 1) - 0.5)**2)", "has pieces itself"),
    ("Piecewise((1, Piecewise((s, s < 1), (2*s, True)) < 1.5), (0, True))", "has pieces itself"),
    ("s/(sqrt(2) + sqrt(3) - sqrt(5 + 2*sqrt(6)))", "is 0, or not distinguishable from 0"),
    ("asin(7)*s", "no real number"),
    ("abs(s*acosh(1/2))", "no real number"),
    ("(sin(1)**2 + cos(1)**2 - 1)**-2", "is 0, or not distinguishable from 0"),
]


@pytest.mark.parametrize(("text", "says"), HOSTILE, ids=[text[:24] for text, _ in HOSTILE])
def test_what_is_no_formula_is_refused(text, says):
    with pytest.raises(ArgumentError, match=says) as caught:
        read_formula(text, NAMES)
    assert len(str(caught.value)) < 500


@pytest.mark.parametrize(
    "expression",
    [
        K * (S - 2) ** 2 / 2,
        sp.Float(0.1) * S ** sp.Rational(5, 3) * sp.exp(-S / K) * sp.exp(1),
        sp.Piecewise((sp.sin(S), S < K / 2), (sp.sqrt(S), True)),
        sp.atan(S) + sp.cosh(S) - sp.pi,
    ],
)
def test_what_is_written_is_read_as_the_same(expression):
    again = read_formula(write_formula(expression), NAMES)
    for s in (0.3, 1.7):
        values = {S: sp.Float(s, 17), K: sp.Float(2.1, 17)}
        assert float((again - expression).subs(values)) == pytest.approx(0.0, abs=1e-15)


def test_a_float_keeps_its_last_bit():
    assert float(read_formula(write_formula(sp.Float(0.1 + 0.2, 17) * S), NAMES).subs(S, 1)) == 0.1 + 0.2


def test_a_size_is_two_pieces():
    kink = read_formula("abs(s - 1)", NAMES)
    assert [kink.subs(S, x) for x in (0, 1, 3)] == [1, 0, 2]


def test_the_size_of_an_expression():
    s = sp.Symbol("s")
    assert expression_size(sp.exp(sp.exp(s)) + s**8, {}) == (7, 2, 8)
