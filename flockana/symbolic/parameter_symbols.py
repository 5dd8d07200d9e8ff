"""Parameters of the formulas as frozen bundles: symbols by default, exact numbers where given."""

from dataclasses import dataclass, fields
from typing import Any

import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.symbolic.sigma_norms import EPS, sigma_norm

_H, _A, _B, _D, _R, _D_PRIME = sp.symbols("h a b d r d'", positive=True)
_C1_ALPHA, _C2_ALPHA, _C1_GAMMA, _C2_GAMMA = sp.symbols("c_1^alpha c_2^alpha c_1^gamma c_2^gamma", nonnegative=True)
_C1_BETA, _C2_BETA = sp.symbols("c_1^beta c_2^beta", nonnegative=True)


def exact(name: str, value: Any) -> sp.Expr:
    """Return a number or expression as an exact sympy expression: the float 0.1 becomes 1/10."""
    try:
        expression = sp.sympify(value, strict=True)
        if isinstance(expression, sp.Float):  # the shortest decimal that reads back as this float
            expression = sp.Rational(str(float(value)))
    except (sp.SympifyError, TypeError, ValueError):
        expression = None
    if not isinstance(expression, sp.Expr) or expression is sp.nan or expression.is_finite is False:
        raise ArgumentError(f"{name} = {value!r}: expected a finite number or a sympy expression")
    return expression


def _fill(bundle: Any, *derived: str, least: str = "a number > 0", sign: str = "is_positive") -> None:
    """Convert the given fields of a frozen bundle to exact expressions; raise on certainly too small ones."""
    for name in (field.name for field in fields(bundle) if field.name not in derived):
        value = exact(name, getattr(bundle, name))
        object.__setattr__(bundle, name, value)
        _require(getattr(value, sign), f"{name} = {value}: expected {least}")


def _derive(bundle: Any, **values: sp.Expr) -> None:
    """Set the missing fields of a frozen parameter object."""
    _require((1 - bundle.h).is_nonnegative, f"h = {bundle.h}: expected 0 < h <= 1")
    for name, value in values.items():
        number = getattr(bundle, name)
        object.__setattr__(bundle, name, value if number is None else exact(name, number))


def _require(condition: bool | None, message: str) -> None:
    """Raise if a condition on parameters is certainly false; undecided conditions are assumptions."""
    if condition is False:
        raise ArgumentError(message)


@dataclass(frozen=True)
class AlphaSymbols:
    """Parameters of the interaction between two alpha-agents, symbols by default.

    Parameters
    ----------
    eps, h, a, b, d, r : number or sympy.Expr
        eps > 0 of the sigma-norm, plateau 0 < h <= 1 of the bump, 0 < a <= b of phi, lattice scale d and
        interaction range r > d, both Euclidean lengths. Floats become the decimal fractions they print as.
    c, d_alpha, r_alpha : sympy.Expr, optional
        Computed from the others; give a symbol to keep its name in print.
    unit : number or sympy.Expr
        The length l > 0 that sigma_1 counts in, 1 in the source: phi(s) contains sigma_1(s/l**2 + c).

    Examples
    --------
    >>> AlphaSymbols(a=1, b=9).c
    4/3
    >>> AlphaSymbols().d_alpha
    (sqrt(d**2*epsilon + 1) - 1)/epsilon
    """

    eps: sp.Expr = EPS
    h: sp.Expr = _H
    a: sp.Expr = _A
    b: sp.Expr = _B
    d: sp.Expr = _D
    r: sp.Expr = _R
    c: sp.Expr = None
    d_alpha: sp.Expr = None
    r_alpha: sp.Expr = None
    unit: sp.Expr = sp.S.One

    def __post_init__(self) -> None:
        _fill(self, "c", "d_alpha", "r_alpha")
        _require((self.b - self.a).is_nonnegative, f"a = {self.a}, b = {self.b}: expected a <= b, or phi(0) != 0")
        _require((self.r - self.d).is_positive, f"d = {self.d}, r = {self.r}: expected r > d")
        scales = {f"{name}_alpha": sigma_norm(getattr(self, name), eps=self.eps) for name in ("d", "r")}
        _derive(self, c=sp.Abs(self.a - self.b) / sp.sqrt(4 * self.a * self.b), **scales)


@dataclass(frozen=True)
class BetaSymbols:
    """Parameters of the interaction with a beta-agent, symbols by default.

    Parameters
    ----------
    eps, h, d : number or sympy.Expr
        eps > 0 of the sigma-norm, plateau 0 < h <= 1 of the bump, distance d' > 0 where the repulsion ends.
    d_beta : sympy.Expr, optional
        Computed from the others; give a symbol to keep its name in print.
    unit : number or sympy.Expr
        The length l > 0 that sigma_1 counts in, 1 in the source.

    Examples
    --------
    >>> BetaSymbols(eps=1, h=0.9, d=sp.sqrt(3)).d_beta
    1
    """

    eps: sp.Expr = EPS
    h: sp.Expr = _H
    d: sp.Expr = _D_PRIME
    d_beta: sp.Expr = None
    unit: sp.Expr = sp.S.One

    def __post_init__(self) -> None:
        _fill(self, "d_beta")
        _derive(self, d_beta=sigma_norm(self.d, eps=self.eps))


@dataclass(frozen=True)
class GainSymbols:
    """Gains of the laws, symbols by default; floats become exact decimal fractions.

    Parameters
    ----------
    c1_alpha, c2_alpha : number or sympy.Expr
        Of the potential force and of the velocity consensus between agents.
    c1_gamma, c2_gamma : number or sympy.Expr
        Of the navigational feedback: position and velocity.
    c1_beta, c2_beta : number or sympy.Expr
        Of the repulsion from obstacles and of the damping at them.

    Examples
    --------
    >>> GainSymbols(c1_gamma=1.1).c1_gamma
    11/10
    """

    c1_alpha: sp.Expr = _C1_ALPHA
    c2_alpha: sp.Expr = _C2_ALPHA
    c1_gamma: sp.Expr = _C1_GAMMA
    c2_gamma: sp.Expr = _C2_GAMMA
    c1_beta: sp.Expr = _C1_BETA
    c2_beta: sp.Expr = _C2_BETA

    def __post_init__(self) -> None:
        _fill(self, least="a gain >= 0", sign="is_nonnegative")


ALPHA = AlphaSymbols()
BETA = BetaSymbols()
GAINS = GainSymbols()
