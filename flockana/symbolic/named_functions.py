"""Named building blocks of pair laws, each once, for printing, kernels and enclosures.

Where a law is composed of `Named` functions, generated code calls these by name, and derivatives are named too
(`tools.formulas`). `composed` is the formula; `stable` is the same function in a form in which no digits cancel, which
floating point computes.
"""

import sympy as sp

from flockana.symbolic.sigma_norms import sigma_1, sigma_norm

HALF = sp.Rational(1, 2)
TINY = sp.Symbol("tiny", nonnegative=True)  # 1e-300 in compiled code, 0 in mathematics


class Named(sp.Function):
    """Base class of named sympy functions that generated code calls by name."""

    composed: sp.Expr  # by other named functions, where the formula has some
    stable = property(lambda self: self.composed)

    formula = property(lambda self: written(self.composed))  # as printed

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative of the function by its first argument; the others are parameters."""
        argument = sp.Dummy("at", real=True)
        composed_form = self.func(argument, *self.args[1:]).composed
        slope = sp.diff(composed_form, argument)
        return (slope if composed_form.has(Named) else sp.simplify(slope)).subs(argument, self.args[0])


def written(expression: sp.Expr) -> sp.Expr:
    """Return an expression in which named functions are replaced by their explicit formulas."""
    return expression.replace(lambda node: isinstance(node, Named), lambda node: node.formula)


class SigmaNorm(Named):
    """Sigma-norm as a function of the squared length and eps; increasing."""

    composed = property(lambda self: sigma_norm(sp.sqrt(self.args[0]), eps=self.args[1]))
    stable = property(lambda self: self.args[0] / (1 + sp.sqrt(1 + self.args[1] * self.args[0])))


class Sigma1(Named):
    """Function sigma_1(z) = z/sqrt(1 + z^2) of a number; increasing."""

    composed = property(lambda self: sigma_1(self.args[0]))


class QuarterSine(Named):
    """Sine, up to a quarter turn."""

    composed = property(lambda self: sp.sin(self.args[0]))


class Taper(Named):
    """Half-cosine as a function of the position on the taper, from 0 to 1; decreasing."""

    composed = property(lambda self: HALF * (1 + sp.cos(sp.pi * self.args[0])))


class Place(Named):
    """Position on the taper of a bump, 0 at z = h and 1 at z = 1, clipped to [0, 1] in balls and series."""

    composed = property(lambda self: (self.args[0] - self.args[1]) / (1 - self.args[1]))


class Bump(Named):
    """Bump rho_h of z >= 0 and h, in a form without cancellation that keeps NaN."""

    composed = property(lambda self: self._pieces((Taper(Place(*self.args)), self.args[0] <= 1), (0, True)))
    stable = property(lambda self: self._pieces((0, self.args[0] >= 1), (QuarterSine(self._angle) ** 2, True)))
    _angle = property(lambda self: sp.pi / 2 / (1 - self.args[1]) * (1 - self.args[0]))

    def _pieces(self, *pieces: tuple[sp.Expr, sp.Basic]) -> sp.Expr:
        return sp.Piecewise((1, self.args[0] < self.args[1]), *pieces)

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative of the bump function rho_h, its continuous slope."""
        return BumpSlope(*self.args)


class BumpSlope(Named):
    """Derivative of rho_h in z, which is 0 off the taper and at its ends."""

    @property
    def composed(self) -> sp.Expr:  # noqa: D102
        z, h = self.args
        argument = sp.Dummy("at", positive=True)
        slope = sp.diff(written(Taper(Place(argument, h))), argument).subs(argument, z)
        return sp.Piecewise((0, sp.Or(z <= h, z >= 1)), (slope, True))


class Phi(Named):
    """Uneven sigmoid phi of s, a, b and c = (b - a)/sqrt(4ab), which vanishes at s = 0; increasing.

    Rearranged it is (a + b)(sigma_1(s + c) - sigma_1(c))/2, a quotient.
    """

    @property
    def stable(self) -> sp.Expr:  # noqa: D102
        return PhiAbove(*self.args).stable / PhiBelow(*self.args).stable

    @property
    def composed(self) -> sp.Expr:  # noqa: D102
        s, a, b, c = self.args
        return HALF * ((a + b) * Sigma1(s + c) + (a - b))

    @property
    def _parts(self) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """Return (s + c, g, product of the roots), with g regularised against 0/0."""
        s, _, _, c = self.args
        x = s + c
        root_at_x, root_at_c = sp.sqrt(1 + x**2), sp.sqrt(1 + c**2)
        return x, sp.Abs(x) * root_at_c + c * root_at_x + TINY, root_at_x * root_at_c


class PhiAbove(Phi):
    """Numerator of the uneven sigmoid phi, written as a quotient."""

    @property
    def stable(self) -> sp.Expr:  # noqa: D102
        s, a, b, c = self.args
        x, g, _ = self._parts
        return HALF * (a + b) * sp.Piecewise((s * (s + 2 * c), x >= 0), (-(g**2), True))


class PhiBelow(Phi):
    """Denominator of the uneven sigmoid phi, written as a quotient."""

    stable = property(lambda self: self._parts[1] * self._parts[2])


class PhiIntegral(Named):
    """Integral of phi from 0 to s, never below 0, in a form accurate at small s."""

    @property
    def composed(self) -> sp.Expr:  # noqa: D102
        s, a, b, c = self.args
        return HALF * ((a + b) * (sp.sqrt(1 + (s + c) ** 2) - sp.sqrt(1 + c**2)) + (a - b) * s)

    @property
    def stable(self) -> sp.Expr:  # noqa: D102
        s, a, b, c = self.args
        root_at_s, root_at_zero, product = sp.sqrt(1 + (s + c) ** 2), sp.sqrt(1 + c**2), c * (s + c)
        difference = (1 + c**2 + (s + c) ** 2) / (root_at_s * root_at_zero + product)
        gap = sp.Piecewise((difference, product > 0), (root_at_s * root_at_zero - product, True))
        return HALF * (a + b) * (s / (root_at_s + root_at_zero)) ** 2 * (gap + 1) / root_at_zero

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative of the integral of phi, which is phi."""
        return Phi(*self.args)
