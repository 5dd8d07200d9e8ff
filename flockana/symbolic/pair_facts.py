"""Proved facts of a formula's pair law: smoothness, sign of the adjacency, least potential, slopes."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import inf, isfinite, sqrt

import sympy as sp
from flint import arb, fmpq

from flockana.base.function_facts import Fact, FactStatus, PairFacts, conjunction
from flockana.symbolic.formula_enclosures import Enclosed, Germ, germ, interval, precision, rational
from flockana.symbolic.interval_decisions import (
    Least,
    Region,
    down,
    is_zero,
    least_of_integral,
    least_on,
    sign_on,
    smooth_on,
    up,
)
from flockana.symbolic.pair_formula import EPS, PiecewiseFormula, S, Z

_SMALL = 1e-9  # of the scale: a jump below it may be rounding of the parameters
_NEAR = (0, 2, 4, 8, 16, 32, 64)  # halvings of the range: how far a germ at contact may reach
_CLOSE = 400  # the same, where the limit at contact is read
_BITS = 200
_SLOPE_BITS, _SLOPE_HALVINGS = 96, 6  # halvings of a part, for a bound within twice the slope at its middle
_PROOF = "every operation of the formula is analytic between the cuts, and both sides agree at them"


def exact_numbers(numbers: Mapping[sp.Symbol, float], eps: float) -> dict[sp.Symbol, sp.Expr]:
    """Return the parameters of a pair law as exact decimals, with the σ-norms of range and length."""
    exact = {symbol: sp.Rational(repr(float(value))) for symbol, value in numbers.items()}
    if eps > 0.0:
        for name in ("r", "d"):
            squared_value = 1 + exact[EPS] * exact[sp.Symbol(name, positive=True)] ** 2
            exact[sp.Symbol(f"{name}_z", positive=True)] = (sp.sqrt(squared_value) - 1) / exact[EPS]
    return exact


def pair_facts(cut: PiecewiseFormula, eps: float, strength: float, tallest: float) -> PairFacts:
    """Return the proved facts of a pair law given as formula with numbers for its parameters."""
    return _NumericFormula(cut, eps, strength, tallest).facts


@dataclass(frozen=True, eq=False)
class _NumericFormula:
    """Pair law formula with numbers for its parameters, for proving facts."""

    cut: PiecewiseFormula
    eps: float
    strength: float
    tallest: float

    @property
    def facts(self) -> PairFacts:
        """Facts on smoothness, sign and least values of a pair law."""
        weight, inside_fact = self._signs()
        minimum, contact_value = self._energies()
        region_minima = [least_on(region, self.tallest) for region in self._regions(self._weights)]
        lowest_value = (min(item.low for item in region_minima), min(item.high for item in region_minima))
        if weight.status == "met":
            lowest_value = (max(lowest_value[0], 0.0), lowest_value[1])
        smooth_fact = conjunction([*self._inner(), *self._joints(), *self._end()], _PROOF)
        return PairFacts(smooth_fact, weight, inside_fact, minimum, contact_value, lowest_value)

    @property
    def _y(self) -> sp.Symbol:
        return self.cut.formula.distance

    @cached_property
    def _numbers(self) -> dict[sp.Symbol, sp.Expr]:
        return exact_numbers(self.cut.numbers, self.eps)

    @cached_property
    def _marks(self) -> list[sp.Expr]:
        """Expressions for 0, the joints between pieces of the formula, and the interaction range."""
        return [sp.Integer(0), *self.cut.exact_marks[1:-1], self._declared("r")]

    def _declared(self, name: str) -> sp.Symbol:
        """Return the symbol of the range or desired distance, in the distance variable of the formula."""
        return sp.Symbol(f"{name}_z" if self._y == Z else name, positive=True)

    def _chosen(self, formula: sp.Expr) -> list[sp.Expr]:
        return [self.cut.chosen(formula, 0.5 * (a + b)) for a, b in pairwise(self.cut.marks)]

    @cached_property
    def _main_pieces(self) -> list[sp.Expr]:
        return self._chosen(self.cut.formula.main)

    @cached_property
    def _weights(self) -> list[sp.Expr]:
        return self._chosen(self.cut.formula.adjacency)

    def place(self, at: fmpq | float) -> float:
        """Return the Euclidean distance that belongs to a value y of the formula's variable."""
        y = float(arb(at))
        return sqrt(max(y, 0.0) * (2.0 + self.eps * y)) if self.eps else y

    def _point(self, mark: sp.Expr, side: int) -> fmpq:
        """Return a rational number that bounds an interval end given as an expression, rounded outwards."""
        exact = mark.xreplace(self._numbers)
        if isinstance(exact, sp.Rational):
            return rational(exact)
        with precision(_BITS):
            ball = _value(exact)
            end = (ball.upper() if side else ball.lower()).man_exp()
        return fmpq(int(end[0])) * fmpq(2) ** int(end[1])

    def _regions(self, formulas: list[sp.Expr], *, split: bool = True) -> Iterator[Region]:
        """Yield formulas with their intervals between joints, also split at the desired distance."""
        length = self._declared("d")
        for formula, (left, right) in zip(formulas, pairwise(self._marks), strict=True):
            inside = self._point(left, 1) < self._point(length, 0) and self._point(length, 1) < self._point(right, 0)
            for a, b in pairwise([left, length, right] if split and inside else [left, right]):
                yield Region(formula, self._y, self._numbers, self._point(a, 0), self._point(b, 1), (a, b), self.place)

    def _inner(self) -> Iterator[Fact]:
        """Yield smoothness faults of a pair law inside the intervals between joints of its pieces."""
        forces, name = self.cut.formula.forces, "the force" if self.cut.formula.forces else "the potential"
        energy = self.strength * self.cut.end
        scales = (self.strength, self.strength / self.cut.end) if forces else (energy, self.strength)
        for formulas, part_text, (scale, slope), kinks in (
            (self._main_pieces, name, scales, "" if forces else "the force"),
            (self._weights, "the adjacency", (self.tallest, self.tallest / self.cut.end), ""),
        ):
            for k, region in enumerate(self._regions(formulas, split=False)):
                if k == 0:
                    width, is_clear = self._clear(region)
                    region = region._replace(left=width)
                    if not is_clear:
                        text = f"whether {part_text} is smooth near contact is open"
                        yield Fact("assumed", text, (0.0, self.place(width)), float(arb(width)))
                for fact in smooth_on(region, part_text, scale, slope, kinks=kinks):
                    is_last = k == len(formulas) - 1 and fact.witness and fact.witness[1] >= self.place(self.cut.end)
                    is_at_end = fact.status == "unmet" and is_last and "no limit" in fact.detail
                    text = f"{part_text} has a pole at the range, s = {self.place(self.cut.end):g}"
                    yield Fact("unmet", text, fact.witness) if is_at_end else fact

    def _clear(self, region: Region) -> tuple[fmpq, bool]:
        """Return the distance from which a formula is checked, and whether it is analytic below that."""
        for halving in _NEAR:
            width = region.right / 2**halving
            with precision(_BITS, 2):
                if region.enclosed.series(interval(fmpq(0), width)) is not None:
                    return fmpq(0), True
                if germ(region.exact, self._y, width) is not None:
                    return width, True
        return region.right / 2 ** _NEAR[-1], False

    def _joints(self) -> Iterator[Fact]:
        """Yield jumps of force, adjacency or potential at the joints between pieces of a pair law."""
        forces, energy = self.cut.formula.forces, self.strength * self.cut.end
        slopes = self._main_pieces if forces else [sp.diff(main_piece, self._y) for main_piece in self._main_pieces]
        rows = [(slopes, "the force", self.strength), (self._weights, "the adjacency", self.tallest)]
        rows += [] if forces else [(self._main_pieces, "the potential", energy)]
        for k, mark in enumerate(self._marks[1:-1]):
            position = self.place(self.cut.marks[k + 1])
            for row, name, scale in rows:
                gap = (row[k] - row[k + 1]).subs(self._y, mark)
                yield from self._vanishes(gap, scale, position, f"{name} jumps at s = {position:g}")

    def _end(self) -> Iterator[Fact]:
        """Yield a fault if the force or the adjacency does not vanish at the range."""
        main, position = self._main_pieces[-1], self.place(self.cut.end)
        force = main if self.cut.formula.forces else sp.diff(main, self._y)
        for what, name, scale in ((force, "force", self.strength), (self._weights[-1], "adjacency", self.tallest)):
            text = f"the {name} does not vanish at the range, s = {position:g}"
            yield from self._vanishes(what.subs(self._y, self._marks[-1]), scale, position, text)

    def _vanishes(self, number: sp.Expr, scale: float, place: float, fault: str) -> Iterator[Fact]:
        """Yield a fault unless a number is 0: unmet if nonzero beyond rounding, else assumed."""
        zero = is_zero(number, self._numbers)
        if zero:
            return
        status: FactStatus = "assumed"
        text = f"open is whether {fault}"
        if zero is False:
            with precision(_BITS):
                fault_size = abs(_value(number.xreplace(self._numbers)))
            text = f"{fault} by {float(fault_size):.2g}, as by rounding of a parameter"
            if fault_size > _SMALL * scale:
                status, text = "unmet", fault
        yield Fact(status, text, (place, place))

    def _signs(self) -> tuple[Fact, Fact]:
        """Return facts whether the adjacency is nonnegative, and positive below the range."""
        signs = []
        for region in self._regions([_factored(weight, self._y) for weight in self._weights]):
            if region.left == 0 and self._limit(region.exact) is None:
                fact, width = self._sign_near(region)
                signs.append((fact, fact))
                if fact.status == "assumed":
                    continue
                region = region._replace(left=width)
            signs.append(sign_on(region, "the adjacency"))
            signs += [(Fact("met"), fact) for fact in self._zeros(region)]
        weights, inside_facts = zip(*signs, strict=True)
        text = "its sign is enclosed at every distance"
        return conjunction(weights, text), conjunction(inside_facts, f"{text} below the range")

    def _zeros(self, region: Region) -> Iterator[Fact]:
        """Yield a fault for each interval end, except contact and range, where the adjacency may vanish."""
        for end, end_place in zip(region.ends, (region.left, region.right), strict=True):
            zero = is_zero(region.expression.subs(self._y, end), self._numbers)
            if end not in (self._marks[0], self._marks[-1]) and zero is not False:
                position = self.place(end_place)
                status: FactStatus = "unmet" if zero else "assumed"
                yield Fact(status, f"the adjacency vanishes at s = {position:.6g}", (position, position))

    def _sign_near(self, region: Region) -> tuple[Fact, fmpq]:
        """Return the sign near contact of a formula without a value there, and its validity width."""
        for halving in _NEAR:
            width = region.right / 2**halving
            with precision(_BITS):
                start, falls = (germ(item, self._y, width) for item in (region.exact, sp.diff(region.exact, self._y)))
                end = region.enclosed.series(arb(width))
            fault = Fact("unmet", "the adjacency is negative near contact", (0.0, self.place(width)))
            if start is not None and not start.factor.contains(0):
                return Fact("met") if start.factor > 0 else fault, width
            if falls is None or end is None or falls.factor.contains(0) or end[0].contains(0):
                continue
            if (falls.factor < 0) == (end[0] > 0):  # it rises to contact from above 0, or falls to it from below
                return Fact("met") if end[0] > 0 else fault, width
        return Fact("assumed", "whether the adjacency is negative near contact is open", (0.0, 0.0)), region.left

    def _limit(self, formula: sp.Expr) -> arb | None:
        """Return the value of a formula at contact, or None if it is not analytic there."""
        enclosed_formula = Enclosed(formula, self._y)
        with precision(_BITS, 2):
            if enclosed_formula.series(interval(fmpq(0), fmpq(1) / 2**_CLOSE)) is None:
                return None
            values = enclosed_formula.series(arb(0))
        return None if values is None else values[0]

    def _energies(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return bounds of the least potential and of the potential at contact."""
        scale = self.strength * self.cut.end
        if self.cut.formula.forces:
            regions = list(self._regions(self._main_pieces))
            return least_of_integral(regions, self._point(self._declared("d"), 0), scale)
        first_region, *later_regions = regions = list(self._regions(self._main_pieces))
        contact_value, minimum, left = self._contact(first_region)
        minima = [minimum, *(least_on(region, scale) for region in (first_region._replace(left=left), *later_regions))]
        low, high = min(item.low for item in minima), min(item.high for item in minima)
        return self._sharpened(regions, low, high), contact_value

    def _sharpened(self, regions: list[Region], low: float, high: float) -> tuple[float, float]:
        """Return bounds of the least potential, exact if the least value is at a declared distance."""
        scale = self.strength * self.cut.end
        for value in (region.expression.subs(self._y, end) for region in regions for end in region.ends):
            with precision(_BITS):
                series = Enclosed(value.xreplace(self._numbers), sp.Dummy()).series(arb(0))
            if series is None or not abs(float(series[0]) - high) <= 1e-9 * max(abs(high), scale):
                continue
            rest = [region._replace(expression=_factored(region.expression - value, self._y)) for region in regions]
            if all(sign_on(item, "")[0].status == "met" for item in rest):
                return down(series[0]), up(series[0])
        return low, high

    def _contact(self, region: Region) -> tuple[tuple[float, float], Least, fmpq]:
        """Return a potential's bounds at contact, its least value nearby, and where checking starts."""
        formula, y = region.exact, self._y
        value = self._limit(formula)
        if value is not None:
            bounds = (down(value), up(value))
            return bounds, Least(*bounds, 0.0), fmpq(0)
        slope = sp.diff(formula, y)
        for halving in _NEAR:
            width = region.right / 2**halving
            with precision(_BITS):
                falls, germ_s = germ(slope, y, width), germ(formula, y, width)
                end = Enclosed(formula, y).series(arb(width))
            if falls is None or end is None or falls.factor.contains(0):
                continue
            least_at_width = Least(down(end[0]), up(end[0]), self.place(width))
            if falls.power <= -1:
                level = inf if falls.factor < 0 else -inf
                return (level, level), least_at_width if level > 0 else Least(-inf, -inf, 0.0), width
            limit = self._close(formula, falls) or (None if germ_s is None else _bounds(germ_s))
            if limit is None:
                continue
            return limit, least_at_width if falls.factor < 0 else Least(*limit, 0.0), width
        if (
            germ_s is not None and (limit := _bounds(germ_s)) is not None
        ):  # of the narrowest, whose slope has no sign known
            with precision(_BITS):
                power = (arb(width).log() * arb(rational(germ_s.power))).exp()
                low = down(germ_s.factor * arb(0).union(power) if germ_s.power > 0 else germ_s.factor)
            return limit, Least(min(low, limit[0]), limit[1], 0.0), width
        return (-inf, inf), Least(-inf, inf, 0.0), width

    def _close(self, formula: sp.Expr, slope: Germ) -> tuple[float, float] | None:
        """Return bounds of a potential's limit at contact, from a nearby value and a slope bound."""
        width = fmpq(1) / 2**_CLOSE
        with precision(4 * _CLOSE):
            end = Enclosed(formula, self._y).series(arb(width))
            power = arb(rational(slope.power)) + 1
            if end is None or not power > 0:
                return None
            change = slope.factor * (arb(width).log() * power).exp() / power
            limit = end[0] - arb(0).union(change)
            return down(limit), up(limit)


def _value(number: sp.Expr) -> arb:
    series = Enclosed(number, sp.Dummy()).series(arb(0))
    return arb.nan() if series is None else series[0]


def _bounds(own: Germ) -> tuple[float, float] | None:
    if own.power > 0:
        return 0.0, 0.0
    low, high = down(own.factor), up(own.factor)
    return (low, high) if own.power == 0 and isfinite(low) and isfinite(high) else None


def _factored(formula: sp.Expr, y: sp.Symbol) -> sp.Expr:
    """Return a polynomial as a product with visible double zeros."""
    is_short = formula.is_polynomial(y) and formula.is_Add and len(formula.free_symbols) < 4
    return sp.factor(formula) if is_short and sp.degree(formula, y) <= 16 else formula


def slope_bounds(
    cut: PiecewiseFormula, eps: float, r: float, places: list[float], parts: int
) -> Iterator[tuple[float, float, float, float]]:
    """Yield subintervals of the range of a pair law, with bounds of |dF/ds| and |da/ds| on each."""
    numbers = exact_numbers(cut.numbers, eps)
    root = sp.sqrt(1 + EPS * S**2)
    norm, inner_slope = ((root - 1) / EPS, S / root) if eps else (S, sp.Integer(1))
    edges = sorted({r * k / parts for k in range(parts)} | {*places, r})
    for left, right in pairwise(edges):
        midpoint = 0.5 * (left + right)
        at = midpoint * midpoint / ((1.0 + eps * midpoint * midpoint) ** 0.5 + 1.0) if eps else midpoint
        main, weight = (cut.chosen(item, at).subs(Z, norm) for item in (cut.formula.main, cut.formula.adjacency))
        force, order = (main * inner_slope, 1) if cut.formula.forces else (main, 2)
        rows = (Enclosed(force.xreplace(numbers), S), order), (Enclosed(weight.xreplace(numbers), S), 1)
        rational_ends = fmpq(*left.as_integer_ratio()), fmpq(*right.as_integer_ratio())
        force_slope, adjacency_slope = (order * _most(of, order, *rational_ends, 0) for of, order in rows)
        yield left, right, force_slope, adjacency_slope


def _most(of: Enclosed, order: int, left: fmpq, right: fmpq, depth: int) -> float:
    """Return an upper bound of the size of a formula's Taylor coefficient on an interval."""
    midpoint = (left + right) / 2
    with precision(_SLOPE_BITS, order + 1):
        series, at = of.series(interval(left, right)), of.series(arb(midpoint))
        if series is not None and at is not None and series[order].abs_upper() <= 2 * at[order].abs_upper():
            return up(series[order].abs_upper())
    if depth >= _SLOPE_HALVINGS:
        return inf if series is None else up(series[order].abs_upper())
    return max(_most(of, order, *interval_ends, depth + 1) for interval_ends in ((left, midpoint), (midpoint, right)))
