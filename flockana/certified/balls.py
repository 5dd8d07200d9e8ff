"""Ball arithmetic (Arb): exact numbers, ranges of monotone functions, and the exact parameters of pair laws.

An argument is an `arb` ball, or an exact number (int, Fraction, fmpq; a float counts with its binary value): the result
contains the function's values on all of it. Comparisons of balls are true only if certain. Work at a precision of your
choice, ``with flint.ctx.workdps(40): ...``. Squares of balls around 0 by `square`: ``x**2`` gives nan there.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from typing import Any, Self

from flint import acb, arb, arb_series, ctx, fmpq

from flockana.base.interrupts import ALARMS, defer_sigint


class Piece(Enum):
    """Interval of distances on which the bump function ρ_h is analytic, or the case between two."""

    CORE = "z < h r_α"
    TAPER = "h r_α < z < r_α"
    OUT = "z > r_α"
    SWITCH = "about a distance where pieces meet"


def ball(x: Any) -> arb:
    """Return an exact number or a ball as a ball of the current precision."""
    return arb(fmpq(x.numerator, x.denominator)) if isinstance(x, Fraction) else arb(x)


def exact(x: Any) -> fmpq:
    """Return a number as the rational of its printed decimal, 0.1 = 1/10."""
    fraction = Fraction(str(x))
    return fmpq(fraction.numerator, fraction.denominator)


def hull(*balls: arb) -> arb:
    """Return the smallest ball that contains all given balls."""
    first_ball, *later_balls = balls
    for item in later_balls:
        first_ball = first_ball.union(item)
    return first_ball


def square(x: Any) -> Any:
    """Return x² of a ball, never below 0, or of a series."""
    return (x * x).nonnegative_part() if isinstance(x, arb) else x * x


def integrate(function: Callable[[Any, bool], Any], start: arb, end: arb) -> arb:
    """Return the integral of an analytic function by Arb; signals are handled afterwards."""
    with defer_sigint(*ALARMS):
        return acb.integral(function, start, end).real


def dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    """Return ⟨a, b⟩ of balls or of series."""
    products = [x * y for x, y in zip(a, b, strict=True)]
    return sum(products[1:], products[0])


def minus(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    """Return a − b of balls or of series."""
    return [x - y for x, y in zip(a, b, strict=True)]


def norm2(x: Sequence[Any]) -> Any:
    """Return ‖x‖² of balls, never below 0, or of series."""
    return sum(map(square, x[1:]), square(x[0]))


def norm(x: Sequence[arb]) -> arb:
    """Return ‖x‖ of balls, never below 0."""
    return norm2(x).nonnegative_part().sqrt()


def monotone(f: Callable[[Any], Any], x: Any) -> Any:
    """Return the range of a monotone function on a ball, from the ball's ends; on a series, its value."""
    return f(x) if not isinstance(x, arb) or x.is_exact() else hull(f(x.lower()), f(x.upper()))


def clamp(x: arb) -> arb:
    """Return the number of [0, 1] that is nearest to a given one."""
    return x.max(arb(0)).min(arb(1))


def place(z: Any, h: arb, piece: Piece) -> Any:
    """Return the position in [0, 1] of a σ-norm on the taper of ρ_h, as a ball or as a series."""
    if piece is Piece.CORE and not isinstance(z, arb):
        return arb_series([0])
    taper_position = (z - h) / (1 - h)
    return clamp(taper_position) if isinstance(z, arb) else taper_position


@contextmanager
def series_length(length: int) -> Iterator[None]:
    """Set the length of power series inside the block."""
    previous_cap, ctx.cap = ctx.cap, length
    try:
        yield
    finally:
        ctx.cap = previous_cap


class _Exact:
    """Base class of bundles of exact rational numbers, given as printed decimals."""

    def __post_init__(self) -> None:
        for name in vars(self):
            object.__setattr__(self, name, exact(getattr(self, name)))
        self._ensure_valid()

    def _ensure_valid(self) -> None:
        """Raise ValueError if a parameter is out of its admissible range."""

    @classmethod
    def of(cls, interaction: Any) -> Self:
        """Return the parameters of an interaction as exact decimals."""
        return cls(**{name: getattr(interaction, name) for name in cls.__annotations__})

    def __str__(self) -> str:
        return ", ".join(f"{name} = {value}" for name, value in vars(self).items())


@dataclass(frozen=True)
class AlphaParameters(_Exact):
    """Parameters of the α-pair law."""

    d: fmpq = 7
    r: fmpq = "8.4"
    eps: fmpq = "0.1"
    h: fmpq = "0.2"
    a: fmpq = 5
    b: fmpq = 5

    def _ensure_valid(self) -> None:
        if not (0 < self.d < self.r and self.eps > 0 and 0 < self.h < 1 and 0 < self.a <= self.b):
            raise ValueError(f"{self}: expected 0 < d < r, eps > 0, 0 < h < 1, 0 < a <= b")


@dataclass(frozen=True)
class BetaParameters(_Exact):
    """Parameters of the β-pair law: d' (here d), ε and h."""

    d: fmpq = "4.2"
    eps: fmpq = "0.1"
    h: fmpq = "0.9"

    def _ensure_valid(self) -> None:
        if not (self.d > 0 and self.eps > 0 and 0 < self.h < 1):
            raise ValueError(f"{self}: expected d > 0, eps > 0, 0 < h < 1")
