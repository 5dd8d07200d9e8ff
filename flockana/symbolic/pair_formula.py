"""Formulas of pair laws: their distance, pieces and derivatives.

A formula is in the distance s or in the σ-norm z = (√(1 + εs²) − 1)/ε. It is cut where its pieces meet, at numbers;
between two cuts it is smooth, and sympy derives there, in y = s² or y = z, what the sums over pairs need.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import mpmath  # type: ignore[import-untyped]
import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.symbolic.grammar import FUNCTIONS, read_formula

DIGITS = 160  # of values that decide something: they are asked for where a formula cancels almost all of them
S, Z = sp.Symbol("s", positive=True), sp.Symbol("z", positive=True)
SQUARE, ROOT = sp.Symbol("s2", positive=True), sp.Symbol("root", positive=True)
EPS = sp.Symbol("eps", positive=True)
OWN = ("r", "d", "r_z", "d_z")  # range and length, and their σ-norms
RESERVED = frozenset((*OWN, "s", "z", "s2", "root", "pi", "Piecewise", *FUNCTIONS))


@dataclass(frozen=True)
class PairFormula:
    """Potential or force, and adjacency, parsed from text.

    Examples
    --------
    >>> formula = read_pair("k*(s - d)**2/2", "", "0", ["k"])
    >>> formula.distance, formula.derivative
    (s, k*(-2*d + 2*s)/2)
    """

    main: sp.Expr  # ψ, or ψ' where `forces`, as a function of the distance
    adjacency: sp.Expr  # a_ij, of the same distance
    distance: sp.Symbol  # `S` or `Z`
    forces: bool  # whether `main` is the derivative of the potential in the distance

    @property
    def derivative(self) -> sp.Expr:
        """ψ', the derivative in the distance."""
        return self.main if self.forces else sp.diff(self.main, self.distance)


def read_pair(potential: str, force: str, adjacency: str, names: list[str]) -> PairFormula:
    """Read a pair law from its potential or its force."""
    taken = sorted(RESERVED & {*names})
    if taken or not all(name.isidentifier() for name in names):
        bad = taken or [name for name in names if not name.isidentifier()]
        raise ArgumentError(f"parameter {bad[0]!r}: expected a name that has no meaning of its own, such as 'k'")
    symbols: dict[str, sp.Symbol] = {"s": S, "z": Z} | {name: sp.Symbol(name, positive=True) for name in OWN}
    symbols |= {name: EPS if name == "eps" else sp.Symbol(name, real=True) for name in names}
    main = _in_fractions(read_formula(force or potential, symbols, where="force" if force else "potential"))
    weight = _in_fractions(read_formula(adjacency, symbols, where="adjacency"))
    used = main.free_symbols | weight.free_symbols
    if {S, Z} <= used:
        raise ArgumentError("the formula is in s and in z: expected the distance s alone, or the σ-norm z alone")
    in_norm = Z in used
    if in_norm and "eps" not in names:
        raise ArgumentError("a formula in the σ-norm z needs parameters['eps'], the ε of the norm")
    if not in_norm and {symbols["r_z"], symbols["d_z"]} & used:
        raise ArgumentError("r_z and d_z are σ-norms: expected a formula in z, or r and d")
    idle = sorted(name for name in names if symbols[name] not in used and not (in_norm and name == "eps"))
    if idle:
        raise ArgumentError(f"parameter {idle[0]!r} is in no formula: leave it out, or use it")
    return PairFormula(main, weight, Z if in_norm else S, bool(force))


def _in_fractions(expression: sp.Expr) -> sp.Expr:
    """Return the expression with decimals as fractions, so that derived terms cancel exactly."""
    return expression.xreplace({number: sp.Rational(repr(float(number))) for number in expression.atoms(sp.Float)})


@dataclass(frozen=True)
class Piece:
    """Piece of a formula between two cuts, in y (s² or z) and the root √(1 + εs²) = 1 + εz.

    `potential` is None where the force was given.
    """

    potential: sp.Expr | None
    force: sp.Expr
    weight: sp.Expr
    slope: sp.Expr
    adjacency: sp.Expr
    adjacency_slope: sp.Expr


def derive_piece(main: sp.Expr, adjacency: sp.Expr, distance: sp.Symbol, *, forces: bool) -> Piece:
    """Derive the weight w of q_j − q_i, dw/d(s²), adjacency a and da/d(s²) from smooth expressions.

    Examples
    --------
    >>> piece = derive_piece(S**2 * (S - 1) ** 2 / 2, sp.Integer(1), S, forces=False)
    >>> sp.expand(piece.weight)
    -3*sqrt(s2) + 2*s2 + 1
    """
    if distance == Z:
        action = main if forces else sp.diff(main, Z)
        slope = (sp.diff(action, Z) - EPS * action / ROOT) / (2 * ROOT**2)
        potential = None if forces else main
        return Piece(potential, action, action / ROOT, slope, adjacency, sp.diff(adjacency, Z) / (2 * ROOT))
    at = sp.sqrt(SQUARE)
    main, adjacency = main.subs(S, at), adjacency.subs(S, at)
    weight = main / at if forces else 2 * sp.diff(main, SQUARE)
    potential = None if forces else main
    force = main if forces else weight * at
    return Piece(potential, force, weight, sp.diff(weight, SQUARE), adjacency, sp.diff(adjacency, SQUARE))


@dataclass(frozen=True)
class Cut:
    """Pair formula with numeric parameters, cut where its pieces meet.

    Examples
    --------
    >>> formula = read_pair("Piecewise((s**2, s < k), (0, True))", "", "0", ["k"])
    >>> Cut(formula, {sp.Symbol("k", real=True): 2.0}, 5.0).marks
    (0.0, 2.0, 5.0)
    """

    formula: PairFormula  # as read
    numbers: Mapping[sp.Symbol, float]  # of the parameters, r, d and their σ-norms
    end: float  # the range, in the distance of the formula

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """0, the distances at which pieces meet, rising, and the end."""
        both = sp.Tuple(self.formula.main, self.formula.adjacency)
        meet = {self._meeting(condition) for condition in _conditions(both)}
        return (0.0, *sorted(x for x in meet if 0.0 < x < self.end), self.end)

    def _meeting(self, condition: Any) -> float:
        """Return the places where a condition changes."""
        y, gap = self.formula.distance, condition.lhs - condition.rhs
        steep = sp.diff(gap, y)
        if gap.has(sp.Piecewise) or y in steep.free_symbols:
            raise ArgumentError(f"the condition {condition} is not linear in {y}: expected one such as {y} < r/2")
        if y not in gap.free_symbols:
            return -1.0  # it holds everywhere, or nowhere
        return float(self.value(-gap.subs(y, 0) / steep))

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Return the piece of the formula between each two marks."""
        return tuple(
            derive_piece(
                self._chosen(self.formula.main, 0.5 * (left + right)),
                self._chosen(self.formula.adjacency, 0.5 * (left + right)),
                self.formula.distance,
                forces=self.formula.forces,
            )
            for left, right in zip(self.marks[:-1], self.marks[1:], strict=True)
        )

    def _chosen(self, expression: sp.Expr, at: float) -> sp.Expr:
        """Return an expression with the pieces that hold at a distance."""
        if isinstance(expression, sp.Piecewise):
            for value, condition in expression.args:
                if condition == sp.true or (condition != sp.false and self._holds(condition, at)):
                    return self._chosen(value, at)
            raise ArgumentError(f"no piece holds at {self.formula.distance} = {at:g}: end Piecewise with (0, True)")
        if not expression.args or not expression.has(sp.Piecewise):
            return expression
        return expression.func(*(self._chosen(each, at) for each in expression.args))

    def _holds(self, condition: Any, at: float) -> bool:
        sign = self.value((condition.lhs - condition.rhs).subs(self.formula.distance, sp.Rational(at)))
        return bool(condition.func(sp.Rational(float(sign)), 0))

    def value(self, expression: sp.Expr) -> Any:
        """The value of an expression in parameters alone, to `DIGITS`."""
        try:
            return self.function(expression)(mpmath.mpf(1))
        except (ZeroDivisionError, ValueError, OverflowError):
            raise ArgumentError(f"{expression} has no value for these parameters: expected a finite number") from None

    def function(self, expression: sp.Expr) -> Callable[[Any], Any]:
        """Return an expression as a function of y, to `DIGITS`; NaN where it is not real."""
        y = Z if self.formula.distance == Z else SQUARE
        expression = expression.subs(ROOT, 1 + EPS * Z)
        symbols = list(self.numbers)
        compiled = sp.lambdify([y, *symbols], expression, "mpmath")
        values = [mpmath.mpf(self.numbers[symbol]) for symbol in symbols]

        def at(distance: Any) -> Any:
            with mpmath.workdps(DIGITS):
                try:
                    found = 1 * mpmath.mpmathify(compiled(mpmath.mpf(distance), *values))  # of pi alone a number too
                except (ZeroDivisionError, ValueError, OverflowError):
                    return mpmath.nan
                return found if isinstance(found, mpmath.mpf) else mpmath.nan

        return at


def _conditions(expression: sp.Basic) -> Iterator[Any]:
    """The comparisons on which the pieces of an expression hang."""
    for piecewise in expression.atoms(sp.Piecewise):
        for _, condition in piecewise.args:
            if condition not in (sp.true, sp.false):
                yield condition
