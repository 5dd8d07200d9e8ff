"""Source of compiled scalar functions from sympy expressions, with common subexpressions shared."""

from __future__ import annotations

import re
from collections.abc import Iterable

import sympy as sp
from sympy.printing.pycode import PythonCodePrinter

from flockana.symbolic.named import Named

RSQRT = sp.Function("rsqrt", positive=True)
_WHOLE = 8  # powers up to it are products


class Constants:
    """Constant subexpressions, numbered among the parameters.

    Examples
    --------
    >>> x, k = sp.symbols("x k")
    >>> constants = Constants([x], 2)
    >>> constants.taken_out(sp.sqrt(k) * x + 1), constants.values
    (c2*x + 1, [sqrt(k)])
    """

    def __init__(self, variables: Iterable[sp.Symbol], first: int) -> None:
        self.variables, self.first = frozenset(variables), first
        self.places: dict[sp.Expr, sp.Symbol] = {}

    @property
    def values(self) -> list[sp.Expr]:
        """Return the values of the constants, in the order of their places."""
        return list(self.places)

    def taken_out(self, expression: sp.Expr) -> sp.Expr:
        """Return an expression with symbols for its constants."""
        if not expression.free_symbols & self.variables:
            return self._named(expression)
        if isinstance(expression, sp.Add | sp.Mul):
            fixed = [each for each in expression.args if not each.free_symbols & self.variables]
            moving = [self.taken_out(each) for each in expression.args if each.free_symbols & self.variables]
            return expression.func(self._named(expression.func(*fixed)), *moving)
        if isinstance(expression, sp.Piecewise):
            return expression.func(*((self.taken_out(value), where) for value, where in expression.args))
        if not expression.args:
            return expression
        return expression.func(*(self.taken_out(each) for each in expression.args))

    def _named(self, constant: sp.Expr) -> sp.Expr:
        if constant.is_Integer or (constant.is_Rational and constant.q in (2, 4)):
            return constant
        symbol = sp.Symbol(f"c{self.first + len(self.places)}", real=True)
        return self.places.setdefault(constant, symbol)


class FloatCode(PythonCodePrinter):
    """Code printer with the kernels' scalar functions, powers as products and roots."""

    def _print_Pow(self, power: sp.Expr, rational: bool = False) -> str:  # noqa: N802  # sympy's name
        base, exponent = power.as_base_exp()
        if exponent.is_Rational and exponent.q <= 2 and abs(exponent) <= _WHOLE:
            whole, half = divmod(abs(int(2 * exponent)), 2)
            text = self.parenthesize(base, 100)
            factors = [text] * whole + [f"sqrt({self._print(base)})"] * half
            product = factors[0] if len(factors) == 1 else f"({'*'.join(factors)})"
            return product if exponent > 0 else f"1.0/{product}"
        return f"{self.parenthesize(base, 100)}**({self._print(exponent)})"

    def _print_Mul(self, product: sp.Expr) -> str:  # noqa: N802  # sympy's name
        number, rest = product.as_coeff_Mul()
        above: list[sp.Expr] = []
        below: list[sp.Expr] = []
        for factor in sp.Mul.make_args(rest):
            exponent = factor.as_base_exp()[1]
            inverse = exponent.is_Rational and exponent < 0
            (below if inverse else above).append(1 / factor if inverse else factor)
        factors = [self._print(abs(number))] * (abs(number) != 1 or not above)
        text = "-" * bool(number < 0) + "*".join([*factors, *(self.parenthesize(each, 50) for each in above)])
        divisor = "*".join(self.parenthesize(each, 50) for each in below)
        return f"{text}/({divisor})" if len(below) > 1 else f"{text}/{divisor}" if below else text

    def _print_Integer(self, number: sp.Integer) -> str:  # noqa: N802  # sympy's name
        return f"{int(number)}.0"

    def _print_Rational(self, number: sp.Rational) -> str:  # noqa: N802  # sympy's name
        return repr(float(number))

    def _print_Function(self, function: sp.Expr) -> str:  # noqa: N802  # sympy's name
        name = {"sin": "sine", "cos": "cosine"}.get(function.func.__name__, function.func.__name__)
        name = re.sub("(?<=[a-z])(?=[A-Z0-9])", "_", name).lower() if isinstance(function, Named) else name
        return f"{name}({', '.join(self._print(each) for each in function.args)})"

    def _print_Pi(self, pi: sp.Expr) -> str:  # noqa: N802  # sympy's name
        return "pi"

    def _print_Abs(self, magnitude: sp.Expr) -> str:  # noqa: N802  # sympy's name
        return f"abs({self._print(magnitude.args[0])})"

    def _print_Piecewise(self, pieces: sp.Piecewise) -> str:  # noqa: N802  # sympy's name
        *chosen, (last, _) = pieces.args
        head = "".join(f"{self._print(value)} if {self._print(where)} else " for value, where in chosen)
        return f"({head}{self._print(last)})"

    _print_sin = _print_cos = _print_tan = _print_exp = _print_log = _print_Function
    _print_sinh = _print_cosh = _print_tanh = _print_asin = _print_acos = _print_atan = _print_Function
    _print_asinh = _print_acosh = _print_atanh = _print_Function


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


def function_text(name: str, arguments: str, before: list[str], expressions: list[list[sp.Expr]], after: str) -> str:
    """Return the text of a function of several results, piecewise by expression.

    Examples
    --------
    >>> x = sp.Symbol("x")
    >>> print(function_text("f", "x", ["y, m0 = x, 1.0"], [[x**2, sp.sin(x) + x**2]], "v0"))
    def f(x):
        y, m0 = x, 1.0
        x0 = (x*x)
        p0, p1 = x0, x0 + sine(x)
        v0 = p0 if y < m0 else p1
        return v0
    """
    printer = FloatCode()
    flat = [each for row in expressions for each in row]
    shared, reduced = sp.cse(flat, symbols=sp.numbered_symbols("x"), order="none")
    lines = [*before, *(f"{symbol} = {printer.doprint(value)}" for symbol, value in shared)]
    at = 0
    for k, row in enumerate(expressions):
        values = [printer.doprint(each) for each in reduced[at : at + len(row)]]
        at += len(row)
        if len(set(values)) == 1:
            lines.append(f"v{k} = {values[0]}")
            continue
        names = [f"p{at - len(row) + i}" for i in range(len(row))]
        lines.append(f"{', '.join(names)} = {', '.join(values)}")
        chosen = names[-1]
        for i in range(len(row) - 2, -1, -1):  # every piece is computed and one chosen: no branch, so it is vectorised
            chosen = f"{names[i]} if y < m{i} else {chosen if chosen == names[-1] else f'({chosen})'}"
        lines.append(f"v{k} = {chosen}")
    return "\n".join([f"def {name}({arguments}):", *(f"    {line}" for line in (*lines, f"return {after}"))])


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
    taken = [constants.taken_out(each) for each in expressions] if constants.variables else expressions
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

    def _named(self, constant: sp.Expr) -> sp.Expr:
        return constant if constant.is_Symbol or (-constant).is_Symbol else super()._named(constant)
