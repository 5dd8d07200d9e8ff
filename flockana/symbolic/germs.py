"""Leading behaviour of a formula just above a point: a power of the distance times an enclosed factor."""

from fractions import Fraction
from math import prod
from typing import Any, NamedTuple

import sympy as sp
from flint import arb, fmpq

from flockana.symbolic.enclosed import Enclosed, rational

_ODD = (sp.sin, sp.tan, sp.sinh, sp.tanh, sp.asin, sp.atan, sp.asinh, sp.atanh)  # they vanish at 0
_SLOW = Fraction(1, 64)  # a logarithm grows slower than this power
_T = sp.Symbol("t", real=True)


class Germ(NamedTuple):
    """Power t^power times a factor within a ball, for all t in (0, w]; analytic there."""

    power: Fraction
    factor: arb


class _UnknownError(ArithmeticError):
    """Exception for a formula whose leading behaviour is not known."""


def germ(expression: sp.Expr, variable: sp.Symbol, width: fmpq) -> Germ | None:
    """Return the leading behaviour of a formula on (0, width]; None where it is not known."""
    try:
        return _GermVisitor(variable, width).of(expression)
    except (_UnknownError, ValueError, ZeroDivisionError, OverflowError):
        return None


class _GermVisitor:
    """Visitor that computes germs of a formula from its leaves up."""

    def __init__(self, variable: sp.Symbol, width: fmpq) -> None:
        self.variable, self.width = variable, arb(width)
        self._known: dict[sp.Expr, Germ] = {}

    def of(self, node: sp.Expr) -> Germ:
        if node not in self._known:
            found = self._of(node)
            if not found.factor.is_finite():
                raise _UnknownError
            self._known[node] = found
        return self._known[node]

    def _of(self, node: sp.Expr) -> Germ:
        if node == self.variable:
            return Germ(Fraction(1), arb(1))
        if self.variable not in node.free_symbols:
            return Germ(Fraction(0), _first(Enclosed(node, self.variable), arb(0)))
        if node.is_Add:
            return self._sum([self.of(each) for each in node.args])
        if node.is_Mul:
            powers, factors = zip(*(self.of(each) for each in node.args), strict=True)
            return Germ(sum(powers, Fraction(0)), prod(factors, start=arb(1)))
        if node.is_Pow and node.exp.is_Rational:
            return self._power(self.of(node.base), node.exp)
        if node.is_Pow:
            return self.of(sp.exp(node.exp * sp.log(node.base), evaluate=False))
        return self._function(node.func, self.of(node.args[0]))

    def _sum(self, terms: list[Germ]) -> Germ:
        least = min(each.power for each in terms)
        return Germ(least, sum((each.factor * self._until(each.power - least) for each in terms), arb(0)))

    def _until(self, power: Fraction) -> arb:
        """Return the range of t^power, power ≥ 0."""
        if power == 0:
            return arb(1)
        return arb(0).union((self.width.log() * arb(rational(power))).exp().upper())

    def _power(self, base: Germ, exponent: sp.Rational) -> Germ:
        x, power = sp.Symbol("x", positive=True), Fraction(int(exponent.p), int(exponent.q))
        return Germ(base.power * power, _first(Enclosed(x**exponent, x), base.factor))

    def _function(self, of: Any, argument: Germ) -> Germ:
        none = Fraction(0)
        if of is sp.log and argument.power != 0:
            return self._logarithm(argument)
        if argument.power >= 0:
            at = argument.factor * self._until(argument.power)  # all values, the limit included
            if of in _ODD and argument.power > 0:
                slope = Enclosed(sp.diff(of(_T), _T), _T)
                return Germ(argument.power, argument.factor * _first(slope, at.union(arb(0))))
            return Germ(none, _first(Enclosed(of(_T), _T), at))
        if of in (sp.sin, sp.cos):
            return Germ(none, arb(0, 1))
        least = abs(argument.factor).lower() * (1 / self._until(-argument.power).upper())
        rises = bool(argument.factor > 0)
        if not (rises or argument.factor < 0):
            raise _UnknownError
        if of is sp.exp and not rises:
            return Germ(none, arb(0).union((-least).exp().upper()))
        if of in (sp.atan, sp.tanh):
            limit, value = (arb.pi() / 2, least.atan()) if of is sp.atan else (arb(1), least.tanh())
            found = value.lower().union(limit.upper())
            return Germ(none, found if rises else -found)
        raise _UnknownError

    def _logarithm(self, argument: Germ) -> Germ:
        """Return the germ of log(t^k N) = k log t + log N, with a bound of t^(1/64) |log t|."""
        if not argument.factor > 0 or not self.width < 1:
            raise _UnknownError
        slow = arb(rational(_SLOW))
        turn = (-1 / slow).exp()  # where t^slow |log t| is largest, 1/(slow e)
        most = 1 / (slow * arb(1).exp()) if self.width >= turn else -self.width.log() * (self.width.log() * slow).exp()
        power = arb(rational(argument.power))
        return Germ(-_SLOW, -power * arb(0).union(most.upper()) + argument.factor.log() * self._until(_SLOW))


def _first(of: Enclosed, at: arb) -> arb:
    found = of.series(at)
    if found is None:
        raise _UnknownError
    return found[0]
