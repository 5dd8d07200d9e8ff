"""Scalar functions of flocking as sympy expressions: bump, action functions, adjacency.

Every function takes and returns sympy expressions. Parameters come in a frozen bundle, symbols by default
and numbers where given, so that one formula serves a proof, a picture in LaTeX and a forty-digit value; kernels and
enclosures are generated from it too (`tools.formulas`).
"""

from __future__ import annotations

import sympy as sp

from flockana.base.argument_kinds import check_kinds
from flockana.symbolic.named_functions import HALF as HALF
from flockana.symbolic.named_functions import Bump, Phi, Place, Sigma1, SigmaNorm, Taper, written
from flockana.symbolic.parameter_symbols import ALPHA, BETA, AlphaSymbols, BetaSymbols


def taper(z: sp.Expr, *, h: sp.Expr = AlphaSymbols.h) -> sp.Expr:
    """Return the half-cosine of the bump on h <= z <= 1."""
    return written(Taper(Place(z, h)))


@check_kinds
def bump(z: sp.Expr, *, h: sp.Expr = AlphaSymbols.h) -> sp.Expr:
    """Return the bump rho_h: 1 on [0, h), a half-cosine on [h, 1], 0 beyond (Olfati-Saber 2006).

    For h < 1 it is continuously differentiable, but not twice; at h = 1 it is the indicator of [0, 1), and jumps.

    Parameters
    ----------
    z : sympy.Expr
        Where to evaluate it, z >= 0.
    h : sympy.Expr
        End of the plateau, 0 < h <= 1.

    Examples
    --------
    >>> bump(sp.Symbol("z"), h=sp.Integer(1))
    Piecewise((1, z < 1), (0, True))
    """
    return sp.Piecewise((1, z < 1), (0, True)) if h == 1 else Bump(z, h).formula


@check_kinds
def phi(s: sp.Expr, *, alpha: AlphaSymbols = ALPHA) -> sp.Expr:
    """Return the uneven sigmoid ((a + b) sigma_1(s/l**2 + c) + (a - b))/2, which vanishes at 0 if a <= b.

    Examples
    --------
    >>> phi(sp.Integer(0), alpha=AlphaSymbols(a=1, b=9))
    0
    """
    return Phi(s / alpha.unit**2, alpha.a, alpha.b, alpha.c).formula


@check_kinds
def phi_alpha(z: sp.Expr, *, alpha: AlphaSymbols = ALPHA) -> sp.Expr:
    """Return the action function rho_h(z/r_alpha) phi(z - d_alpha) (Olfati-Saber 2006).

    Examples
    --------
    >>> phi_alpha(sp.Integer(1), alpha=AlphaSymbols(eps=1, h=0.5, a=1, b=1, d=sp.sqrt(8), r=sp.sqrt(24)))
    -sqrt(2)/2
    """
    return adjacency(z, alpha=alpha) * written(alpha_smooth(z, alpha))


@check_kinds
def adjacency(z: sp.Expr, *, alpha: AlphaSymbols = ALPHA) -> sp.Expr:
    """Return the weight a_ij = rho_h(z/r_alpha) of a pair at sigma-distance z (Olfati-Saber 2006).

    Examples
    --------
    >>> adjacency(sp.Integer(3), alpha=AlphaSymbols(eps=1, h=0.5, d=sp.sqrt(8), r=sp.sqrt(24)))
    1/2
    """
    return bump(z / alpha.r_alpha, h=alpha.h)


@check_kinds
def phi_beta(z: sp.Expr, *, beta: BetaSymbols = BETA) -> sp.Expr:
    """Return the repulsion rho_h(z/d_beta) (sigma_1((z - d_beta)/l**2) - 1) of a beta-agent (Olfati-Saber 2006).

    Parameters
    ----------
    beta : BetaSymbols
        Parameters; all symbolic if not given.

    Examples
    --------
    >>> phi_beta(sp.Integer(0), beta=BetaSymbols(eps=1, h=0.9, d=sp.sqrt(3)))
    -1 - sqrt(2)/2
    """
    return bump(z / beta.d_beta, h=beta.h) * written(beta_smooth(z, beta))


def alpha_smooth(z: sp.Expr, alpha: AlphaSymbols) -> sp.Expr:
    """Return phi_alpha without its bump, by named functions."""
    return Phi((z - alpha.d_alpha) / alpha.unit**2, alpha.a, alpha.b, alpha.c)


def beta_smooth(z: sp.Expr, beta: BetaSymbols) -> sp.Expr:
    """Return phi_beta without its bump, by named functions."""
    return Sigma1((z - beta.d_beta) / beta.unit**2) - 1


def beta_closed(z: sp.Expr, beta: BetaSymbols) -> sp.Expr:
    """Return an antiderivative of `beta_smooth` by named functions, without cancellation."""
    area = beta.unit**2
    return area * SigmaNorm(((z - beta.d_beta) / area) ** 2, sp.S.One) - z
