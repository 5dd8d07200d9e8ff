"""psi_alpha and psi_beta: derivations, both cases, reference values, direct quadrature."""

import mpmath
import pytest
import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.symbolic import AlphaSymbols, BetaSymbols, potentials
from flockana.symbolic.potentials import derive_psi_alpha, derive_psi_beta, psi_alpha, psi_beta

Z = potentials.Z
TABLE = [
    ((0.1, 0.2, 5, 5, 7, 8.4), 52.383811786644864, 0.73590113426239231),
    ((0.1, 0.4, 7, 9, 1.9, 2.8), 8.2894763964404246, 1.9197227378044615),
    ((0.1, 0.1, 3, 3, 15, 18), 77.314354838042652, 0.80748441845582953),
]
PLATEAU = (0.1, 0.9, 4, 6, 7, 8.4)  # h r_alpha = 16.5 > d_alpha = 14.3


def values(parameters: tuple[float, ...]) -> dict[sp.Symbol, sp.Expr]:
    """Numbers for the named parameters, to thirty digits."""
    named, given = potentials.ALPHA_NAMED, AlphaSymbols(*parameters)
    return {getattr(named, k): getattr(given, k).evalf(30) for k in ("h", "a", "b", "c", "d_alpha", "r_alpha")}


def numeric(expression: sp.Expr, numbers: dict[sp.Symbol, sp.Expr], at: sp.Expr) -> mpmath.mpf:
    """Evaluate an expression in z by mpmath; sympy's own evalf of an Integral is a hundred times slower."""
    function = sp.lambdify([Z, *numbers], expression, "mpmath")
    with mpmath.workdps(30):
        return function(*(mpmath.mpmathify(sp.sympify(x).evalf(30)) for x in (at, *numbers.values())))


def test_derivations_hold() -> None:
    assert derive_psi_alpha().holds
    assert len(derive_psi_alpha().residuals) == 15
    assert derive_psi_beta().holds


@pytest.mark.parametrize(("parameters", "at_zero", "at_cutoff"), TABLE)
def test_reference_values(parameters: tuple[float, ...], at_zero: float, at_cutoff: float) -> None:
    named, numbers = psi_alpha(Z, alpha=potentials.ALPHA_NAMED), values(parameters)
    r_alpha = AlphaSymbols(*parameters).r_alpha
    assert float(numeric(named, numbers, sp.S.Zero)) == pytest.approx(at_zero, rel=1e-15, abs=0)
    assert float(numeric(named, numbers, r_alpha)) == pytest.approx(at_cutoff, rel=1e-15, abs=0)
    assert float(numeric(named, numbers, 2 * r_alpha)) == pytest.approx(at_cutoff, rel=1e-15, abs=0)


def test_the_two_cases_agree_where_they_meet() -> None:
    """h r_alpha = d_alpha = 2 exactly: the value at 0 is closed, from either case."""
    alpha = AlphaSymbols(eps=1, h=0.5, a=1, b=1, d=sp.sqrt(8), r=sp.sqrt(24))
    both = [potentials.alpha_potential(alpha).pieces(place)[0](sp.S.Zero) for place in (True, False)]
    assert both[0] == both[1] == sp.sqrt(5) - 1
    assert psi_alpha(sp.S.Zero, alpha=alpha) == sp.sqrt(5) - 1


def test_pieces_hold_where_they_say() -> None:
    """At every z and in either case, the steps whose condition is met agree with the Piecewise."""
    derivation = derive_psi_alpha()
    for parameters in (TABLE[1][0], PLATEAU):
        numbers = values(parameters)
        r_alpha = numbers[potentials.ALPHA_NAMED.r_alpha]
        for z in (0.05 * r_alpha, 0.93 * r_alpha, 1.1 * r_alpha):
            at = {**numbers, Z: z}
            met = [step for step in derivation.steps[3:] if step.condition.subs(at) == sp.true]
            assert len(met) == 1
            difference = met[0].equation.rhs - psi_alpha(Z, alpha=potentials.ALPHA_NAMED)
            assert abs(numeric(difference, numbers, z)) < 1e-25


def test_an_indicator_has_no_taper() -> None:
    for psi, bundle in ((psi_alpha, {"alpha": AlphaSymbols(h=1)}), (psi_beta, {"beta": BetaSymbols(h=1)})):
        with pytest.raises(ArgumentError, match="h = 1: expected 0 < h < 1"):
            psi(Z, **bundle)
