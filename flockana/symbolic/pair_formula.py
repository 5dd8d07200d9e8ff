"""Formula of a pair law: its variable, its pieces, and derived weight and slopes.

A formula is in the distance s or in the σ-norm z = (√(1 + εs²) − 1)/ε. It is cut where its pieces meet, at numbers;
between two cuts it is smooth, and sympy derives there, in y = s² or y = z, what the sums over pairs need.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any

import mpmath  # type: ignore[import-untyped]
import sympy as sp

from flockana.base.errors import ArgumentError
from flockana.symbolic.derivation import Derivation, Step
from flockana.symbolic.formula_grammar import FUNCTIONS, expression_size, read_formula
from flockana.symbolic.scalar_functions import adjacency, phi_alpha

DIGITS = 160  # of values that decide something: they are asked for where a formula cancels almost all of them
S, Z = sp.Symbol("s", positive=True), sp.Symbol("z", positive=True)
SQUARE, ROOT = sp.Symbol("s2", positive=True), sp.Symbol("root", positive=True)
EPS = sp.Symbol("eps", positive=True)
_SLOPE, _CURVATURE = 4000, 20_000  # nodes of a first and of a second derivative
_KEPT = 64  # texts
_CUTS = 24  # distances at which pieces meet
OWN = ("r", "d", "r_z", "d_z")  # range and length, and their σ-norms
RESERVED = frozenset((*OWN, "s", "z", "s2", "root", "pi", "Piecewise", *FUNCTIONS))


@dataclass(frozen=True)
class PairFormula:
    """Potential or force, and adjacency, as parsed from text."""

    main: sp.Expr  # ψ, or ψ' where `forces`, as a function of the distance
    adjacency: sp.Expr  # a_ij, of the same distance
    distance: sp.Symbol  # `S` or `Z`
    forces: bool  # whether `main` is the derivative of the potential in the distance

    @property
    def derivative(self) -> sp.Expr:
        """Derivative ψ' of the potential by the distance."""
        return self.main if self.forces else sp.diff(self.main, self.distance)


def read_pair(potential: str, force: str, adjacency: str, names: Iterable[str]) -> PairFormula:
    """Return a pair law from texts of potential or force, and adjacency."""
    return _read_pair(potential, force, adjacency, tuple(names))


@lru_cache(maxsize=_KEPT)
def _read_pair(potential: str, force: str, adjacency: str, names: tuple[str, ...]) -> PairFormula:
    bad_names = sorted(RESERVED & {*names}) or [name for name in names if not name.isidentifier()]
    if bad_names:
        raise ArgumentError(f"parameter {bad_names[0]!r}: expected a name that has no meaning of its own, such as 'k'")
    symbols: dict[str, sp.Symbol] = {"s": S, "z": Z} | {name: sp.Symbol(name, positive=True) for name in OWN}
    symbols |= {name: EPS if name == "eps" else sp.Symbol(name, real=True) for name in names}
    main_formula = read_formula(force or potential, symbols, where="force" if force else "potential")
    weight = read_formula(adjacency, symbols, where="adjacency")
    symbols_used = main_formula.free_symbols | weight.free_symbols
    if {S, Z} <= symbols_used:
        raise ArgumentError("the formula is in s and in z: expected the distance s alone, or the σ-norm z alone")
    is_in_norm = Z in symbols_used
    if is_in_norm and "eps" not in names:
        raise ArgumentError("a formula in the σ-norm z needs parameters['eps'], the ε of the norm")
    if not is_in_norm and {symbols["r_z"], symbols["d_z"]} & symbols_used:
        raise ArgumentError("r_z and d_z are σ-norms: expected a formula in z, or r and d")
    idle = sorted(name for name in names if symbols[name] not in symbols_used and not (is_in_norm and name == "eps"))
    if idle:
        raise ArgumentError(f"parameter {idle[0]!r} is in no formula: leave it out, or use it")
    return PairFormula(main_formula, weight, Z if is_in_norm else S, bool(force))


def _without_overflow(expression: sp.Expr) -> sp.Expr:
    """Return an expression with logistic switches 1/(1 + exp(g)) as (1 − tanh(g/2))/2, whose slopes do not overflow."""

    def is_switch(node: sp.Basic) -> bool:
        return bool(node.is_Pow and node.exp.is_Integer and node.exp < 0 and isinstance(node.base - 1, sp.exp))

    return expression.replace(is_switch, lambda node: ((1 - sp.tanh((node.base - 1).exp / 2)) / 2) ** -node.exp)


@dataclass(frozen=True)
class Piece:
    """Weight, adjacency and their slopes between two joints of a pair law, in the variable y: s² or z.

    `potential` is None where the force was given.
    """

    potential: sp.Expr | None
    force: sp.Expr
    weight: sp.Expr
    slope: sp.Expr
    adjacency: sp.Expr
    adjacency_slope: sp.Expr


@lru_cache(maxsize=_KEPT)
def derive_piece(main: sp.Expr, adjacency: sp.Expr, distance: sp.Symbol, *, forces: bool) -> Piece:
    """Return weight w of q_j − q_i, dw/d(s²), adjacency and da/d(s²) of smooth expressions."""
    main, adjacency = _without_overflow(main), _without_overflow(adjacency)
    _ensure_derived(sp.diff(main, distance), _SLOPE)
    if distance == Z:
        force = main if forces else sp.diff(main, Z)
        weight, slope = force / ROOT, (sp.diff(force, Z) - EPS * force / ROOT) / (2 * ROOT**2)
        adjacency_slope = sp.diff(adjacency, Z) / (2 * ROOT)
    else:
        distance_symbol = sp.sqrt(SQUARE)
        main, adjacency = main.subs(S, distance_symbol), adjacency.subs(S, distance_symbol)
        weight = main / distance_symbol if forces else 2 * sp.diff(main, SQUARE)
        force = main if forces else weight * distance_symbol
        slope, adjacency_slope = sp.diff(weight, SQUARE), sp.diff(adjacency, SQUARE)
    return Piece(None if forces else main, force, weight, slope, adjacency, adjacency_slope)


def _ensure_derived(derivative: sp.Expr, most: int) -> None:
    """Raise on a formula whose derivatives are too large to compile."""
    if (nodes := expression_size(derivative, {})[0]) > most:
        raise ArgumentError(f"a derivative of the formula has {nodes} parts: expected at most {most}")


@dataclass(frozen=True)
class PiecewiseFormula:
    """Pair formula with numbers for its parameters, divided where its pieces meet."""

    formula: PairFormula  # as read
    numbers: Mapping[sp.Symbol, float]  # of the parameters, r, d and their σ-norms
    end: float  # the range, in the distance of the formula

    @cached_property
    def marks(self) -> tuple[float, ...]:
        """Rising distances that bound the pieces of a formula: 0, the joints, and the end, as numbers."""
        return (0.0, *self._meetings, self.end)

    @cached_property
    def exact_marks(self) -> tuple[sp.Expr, ...]:
        """Distances at the joints of pieces as expressions in the parameters, and the end as a number."""
        return (sp.Integer(0), *self._meetings.values(), sp.Float(self.end))

    @cached_property
    def _meetings(self) -> dict[float, sp.Expr]:
        expression_pair = sp.Tuple(self.formula.main, self.formula.adjacency)
        meeting_points = {float(self.value(at)): at for at in map(self._meeting, _conditions(expression_pair))}
        inner_meetings = {x: meeting_points[x] for x in sorted(meeting_points) if 0.0 < x < self.end}
        if len(inner_meetings) > _CUTS:
            raise ArgumentError(f"the formula has {len(inner_meetings) + 1} pieces: expected at most {_CUTS + 1}")
        return inner_meetings

    def _meeting(self, condition: Any) -> sp.Expr:
        """Return the distance at which a condition changes its truth value."""
        y = self.formula.distance
        if not isinstance(condition, sp.core.relational.Relational):
            raise ArgumentError(f"the condition {condition} is not one comparison: expected one such as {y} < r/2")
        gap = condition.lhs - condition.rhs
        gap_slope = sp.diff(gap, y)
        if gap.has(sp.Piecewise) or y in gap_slope.free_symbols:
            raise ArgumentError(f"the condition {condition} is not linear in {y}: expected one such as {y} < r/2")
        if y not in gap.free_symbols:
            return sp.Integer(-1)  # it holds everywhere, or nowhere
        return -gap.subs(y, 0) / gap_slope

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Expressions of weight, adjacency and slopes between consecutive joints of the formula."""
        formula, parts = self.formula, []
        for midpoint in (0.5 * (left + right) for left, right in pairwise(self.marks)):
            main_formula, weight = (self.chosen(part, midpoint) for part in (formula.main, formula.adjacency))
            parts.append(derive_piece(main_formula, weight, formula.distance, forces=formula.forces))
            _ensure_derived(parts[-1].slope, _CURVATURE)
        return tuple(parts)

    def chosen(self, expression: sp.Expr, at: float) -> sp.Expr:
        """Return an expression in which each Piecewise is replaced by its branch valid at a distance."""
        if isinstance(expression, sp.Piecewise):
            for value, condition in expression.args:
                if condition == sp.true or (condition != sp.false and self._holds(condition, at)):
                    return self.chosen(value, at)
            raise ArgumentError(f"no piece holds at {self.formula.distance} = {at:g}: end Piecewise with (0, True)")
        if not expression.args or not expression.has(sp.Piecewise):
            return expression
        return expression.func(*(self.chosen(argument, at) for argument in expression.args))

    def _holds(self, condition: Any, at: float) -> bool:
        sign = self.value((condition.lhs - condition.rhs).subs(self.formula.distance, sp.Rational(at)))
        return bool(condition.func(sp.Rational(float(sign)), 0))

    def value(self, expression: sp.Expr) -> Any:
        """Return the numeric value of an expression in parameters alone, with `DIGITS` digits."""
        try:
            return self.function(expression)(mpmath.mpf(1))
        except (ZeroDivisionError, ValueError, OverflowError):
            raise ArgumentError(f"{expression} has no value for these parameters: expected a finite number") from None

    def function(self, expression: sp.Expr) -> Callable[[Any], Any]:
        """Return an expression as a function of y, with `DIGITS` digits; NaN where not real."""
        compiled = _compiled(expression, Z if self.formula.distance == Z else SQUARE, tuple(self.numbers))
        values = [mpmath.mpf(number) for number in self.numbers.values()]

        def at(distance: Any) -> Any:
            with mpmath.workdps(DIGITS):
                try:
                    value = 1 * mpmath.mpmathify(compiled(mpmath.mpf(distance), *values))  # of pi alone a number too
                except (ZeroDivisionError, ValueError, OverflowError):
                    return mpmath.nan
                return value if isinstance(value, mpmath.mpf) else mpmath.nan

        return at


@lru_cache(maxsize=16 * _KEPT)
def _compiled(expression: sp.Expr, y: sp.Symbol, symbols: tuple[sp.Symbol, ...]) -> Callable[..., Any]:
    """Return an expression as a function of y and of its parameters, for mpmath."""
    expression = expression.subs(ROOT, 1 + EPS * Z)
    bounded_form = expression.replace(lambda e: e.is_Pow and not e.exp.is_number, lambda e: _POWER(*e.args))
    symbols_given = {symbol: sp.Dummy() for symbol in symbols}  # a parameter may be named like a function of mpmath
    compiled: Callable[..., Any] = sp.lambdify(
        [y, *symbols_given.values()], bounded_form.xreplace(symbols_given), [_BOUNDED, "mpmath"], dummify=True
    )
    return compiled


_POWER = sp.Function("bounded_power")
_LONGEST = 1e12  # argument of an exponential: beyond it the result has more digits than memory


def _bounded_exp(x: Any) -> Any:
    """Return the exponential of a number, 0 on underflow; raise OverflowError on overflow."""
    if mpmath.mpf(x) > _LONGEST:
        raise OverflowError
    return mpmath.exp(x) if x > -_LONGEST else mpmath.mpf(0)


_BOUNDED: dict[str, Callable[..., Any]] = {
    "exp": _bounded_exp,
    "cosh": lambda x: (_bounded_exp(abs(x)) + _bounded_exp(-abs(x))) / 2,
    "sinh": lambda x: (_bounded_exp(x) - _bounded_exp(-x)) / 2 if abs(x) > 1 else mpmath.sinh(x),
    "tanh": lambda x: mpmath.tanh(x) if abs(x) < _LONGEST else mpmath.sign(x),
    "bounded_power": lambda x, k: _bounded_exp(k * mpmath.log(x)) if x > 0 else mpmath.power(x, k),
}


def _conditions(expression: sp.Basic) -> Iterator[Any]:
    """Return the comparisons that select the pieces of an expression."""
    conditions = (condition for piecewise in expression.atoms(sp.Piecewise) for _, condition in piecewise.args)
    return (condition for condition in conditions if condition not in (sp.true, sp.false))


def pair_derivation(formula: PairFormula) -> Derivation:
    """Derive potential, force and weight from a pair law's formula, with residuals of checkable equations."""
    y = formula.distance
    psi, symbol_name = sp.Function("psi")(y), "s" if y == S else "z"
    derivative = formula.derivative
    weight = derivative / y if y == S else derivative / (1 + EPS * Z)
    potential = sp.Integral(formula.main, y) if formula.forces else formula.main
    squared_value = sp.Symbol("x", positive=True)
    at = sp.sqrt(squared_value) if y == S else (sp.sqrt(1 + EPS * squared_value) - 1) / EPS
    residuals = () if formula.forces else (2 * sp.diff(formula.main.subs(y, at), squared_value) - weight.subs(y, at),)
    steps = (
        Step(f"The potential of a pair, in ${symbol_name}$,", sp.Eq(psi, potential, evaluate=False)),
        Step("its derivative, negative where the pair repels,", sp.Eq(psi.diff(y), derivative, evaluate=False)),
        Step(r"the force on $i$ is $w\,(q_j - q_i)$ with", sp.Eq(sp.Symbol("w"), weight, evaluate=False)),
        Step("and velocities are averaged with", sp.Eq(sp.Symbol("a_ij"), formula.adjacency, evaluate=False)),
    )
    return Derivation("The pair law", steps, weight, tuple(sp.simplify(residual) for residual in residuals))


def alpha_steps() -> tuple[Step, ...]:
    """Return force and adjacency of Olfati-Saber's pair law, whose potential has no closed form."""
    first_step = Step("The pair law's derivative of the potential, in the sigma-norm,", phi_alpha(Z))
    return first_step, Step("and its adjacency", adjacency(Z))
