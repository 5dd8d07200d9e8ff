"""Formulas as text, parsed by a small grammar and never evaluated as Python.

Known are names, numbers, + - * / ** and brackets, comparisons with the distance, ``Piecewise((value, condition), ...)``
and the functions in `FUNCTIONS`. Nothing is evaluated as Python, and nothing that is written small can grow large.
"""

import ast
import operator
from collections.abc import Callable, Mapping
from math import inf, isfinite
from typing import Any

import sympy as sp
from flint import arb
from sympy.printing.str import StrPrinter

from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.symbolic.formula_enclosures import Enclosed, precision

LENGTH = 4000  # characters of a formula
DEPTH = 100  # of brackets and operations within each other
LARGEST_POWER = 64
NODES = 1000  # of the expression
TOWER = 3  # exponentials, or powers of the distance, within each other
DEGREE = 4096  # of powers of powers
_BITS = 1024  # largest size, in bits, of a rational number that a power gives
_MOST_EXPONENT = 600  # of e
_GREATEST = 1e300
_GROWING = ("exp", "sinh", "cosh")

_REAL = 1e-9  # relative: an imaginary part that is more than rounding
_DIVISOR_BITS = 600  # to which a divisor must differ from 0

FUNCTIONS: Mapping[str, Callable[..., sp.Expr]] = {
    **{name: getattr(sp, name) for name in ("sqrt", "exp", "log", "sin", "cos", "tan", "sinh", "cosh", "tanh")},
    **{name: getattr(sp, name) for name in ("asin", "acos", "atan", "asinh", "acosh", "atanh")},
    **dict.fromkeys(("abs", "Abs"), sp.Abs),
}
_CONSTANTS = {"pi": sp.pi, "True": sp.true}
_OPERATIONS: Mapping[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
_RELATIONS: Mapping[type, type] = {ast.Lt: sp.Lt, ast.LtE: sp.Le, ast.Gt: sp.Gt, ast.GtE: sp.Ge}


def read_formula(text: str, symbols: Mapping[str, sp.Expr], *, where: str = "the formula") -> sp.Expr:
    """Return the sympy expression of a formula given as text, in given names of variables."""
    if not isinstance(text, str):
        raise ArgumentError(f"{where} = {text!r}: expected a sympy expression, or text")
    if len(text) > LENGTH:
        raise ArgumentError(f"{where} has {len(text)} characters: expected at most {LENGTH}")
    if "^" in text:
        power = _short(text.replace("^", "**"))
        raise ArgumentError(f"{where}: {_short(text)} has a ^, which is no power here; expected **, as in {power}")
    try:
        tree = ast.parse(text.strip(), mode="eval")
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        fault = f"{where}: {_short(text)} cannot be read; expected a formula such as k*(s - d)**2"
        raise ArgumentError(fault) from None
    value = _Reader(text, symbols, where).expression(tree.body, 0)
    if not isinstance(value, sp.Expr):
        raise ArgumentError(f"{where}: {_short(text)} is a condition; expected a value")
    return _with_pieces(value, where)


def expression_size(value: sp.Basic, known: dict[sp.Basic, tuple[int, int, int]]) -> tuple[int, int, int]:
    """Return the number of nodes of an expression, its height of exponentials, and its degree."""
    if value not in known:
        rows = [expression_size(argument, known) for argument in value.args] or [(0, 0, 1)]
        nodes = 1 + sum(nodes for nodes, _, _ in rows)
        power_height, degree = (max(row[k] for row in rows) for k in (1, 2))
        if isinstance(value, sp.Pow) and value.exp.is_number:
            degree *= max(1, int(abs(float(value.exp))))
        elif isinstance(value, sp.Pow) or value.func.__name__ in _GROWING:
            power_height += 1
        known[value] = nodes, power_height, degree
    return known[value]


def _with_pieces(value: sp.Expr, where: str) -> sp.Expr:
    """Return an expression in which absolute values are written as piecewise expressions."""
    for inner in value.atoms(sp.Abs):
        _ensure_plain(inner.args[0], where)
    try:
        return value.replace(sp.Abs, lambda x: sp.Piecewise((x, x >= 0), (-x, True), evaluate=False))
    except TypeError as error:  # a comparison of what is not real
        raise ArgumentError(f"{where}: {error}; expected real values at every distance") from None


def _ensure_plain(value: sp.Expr, where: str) -> None:
    """Raise if the argument of a condition or of abs is itself piecewise."""
    if value.has(sp.Piecewise, sp.Abs):
        raise ArgumentError(
            f"{where}: a condition, or abs, of {_short(str(value))}, which has pieces itself; expected one that is "
            "linear in the distance: write the pieces as Piecewise((value, s < 1), ..., (value, True))"
        )


def write_formula(expression: sp.Expr) -> str:
    """Return an expression as text from which `read_formula` restores it exactly."""
    return str(_Printer().doprint(expression))


class _Printer(StrPrinter):
    """Printer of sympy expressions as text that keeps numbers exact."""

    def _print_Float(self, number: sp.Float) -> str:  # noqa: N802  # sympy's name
        return repr(float(number))

    def _print_Exp1(self, number: sp.Expr) -> str:  # noqa: N802  # sympy's name
        return "exp(1)"


def _short(text: str) -> str:
    return repr(text if len(text) <= 60 else f"{text[:57]}...")


class _Reader:
    """Visitor that builds a sympy expression from the syntax tree of a formula's text."""

    def __init__(self, text: str, symbols: Mapping[str, sp.Expr], where: str) -> None:
        self.text, self.where = text, where
        self.names = {**_CONSTANTS, **symbols}
        self._sizes: dict[sp.Basic, tuple[int, int, int]] = {}

    def expression(self, node: ast.AST, depth: int) -> Any:
        """Return the sympy expression of a node of a formula's syntax tree."""
        if depth > DEPTH:
            raise ArgumentError(f"{self.where} is nested more than {DEPTH} deep: expected a simpler formula")
        if isinstance(node, ast.Constant):
            return self._number(node.value)
        if isinstance(node, ast.Name):
            if node.id not in self.names:
                names, remedy = ", ".join(sorted({*self.names} - {"True"})), f"parameters={{{node.id!r}: ...}}"
                fault = f"{self.where} has the unknown name {node.id!r}: expected one of {names}"
                raise ArgumentError(f"{fault}; give a parameter its value, {remedy}")
            return self.names[node.id]
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
            value = self._value(node.operand, depth)
            return -value if isinstance(node.op, ast.USub) else value
        if isinstance(node, ast.BinOp):
            return self._operation(node, depth)
        if isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _RELATIONS:
            sides = [self._value(item, depth) for item in (node.left, node.comparators[0])]
            for side in sides:
                _ensure_plain(side, self.where)
            try:
                return _RELATIONS[type(node.ops[0])](*sides)
            except TypeError as error:
                raise ArgumentError(f"{self.where}: {error}; expected real values to compare") from None
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
            return self._call(node.func.id, node.args, depth)
        raise self._refused(node)

    def _refused(self, node: ast.AST) -> ArgumentError:
        expression_text = ast.get_source_segment(self.text.strip(), node) or self.text
        return ArgumentError(
            f"{self.where}: {_short(expression_text)} is no formula; expected names, numbers, + - * / **, comparisons, "
            f"Piecewise((value, condition), ...) and {', '.join(sorted(FUNCTIONS))}"
        )

    def _value(self, node: ast.AST, depth: int) -> sp.Expr:
        value = self.expression(node, depth + 1)
        if not isinstance(value, sp.Expr):
            raise self._refused(node)
        return value

    def _number(self, value: Any) -> sp.Expr:
        if isinstance(value, bool):
            return sp.true if value else sp.false
        if isinstance(value, int) and value.bit_length() <= _BITS:
            return sp.Integer(value)
        if isinstance(value, float) and isfinite(value):
            return sp.Rational(repr(value))  # 0.1 is 1/10, so that terms cancel exactly, and no exponential overflows
        text = value if isinstance(value, float) else type(value).__name__
        raise ArgumentError(f"{self.where}: {text} is no number of a formula; expected a finite one")

    def _operation(self, node: ast.BinOp, depth: int) -> sp.Expr:
        left, right = self._value(node.left, depth), self._value(node.right, depth)
        if isinstance(node.op, ast.Pow):
            self._ensure_small_power(left, right)
            if right.is_negative:
                self._ensure_divisor(left, node.left)
            value = left**right
        elif type(node.op) in _OPERATIONS:
            if isinstance(node.op, ast.Div):
                self._ensure_divisor(right, node.right)
            value = _OPERATIONS[type(node.op)](left, right)
        else:
            raise self._refused(node)
        return self._real(value, node)

    def _real(self, value: sp.Expr, node: ast.AST) -> sp.Expr:
        """Return an expression unchanged; raise if it is complex, infinite or too large."""
        self._ensure_small(value)
        is_unreal = value.has(sp.zoo, sp.nan, sp.oo, -sp.oo, sp.I)
        if is_unreal or (value.is_number and not self._size_of(value) < _GREATEST):
            raise ArgumentError(f"{self.where}: {_short(ast.unparse(node))} is no real number below {_GREATEST:g}")
        return value

    @staticmethod
    def _size_of(value: sp.Expr) -> float:
        try:
            number = complex(value.evalf(15))
            return inf if abs(number.imag) > _REAL * abs(number) else abs(number)
        except (ArithmeticError, ValueError, TypeError):
            return inf

    def _ensure_small(self, value: sp.Expr) -> None:
        """Raise on an expression with too many nodes or nested exponentials, or of too high a degree."""
        nodes, power_height, degree = expression_size(value, self._sizes)
        towers = power_height, TOWER, "exponentials within each other"
        for count, most, part_name in ((nodes, NODES, "parts"), towers, (degree, DEGREE, "as its degree")):
            if count > most:
                raise ArgumentError(f"{self.where} has {count} {part_name}: expected at most {most}, a simpler formula")

    def _ensure_divisor(self, value: sp.Expr, node: ast.AST) -> None:
        """Raise on a divisor that is or may be 0."""
        if not value.is_number or value.is_Rational:
            return
        with precision(_DIVISOR_BITS):
            series = Enclosed(value, sp.Dummy()).series(arb(0))
        if series is None or series[0].contains(0):
            divisor = _short(ast.unparse(node))
            raise ArgumentError(f"{self.where}: the divisor {divisor} is 0, or not distinguishable from 0")

    def _ensure_small_power(self, base: sp.Expr, power: sp.Expr) -> None:
        """Raise on powers such as 9**9**9 before they are computed."""
        if power.is_number and not (power.is_Rational or power.is_Float):
            raise ArgumentError(f"{self.where}: a power {power} is no plain number; expected one such as 2 or 1/2")
        if power.is_number and abs(power) > LARGEST_POWER:
            raise ArgumentError(f"{self.where} has a power beyond {LARGEST_POWER}: expected a smaller one")
        if base.is_Rational and power.is_number:
            bits = max(abs(base.p), base.q).bit_length()
            if bits * abs(float(power)) > _BITS:
                raise ArgumentError(f"{self.where} has a power with more than {_BITS} bits: expected a smaller one")

    def _call(self, name: str, arguments: list[ast.expr], depth: int) -> sp.Expr:
        if name == "Piecewise":
            return sp.Piecewise(*(self._piece(item, depth) for item in arguments), evaluate=False)
        if name not in FUNCTIONS:
            raise UnknownNameError(f"function in {self.where}:", name, [*FUNCTIONS, "Piecewise"])
        if len(arguments) != 1:
            raise ArgumentError(f"{self.where}: {name} of {len(arguments)} arguments; expected one")
        argument = self._value(arguments[0], depth)
        if name in ("abs", "Abs"):
            _ensure_plain(argument, self.where)
        if argument.is_number and name in _GROWING and abs(float(argument)) > _MOST_EXPONENT:
            raise ArgumentError(f"{self.where}: {name} of {_short(str(argument))}; expected at most {_MOST_EXPONENT}")
        return self._real(FUNCTIONS[name](argument), arguments[0])

    def _piece(self, node: ast.expr, depth: int) -> tuple[sp.Expr, Any]:
        if not isinstance(node, ast.Tuple) or len(node.elts) != 2:
            raise self._refused(node)
        condition = self.expression(node.elts[1], depth + 1)
        if isinstance(condition, sp.Expr):
            raise self._refused(node.elts[1])
        return self._value(node.elts[0], depth), condition
