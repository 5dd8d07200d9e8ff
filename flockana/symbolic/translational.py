"""Transfer functions of the centre of mass under Algorithm 2: a linear second-order system."""

import sympy as sp

from flockana.symbolic.pair import own_force
from flockana.symbolic.parameters import GAINS, GainSymbols, exact

S = sp.Symbol("s")
OMEGA = sp.Symbol("omega", positive=True)
SQUARE = sp.Symbol("w", nonnegative=True)  # ω²


def natural_frequency(gains: GainSymbols = GAINS) -> sp.Expr:
    """Return omega_n = sqrt(c1_gamma), in radians per time unit.

    Examples
    --------
    >>> natural_frequency(GainSymbols(c1_gamma=4))
    2
    """
    return sp.sqrt(gains.c1_gamma)


def damping_ratio(gains: GainSymbols = GAINS) -> sp.Expr:
    """Return zeta = c2_gamma/(2 sqrt(c1_gamma)).

    Examples
    --------
    >>> damping_ratio(GainSymbols(c1_gamma=4, c2_gamma=4))
    1
    """
    return gains.c2_gamma / (2 * sp.sqrt(gains.c1_gamma))


def transfer_function(scale: sp.Expr = sp.S.One, *, gains: GainSymbols = GAINS, s: sp.Symbol = S) -> sp.Expr:
    """Return the transfer function from q_r to q_c, for a gamma-agent that prints p_r = scale * dq_r/dt.

    It is solved from q_c'' = -c1_gamma (q_c - q_r) - c2_gamma (q_c' - p_r) in the Laplace domain.

    Parameters
    ----------
    scale : number or sympy.Expr
        1 for the true velocity, 0 for a p_r held at zero; erratum E12 has the step, a p_r per iteration.
    s : sympy.Symbol
        The Laplace variable.

    Examples
    --------
    >>> transfer_function(0, gains=GainSymbols(c1_gamma=4, c2_gamma=3))
    4/(s**2 + 3*s + 4)
    >>> transfer_function(gains=GainSymbols(c1_gamma=4, c2_gamma=3))
    (3*s + 4)/(s**2 + 3*s + 4)
    """
    q_c = sp.Symbol("Q_c")
    terms = (q_c, s * q_c, sp.S.One, exact("scale", scale) * s)
    force = own_force(*(sp.Matrix([term]) for term in terms), gains=gains)
    (response,) = sp.solve(sp.Eq(s**2 * q_c, force[0]), q_c)
    return response


def frequency_gain(scale: sp.Expr = sp.S.One, *, gains: GainSymbols = GAINS, omega: sp.Expr = OMEGA) -> sp.Expr:
    """Return |G(j omega)|, the ratio of the flock's amplitude to the gamma-agent's on a sine or circle.

    Parameters
    ----------
    scale : number or sympy.Expr
        As in `transfer_function`, real.
    omega : number or sympy.Expr
        Angular frequency, real.

    Examples
    --------
    >>> frequency_gain(0, gains=GainSymbols(c1_gamma=4, c2_gamma=3), omega=2)
    2/3
    """
    omega = exact("omega", omega)
    numerator, denominator = _squared_moduli(scale, gains, omega**2)
    return sp.sqrt(numerator / denominator)


def _squared_moduli(scale: sp.Expr, gains: GainSymbols, square: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """Return squared moduli of numerator and denominator of G(jω), polynomials in ω²."""

    def modulus(polynomial: sp.Expr) -> sp.Expr:
        even, odd = ((polynomial + sign * polynomial.subs(S, -S)) / 2 for sign in (1, -1))
        return sp.expand(sp.expand(even**2 - odd**2).subs(S, sp.I * sp.sqrt(square)))

    numerator, denominator = (modulus(part) for part in sp.fraction(transfer_function(scale, gains=gains)))
    return numerator, denominator


def gain_slope(scale: sp.Expr = sp.S.One, *, gains: GainSymbols = GAINS, square: sp.Expr = SQUARE) -> sp.Expr:
    """Return the numerator of d|G(j omega)|^2 / d(omega^2), whose sign is that of the slope over the speed."""
    numerator, denominator = _squared_moduli(scale, gains, square)
    return sp.expand(sp.diff(numerator, square) * denominator - numerator * sp.diff(denominator, square))


def falling_condition(scale: sp.Expr = sp.S.One, *, gains: GainSymbols = GAINS) -> sp.Expr:
    """Return c2_gamma^2 (1 - scale^2) - 2 c1_gamma: |G(j omega)| falls with omega iff it is >= 0 (erratum E15)."""
    return gains.c2_gamma**2 * (1 - exact("scale", scale) ** 2) - 2 * gains.c1_gamma
