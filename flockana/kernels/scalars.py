"""The scalar functions of Olfati-Saber's pair laws, each written once, for compiled and interpreted use.

They are plain Python functions that numba may also inline into a compiled loop (`register_jitable`).
"""

from __future__ import annotations

from math import factorial, inf, pi, sin, sqrt

from flockana.jit import register_jitable

_FLAT = 1e140  # from here on φ is its limit, and squares would overflow
_S1, _S2, _S3, _S4, _S5, _S6, _S7, _S8, _S9, _S10 = ((-1.0) ** k / factorial(2 * k + 1) for k in range(1, 11))


@register_jitable
def sigma_norm(x2, eps):
    """‖x‖_σ from x2 = ‖x‖²; this form loses nothing where ε‖x‖² is small."""
    root = sqrt(1.0 + eps * x2)
    return x2 / (root + 1.0) if root < inf else sqrt(x2 / eps)


@register_jitable
def sigma_1(s):
    """σ₁(s) = s/√(1+s²), without overflow for huge |s|."""
    if abs(s) > 1e100:
        return 1.0 if s > 0.0 else -1.0
    return s / sqrt(1.0 + s * s)


@register_jitable
def taper(z, h):
    """ρ_h(z) for z ≥ 0: 1 up to h, a raised cosine on [h, 1], 0 from there on.

    ½(1 + cos πt) = sin² ½π(1 − t) by the series of the sine, to rounding of itself; a loop over it is vectorised.
    """
    y = (0.5 * pi / (1.0 - h)) * (1.0 - z)
    x = y * y
    x2 = x * x
    low, middle = (1.0 + x * _S1) + x2 * (_S2 + x * _S3), (_S4 + x * _S5) + x2 * (_S6 + x * _S7)
    high = (_S8 + x * _S9) + x2 * _S10
    x4 = x2 * x2
    sine = y * (low + x4 * (middle + x4 * high))
    rho = 1.0 if z < h else sine * sine
    return 0.0 if z >= 1.0 else rho


@register_jitable
def bump(z, h):
    """ρ_h(z): 1 on [0, h), a raised cosine on [h, 1], 0 otherwise."""
    return 0.0 if z < 0.0 else taper(z, h)


@register_jitable
def bump_slope(z, h):
    """dρ_h/dz (0 at the ends of the taper: ρ_h is C¹, not C²)."""
    if z <= h or z >= 1.0:
        return 0.0
    return -0.5 * pi / (1.0 - h) * sin(pi * (z - h) / (1.0 - h))


@register_jitable
def phi(s, a, b, c):
    """φ(s) = ½[(a+b) σ₁(s+c) + (a−b)] for c = (b−a)/√(4ab)."""
    if abs(s) > _FLAT:
        s = _FLAT if s > 0.0 else -_FLAT
    above, below = phi_parts(s, a, b, c)
    return above / below


@register_jitable
def phi_parts(s, a, b, c):
    """φ(s) = above/below where |s| ≤ 1e140, without a division: a loop over it is vectorised.

    It is ½(a+b)[σ₁(x) − σ₁(c)], x = s + c, whose difference (x√(1+c²) − c√(1+x²))/√… is rearranged where x ≥ 0, so that
    nothing cancels. The last summand of g keeps 0/0 out; it is beyond all rounding elsewhere.
    """
    x = s + c
    at_x, at_c = sqrt(1.0 + x * x), sqrt(1.0 + c * c)
    g = abs(x) * at_c + c * at_x + 1e-300
    difference = s * (s + 2.0 * c) if x >= 0.0 else -g * g  # times g
    return 0.5 * (a + b) * difference, g * (at_x * at_c)


@register_jitable
def phi_slope(s, a, b, c):
    """dφ/ds."""
    return 0.5 * (a + b) / sqrt(1.0 + (s + c) ** 2) ** 3


@register_jitable
def phi_integral(s, a, b, c):
    """∫_0^s φ = ½[(a+b)(√(1+(s+c)²) − √(1+c²)) + (a−b)s] ≥ 0, rearranged: nothing cancels where s is small."""
    at_s, at_0, product = sqrt(1.0 + (s + c) ** 2), sqrt(1.0 + c * c), c * (s + c)
    gap = at_s * at_0 - product
    if product > 0.0:
        gap = (1.0 + c * c + (s + c) ** 2) / (at_s * at_0 + product)
    return 0.5 * (a + b) * (s / (at_s + at_0)) ** 2 * (gap + 1.0) / at_0


@register_jitable
def on_panels(z, panels):
    """A function given by panels of polynomials at z: each row is (left, right, coefficients), rows in rising order.

    A coefficient is that of a power of x, which is −1 at the left end and 1 at the right one; they are one more than a
    multiple of four, whose four sums need not wait for each other.
    Points outside take the value at the nearest end. No branch hangs on z: a loop over it runs ahead of itself.
    """
    row, rest = 0, panels.shape[0]
    while rest > 1:
        half = rest // 2
        row += half * (z >= panels[row + half - 1, 1])
        rest -= half
    left, right = panels[row, 0], panels[row, 1]
    x = (2.0 * z - left - right) / (right - left)
    if abs(x) > 1.0:  # not by min and max, which would turn a NaN into a number
        x = 1.0 if x > 0.0 else -1.0
    last = panels.shape[1] - 1
    a, b, c, d, x2 = panels[row, last], 0.0, 0.0, 0.0, x * x
    x4 = x2 * x2
    for k in range(last - 4, 1, -4):
        a, b = x4 * a + panels[row, k], x4 * b + panels[row, k + 1]
        c, d = x4 * c + panels[row, k + 2], x4 * d + panels[row, k + 3]
    return (a + x2 * c) + x * (b + x2 * d)
