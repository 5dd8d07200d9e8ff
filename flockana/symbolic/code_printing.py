"""Source of compiled scalar functions from sympy expressions, with common subexpressions shared."""

import re
from collections.abc import Iterable

import sympy as sp
from sympy.printing.pycode import PythonCodePrinter

from flockana.symbolic.named_functions import Named

_WHOLE = 8  # powers up to it are products


class Constants:
    """Table of constant subexpressions that become numbered parameters of compiled code."""

    def __init__(self, variables: Iterable[sp.Symbol], first: int) -> None:
        self.variables, self.first = frozenset(variables), first
        self.places: dict[sp.Expr, sp.Symbol] = {}

    values = property(lambda self: list(self.places))  # of the constants, in the order of their places

    def extract_constants(self, expression: sp.Expr) -> sp.Expr:
        """Return an expression with its constant subexpressions replaced by parameter symbols."""
        if not expression.free_symbols & self.variables:
            return self._symbol_for(expression)
        if isinstance(expression, sp.Add | sp.Mul):
            fixed = [each for each in expression.args if not each.free_symbols & self.variables]
            moving = [self.extract_constants(each) for each in expression.args if each.free_symbols & self.variables]
            return expression.func(self._symbol_for(expression.func(*fixed)), *moving)
        if isinstance(expression, sp.Piecewise):
            return expression.func(*((self.extract_constants(value), where) for value, where in expression.args))
        if not expression.args:
            return expression
        return expression.func(*(self.extract_constants(each) for each in expression.args))

    def _symbol_for(self, constant: sp.Expr) -> sp.Expr:
        if constant.is_Integer or (constant.is_Rational and constant.q in (2, 4)):
            return constant
        symbol = sp.Symbol(f"c{self.first + len(self.places)}", real=True)
        return self.places.setdefault(constant, symbol)


class FloatCode(PythonCodePrinter):
    """Printer of sympy expressions as code in floating point, with powers as products and roots."""

    def _print_Pow(self, power: sp.Expr, rational: bool = False) -> str:  # noqa: N802  # sympy's name
        base, exponent = power.as_base_exp()
        if exponent.is_Rational and exponent.q <= 2 and abs(exponent) <= _WHOLE:
            whole, half_power = divmod(abs(int(2 * exponent)), 2)
            text = self.parenthesize(base, 100)
            factors = [text] * whole + [f"sqrt({self._print(base)})"] * half_power
            product = factors[0] if len(factors) == 1 else f"({'*'.join(factors)})"
            return product if exponent > 0 else f"1.0/{product}"
        return f"{self.parenthesize(base, 100)}**({self._print(exponent)})"

    def _print_Mul(self, product: sp.Expr) -> str:  # noqa: N802  # sympy's name
        number, other_factors = product.as_coeff_Mul()
        numerators, denominators = list[sp.Expr](), list[sp.Expr]()
        for factor in sp.Mul.make_args(other_factors):
            exponent = factor.as_base_exp()[1]
            inverse = exponent.is_Rational and exponent < 0
            (denominators if inverse else numerators).append(1 / factor if inverse else factor)
        factors = [self._print(abs(number))] * (abs(number) != 1 or not numerators)
        text = "-" * bool(number < 0) + "*".join([*factors, *(self.parenthesize(item, 50) for item in numerators)])
        divisor = "*".join(self.parenthesize(item, 50) for item in denominators)
        return f"{text}/({divisor})" if len(denominators) > 1 else f"{text}/{divisor}" if denominators else text

    def _print_Integer(self, number: sp.Integer) -> str:  # noqa: N802  # sympy's name
        return f"{int(number)}.0"

    def _print_Rational(self, number: sp.Rational) -> str:  # noqa: N802  # sympy's name
        return repr(float(number))

    def _print_Function(self, function: sp.Expr) -> str:  # noqa: N802  # sympy's name
        name = {"sin": "sine", "cos": "cosine"}.get(function.func.__name__, function.func.__name__)
        name = re.sub("(?<=[a-z])(?=[A-Z0-9])", "_", name).lower() if isinstance(function, Named) else name
        return f"{name}({', '.join(self._print(argument) for argument in function.args)})"

    def _print_Pi(self, pi: sp.Expr) -> str:  # noqa: N802  # sympy's name
        return "pi"

    def _print_Piecewise(self, pieces: sp.Piecewise) -> str:  # noqa: N802  # sympy's name
        *first_pieces, (last_piece, _) = pieces.args
        head = "".join(f"{self._print(value)} if {self._print(condition)} else " for value, condition in first_pieces)
        return f"({head}{self._print(last_piece)})"

    _print_sin = _print_cos = _print_tan = _print_exp = _print_log = _print_Function
    _print_sinh = _print_cosh = _print_tanh = _print_asin = _print_acos = _print_atan = _print_Function
    _print_asinh = _print_acosh = _print_atanh = _print_Function


def function_text(name: str, arguments: str, before: list[str], expressions: list[list[sp.Expr]], after: str) -> str:
    """Return the source text of a function of several results, piecewise by expression."""
    printer = FloatCode()
    expression_list = [item for row in expressions for item in row]
    shared_terms, reduced_expressions = sp.cse(expression_list, symbols=sp.numbered_symbols("x"), order="none")
    lines = [*before, *(f"{symbol} = {printer.doprint(value)}" for symbol, value in shared_terms)]
    row_start = 0
    for k, row in enumerate(expressions):
        values = [printer.doprint(item) for item in reduced_expressions[row_start : row_start + len(row)]]
        row_start += len(row)
        if len(set(values)) == 1:
            lines.append(f"v{k} = {values[0]}")
            continue
        names = [f"p{row_start - len(row) + i}" for i in range(len(row))]
        lines.append(f"{', '.join(names)} = {', '.join(values)}")
        last_name = names[-1]
        for i in range(len(row) - 2, -1, -1):  # every piece is computed and one chosen: no branch, so it is vectorised
            last_name = f"{names[i]} if y < m{i} else {last_name if last_name == names[-1] else f'({last_name})'}"
        lines.append(f"v{k} = {last_name}")
    return "\n".join([f"def {name}({arguments}):", *(f"    {line}" for line in (*lines, f"return {after}"))])
