"""Expressions of sympy in ball arithmetic: a value that certainly is not 0 proves "≠", which simplifying cannot.

So that a formula that is proved in sympy and one that is enclosed are one object, and not two copies.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import sympy as sp
from flint import acb, arb, fmpq
from sympy.core.function import AppliedUndef

from flockana.symbolic.sigma_norms import sigma_norm
from flockana.symbolic.sums_over_pairs import P, Q, V, X, Z, write_out

DIMENSION = 3  # of the positions of two agents at which sums are written out
_FUNCTIONS: dict[Any, str] = {
    **{sp.cos: "cos", sp.sin: "sin", sp.log: "log", sp.exp: "exp", sp.asinh: "asinh", sp.sinh: "sinh"},
    **{sp.Abs: "__abs__"},
}
_COMPARED: dict[Any, Callable[[arb, arb], bool]] = {
    sp.StrictLessThan: lambda a, b: bool(a < b),
    sp.LessThan: lambda a, b: bool(a <= b),
    sp.StrictGreaterThan: lambda a, b: bool(a > b),
    sp.GreaterThan: lambda a, b: bool(a >= b),
}


def enclosed(expression: sp.Expr, values: Mapping[sp.Expr, Any] | None = None) -> acb:
    """All values of an expression where its symbols are in these balls, at the present precision."""
    values = {} if values is None else values
    if expression in values:
        return acb(values[expression])
    if isinstance(expression, sp.Piecewise):
        return enclosed(_branch(expression, values), values)
    if expression.is_Rational:
        return acb(fmpq(int(expression.p), int(expression.q)))
    if expression is sp.pi or expression is sp.I:
        return acb.pi() if expression is sp.pi else acb(0, 1)
    parts = [enclosed(part, values) for part in expression.args]
    if expression.is_Add:
        return sum(parts, acb(0))
    if expression.is_Mul:
        product = acb(1)
        for part in parts:
            product *= part
        return product
    if expression.is_Pow:
        return _power(parts[0], expression.exp, parts[1])
    if expression.func in _FUNCTIONS:
        return acb(getattr(parts[0], _FUNCTIONS[expression.func])())
    raise TypeError(f"{expression}: expected a number, a symbol with a value, or an elementary function of such")


def _power(base: acb, exponent: sp.Expr, ball: acb) -> acb:
    """Whole powers and square roots are those of Arb: the general one has a branch where the base is negative."""
    if exponent.is_Integer:
        return base ** int(exponent)
    if (2 * exponent).is_Integer:
        return base.sqrt() ** int(2 * exponent)
    return base**ball


def _branch(pieces: sp.Piecewise, values: Mapping[sp.Expr, Any]) -> sp.Expr:
    """The one piece whose condition certainly holds, those before it certainly not."""
    for value, condition in pieces.args:
        if condition == sp.true or _certain(condition, values):
            return value
        if not _certain(sp.Not(condition), values):
            break
    raise ValueError(f"{pieces}: cannot tell which piece holds; expected balls within one")


def _certain(condition: Any, values: Mapping[sp.Expr, Any]) -> bool:
    compared = _COMPARED[condition.func]
    return compared(*(enclosed(side, values).real for side in condition.args))


def differs(expression: Any) -> bool:
    """Whether an expression certainly is not 0 everywhere: by its value at one place, positions of two agents where
    it has sums over agents; values of functions that it leaves open may be any."""
    expression = sp.sympify(expression)
    if isinstance(expression, sp.MatrixBase):
        return any(differs(entry) for entry in expression)
    if expression.has(sp.Sum, sp.Indexed):
        expression = _of_two(expression)
    places: dict[sp.Expr, Any] = {}
    open_ones = sorted(expression.atoms(AppliedUndef), key=sp.default_sort_key)
    expression = expression.xreplace({f: sp.Symbol(f"open_{k}", positive=True) for k, f in enumerate(open_ones)})
    for k, symbol in enumerate(sorted(expression.free_symbols, key=sp.default_sort_key)):
        places[symbol] = arb(fmpq(int(sp.prime(k + 3)), 2 * k + 3))
    value = enclosed(expression, places)
    return bool(value.real != 0 or value.imag != 0)


def _of_two(expression: sp.Expr) -> sp.Expr:
    """Sums written out for two agents, with their σ-distance that of their positions."""
    written = write_out(expression, 2)
    for base in (Q, X):
        if written.has(base):
            axes = sorted({atom.indices[1] for atom in written.atoms(sp.Indexed) if atom.base == base}, key=int)
            gap = sp.Matrix([base[1, k] - base[2, k] for k in axes])
            written = written.subs(Z[1, 2], sigma_norm(gap))
    kinds = {base.label.name for base in (Q, P, X, V)}
    names = {
        atom: sp.Symbol(f"{atom.base.label}_{'_'.join(map(str, atom.indices))}", real=True)
        for atom in written.atoms(sp.Indexed)
        if str(atom.base.label) in kinds
    }
    return written.xreplace(names)
