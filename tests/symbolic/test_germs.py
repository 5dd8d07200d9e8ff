import sympy as sp
from flint import fmpq

from flockana.symbolic.germs import germ


def test_the_leading_power_of_a_potential_at_contact():
    s = sp.Symbol("s", positive=True)
    found = germ(s**-12 - s**-6, s, fmpq(1, 2))
    assert int(found.power) == -12
    assert 0.984 <= float(found.factor.lower()) <= float(found.factor.upper()) <= 1.001
