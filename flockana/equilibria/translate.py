"""Translation of sympy expressions to CasADi, so that the solver uses the derived expressions."""

from collections.abc import Callable, Mapping
from functools import reduce
from typing import Any

import casadi as ca
import sympy as sp

from flockana.base.errors import ArgumentError

_UNARY: dict[Any, Callable[[Any], Any]] = {
    sp.cos: ca.cos,
    sp.sin: ca.sin,
    sp.exp: ca.exp,
    sp.Abs: ca.fabs,
    sp.sign: ca.sign,
}
_RELATIONS: dict[Any, Callable[[Any, Any], Any]] = {
    sp.StrictLessThan: ca.lt,
    sp.LessThan: ca.le,
    sp.StrictGreaterThan: ca.gt,
    sp.GreaterThan: ca.ge,
}


def to_casadi(expression: Any, values: Mapping[Any, Any]) -> Any:
    """Translate a sympy expression to CasADi; constants become the nearest floats."""
    if isinstance(expression, sp.Expr) and not expression.free_symbols and not expression.has(sp.Integral):
        return float(expression.evalf(25))
    if expression in values:
        return values[expression]
    arguments = [
        to_casadi(argument, values) for argument in expression.args if not isinstance(expression, sp.Piecewise)
    ]
    kind = type(expression)
    if kind in _UNARY:
        return _UNARY[kind](*arguments)
    if kind in _RELATIONS:
        return _RELATIONS[kind](*arguments)
    if isinstance(expression, sp.Min | sp.Max):
        return reduce(ca.fmin if isinstance(expression, sp.Min) else ca.fmax, arguments)
    if isinstance(expression, sp.Add):
        return sum(arguments[1:], arguments[0])
    if isinstance(expression, sp.Mul):
        product = arguments[0]
        for factor in arguments[1:]:
            product = product * factor
        return product
    if isinstance(expression, sp.Pow):
        return _power(arguments[0], expression.exp, arguments[1])
    if isinstance(expression, sp.Piecewise):
        return _piecewise(expression, values)
    raise ArgumentError(f"{expression}: expected elementary functions of {', '.join(map(str, values))}")


def _power(base: Any, exponent: Any, translated: Any) -> Any:
    """Return base^exponent; roots as square roots, which CasADi differentiates without a logarithm."""
    if (2 * exponent).is_Integer and not exponent.is_Integer:
        return ca.sqrt(base) ** int(2 * exponent)
    return base ** (int(exponent) if exponent.is_Integer else translated)


def _piecewise(expression: sp.Piecewise, values: Mapping[Any, Any]) -> Any:
    """Return nested if_else, last branch first; every branch must be finite everywhere."""
    *others, last = expression.args
    if last.cond != sp.true:
        raise ArgumentError(f"{expression}: expected a Piecewise whose last branch holds otherwise")
    result = to_casadi(last.expr, values)
    for branch in reversed(others):
        result = ca.if_else(to_casadi(branch.cond, values), to_casadi(branch.expr, values), result)
    return result
