import sympy as sp

from flockana.symbolic.decide import is_zero


def test_a_number_is_zero_by_algebra_or_not_by_its_enclosure():
    k = sp.Symbol("k")
    assert is_zero(k - 2, {k: sp.Integer(2)}) is True
    assert is_zero(k - sp.pi, {k: sp.Integer(3)}) is False
