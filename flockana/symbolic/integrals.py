"""Bounds of a potential given by its slope: sums of Taylor integrals with enclosed remainders."""

from functools import reduce
from math import inf

from flint import arb, fmpq

from flockana.symbolic.decide import Region, down, up
from flockana.symbolic.enclosed import interval, precision

_TERMS = 10
_MOST = 4000  # intervals of a region
_EXACT = 1e-15  # of the scale: remainder of an interval
_HALVINGS = 40
_BITS = 128
_UNKNOWN = ((-inf, inf), (-inf, inf))
Bounds = tuple[float, float]


def least_of_integral(regions: list[Region], anchor: fmpq, scale: float) -> tuple[Bounds, Bounds]:
    """Return bounds of an integral's least value and of its value at the left end; it is 0 at the anchor."""
    total, at_anchor, lows, highs = arb(0), None, [arb(0)], [arb(0)]
    with precision(_BITS, _TERMS):
        for region in regions:
            if abs(float(arb(region.left - anchor))) <= 1e-20 * float(arb(region.right)):
                at_anchor = total
            parts = _parts(region, scale)
            if parts is None:
                return _UNKNOWN
            for whole, slope, width in parts:
                if slope.contains(0):
                    lows.append((total + arb(0).union(slope * width)).lower())
                total += whole
                lows.append(total.lower())
                highs.append(total.upper())
        if at_anchor is None:
            at_anchor = total
        least, most = reduce(arb.min, lows), reduce(arb.min, highs)
        return (down(least - at_anchor), up(most - at_anchor)), (down(-at_anchor), up(-at_anchor))


def _parts(region: Region, scale: float) -> list[tuple[arb, arb, arb]] | None:
    """Return integral, range and width of intervals on which Taylor's formula is exact to rounding."""
    of, parts = region.enclosed, []
    stack = [(region.left, region.right, 0)]
    while stack:
        left, right, depth = stack.pop()
        middle, half = (left + right) / 2, (right - left) / 2
        found, at = of.series(interval(left, right)), of.series(arb(middle))
        if found is not None and at is not None:
            whole = sum((2 * at[k] * arb(half) ** (k + 1) / (k + 1) for k in range(0, _TERMS - 1, 2)), arb(0))
            rest = 2 * arb(half) ** _TERMS / _TERMS * found[_TERMS - 1].abs_upper()
            crosses = found[0].contains(0) and float((found[0].abs_upper() * arb(2 * half)).upper()) > _EXACT * scale
            if float(rest) <= _EXACT * scale and not (crosses and depth < _HALVINGS):
                parts.append((whole + arb(0, rest), found[0], arb(2 * half)))
                continue
        if depth >= _HALVINGS or len(parts) + len(stack) > _MOST:
            return None
        stack += [(middle, right, depth + 1), (left, middle, depth + 1)]
    return parts
