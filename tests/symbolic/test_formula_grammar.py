"""Formulas as text: what the grammar reads, what it refuses, and that no short text takes long."""

import pytest
import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.symbolic.formula_grammar import expression_size, read_formula, write_formula

S, K = sp.symbols("s k", positive=True)
NAMES = {"s": S, "k": K}
HOSTILE = [  # what is said of some formulas
    ("power beyond 64", "9**9**9**9"),
    ("more than 1024 bits", "((9**64)**64)**64"),
    ("is no formula", "().__class__.__bases__", "s.__class__", "__import__('os').system('true')", "[s for s in s]"),
    ("is no formula", "lambda: s", "s if s else k", "1 < s < 2", "Piecewise(s, k)"),
    ("unknown function", "__import__(s)", "open(s)"),
    ("cannot be read", "s := 1", "s; s", "(" * 300 + "s" + ")" * 300, "\x00", ""),
    ("is no number", "'s'", "s + 1j"),
    ("inf is no number of a formula", "1e400"),
    ("expected", "9" * 3999, "-" * 3999 + "s"),
    ("1000000 characters", "s" * 1_000_000),
    ("nested more than 100", "s" + "+s" * 1500),
    ("at most 600", "exp(exp(exp(exp(1000))))", "Piecewise((1, s < exp(exp(exp(20)))), (0, True))"),
    ("no real number", "1/0", "log(0)", "sqrt(-1)", "asin(7)*s", "abs(s*acosh(1/2))"),
    ("is a condition", "s < 1"),
    ("2 arguments", "sin(s, k)"),
    ("unknown name 'q'", "q*s"),
    ("exponentials within each other", "exp(exp(exp(exp(s))))", "s**(s**(s**(s**s)))"),
    ("exponentials within each other", "2**(2**(2**(2**(2**s))))*s**2", "cosh(sinh(cosh(exp(s))))"),
    ("as its degree", "((s**64)**64)**64", "((((s + 1)**64 + 1)**64 + 1)**64)"),
    ("has pieces itself", "abs(" * 8 + "s" + " - 0.1)" * 8, "abs(abs(s - 1) - 0.5)", "sqrt((abs(s - 1) - 0.5)**2)"),
    ("has pieces itself", "Piecewise((1, Piecewise((s, s < 1), (2*s, True)) < 1.5), (0, True))"),
    ("is 0, or not distinguishable from 0", "s/(sqrt(2) + sqrt(3) - sqrt(5 + 2*sqrt(6)))"),
    ("is 0, or not distinguishable from 0", "(sin(1)**2 + cos(1)**2 - 1)**-2"),
]


@pytest.mark.parametrize(
    ("says", "text"), [(says, text) for says, *texts in HOSTILE for text in texts], ids=lambda text: text[:24]
)
def test_what_is_no_formula_is_refused(says, text):
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
