"""Decisions about a formula over an interval by branch and bound: smoothness, sign, least value or integral.

Intervals are halved until an enclosure decides. What decides is the number of intervals, never the clock, so that the
answer is the same on every machine.
"""

import heapq
from collections.abc import Callable
from functools import reduce
from itertools import count
from math import inf, nextafter
from typing import NamedTuple

import sympy as sp
from flint import arb, fmpq

from flockana.base.function_facts import Fact
from flockana.symbolic.formula_enclosures import NONNEGATIVE, POSITIVE, Enclosed, interval, precision

MOST = 6000  # intervals looked at
_DEEPEST = 130  # halvings; then the point is looked at from both sides
_FEW = 4  # points that stay open
_SEEN = 1e-6  # of the scale: a change within less than 1e-15 of the interval that counts as a jump
_STRICT = 12  # halvings, for a sign that is not certainly strict
_ORDERS = 8  # of the first derivative that is not 0
_CLOSED, _CLOSED_OF_SCALE = 1e-13, 1e-15  # to which a least value is known, relative to it or to the scale
_NARROWEST = 80  # halvings of an interval on which a least value is sought
_BITS = 96
_INTEGRAL_BITS, _TERMS = 128, 10  # of Taylor integrals with enclosed remainders
_PARTS, _FINEST = 4000, 40  # intervals of a region, and halvings
_EXACT = 1e-15  # of the scale: remainder of an interval
_UNKNOWN = ((-inf, inf), (-inf, inf))
Bounds = tuple[float, float]


def down(x: arb) -> float:
    """Return a float that is a lower bound of a ball of ball arithmetic."""
    value = float(x.lower())
    return value if arb(value) <= x.lower() else nextafter(value, -inf)


def up(x: arb) -> float:
    """Return a float that is an upper bound of a ball of ball arithmetic."""
    return 0.0 - down(-x)


def is_zero(expression: sp.Expr, numbers: dict[sp.Symbol, sp.Expr]) -> bool | None:
    """Return whether a symbolic number is 0, by algebra or by an enclosure; None if undecided."""
    exact = expression.xreplace(numbers)
    if expression == 0 or exact == 0:
        return True
    with precision(600):
        value = Enclosed(exact, sp.Dummy()).series(arb(0))
    if value is not None and not value[0].contains(0):
        return False
    return True if value is not None and 0 in (sp.expand(exact), sp.expand(sp.together(exact))) else None


class Region(NamedTuple):
    """Formula with numbers for its parameters, on an interval of its variable.

    `left` and `right` hold the exact points `ends` between them; `place` gives the distance for messages.
    """

    expression: sp.Expr
    variable: sp.Symbol
    numbers: dict[sp.Symbol, sp.Expr]
    left: fmpq
    right: fmpq
    ends: tuple[sp.Expr, sp.Expr]
    place: Callable[[fmpq], float]

    @property
    def exact(self) -> sp.Expr:
        """Formula with the numbers of its parameters inserted."""
        return self.expression.xreplace(self.numbers)

    def between(self, left: fmpq, right: fmpq) -> tuple[float, float]:
        """Return the distances between agents at the two ends of an interval, for messages."""
        return self.place(left), self.place(right)

    @property
    def enclosed(self) -> Enclosed:
        """Formula as a function in ball arithmetic."""
        return Enclosed(self.exact, self.variable)


def smooth_on(region: Region, name: str, scale: float, slope: float, *, kinks: str = "") -> list[Fact]:
    """Return reasons why a formula is, or may be, not analytic on a closed interval; empty if analytic."""
    of, whole = region.enclosed, region.right - region.left
    open_: list[Fact] = []
    stack, looked = [(region.left, region.right, 0)], 0
    while stack and looked < MOST and len(open_) < _FEW:
        left, right, depth = stack.pop()
        looked += 1
        with precision(64 + 4 * depth, 2):
            if of.series(interval(left, right)) is not None:
                continue
        if depth < _DEEPEST:
            midpoint = (left + right) / 2
            stack += [(midpoint, right, depth + 1), (left, midpoint, depth + 1)]
            continue
        fact = _visible_faults(of, region, (left + right) / 2, name, (scale, slope), kinks)
        if fact.status == "unmet":
            return [fact]
        open_.append(fact)
    rest = sum(_float(right - left) for left, right, _ in stack)
    if rest:
        text = f"whether {name} is smooth is open from s = {region.place(stack[-1][0]):.6g} on"
        open_.append(Fact("assumed", text, region.between(stack[-1][0], stack[0][1]), rest))
    elif open_:
        open_[0] = Fact("assumed", open_[0].detail, open_[0].witness, len(open_) * _float(whole) * 2.0**-_DEEPEST)
    return open_[:1] if not rest else open_[-1:]


def _float(x: fmpq) -> float:
    return float(arb(x))


def _visible_faults(of: Enclosed, region: Region, at: fmpq, name: str, scales: tuple[float, float], kinks: str) -> Fact:
    """Return a formula's fault near a point: a jump, pole, kink or missing value, or that it is open."""
    region_width, position = region.right - region.left, region.place(at)
    near_step, far_step = region_width / 2**100, region_width / 2**50
    sides: list[list[list[arb] | None]] = []
    witness = region.between(max(at - near_step, region.left), min(at + near_step, region.right))
    with precision(900, 2):
        for sign in (-1, 1):
            points = [at + sign * step for step in (near_step, far_step)]
            if region.left <= points[0] <= region.right:
                sides.append([of.series(arb(point)) for point in points])
    if any(all(values is None for values in side) for side in sides):
        return Fact("unmet", f"{name} has no finite real value at s = {position:.6g}", witness)
    if any(None in side for side in sides):
        return Fact("assumed", f"whether {name} is defined at s = {position:.6g} is open", witness)
    for order, (scale, word) in enumerate(zip(scales, (name, kinks), strict=True)):
        if not word:
            continue
        threshold = _SEEN * (scale or 1.0)
        changes = [abs(side[0][order] - side[1][order]) for side in sides]  # type: ignore[index]
        if any(change > threshold for change in changes):
            return Fact("unmet", f"{word} has no limit at s = {position:.6g}", witness)
        if len(sides) == 2 and abs(sides[0][0][order] - sides[1][0][order]) > threshold:  # type: ignore[index]
            return Fact("unmet", f"{word} jumps at s = {position:.6g}", witness)
    return Fact("assumed", f"whether {name} is smooth at s = {position:.6g} is open", witness)


def sign_on(region: Region, name: str) -> tuple[Fact, Fact]:
    """Return the fact whether a formula is nonnegative on an interval, and positive inside."""
    if region.expression == 0:
        return Fact("met", f"{name} is 0"), Fact("unmet", f"{name} is 0", region.between(region.left, region.right))
    left, right = region.left, region.right
    for side in (0, 1):
        sign, width = _at_end(region, side)
        if sign < 0:
            box = (left, left + width) if side == 0 else (right - width, right)
            text = f"{name} is negative beside s = {region.place(box[side]):.6g}"
            return (Fact("unmet", text, region.between(*box)),) * 2
        left, right = (left + width, right) if side == 0 else (left, right - width)
    return _sign_inside(region, left, right, name)


def _at_end(region: Region, side: int) -> tuple[int, fmpq]:
    """Return a formula's sign near an interval end where it vanishes, and that width; else (0, 0)."""
    derivative, region_width = region.expression, region.right - region.left
    end = region.ends[side]
    order = 0
    while (zero := is_zero(derivative.subs(region.variable, end), region.numbers)) and order < _ORDERS - 1:
        derivative, order = sp.diff(derivative, region.variable), order + 1
    if zero is not False or order == 0:
        return 0, fmpq(0)
    enclosed_expression = region.enclosed
    for halving in range(2, 60):
        width = region_width / 2**halving
        ball = interval(region.left, region.left + width) if side == 0 else interval(region.right - width, region.right)
        with precision(_BITS + halving, order + 1):
            series = enclosed_expression.series(ball)
        if series is not None and not series[order].contains(0):
            sign = 1 if series[order] > 0 else -1
            return sign * (-1) ** (order * side), width
    return 0, fmpq(0)


def _sign_inside(region: Region, left: fmpq, right: fmpq, name: str) -> tuple[Fact, Fact]:
    of = region.enclosed
    stack, weak, search_count = [(left, right, 0)], [], 0
    while stack and search_count <= MOST:
        left, right, depth = stack.pop()
        search_count += 1
        with precision(_BITS + 2 * depth, 2):
            sign = _sign_of(of, left, right)
            midpoint = (left + right) / 2
            at = of.series(arb(midpoint))
            if at is not None and at[0] < 0:
                position = region.place(midpoint)
                return (Fact("unmet", f"{name} is {float(at[0]):.3g} at s = {position:.6g}", (position, position)),) * 2
        if sign == POSITIVE or (sign == NONNEGATIVE and depth >= _STRICT):
            weak += [(left, right)] * (sign == NONNEGATIVE)
            continue
        if depth >= _DEEPEST:
            stack.append((left, right, depth))
            break
        stack += [(midpoint, right, depth + 1), (left, midpoint, depth + 1)]
    if stack:
        where, open_width = region.between(stack[-1][0], stack[0][1]), sum(_float(b) - _float(a) for a, b, _ in stack)
        text = f"whether {name} is negative is open from s = {where[0]:.6g} on"
        return (Fact("assumed", text, where, open_width),) * 2
    fact = Fact("met", f"{name} is enclosed at every distance")
    if not weak:
        return fact, fact
    where, width = region.between(weak[0][0], weak[-1][1]), sum(_float(b) - _float(a) for a, b in weak)
    return fact, Fact("assumed", f"whether {name} vanishes is open near s = {where[0]:.6g}", where, width)


def _sign_of(of: Enclosed, left: fmpq, right: fmpq) -> int:
    """Return the certain sign of a formula on an interval, by its enclosure or by its end values."""
    ball = interval(left, right)
    sign, series = of.sign(ball), of.series(ball)
    if sign == POSITIVE or series is None or series[1].contains(0):
        return sign
    lower = of.series(arb(left if series[1] > 0 else right))
    if lower is None or not lower[0] >= 0:
        return sign
    return POSITIVE if lower[0] > 0 else NONNEGATIVE


class Least(NamedTuple):
    """Bounds of a formula's least value, and the position that gives the upper bound."""

    low: float
    high: float
    at: float


def least_on(region: Region, scale: float) -> Least:
    """Return bounds of a formula's least value on an interval; −∞ as lower bound where undefined."""
    enclosed_expression, number = region.enclosed, count(0, -1)  # of two that are as low the later first
    best, where, search_count = arb.pos_inf(), region.left, 0
    heap: list[tuple[float, int, fmpq, fmpq]] = []

    def bound_part(left: fmpq, right: fmpq) -> None:
        nonlocal best, where
        low, high, position = _lowest(enclosed_expression, left, right)
        if high < best:
            best, where = high, position
        heapq.heappush(heap, (down(low) if low.is_finite() else -inf, next(number), left, right))

    with precision(_BITS, 3):
        bound_part(region.left, region.right)
        while search_count < MOST // 2:
            search_count += 1
            low, _, left, right = heap[0]
            is_low = low >= down(best) - max(_CLOSED_OF_SCALE * scale, _CLOSED * abs(down(best)))
            if is_low or (right - left) * 2**_NARROWEST < region.right - region.left:
                break
            heapq.heappop(heap)
            midpoint = (left + right) / 2
            bound_part(left, midpoint)
            bound_part(midpoint, right)
        return Least(min(heap[0][0], down(best)), up(best), region.place(where))


def _lowest(of: Enclosed, left: fmpq, right: fmpq) -> tuple[arb, arb, fmpq]:
    """Return a formula's lower bound on an interval, one of its values there, and that value's position."""
    midpoint = (left + right) / 2
    series, midpoint_series = of.series(interval(left, right)), of.series(arb(midpoint))
    lowest_value = arb.pos_inf() if midpoint_series is None else midpoint_series[0].upper()
    if series is None:
        return arb.neg_inf(), lowest_value, midpoint
    if not series[1].contains(0):
        end = left if series[1] > 0 else right
        value = of.series(arb(end))
        if value is not None:
            return value[0].lower(), value[0].upper(), end
    low = series[0].lower()
    if midpoint_series is not None:
        deviation = interval(left - midpoint, right - midpoint)
        squared_value = (deviation * deviation).nonnegative_part()
        low = low.max((midpoint_series[0] + midpoint_series[1] * deviation + series[2] * squared_value).lower())
    return low, lowest_value, midpoint


def least_of_integral(regions: list[Region], anchor: fmpq, scale: float) -> tuple[Bounds, Bounds]:
    """Return bounds of an integral's least value and of its value at the left end; 0 at the anchor."""
    total, at_anchor, lows, highs = arb(0), None, [arb(0)], [arb(0)]
    with precision(_INTEGRAL_BITS, _TERMS):
        for region in regions:
            if abs(float(arb(region.left - anchor))) <= 1e-20 * float(arb(region.right)):
                at_anchor = total
            parts = _taylor_parts(region, scale)
            if parts is None:
                return _UNKNOWN
            for piece_integral, slope, width in parts:
                if slope.contains(0):
                    lows.append((total + arb(0).union(slope * width)).lower())
                total += piece_integral
                lows.append(total.lower())
                highs.append(total.upper())
        if at_anchor is None:
            at_anchor = total
        minimum, maximum = reduce(arb.min, lows), reduce(arb.min, highs)
        return (down(minimum - at_anchor), up(maximum - at_anchor)), (down(-at_anchor), up(-at_anchor))


def _taylor_parts(region: Region, scale: float) -> list[tuple[arb, arb, arb]] | None:
    """Return integrals, ranges and widths of subintervals on which Taylor's formula is exact to rounding."""
    of, parts = region.enclosed, []
    stack = [(region.left, region.right, 0)]
    while stack:
        left, right, depth = stack.pop()
        midpoint, half = (left + right) / 2, (right - left) / 2
        series, at = of.series(interval(left, right)), of.series(arb(midpoint))
        if series is not None and at is not None:
            whole = sum((2 * at[k] * arb(half) ** (k + 1) / (k + 1) for k in range(0, _TERMS - 1, 2)), arb(0))
            rest = 2 * arb(half) ** _TERMS / _TERMS * series[_TERMS - 1].abs_upper()
            crosses = series[0].contains(0) and float((series[0].abs_upper() * arb(2 * half)).upper()) > _EXACT * scale
            if float(rest) <= _EXACT * scale and not (crosses and depth < _FINEST):
                parts.append((whole + arb(0, rest), series[0], arb(2 * half)))
                continue
        if depth >= _FINEST or len(parts) + len(stack) > _PARTS:
            return None
        stack += [(midpoint, right, depth + 1), (left, midpoint, depth + 1)]
    return parts
