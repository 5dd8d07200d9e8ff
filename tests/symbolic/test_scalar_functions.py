"""Exact facts about the scalar functions."""

import math

import pytest
import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.symbolic import ALPHA, AlphaSymbols, BetaSymbols, GainSymbols, sigma_norm, sigma_norm_gradient
from flockana.symbolic.scalar_functions import adjacency, bump, phi, phi_alpha, phi_beta
from tests.refused import refused

H = ALPHA.h
PAPER = AlphaSymbols(eps=0.1, h=0.2, a=5, b=5, d=7, r=8.4)


def test_phi_at_zero_needs_a_at_most_b() -> None:
    """With a > b the same algebra gives a - b, which is why the parameters are refused."""
    c = sp.Abs(ALPHA.a - ALPHA.b) / sp.sqrt(4 * ALPHA.a * ALPHA.b)
    value = phi(sp.S.Zero).subs(1 + c**2, sp.factor(1 + c**2)).subs(ALPHA.a, ALPHA.b + sp.Symbol("k", positive=True))
    assert sp.simplify(value) == sp.Symbol("k", positive=True)
    with pytest.raises(ArgumentError, match="expected a <= b"):
        AlphaSymbols(a=9, b=7)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_sigma_norm_gradient_is_its_gradient(m: int) -> None:
    z = sp.Matrix(sp.symbols(f"z1:{m + 1}", real=True))
    gradient = sp.Matrix([sp.diff(sigma_norm(z), component) for component in z])
    stated = z / (1 + ALPHA.eps * sigma_norm(z))
    assert sp.simplify(gradient - sigma_norm_gradient(z)) == sp.zeros(m, 1)
    assert sp.simplify(gradient - stated) == sp.zeros(m, 1)


def test_bump_joins_with_its_first_derivative_but_not_its_second() -> None:
    z = sp.Symbol("z", positive=True)
    plateau, falling, beyond = (branch for branch, _ in bump(z).args)
    jump = sp.pi**2 / (2 * (1 - H) ** 2)
    for order, at_h, at_one in ((0, 0, 0), (1, 0, 0), (2, -jump, -jump)):
        taper = sp.diff(falling, z, order)
        assert sp.simplify(taper.subs(z, H) - sp.diff(plateau, z, order) - at_h) == 0
        assert sp.simplify(sp.diff(beyond, z, order) - taper.subs(z, 1) - at_one) == 0


@pytest.mark.parametrize(
    ("parameters", "c", "d_alpha", "r_alpha"),
    [
        ((0.1, 0.2, 5, 5, 7, 8.4), 0, 14.289915602982238, 18.383093559370867),
        ((0.1, 0.4, 7, 9, 1.9, 2.8), 0.12598815766974241, 1.6661904664719065, 3.3566462856512001),
        ((0.1, 0.1, 3, 3, 15, 18), 0, 38.47679857416329, 47.792733107199559),
    ],
)
def test_reference_scales(parameters: tuple[float, ...], c: float, d_alpha: float, r_alpha: float) -> None:
    alpha = AlphaSymbols(*parameters)
    for computed, stated in ((alpha.c, c), (alpha.d_alpha, d_alpha), (alpha.r_alpha, r_alpha)):
        assert float(computed.evalf(20)) == pytest.approx(stated, rel=1e-15, abs=0)


def test_phi_alpha_changes_sign_at_d_alpha_and_ends_at_r_alpha() -> None:
    alpha = AlphaSymbols(eps=1, h=0.5, a=1, b=4, d=sp.sqrt(8), r=sp.sqrt(24))  # d_alpha = 2, r_alpha = 4
    values = [phi_alpha(sp.Rational(z, 2), alpha=alpha) for z in (0, 3, 4, 5, 8, 9)]
    assert [sp.sign(value.evalf(30, chop=True)) for value in values] == [-1, -1, 0, 1, 0, 0]
    by_hand = 0.5 * (1 + math.cos(math.pi * (0.625 - 0.5) / 0.5)) * 0.5 * (5 * 1.25 / math.hypot(1, 1.25) - 3)
    assert float(values[3]) == pytest.approx(by_hand, rel=1e-14)  # z = 2.5, c = 3/4
    assert adjacency(sp.Integer(3), alpha=alpha) == sp.Rational(1, 2)


def test_phi_beta_repels_up_to_d_beta() -> None:
    beta = BetaSymbols(eps=1, h=0.9, d=sp.sqrt(3))  # d_beta = 1
    assert phi_beta(sp.Rational(1, 4), beta=beta) == -sp.Rational(8, 5)
    assert phi_beta(sp.Rational(19, 20), beta=beta).evalf() < 0
    assert [phi_beta(sp.Integer(z), beta=beta) for z in (1, 2)] == [0, 0]


def test_floats_become_the_decimals_they_print_as() -> None:
    assert (PAPER.eps, PAPER.r) == (sp.Rational(1, 10), sp.Rational(42, 5))
    assert GainSymbols(c2_alpha=1e-3).c2_alpha == sp.Rational(1, 1000)


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ({"eps": 0}, "eps = 0: expected a number > 0"),
        ({"h": 1.5}, "expected 0 < h <= 1"),
        ({"h": -1}, "h = -1: expected a number > 0"),
        ({"a": -1}, "a = -1: expected a number > 0"),
        ({"d": 8, "r": 8}, "d = 8, r = 8: expected r > d"),
        ({"r": float("nan")}, "r = nan: expected a finite number"),
        ({"b": float("inf")}, "b = inf: expected a finite number"),
        ({"d": "7"}, "d = '7': expected a finite number or a sympy expression"),
        ({"eps": None}, "eps = None: expected a finite number"),
    ],
)
def test_bad_parameters_are_named(bad: dict[str, object], message: str) -> None:
    with pytest.raises(ArgumentError, match=message):
        AlphaSymbols(**bad)  # type: ignore[arg-type]


test_bad_beta_parameters_and_gains = refused(
    (lambda: BetaSymbols(h=2), "expected 0 < h <= 1"),
    (lambda: GainSymbols(c1_gamma=-1), "c1_gamma = -1: expected a gain >= 0"),
)
