"""The α- and β-pair laws in balls and power series (Arb), for the provers.

Generated from `flockana.symbolic` by `python -m tools.formulas`; edit these.

`law` holds the numbers as balls (`flockana.certified.series`); `piece` says on which piece of ρ_h a series lies. The
checkers have formulas of their own.
"""

# fmt: off
from __future__ import annotations

from typing import Any

from flint import arb

from flockana.certified.balls import monotone, place, square


def sigma_norm(s2: Any, eps: Any) -> Any:
    """‖x‖_σ, monotone."""
    return monotone(lambda s2: s2/((eps*s2 + 1).sqrt() + 1), s2)


def sigma_1(s: Any) -> Any:
    """σ₁(s), monotone."""
    return monotone(lambda s: s*(square(s) + 1).rsqrt(), s)


def taper(s: Any) -> Any:
    """Half-cosine of ρ_h, monotone."""
    return monotone(lambda s: s.cos_pi()/2 + arb(1)/2, s)


def phi(s: Any, a: Any, b: Any, c: Any) -> Any:
    """φ(s), increasing."""
    x0 = sigma_1(c + s)
    return a/2 - b/2 + x0*(a + b)/2


def alpha_pair(s2: Any, law: Any, piece: Any) -> Any:
    """(weight, adjacency) at squared distance s2."""
    x0 = sigma_norm(s2, law.eps)
    x1 = phi((-law.d_alpha + x0)/law.area, law.a, law.b, law.c)
    x2 = place(x0/law.r_alpha, law.h, piece)
    x3 = (law.eps*s2 + 1).rsqrt()
    x4 = taper(x2)
    return x1*x3*x4, x4


def alpha_slopes(s2: Any, law: Any, piece: Any) -> Any:
    """Derivatives of the two by s2."""
    x0 = 1/law.area
    x1 = sigma_norm(s2, law.eps)
    x2 = x0*(-law.d_alpha + x1)
    x3 = law.c + x2
    x4 = phi(x2, law.a, law.b, law.c)
    x5 = 1/law.r_alpha
    x6 = place(x1*x5, law.h, piece)
    x7 = taper(x6)
    x8 = (law.eps*s2 + 1).rsqrt()
    x9 = (square(x3) + 1).rsqrt()
    x10 = x6.sin_pi()
    x11 = arb.pi()*x10*x5/(law.h - 1)
    return square(x8)*(-2*x4*x7*x8*law.eps + x0*x7*square(x9)*x9*(law.a + law.b) + x11*x4)/4, x11*x8/4


def alpha_closed(z: Any, law: Any) -> Any:
    """An antiderivative of the action where ρ_h = 1."""
    x0 = (-law.d_alpha + z)/law.area
    x1 = law.c + x0
    return law.area*(x0*(law.a - law.b) + (law.a + law.b)*(-(square(law.c) + 1).sqrt() + (square(x1) + 1).sqrt()))/2


def alpha_tapered(z: Any, law: Any, analytic: Any) -> Any:
    """The action on the taper."""
    x0 = law.c + (-law.d_alpha + z)/law.area
    x1 = (square(x0) + 1).rsqrt(analytic=analytic)
    x2 = ((-law.h + z/law.r_alpha)/(1 - law.h)).cos_pi()
    return (x2 + 1)*(law.a - law.b + x0*x1*(law.a + law.b))/4


def alpha_stiffness(s2: Any, law: Any, piece: Any) -> Any:
    """F''(ℓ) of F = ψ_α(‖·‖_σ), by s2 = ℓ²."""
    x0 = 1/law.area
    x1 = sigma_norm(s2, law.eps)
    x2 = x0*(-law.d_alpha + x1)
    x3 = law.c + x2
    x4 = phi(x2, law.a, law.b, law.c)
    x5 = 1/law.r_alpha
    x6 = place(x1*x5, law.h, piece)
    x7 = taper(x6)
    x8 = (law.eps*s2 + 1).rsqrt()
    x9 = (square(x3) + 1).rsqrt()
    x10 = x6.sin_pi()
    return square(x8)*(s2*(x0*x7*square(x9)*x9*(law.a + law.b) + arb.pi()*x10*x4*x5/(law.h - 1))/2 + x4*x7*x8)


def beta_pair(s2: Any, law: Any, piece: Any) -> Any:
    """(weight, adjacency) at squared distance s2."""
    x0 = sigma_norm(s2, law.eps)
    x1 = place(x0/law.d_beta, law.h, piece)
    x2 = sigma_1((-law.d_beta + x0)/law.area)
    x3 = (law.eps*s2 + 1).rsqrt()
    x4 = taper(x1)
    return x3*x4*(x2 - 1), x4


def beta_slopes(s2: Any, law: Any, piece: Any) -> Any:
    """Derivatives of the two by s2."""
    x0 = sigma_norm(s2, law.eps)
    x1 = -law.d_beta + x0
    x2 = 1/law.d_beta
    x3 = place(x0*x2, law.h, piece)
    x4 = 1/law.area
    x5 = sigma_1(x1*x4)
    x6 = taper(x3)
    x7 = (1 + square(x1)/square(law.area)).rsqrt()
    x8 = (law.eps*s2 + 1).rsqrt()
    x9 = x3.sin_pi()
    x10 = 2*x6
    x11 = x5 - 1
    x12 = arb.pi()*x2*x9/(law.h - 1)
    return square(x8)*(-x10*x11*x8*law.eps + x10*x4*square(x7)*x7 + x11*x12)/4, x12*x8/4


def beta_closed(z: Any, law: Any) -> Any:
    """An antiderivative of the action where ρ_h = 1."""
    x0 = -z
    x1 = law.d_beta + x0
    return law.area*((1 + square(x1)/square(law.area)).sqrt() - 1) + x0


def beta_tapered(z: Any, law: Any, analytic: Any) -> Any:
    """The action on the taper."""
    x0 = -law.d_beta + z
    x1 = (1 + square(x0)/square(law.area)).rsqrt(analytic=analytic)
    x2 = ((-law.h + z/law.d_beta)/(1 - law.h)).cos_pi()
    return (x2 + 1)*(-1 + x0*x1/law.area)/2
