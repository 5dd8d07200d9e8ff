"""The scalar functions of Olfati-Saber's pair laws, for compiled and interpreted use.

Generated from `flockana.symbolic` by `python -m tools.formulas`; edit these.
"""

# fmt: off
# ruff: noqa: SIM300
from __future__ import annotations

from math import inf, pi, sqrt

from flockana.jit import register_jitable
from flockana.kernels.sine_and_cosine import quarter_sine, sine

LARGE = 2.0**400  # beyond it σ₁ is 1; a power of two: φ reaches its limits exactly
tiny = 1e-300  # keeps 0/0 out


@register_jitable
def sigma_norm(s2, eps):
    """‖x‖_σ from s2 = ‖x‖²."""
    x0 = sqrt(eps*s2 + 1.0)
    if inf > x0:
        return s2/(x0 + 1.0)
    return sqrt(s2)/sqrt(eps)


@register_jitable
def clipped(s):
    """s, cut off where squares would overflow."""
    x0 = -LARGE
    return LARGE if (LARGE < s) else x0 if (LARGE < -s) else s


@register_jitable
def sigma_1(s):
    """σ₁(s) = s/√(1+s²)."""
    x0 = clipped(s)
    return x0/sqrt((x0*x0) + 1.0)


@register_jitable
def taper(z, h):
    """ρ_h(z) for z ≥ 0."""
    c0 = 0.5*pi/(1.0 - h)
    x0 = quarter_sine(c0*(1.0 - z))
    x1 = (x0*x0)
    return 1.0 if (h > z) else 0.0 if (z >= 1.0) else x1


@register_jitable
def bump(z, h):
    """ρ_h(z), 0 for z < 0."""
    x0 = taper(z, h)
    return 0.0 if (z < 0.0) else x0


@register_jitable
def bump_slope(z, h):
    """dρ_h/dz, 0 at the ends of the taper."""
    x0 = pi/(1.0 - h)
    if (h >= z) or (z >= 1.0):
        return 0.0
    return -0.5*x0*sine(x0*(-h + z))


@register_jitable
def phi_above(s, a, b, c):
    """Numerator of the uneven sigmoid φ(s)."""
    c0 = 2.0*c
    c1 = sqrt((c*c) + 1.0)
    c2 = 0.5*a + 0.5*b
    x0 = s*(c0 + s)
    x1 = c + s
    x2 = abs(x1)
    x3 = c*sqrt((x1*x1) + 1.0) + c1*x2 + tiny
    x4 = -(x3*x3)
    return c2*(x0 if (x1 >= 0.0) else x4)


@register_jitable
def phi_below(s, a, b, c):
    """Denominator of the uneven sigmoid φ(s)."""
    c0 = sqrt((c*c) + 1.0)
    x0 = c + s
    x1 = abs(x0)
    x2 = sqrt((x0*x0) + 1.0)
    return c0*x2*(x2*c + c0*x1 + tiny)


@register_jitable
def phi(s, a, b, c):
    """φ(s) = ½[(a+b) σ₁(s+c) + (a−b)] for c = (b−a)/√(4ab)."""
    x0 = clipped(s)
    x1 = phi_above(x0, a, b, c)
    x2 = phi_below(x0, a, b, c)
    return x1/x2


@register_jitable
def phi_integral(s, a, b, c):
    """∫₀ˢ φ ≥ 0."""
    c0 = sqrt((c*c) + 1.0)
    c1 = (c*c) + 1.0
    c2 = (0.5*a + 0.5*b)/sqrt((c*c) + 1.0)
    x0 = c + s
    x1 = (x0*x0)
    x2 = sqrt(x1 + 1.0)
    x3 = x0*c
    x4 = (c1 + x1)/(c0*x2 + x3)
    x5 = c0 + x2
    x6 = c0*x2 - x3
    return c2*(s*s)*((x4 if (x3 > 0.0) else x6) + 1.0)/(x5*x5)
