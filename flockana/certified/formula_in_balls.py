"""A pair law in balls and power series (Arb), for the provers.

Generated from `flockana.symbolic` by `python -m tools.formulas`; edit these.

`law` holds the numbers of an α- or β-pair as balls (`flockana.certified.pair_laws_in_series`); `piece` says on which
piece of ρ_h a
series lies. The checkers have formulas of their own.
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


def pair(s2: Any, law: Any, piece: Any) -> Any:
    """Force weight and adjacency of a pair at squared distance s2."""
    x0 = sigma_norm(s2, law.eps)
    x1 = phi((-law.zero + x0)/law.area, law.a, law.b, law.c)
    x2 = place(x0/law.cutoff, law.h, piece)
    x3 = (law.eps*s2 + 1).rsqrt()
    x4 = taper(x2)
    return x1*x3*x4, x4


def slopes(s2: Any, law: Any, piece: Any) -> Any:
    """Derivatives of (weight, adjacency) by s2."""
    x0 = 1/law.area
    x1 = sigma_norm(s2, law.eps)
    x2 = x0*(-law.zero + x1)
    x3 = law.c + x2
    x4 = phi(x2, law.a, law.b, law.c)
    x5 = 1/law.cutoff
    x6 = place(x1*x5, law.h, piece)
    x7 = taper(x6)
    x8 = (law.eps*s2 + 1).rsqrt()
    x9 = (square(x3) + 1).rsqrt()
    x10 = x6.sin_pi()
    x11 = arb.pi()*x10*x5/(law.h - 1)
    return square(x8)*(-2*x4*x7*x8*law.eps + x0*x7*square(x9)*x9*(law.a + law.b) + x11*x4)/4, x11*x8/4


def stiffness(s2: Any, law: Any, piece: Any) -> Any:
    """F''(ℓ) of F = ψ(‖·‖_σ), by s2 = ℓ²."""
    x0 = 1/law.area
    x1 = sigma_norm(s2, law.eps)
    x2 = x0*(-law.zero + x1)
    x3 = law.c + x2
    x4 = phi(x2, law.a, law.b, law.c)
    x5 = 1/law.cutoff
    x6 = place(x1*x5, law.h, piece)
    x7 = taper(x6)
    x8 = (law.eps*s2 + 1).rsqrt()
    x9 = (square(x3) + 1).rsqrt()
    x10 = x6.sin_pi()
    return square(x8)*(s2*(x0*x7*square(x9)*x9*(law.a + law.b) + arb.pi()*x10*x4*x5/(law.h - 1))/2 + x4*x7*x8)


def closed(z: Any, law: Any) -> Any:
    """An antiderivative of the action where ρ_h = 1."""
    x0 = (-law.zero + z)/law.area
    x1 = law.c + x0
    return law.area*(x0*(law.a - law.b) + (law.a + law.b)*(-(square(law.c) + 1).sqrt() + (square(x1) + 1).sqrt()))/2


def tapered(z: Any, law: Any, analytic: Any) -> Any:
    """The action on the taper."""
    x0 = law.c + (-law.zero + z)/law.area
    x1 = (square(x0) + 1).rsqrt(analytic=analytic)
    x2 = ((-law.h + z/law.cutoff)/(1 - law.h)).cos_pi()
    return (x2 + 1)*(law.a - law.b + x0*x1*(law.a + law.b))/4
