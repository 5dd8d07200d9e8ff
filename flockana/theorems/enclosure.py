"""Interval arithmetic on observables: two ends of each number, with a best value between."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray

_ULPS = 4  # by which exp, log and powers of a processor's library may be off

Real = Any  # a number, an array or an Enclosure


@dataclass(frozen=True, eq=False)
class Enclosure:
    """Interval for each entry of an array: the quantity lies in [lo, hi], and `mid` is its best value.

    All operations round outwards, so that a formula on enclosures encloses the formula. An end that is NaN, such as
    ∞ − ∞, becomes infinite. Sums and differences that are exactly 0 stay 0.
    """

    lo: Real
    mid: Real
    hi: Real

    __array_ufunc__ = None  # a numpy array on the left leaves the operation to this class

    def __post_init__(self) -> None:
        midpoint = np.asarray(self.mid, dtype=np.float64)
        lo, hi = (np.broadcast_to(np.asarray(end, dtype=np.float64), midpoint.shape) for end in (self.lo, self.hi))
        lo, hi = np.where(np.isnan(lo), -np.inf, lo), np.where(np.isnan(hi), np.inf, hi)
        if (lo > hi).any():
            raise ArgumentError(f"lo = {lo[lo > hi][0]:g} above hi = {hi[lo > hi][0]:g}: expected lo <= hi")
        for name, value in (("lo", lo), ("mid", midpoint), ("hi", hi)):
            object.__setattr__(self, name, value)

    @classmethod
    def of(cls, x: Real) -> Enclosure:
        """Return an enclosure unchanged, or the enclosure of exact numbers."""
        return x if isinstance(x, Enclosure) else cls(x, x, x)

    @classmethod
    def around(cls, value: Real, half_width: Real = 0.0) -> Enclosure:
        """Return the enclosure of given half width around a value; an infinite or NaN half width covers all."""
        value, half = np.asarray(value, dtype=np.float64), np.asarray(half_width, dtype=np.float64)
        with np.errstate(invalid="ignore"):
            return _outward(value - half, value, value + half, exact=half == 0.0)

    @classmethod
    def between(cls, lo: Real, hi: Real) -> Enclosure:
        """Return the enclosure with given ends, with the middle or a finite end as best value."""
        lo, hi = np.asarray(lo, dtype=np.float64), np.asarray(hi, dtype=np.float64)
        with np.errstate(invalid="ignore"):
            midpoint = np.where(np.isinf(lo), hi, np.where(np.isinf(hi), lo, 0.5 * lo + 0.5 * hi))
        return cls(lo, midpoint, hi)

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the array of enclosed quantities."""
        return np.shape(self.mid)

    @property
    def half_width(self) -> FloatArray:
        """Distance from the best value to the farther end."""
        with np.errstate(invalid="ignore"):
            width: FloatArray = np.maximum(self.mid - self.lo, self.hi - self.mid)
        return np.where(np.isnan(width), np.inf, width)

    @property
    def worst(self) -> Enclosure:
        """Enclosed entry that decides whether all are nonnegative, as a scalar; 1 for an empty array."""
        if not self.mid.size:
            return Enclosure.of(1.0)
        k = self.worst_index
        return Enclosure(self.lo.ravel()[k], self.mid.ravel()[k], self.hi.ravel()[k])

    @property
    def worst_index(self) -> int:
        """Flat index of the most certainly negative entry, else of the nearest to being negative."""
        return int(np.argmin(self.hi if (self.hi < 0.0).any() else self.lo))

    def __getitem__(self, index: Any) -> Enclosure:
        return Enclosure(self.lo[index], self.mid[index], self.hi[index])

    def __neg__(self) -> Enclosure:
        return Enclosure(-self.hi, -self.mid, -self.lo)

    def __add__(self, other: Real) -> Enclosure:
        x = Enclosure.of(other)
        with np.errstate(invalid="ignore", over="ignore"):
            return _outward(self.lo + x.lo, self.mid + x.mid, self.hi + x.hi)

    def __sub__(self, other: Real) -> Enclosure:
        return self + (-Enclosure.of(other))

    def __rsub__(self, other: Real) -> Enclosure:
        return Enclosure.of(other) - self

    __radd__ = __add__

    def __mul__(self, other: Real) -> Enclosure:
        x = Enclosure.of(other)
        end_products = [_product(a, b) for a in (self.lo, self.hi) for b in (x.lo, x.hi)]
        exact = ((self.lo == 0.0) & (self.hi == 0.0)) | ((x.lo == 0.0) & (x.hi == 0.0))
        lo, hi = np.minimum.reduce(end_products), np.maximum.reduce(end_products)
        sign = ((self.lo >= 0.0) & (x.lo >= 0.0)) | ((self.hi <= 0.0) & (x.hi <= 0.0))
        product = _outward(lo, _product(self.mid, x.mid), hi, exact=exact, keep_zero=False)
        return Enclosure(np.where(sign, np.maximum(product.lo, 0.0), product.lo), product.mid, product.hi)

    __rmul__ = __mul__

    def __truediv__(self, other: Real) -> Enclosure:
        x = Enclosure.of(other)
        contains_zero = (x.lo <= 0.0) & (x.hi >= 0.0)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            inverse = _outward(
                np.where(contains_zero & (x.lo < 0.0), -np.inf, 1.0 / x.hi),
                1.0 / x.mid,
                np.where(contains_zero & (x.hi > 0.0), np.inf, 1.0 / x.lo),
            )
            quotient, midpoint = self * inverse, np.divide(self.mid, x.mid)
        return Enclosure(quotient.lo, midpoint, quotient.hi)

    def __rtruediv__(self, other: Real) -> Enclosure:
        return Enclosure.of(other) / self

    def __abs__(self) -> Enclosure:
        lo = np.where((self.lo <= 0.0) & (self.hi >= 0.0), 0.0, np.minimum(np.abs(self.lo), np.abs(self.hi)))
        return Enclosure(lo, np.abs(self.mid), np.maximum(np.abs(self.lo), np.abs(self.hi)))

    def square(self) -> Enclosure:
        """Return the enclosure of x² for an enclosed x, at least 0."""
        magnitude = abs(self)
        return magnitude * magnitude

    def sqrt(self) -> Enclosure:
        """Return √x of the nonnegative part of the enclosure."""
        return self.clip(0.0).rising(np.sqrt, ulps=1).clip(0.0)

    def exp(self) -> Enclosure:
        """Return the enclosure of e^x for an enclosed x."""
        return self.rising(np.exp).clip(0.0)

    def log(self) -> Enclosure:
        """Return ln x of the nonnegative part of the enclosure; -∞ if it contains 0."""
        return self.clip(0.0).rising(np.log)

    def rising(self, function: Callable[[FloatArray], Any], *, ulps: int = _ULPS) -> Enclosure:
        """Return the enclosure of a nondecreasing function's values, with ends rounded outwards."""
        with np.errstate(all="ignore"):
            lo, midpoint, hi = (np.asarray(function(end), dtype=np.float64) for end in (self.lo, self.mid, self.hi))
        return _outward(lo, midpoint, hi, ulps=ulps)

    def falling(self, function: Callable[[FloatArray], Any]) -> Enclosure:
        """Return the enclosure of a nonincreasing function's values, with ends rounded outwards."""
        return -self.rising(lambda x: -np.asarray(function(x), dtype=np.float64))

    def clip(self, least: float) -> Enclosure:
        """Return max(x, least) of the enclosure."""
        return Enclosure(*(np.maximum(end, least) for end in (self.lo, self.mid, self.hi)))

    def widened(self, by: Real) -> Enclosure:
        """Return the enclosure with both ends moved outwards by a number >= 0."""
        by = np.asarray(by, dtype=np.float64)
        with np.errstate(invalid="ignore"):
            return _outward(self.lo - by, self.mid, self.hi + by, exact=by == 0.0)

    def scaled_out(self, share: float) -> Enclosure:
        """Return the enclosure widened by a fraction of each end's size; infinite ends stay."""
        with np.errstate(invalid="ignore"):
            lo, hi = self.lo - share * np.abs(self.lo), self.hi + share * np.abs(self.hi)
        return Enclosure(np.where(np.isinf(self.lo), self.lo, lo), self.mid, np.where(np.isinf(self.hi), self.hi, hi))

    def max(self, axis: int | None = None) -> Enclosure:
        """Return the largest entry."""
        return Enclosure(*(end.max(axis=axis) for end in (self.lo, self.mid, self.hi)))

    def min(self, axis: int | None = None) -> Enclosure:
        """Return the smallest entry."""
        return Enclosure(*(end.min(axis=axis) for end in (self.lo, self.mid, self.hi)))

    def sum(self, axis: int | None = None) -> Enclosure:
        """Return the sum of all entries, widened by the rounding of its terms."""
        terms = self.mid.size if axis is None else self.mid.shape[axis]
        magnitudes = np.maximum(np.abs(self.lo), np.abs(self.hi)).sum(axis=axis)
        with np.errstate(invalid="ignore", over="ignore"):
            total = Enclosure(*(end.sum(axis=axis) for end in (self.lo, self.mid, self.hi)))
            return total.widened(terms * np.finfo(float).eps * magnitudes)

    def largest_so_far(self) -> Enclosure:
        """Return the running maximum along the first axis."""
        return Enclosure(*(np.maximum.accumulate(end, axis=0) for end in (self.lo, self.mid, self.hi)))


def stacked(enclosures: Any) -> Enclosure:
    """Return several enclosures along a new first axis."""
    terms = [Enclosure.of(x) for x in enclosures]
    return Enclosure(*(np.stack([getattr(x, end) for x in terms]) for end in ("lo", "mid", "hi")))


def _product(a: FloatArray, b: FloatArray) -> FloatArray:
    """Return the product of interval ends, with 0 times ∞ as 0."""
    with np.errstate(invalid="ignore", over="ignore", under="ignore"):
        product: FloatArray = a * b
    return np.where((a == 0.0) | (b == 0.0), 0.0, product)


def _outward(lo: Any, mid: Any, hi: Any, *, ulps: int = 1, exact: Any = False, keep_zero: bool = True) -> Enclosure:
    """Return an enclosure whose computed ends are moved outwards by their rounding; exact ends are kept."""
    lo, hi = np.asarray(lo, dtype=np.float64), np.asarray(hi, dtype=np.float64)
    lower_end, upper_end = lo, hi
    for _ in range(ulps):
        lower_end, upper_end = np.nextafter(lower_end, -np.inf), np.nextafter(upper_end, np.inf)
    is_exact: npt.NDArray[np.bool_] = np.asarray(exact, dtype=np.bool_)
    low_stays, high_stays = (is_exact | (end == 0.0) if keep_zero else is_exact for end in (lo, hi))
    return Enclosure(np.where(low_stays, lo, lower_end), mid, np.where(high_stays, hi, upper_end))
