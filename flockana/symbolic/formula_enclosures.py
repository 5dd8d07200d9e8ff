"""Enclosures of a formula and of its Taylor coefficients over an interval, in ball arithmetic (Arb).

An enclosure exists only where every operation of the formula is analytic on the whole interval: no divisor may vanish,
no argument of a root or logarithm may reach 0. So it proves that the formula has all derivatives there. Just above a
point a formula may lead with a power of the distance times an enclosed factor, its germ.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from fractions import Fraction
from functools import reduce
from math import prod
from operator import add, mul
from typing import Any, NamedTuple

import sympy as sp
from flint import arb, arb_series, ctx, fmpq

POSITIVE, NONNEGATIVE, OPEN = 2, 1, 0  # what is certain about a sign
_LARGEST = 2**120  # argument of an exponential
_ODD = (sp.sin, sp.tan, sp.sinh, sp.tanh, sp.asin, sp.atan, sp.asinh, sp.atanh)  # they vanish at 0
_SLOW = Fraction(1, 64)  # a logarithm grows slower than this power
_T = sp.Symbol("t", real=True)


@contextmanager
def precision(bits: int, terms: int = 1) -> Iterator[None]:
    """Set the bits of ball arithmetic and the number of series terms within a with-block."""
    saved_precision = ctx.prec, ctx.cap
    ctx.prec, ctx.cap = bits, terms
    try:
        yield
    finally:
        ctx.prec, ctx.cap = saved_precision


def rational(number: Any) -> fmpq:
    """Return a rational number of sympy, or a Fraction, as a rational number of Arb."""
    fraction = Fraction(int(number.p), int(number.q)) if isinstance(number, sp.Rational) else Fraction(number)
    return fmpq(fraction.numerator, fraction.denominator)


def interval(left: fmpq, right: fmpq) -> arb:
    """Return a ball that covers an interval given by its ends."""
    return arb(left).union(arb(right))


class UndefinedError(ArithmeticError):
    """Exception for an operation that is not certainly analytic on an interval."""


class Enclosed:
    """Formula in one variable as a function of balls."""

    def __init__(self, expression: sp.Expr, variable: sp.Symbol) -> None:
        self.variable = variable
        self._steps: list[tuple[Callable[..., Any], tuple[int, ...], sp.Expr, bool]] = []
        self._at: dict[sp.Expr, int] = {}
        self._constants: dict[tuple[int, int], dict[int, arb_series]] = {}
        self._add(sp.sympify(expression))

    def _add(self, node: sp.Expr) -> int:
        """Return the index of an expression node, added to the formula's steps after its operands."""
        if node not in self._at:
            arguments = tuple(self._add(argument) for argument in _arguments(node))
            self._steps.append((_operation(node, self.variable), arguments, node, self.variable in node.free_symbols))
            self._at[node] = len(self._steps) - 1
        return self._at[node]

    def series(self, x: arb) -> list[arb] | None:
        """Return Taylor coefficients of the formula valid for every centre in a ball; None where not analytic."""
        parts = self._run(x)
        return None if parts is None else _coefficients(parts[-1][0])

    def sign(self, x: arb) -> int:
        """Return whether the formula is certainly positive, and certainly nonnegative, on a ball."""
        series = self._run(x)
        return OPEN if series is None else series[-1][1]

    def _run(self, x: arb) -> list[tuple[Any, int]] | None:
        constants = self._constants.setdefault((ctx.prec, ctx.cap), {})
        values: list[tuple[Any, int]] = []
        midpoint, centre = x.mid(), None
        if not x.is_exact() and ctx.cap > 1 and (centre := self._run(midpoint)) is None:
            return None
        try:
            for k, (operation, arguments, node, is_variable) in enumerate(self._steps):
                if not is_variable and k in constants:
                    values.append(constants[k])
                    continue
                arguments_given = [values[argument] for argument in arguments]
                value = operation(x, *(argument for argument, _ in arguments_given))
                if centre is not None and (node.is_Add or node.is_Mul):
                    mean = centre[k][0][0] + value[1] * (x - midpoint)  # by the mean value form
                    value = _with_value(value, value[0].intersection(mean))
                if not all(map(arb.is_finite, value.coeffs())):
                    return None
                values.append((value, _sign(node, value, [sign for _, sign in arguments_given])))
                if not is_variable:
                    constants[k] = values[-1]
        except (UndefinedError, ValueError, ZeroDivisionError, OverflowError):
            return None
        return values


def _coefficients(series: arb_series) -> list[arb]:
    """Return all coefficients of a Taylor series, trailing zeros included."""
    coefficients = series.coeffs()[: ctx.cap]
    return [*coefficients, *([arb(0)] * (ctx.cap - len(coefficients)))]


def _arguments(node: sp.Expr) -> tuple[sp.Expr, ...]:
    """Return the operands of an expression node, without the exponent of a rational power."""
    if node.is_Pow and node.exp.is_Rational:
        return (node.base,)
    return () if node.is_Atom else tuple(node.args)


def _operation(node: sp.Expr, variable: sp.Symbol) -> Callable[..., Any]:
    """Return the operation of an expression node as a function of a ball and of the operands' series."""
    if node == variable:
        return lambda x: arb_series([x, 1])
    if isinstance(node, sp.Float):
        node = sp.Rational(repr(float(node)))
    if isinstance(node, sp.Rational):
        number = rational(node)
        return lambda x: arb_series([arb(number)])
    if node in (sp.pi, sp.E):
        return lambda x: arb_series([arb.pi() if node == sp.pi else arb.const_e()])
    if node.is_Add:
        return lambda x, *terms: reduce(add, terms)
    if node.is_Mul:
        return lambda x, *factors: reduce(mul, factors)
    if node.is_Pow and node.exp.is_Rational:
        whole, root, is_positive = int(abs(node.exp.p)), int(node.exp.q), bool(node.exp.p > 0)
        return lambda x, base: _power(base, whole, root, up=is_positive)
    if node.is_Pow:
        return lambda x, base, exponent: _exp(exponent * _positive(base).log())
    if (function := _FUNCTIONS.get(node.func)) is not None:
        return lambda x, argument: function(argument)
    if not isinstance(node, sp.Function):  # an infinity, bounds of one, or none
        return lambda x, *arguments: _where(False, x)
    raise TypeError(f"{node.func.__name__} has no enclosure")


def _with_value(series: Any, value: arb) -> Any:
    """Return a Taylor series with its constant term replaced by a new enclosure."""
    return arb_series([value, *_coefficients(series)[1:]])


def _where(holds: Any, series: Any) -> Any:
    """Return a Taylor series unchanged; raise unless a condition for analyticity holds."""
    if not holds:
        raise UndefinedError
    return series


def _positive(series: Any) -> Any:
    return _where(series[0] > 0, series)


def _power(base: Any, whole: int, root: int = 1, *, up: bool = True) -> Any:
    """Return a rational power of a Taylor series, or its reciprocal unless `up`."""
    of = base if root == 1 else _positive(base).sqrt() if root == 2 else (_positive(base).log() / root).exp()
    value = _with_value(_multiplied(of, whole), _power_range(of[0], whole)) if whole > 1 else of
    return value if up else 1 / _where(abs(value[0]) > 0, value)


def _multiplied(base: Any, whole: int) -> Any:
    """Return a positive integer power of a ball or a Taylor series, by repeated squaring."""
    value = None
    while whole:
        if whole & 1:
            value = base if value is None else value * base
        whole >>= 1
        base = base * base if whole else base
    return value


def _power_range(base: arb, whole: int) -> arb:
    """Return the range of an integer power of a ball, including 0 where the base changes sign."""
    range_ends = _multiplied(base.lower(), whole).union(_multiplied(base.upper(), whole))
    if whole % 2 or base > 0 or base < 0:
        return range_ends
    return arb(0).union(abs(range_ends).upper())


def _exp(x: Any) -> Any:
    if _where(x[0] < _LARGEST, x)[0] > -_LARGEST:
        return x.exp()
    floor = arb(0).union(arb(-_LARGEST).max(x[0].upper()).exp().upper())
    return _with_value(x, arb(0)).exp() * floor


def _integrated(value: arb, slope: Any, x: Any) -> Any:
    """Return the Taylor series of a function from its value and the series of its derivative."""
    return (slope * x.derivative()).integral() + value if ctx.cap > 1 else arb_series([value])


def _tanh(x: Any) -> Any:
    """Return tanh of a series from the ends of its range; its slope is 1 − tanh²."""
    tanh_range = x[0].lower().tanh().union(x[0].upper().tanh())
    value = arb_series([tanh_range])
    for _ in range(ctx.cap - 1):
        value = _integrated(tanh_range, 1 - value * value, x)
    return value


def _cosine_range(x: arb) -> arb:
    """Return the range of the cosine over a ball, with the maxima and minima between the ends."""
    turns = x / arb.pi()
    if x.is_exact() or not turns.rad() < 0.25:
        return x.cos()
    range_ends = x.lower().cos().union(x.upper().cos())
    if not turns.contains_integer():
        return range_ends
    whole = round(float(turns.mid()))
    return range_ends.union(arb(1 - 2 * (whole % 2))).intersection(arb(0, 1))


def _inside(x: Any) -> Any:
    """Return a Taylor series unchanged; raise unless its value is certainly within (−1, 1)."""
    return _where(x[0] > -1 and x[0] < 1, x)


def _hyperbolic(x: Any, *, odd: bool) -> Any:
    up, decaying_exp = _exp(x), _exp(-x)
    return _with_value((up - decaying_exp if odd else up + decaying_exp) / 2, x[0].sinh() if odd else x[0].cosh())


_FUNCTIONS: dict[Any, Callable[[Any], Any]] = {
    sp.exp: _exp,
    sp.log: lambda x: _positive(x).log(),
    sp.sin: lambda x: _with_value(x.sin(), _cosine_range(x[0] - arb.pi() / 2)),
    sp.cos: lambda x: _with_value(x.cos(), _cosine_range(x[0])),
    sp.tan: lambda x: _where(abs(x[0].cos()) > 0 and 2 * x[0].rad() < arb.pi(), x).tan(),
    sp.atan: lambda x: x.atan(),
    sp.asin: lambda x: _integrated(_inside(x)[0].asin(), (1 - x * x).rsqrt(), x),
    sp.acos: lambda x: _integrated(_inside(x)[0].acos(), -(1 - x * x).rsqrt(), x),
    sp.sinh: lambda x: _hyperbolic(x, odd=True),
    sp.cosh: lambda x: _hyperbolic(x, odd=False),
    sp.tanh: _tanh,
    sp.asinh: lambda x: _integrated(x[0].asinh(), _power(1 + _power(x, 2), 1, 2, up=False), x),
    sp.acosh: lambda x: _integrated(_where(x[0] > 1, x)[0].acosh(), (x * x - 1).rsqrt(), x),
    sp.atanh: lambda x: _integrated(_inside(x)[0].atanh(), 1 / (1 - x * x), x),
}


def _sign(node: sp.Expr, value: Any, signs: list[int]) -> int:
    """Return the certain sign of an expression node, from its enclosure or from its operands' signs."""
    ball = value[0]
    if ball > 0:
        return POSITIVE
    sign = NONNEGATIVE if ball >= 0 else OPEN
    if node.is_Add or node.is_Mul:
        lowest_sign = min(signs)
        sign = max(sign, POSITIVE if node.is_Add and lowest_sign and max(signs) == POSITIVE else lowest_sign)
    elif node.is_Pow and node.exp.is_Rational and (node.exp.p % 2 == 0 or signs[0]):
        sign = max(sign, signs[0] or NONNEGATIVE)
    elif node.func is sp.exp or (node.is_Pow and signs[0] == POSITIVE):
        sign = POSITIVE
    return sign


class Germ(NamedTuple):
    """Leading behaviour of a function near 0: t^power times a factor within a ball, for all t in (0, w]."""

    power: Fraction
    factor: arb


class _UnknownError(ArithmeticError):
    """Exception for a formula whose leading behaviour near 0 is not known."""


def germ(expression: sp.Expr, variable: sp.Symbol, width: fmpq) -> Germ | None:
    """Return the leading behaviour of a formula on (0, width]; None if unknown."""
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
            own_germ = self._of(node)
            if not own_germ.factor.is_finite():
                raise _UnknownError
            self._known[node] = own_germ
        return self._known[node]

    def _of(self, node: sp.Expr) -> Germ:
        if node == self.variable:
            return Germ(Fraction(1), arb(1))
        if self.variable not in node.free_symbols:
            return Germ(Fraction(0), _first(Enclosed(node, self.variable), arb(0)))
        if node.is_Add:
            return self._sum([self.of(argument) for argument in node.args])
        if node.is_Mul:
            powers, factors = zip(*(self.of(argument) for argument in node.args), strict=True)
            return Germ(sum(powers, Fraction(0)), prod(factors, start=arb(1)))
        if node.is_Pow and node.exp.is_Rational:
            return self._power(self.of(node.base), node.exp)
        if node.is_Pow:
            return self.of(sp.exp(node.exp * sp.log(node.base), evaluate=False))
        return self._function(node.func, self.of(node.args[0]))

    def _sum(self, terms: list[Germ]) -> Germ:
        power = min(term.power for term in terms)
        return Germ(power, sum((term.factor * self._until(term.power - power) for term in terms), arb(0)))

    def _until(self, power: Fraction) -> arb:
        """Return the range of t^power for t in (0, w], power ≥ 0."""
        if power == 0:
            return arb(1)
        return arb(0).union((self.width.log() * arb(rational(power))).exp().upper())

    def _power(self, base: Germ, exponent: sp.Rational) -> Germ:
        x, power = sp.Symbol("x", positive=True), Fraction(int(exponent.p), int(exponent.q))
        return Germ(base.power * power, _first(Enclosed(x**exponent, x), base.factor))

    def _function(self, of: Any, argument: Germ) -> Germ:
        zero_power = Fraction(0)
        if of is sp.log and argument.power != 0:
            return self._logarithm(argument)
        if argument.power >= 0:
            argument_range = argument.factor * self._until(argument.power)  # all values, the limit included
            if of in _ODD and argument.power > 0:
                slope = Enclosed(sp.diff(of(_T), _T), _T)
                return Germ(argument.power, argument.factor * _first(slope, argument_range.union(arb(0))))
            return Germ(zero_power, _first(Enclosed(of(_T), _T), argument_range))
        if of in (sp.sin, sp.cos):
            return Germ(zero_power, arb(0, 1))
        bound = abs(argument.factor).lower() * (1 / self._until(-argument.power).upper())
        rises = bool(argument.factor > 0)
        if not (rises or argument.factor < 0):
            raise _UnknownError
        if of is sp.exp and not rises:
            return Germ(zero_power, arb(0).union((-bound).exp().upper()))
        if of in (sp.atan, sp.tanh):
            limit, value = (arb.pi() / 2, bound.atan()) if of is sp.atan else (arb(1), bound.tanh())
            hull = value.lower().union(limit.upper())
            return Germ(zero_power, hull if rises else -hull)
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
    series = of.series(at)
    if series is None:
        raise _UnknownError
    return series[0]
