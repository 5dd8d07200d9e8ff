"""Sigma-norm, its gradient and sigma_1 as sympy expressions."""

from __future__ import annotations

from typing import Any

import sympy as sp

from flockana.base.argument_kinds import check_kinds

EPS = sp.Symbol("epsilon", positive=True)


def _square(z: Any) -> sp.Expr:
    """Return the squared Euclidean length of a scalar or a vector, the same expression for z and -z."""
    components = z if isinstance(z, sp.MatrixBase) else [sp.sympify(z)]
    return sp.Add(*((-x if x.could_extract_minus_sign() else x) ** 2 for x in components))


@check_kinds
def sigma_norm(z: sp.Expr | sp.Matrix, *, eps: sp.Expr = EPS) -> sp.Expr:
    """Return the sigma-norm (sqrt(1 + eps |z|^2) - 1)/eps (Olfati-Saber 2006).

    Parameters
    ----------
    z : sympy.Expr or sympy.Matrix
        A vector, or its Euclidean length.
    eps : sympy.Expr
        The parameter eps > 0.

    Examples
    --------
    >>> sigma_norm(sp.Matrix([3, 4]), eps=sp.Rational(3, 25))
    25/3
    """
    return (sp.sqrt(1 + eps * _square(z)) - 1) / eps


@check_kinds
def sigma_norm_gradient(z: sp.Expr | sp.Matrix, *, eps: sp.Expr = EPS) -> sp.Expr | sp.Matrix:
    """Return the gradient z/sqrt(1 + eps |z|^2) of the sigma-norm, which is z/(1 + eps |z|_sigma).

    Parameters
    ----------
    z : sympy.Expr or sympy.Matrix
        A vector, or a scalar (m = 1).
    eps : sympy.Expr
        The parameter eps > 0.

    Examples
    --------
    >>> sigma_norm_gradient(sp.Integer(2), eps=2)
    2/3
    """
    return z / sp.sqrt(1 + eps * _square(z))


@check_kinds
def sigma_1(z: sp.Expr | sp.Matrix) -> sp.Expr | sp.Matrix:
    """Return sigma_1(z) = z/sqrt(1 + |z|^2) of a scalar or vector.

    Parameters
    ----------
    z : sympy.Expr or sympy.Matrix
        A scalar or a vector.

    Examples
    --------
    >>> sigma_1(sp.Rational(3, 4))
    3/5
    """
    return sigma_norm_gradient(z, eps=sp.Integer(1))
