"""Pair potentials psi_alpha and psi_beta, derived piece by piece.

Both are integrals of (bump) x (smooth function): closed where the bump is 1, a smooth one-dimensional
integral on its taper, constant beyond its cut-off. Which constant the closed piece carries depends on which
side of the taper's start the potential's zero lies.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import sympy as sp

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.named_functions import PhiIntegral, written
from flockana.symbolic.parameter_symbols import ALPHA, BETA, AlphaSymbols, BetaSymbols
from flockana.symbolic.scalar_functions import alpha_smooth, beta_closed, beta_smooth, phi, taper

Z = sp.Symbol("z", nonnegative=True)
_S = sp.Symbol("s", nonnegative=True)
Scalar = Callable[[sp.Expr], sp.Expr]

_D, _R = sp.symbols("d_alpha r_alpha", positive=True)
ALPHA_NAMED = AlphaSymbols(c=sp.Symbol("c", nonnegative=True), d_alpha=_D, r_alpha=_R)
BETA_NAMED = BetaSymbols(d_beta=sp.Symbol("d_beta", positive=True))


@dataclass(frozen=True)
class _Potential:
    """Potential as integral from `zero`: `smooth` on [0, edge], `tapered` on [edge, cutoff], 0 beyond."""

    smooth: Scalar
    closed: Scalar
    zero: sp.Expr
    cutoff: sp.Expr
    h: sp.Expr

    def __post_init__(self) -> None:
        if self.h == 1:
            raise ArgumentError("h = 1: expected 0 < h < 1, the bump of a potential needs a taper")

    @property
    def edge(self) -> sp.Expr:
        """End of the interval [0, edge] on which the bump function is 1."""
        return self.h * self.cutoff

    def tapered(self, z: sp.Expr) -> sp.Expr:
        """Return the force on the taper of the bump function."""
        return taper(z / self.cutoff, h=self.h) * self.smooth(z)

    def integral(self, low: sp.Expr, high: sp.Expr) -> sp.Expr:
        """Return the unevaluated integral of the force over the taper, which has no elementary form."""
        return sp.S.Zero if low == high else sp.Integral(self.tapered(_S), (_S, low, high))

    def pieces(self, zero_on_plateau: bool) -> tuple[Scalar, Scalar, Scalar]:
        """Return the potential on the plateau, on the taper and beyond, with its zero on plateau or taper."""
        start = self.edge if zero_on_plateau else self.zero
        level = self.closed(self.edge) - self.closed(self.zero) if zero_on_plateau else sp.S.Zero
        return (
            lambda z: self.closed(z) - self.closed(self.edge) + self.integral(start, self.edge) + level,
            lambda z: level + self.integral(start, z),
            lambda z: level + self.integral(start, self.cutoff),
        )

    def expression(self, z: sp.Expr) -> sp.Expr:
        """Return the potential as one Piecewise; numeric parameters select one case."""
        plateau_condition = sp.Ge(self.edge, self.zero)
        branches: list[tuple[sp.Expr, sp.Basic]] = []
        for is_plateau, case in ((True, plateau_condition), (False, sp.Not(plateau_condition))):
            bounds = sp.Le(z, self.edge), sp.Le(z, self.cutoff), sp.true
            pieces = self.pieces(is_plateau)
            branches += [(piece(z), sp.And(case, bound)) for piece, bound in zip(pieces, bounds, strict=True)]
        return sp.Piecewise(*branches)

    def residuals(self, zero_on_plateau: bool) -> tuple[sp.Expr, ...]:
        """Return residuals of a potential that must be 0: derivative less force, jumps, value at its zero."""
        inner_piece, middle_piece, outer_piece = self.pieces(zero_on_plateau)
        zero_piece = inner_piece if zero_on_plateau else middle_piece
        differences = (
            sp.diff(self.closed(Z), Z) - self.smooth(Z),
            sp.diff(inner_piece(Z), Z) - self.smooth(Z),
            sp.diff(middle_piece(Z), Z) - self.tapered(Z),
            sp.diff(outer_piece(Z), Z),
            inner_piece(self.edge) - middle_piece(self.edge),
            middle_piece(self.cutoff) - outer_piece(self.cutoff),
            zero_piece(self.zero),
        )
        return tuple(sp.expand(residual) for residual in differences)


@check_kinds
def alpha_antiderivative(z: sp.Expr, *, alpha: AlphaSymbols = ALPHA) -> sp.Expr:
    """Return the integral of phi(z - d_alpha) from d_alpha, a closed form.

    Examples
    --------
    >>> z = sp.Symbol("z")
    >>> sp.simplify(sp.diff(alpha_antiderivative(z), z) - phi(z - ALPHA.d_alpha))
    0
    """
    return written(alpha.unit**2 * PhiIntegral(*alpha_smooth(z, alpha).args))


def alpha_potential(alpha: AlphaSymbols) -> _Potential:
    """Return the pieces of psi_alpha."""
    closed = partial(alpha_antiderivative, alpha=alpha)
    return _Potential(lambda z: phi(z - alpha.d_alpha, alpha=alpha), closed, alpha.d_alpha, alpha.r_alpha, alpha.h)


def _beta(beta: BetaSymbols) -> _Potential:
    """Return the pieces of psi_beta, which is 0 at its cut-off."""
    smooth_form, closed_form = (lambda z, of=of: written(of(z, beta)) for of in (beta_smooth, beta_closed))
    return _Potential(smooth_form, closed_form, beta.d_beta, beta.d_beta, beta.h)


@check_kinds
def psi_alpha(z: sp.Expr, *, alpha: AlphaSymbols = ALPHA) -> sp.Expr:
    """Return the potential psi_alpha(z), integral of phi_alpha from d_alpha (Olfati-Saber 2006).

    Parameters
    ----------
    alpha : AlphaSymbols
        Parameters; all symbolic if not given. With numbers, ``.evalf(digits)`` gives the value.

    Raises
    ------
    ArgumentError
        If h = 1, where the bump has no taper.

    Examples
    --------
    >>> paper = AlphaSymbols(eps=0.1, h=0.2, a=5, b=5, d=7, r=8.4)
    >>> psi_alpha(sp.Integer(0), alpha=paper).evalf(17)
    52.383811786644864
    """
    return alpha_potential(alpha).expression(sp.sympify(z))


@check_kinds
def psi_beta(z: sp.Expr, *, beta: BetaSymbols = BETA) -> sp.Expr:
    """Return the potential psi_beta(z) >= 0, integral of phi_beta from d_beta.

    Parameters
    ----------
    beta : BetaSymbols
        Parameters; all symbolic if not given.

    Raises
    ------
    ArgumentError
        If h = 1, where the bump has no taper.

    Examples
    --------
    >>> psi_beta(sp.Integer(2), beta=BetaSymbols(eps=1, h=0.9, d=sp.sqrt(3)))
    0
    """
    potential = _beta(beta)
    inner_piece, middle_piece, _ = potential.pieces(zero_on_plateau=False)
    z = sp.sympify(z)
    return sp.Piecewise((inner_piece(z), z <= potential.edge), (middle_piece(z), z <= potential.cutoff), (0, True))


def _piece_steps(name: str, potential: _Potential, zero_on_plateau: bool, case: sp.Basic) -> tuple[Step, ...]:
    """Return one derivation step for each piece of a potential, with its condition."""
    psi = sp.Function(name)(Z)
    edge, cutoff, pieces = potential.edge, potential.cutoff, potential.pieces(zero_on_plateau)
    rows = (
        ("Plateau, where the bump is 1: closed form.", sp.Le(Z, edge)),
        ("Taper: a smooth one-dimensional integral.", sp.And(sp.Ge(Z, edge), sp.Le(Z, cutoff))),
        ("Beyond the cut-off: constant.", sp.Ge(Z, cutoff)),
    )
    return tuple(
        Step(text, sp.Eq(psi, piece(Z), evaluate=False), sp.And(case, condition))
        for (text, condition), piece in zip(rows, pieces, strict=True)
    )


def _phi_at_zero() -> tuple[sp.Expr, sp.Expr]:
    """Return the uneven sigmoid phi(0) with its root extracted, and its value for b = a + k, k >= 0."""
    root = ALPHA.c**2 + 1
    value = phi(sp.S.Zero).subs(root, sp.factor(root))
    return value, value.subs(ALPHA.b, ALPHA.a + sp.Symbol("k", nonnegative=True))


def derive_psi_alpha() -> Derivation:
    """Derive psi_alpha in both cases: d_alpha on the plateau (h r_alpha >= d_alpha) or on the taper.

    Examples
    --------
    >>> derive_psi_alpha().holds
    True
    """
    alpha, potential = ALPHA_NAMED, alpha_potential(ALPHA_NAMED)
    zero, phi_at_zero = _phi_at_zero()
    plateau = sp.Ge(potential.edge, potential.zero)
    named = sp.Function("phi")
    force = sp.Eq(named(Z - alpha.d_alpha), potential.smooth(Z), evaluate=False)
    vanishing = sp.Eq(named(0), zero, evaluate=False)
    closed = sp.Eq(sp.Derivative(potential.closed(Z), Z), sp.diff(potential.closed(Z), Z), evaluate=False)
    steps = (
        Step(r"The force integrated: $\phi_\alpha(z) = \rho_h(z/r_\alpha)\,\phi(z - d_\alpha)$ with", force),
        Step(r"It vanishes at $d_\alpha$, since $\sqrt{1 + c^2} = (a + b)/\sqrt{4ab}$:", vanishing, alpha.a <= alpha.b),
        Step("A closed antiderivative, checked by differentiating:", closed),
        *_piece_steps("psi_alpha", potential, True, plateau),
        *_piece_steps("psi_alpha", potential, False, sp.Not(plateau)),
    )
    residuals = (phi_at_zero, *potential.residuals(True), *potential.residuals(False))
    return Derivation(r"The potential $\psi_\alpha$", steps, potential.expression(Z), residuals)


def derive_psi_beta() -> Derivation:
    """Derive psi_beta, whose zero d_beta is its cut-off: h d_beta < d_beta leaves one case.

    Examples
    --------
    >>> derive_psi_beta().holds
    True
    """
    potential = _beta(BETA_NAMED)
    closed = sp.Eq(sp.Derivative(potential.closed(Z), Z), sp.diff(potential.closed(Z), Z), evaluate=False)
    first_text = r"A closed antiderivative of $\phi_\beta(z) = \sigma_1(z - d_\beta) - 1$ where the bump is 1:"
    steps = (Step(first_text, closed, sp.Lt(Z, potential.edge)), *_piece_steps("psi_beta", potential, False, sp.true))
    return Derivation(r"The potential $\psi_\beta$", steps, psi_beta(Z, beta=BETA_NAMED), potential.residuals(False))
