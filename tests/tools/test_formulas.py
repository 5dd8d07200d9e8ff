from pathlib import Path

import pytest
import sympy as sp

import flockana
from flockana.symbolic import BETA, named_functions
from flockana.symbolic.named_functions import Bump, Phi, PhiIntegral, SigmaNorm, written
from flockana.symbolic.scalar_functions import beta_closed, beta_smooth
from tools.formulas import sources

A, Y, H, Z = sp.symbols("a y h z", positive=True)
C = sp.Symbol("c", positive=True)
B = A * (1 + 2 * C * (C + sp.sqrt(1 + C**2)))  # so that (b − a)/√(4ab) = c
AT = {A: 2, H: 3, C: 1.25, Y: 5}


@pytest.mark.parametrize("path", sources())
def test_a_generated_file_is_what_its_formulas_give(path):
    text = (Path(flockana.__file__).parent / path).read_text("utf-8")
    assert text == sources()[path], "run `python -m tools.formulas`"


def test_slopes_are_derivatives_of_the_printed_formulas():
    s = sp.Symbol("s", real=True)
    for node in (named_functions.Sigma1(s), Phi(s, A, A + H, C), PhiIntegral(s, A, B, C), SigmaNorm(Y, A)):
        x = node.args[0]
        assert abs((written(node.diff(x)) - node.formula.diff(x)).subs(AT | {s: 0.3}).evalf()) < 1e-14
    z = sp.Symbol("z", positive=True)
    slope = written(Bump(z, sp.Rational(1, 5)).diff(z))
    assert slope.subs(z, sp.Rational(1, 10)) == slope.subs(z, 2) == slope.subs(z, 1) == 0
    on_taper = written(named_functions.Taper(named_functions.Place(z, sp.Rational(1, 5))))
    assert abs((slope - on_taper.diff(z)).subs(z, 0.7).evalf()) < 1e-15


def test_a_beta_pair_is_an_alpha_pair_of_other_numbers():
    """Enclosures take φ of a = 0, b = 2 and c = 0 for σ₁ − 1."""
    s = (Z - BETA.d_beta) / BETA.unit**2
    assert written(beta_smooth(Z, BETA)) == Phi(s, sp.S.Zero, sp.Integer(2), sp.S.Zero).formula
    assert sp.simplify(written(beta_closed(Z, BETA) - PhiIntegral(s, 0, 2, 0)).diff(Z)) == 0
