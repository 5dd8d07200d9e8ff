"""Printers of generated code: functions of kernels, of balls and power series, and of integrands."""

from __future__ import annotations

import re
from collections.abc import Iterable

import sympy as sp
from sympy.printing.pycode import PythonCodePrinter

from flockana.symbolic.code_printing import Constants, FloatCode

RSQRT = sp.Function("rsqrt", positive=True)


class BallCode(FloatCode):
    """Code printer for balls and power series of python-flint; `of_roots` are arguments of a root's method."""

    of_roots = ""

    def _print_Pow(self, power: sp.Expr, rational: bool = False) -> str:  # noqa: N802  # sympy's name
        base, exponent = power.as_base_exp()
        of = self.parenthesize(base, 100)
        if exponent == sp.S.Half:
            return f"{of}.sqrt({self.of_roots})"
        whole = abs(int(exponent))
        factors = [f"square({self._print(base)})"] * (whole // 2) + [of] * (whole % 2)
        return "*".join(factors) if exponent > 0 else f"1/({'*'.join(factors)})" if whole > 1 else f"1/{of}"

    def _print_Mul(self, product: sp.Expr) -> str:  # noqa: N802  # sympy's name
        number, rest = product.as_coeff_Mul()
        parts = sp.Mul.make_args(rest)
        below = [1 / each for each in parts if each.is_Pow and each.exp.is_Integer and each.exp < 0]
        above = [each for each in parts if 1 / each not in below]
        factors = [str(abs(number.p))] * (abs(number.p) != 1 or not above)
        text = "-" * bool(number < 0) + "*".join([*factors, *(self.parenthesize(each, 50) for each in above)])
        divisor = [str(number.q)] * (number.q != 1) + [self.parenthesize(each, 50) for each in below]
        return f"{text}/({'*'.join(divisor)})" if len(divisor) > 1 else f"{text}/{divisor[0]}" if divisor else text

    def _print_Rational(self, number: sp.Rational) -> str:  # noqa: N802  # sympy's name
        return f"arb({number.p})/{number.q}"

    def _print_cos(self, function: sp.Expr) -> str:
        return f"{self.parenthesize(function.args[0] / sp.pi, 100)}.{function.func.__name__}_pi()"

    _print_sin = _print_cos

    def _print_Function(self, function: sp.Expr) -> str:  # noqa: N802  # sympy's name
        if function.func == RSQRT:
            return f"{self.parenthesize(function.args[0], 100)}.rsqrt({self.of_roots})"
        return super()._print_Function(function)

    def _print_Integer(self, number: sp.Integer) -> str:  # noqa: N802  # sympy's name
        return str(int(number))

    def _print_Pi(self, pi: sp.Expr) -> str:  # noqa: N802  # sympy's name
        return "arb.pi()"


def by_inverse_roots(expression: sp.Expr) -> sp.Expr:
    """Return an expression with powers of each root in a divisor as those of its inverse, which series have at once.

    Examples
    --------
    >>> x = sp.Symbol("x", positive=True)
    >>> by_inverse_roots(x ** sp.Rational(-3, 2))
    rsqrt(x)**3
    """
    below = [power for power in expression.atoms(sp.Pow) if power.exp.is_number and power.exp < 0]
    roots = {power.base for power in below if power.exp.q == 2}
    known = {power: RSQRT(power.base) ** (-2 * power.exp) for power in below if power.base in roots}
    return expression.xreplace(known)


class IntegrandCode(BallCode):
    """Code printer for integrands of `acb.integral`, whose roots must be analytic."""

    of_roots = "analytic=analytic"


def shared_text(
    head: str,
    doc: str,
    expressions: list[sp.Expr],
    printer: PythonCodePrinter,
    moving: Iterable[sp.Symbol] = (),
    *,
    lazy: bool = False,
) -> str:
    """Return the text of a function; first what depends on no `moving` argument, which leaves a loop over them.

    Unless `lazy`, every piece of a piecewise expression is computed and one chosen: a loop over it is vectorised.

    Examples
    --------
    >>> x, h = sp.symbols("x h")
    >>> pieces = sp.Piecewise((x / sp.sqrt(h), x < 1), (0, True))
    >>> print(shared_text("f(x, h)", "Of x.", [pieces], FloatCode(), [x]).replace('"', "'"))
    def f(x, h):
        '''Of x.'''
        c0 = 1.0/sqrt(h)
        x0 = c0*x
        return x0 if x < 1.0 else 0.0
    """
    constants = _Ahead(moving, 0)
    taken = [constants.extract_constants(each) for each in expressions] if constants.variables else expressions
    parts = {power.base for each in taken for power in each.atoms(sp.Pow) if abs(power.exp) > 1}
    parts |= {call for each in taken for call in each.atoms(sp.Function) if not isinstance(call, sp.Piecewise)}
    parts -= {*taken}
    parts |= {value for each in taken for one in each.atoms(sp.Piecewise) for value, _ in one.args}
    named = [] if lazy else sorted((part for part in parts if part.args), key=sp.default_sort_key)
    shared, reduced = sp.cse([*named, *taken], symbols=sp.numbered_symbols("x", real=True), order="none")
    lines = [f"c{k} = {printer.doprint(value)}" for k, value in enumerate(constants.values)]
    lines += [f"{symbol} = {printer.doprint(value)}" for symbol, value in shared]
    results = reduced[len(named) :]
    if lazy and isinstance(results[0], sp.Piecewise):
        *pieces, (last, _) = results[0].args
        for value, where in pieces:
            lines += [f"if {_bare(printer.doprint(where))}:", f"    return {printer.doprint(value)}"]
        results = [last]
    lines += [f"return {', '.join(_bare(printer.doprint(each)) for each in results)}"]
    return "\n".join([f"def {head}:", *(f"    {line}" for line in (f'"""{doc}"""', *lines))])


def _bare(text: str) -> str:
    """Return a text without brackets around all of it."""
    return re.sub(r"^\(((?:[^()]|\([^()]*\))*)\)$", r"\1", text)


class _Ahead(Constants):
    """Constant subexpressions that are computed first, but for single parameters."""

    def _symbol_for(self, constant: sp.Expr) -> sp.Expr:
        return constant if constant.is_Symbol or (-constant).is_Symbol else super()._symbol_for(constant)
