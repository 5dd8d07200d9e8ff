"""One rigorous step of an ordinary differential equation: Lohner's method in ball arithmetic (Arb).

The set of possible states is x̂ + C r₀ + B r: a point, what is left of the start, and everything that was added since, each
in coordinates that turn with the flow. A step of the Taylor polynomial moves the point, its derivative the sets, and
the coordinates B are made orthogonal again, longest edge first (QR), so that boxes are not wrapped in boxes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from flint import arb, arb_mat

from flockana.certified.flow import Flow, Pieces
from flockana.certified.intervals import hull
from flockana.certified.krawczyk import column, identity, midpoints
from flockana.certified.series import Piece

_INFLATIONS = 12  # of a candidate enclosure, before a step is called too long
_GRAIN = arb(2) ** -64  # relative: by which a candidate of no width is made wider
_VARIATION = 14  # order of the derivative of a step


@dataclass(frozen=True)
class StateSet:
    """The states x̂ + C r₀ + B r.

    Attributes
    ----------
    centre : tuple of arb
        x̂, exact.
    c, b : arb_mat
        C and B, exact.
    start, error : tuple of arb
        The boxes r₀ and r, about 0.
    """

    centre: tuple[arb, ...]
    c: arb_mat
    start: tuple[arb, ...]
    b: arb_mat
    error: tuple[arb, ...]

    @classmethod
    def box(cls, centre: Sequence[arb], radius: Sequence[arb]) -> StateSet:
        """All states in a box."""
        middle = tuple(x.mid() for x in centre)
        spread = tuple(x - y + arb(0, r.upper()) for x, y, r in zip(centre, middle, radius, strict=True))
        size = len(middle)
        return cls(middle, identity(size), spread, identity(size), (arb(0),) * size)

    @property
    def hull(self) -> list[arb]:
        """The smallest box, in the coordinates of the state."""
        spread = (self.c * column(self.start) + self.b * column(self.error)).entries()
        return [x + y for x, y in zip(self.centre, spread, strict=True)]


class Step(NamedTuple):
    """What one step proves.

    Attributes
    ----------
    after : StateSet
        Holds the states at its end.
    during : list of arb
        Box that holds them from its begin to its end.
    pieces : tuple of Piece
        Of each pair and agent within that box.
    added : arb
        The largest remainder.
    """

    after: StateSet
    during: list[arb]
    pieces: Pieces
    added: arb


def taylor_step(flow: Flow, t: arb, h: arb, before: StateSet, order: int) -> Step | None:
    """A step of a Taylor polynomial; None if it is too long, or a pair may change its piece on the way."""
    span, box = _interval(h), before.hull
    if Piece.SWITCH in (pieces := flow.pieces(box)):
        return None
    path = flow.taylor(t, box, order - 1, pieces)
    reach = [_at(coefficients, span) for coefficients in path]
    found = _enclosed(flow, t + span, h, reach, order, pieces)
    if found is None:
        return None
    during, remainder = found
    variation = _variation(flow, t, h, path, during, pieces, min(_VARIATION, order - 1))
    point = flow.taylor(t, before.centre, order - 1, pieces)
    moved = [_at(coefficients, h) + rest for coefficients, rest in zip(point, remainder, strict=True)]
    return Step(_moved(before, moved, variation), during, pieces, _largest(remainder))


def crossing_step(flow: Flow, t: arb, h: arb, before: StateSet) -> Step | None:
    """A step of second order, which needs the right-hand side C¹ only; None if it is too long.

    x(t + h) = x + h x' + ½ h² x'' at some time between, each coordinate at its own, with x'' continuous.
    """
    span, box = _interval(h), before.hull
    during = _picard(flow, t, span, box)
    if during is None:
        return None
    pieces, at_start = flow.pieces(during), flow.pieces(box)
    remainder = [h * h / 2 * x for x in flow.acceleration(t + span, during, pieces)]
    rate = flow.rate(t, before.centre, flow.pieces(before.centre))
    moved = [x + h * v + rest for x, v, rest in zip(before.centre, rate, remainder, strict=True)]
    slope = identity(len(box)) + flow.jacobian(t, box, at_start) * h
    after = _moved(before, moved, slope)
    if not all(x.is_finite() for x in after.hull):
        return None
    return Step(after, during, pieces, arb(max(x.rad() for x in remainder)))


def _enclosed(
    flow: Flow, times: arb, h: arb, reach: Sequence[arb], order: int, pieces: Pieces
) -> tuple[list[arb], list[arb]] | None:
    """(box that holds the solutions during a step, remainder at its end), if the Taylor series proves one.

    If the polynomial on [0, h] plus h^N times the N-th coefficient on a box E lies inside E, no solution leaves E: it
    would be on E's boundary at a first time, and inside by Taylor's theorem up to it.
    """
    growth = _first_growth(reach, h)
    for _ in range(_INFLATIONS):
        box = [x + arb(0, g) for x, g in zip(reach, growth, strict=True)]
        if flow.pieces(box) != pieces:
            return None
        last = [coefficients[order] for coefficients in flow.taylor(times, box, order, pieces)]
        if not all(x.is_finite() for x in last):
            return None
        power, whole = h**order, _interval(h**order)
        image = [x + whole * rest for x, rest in zip(reach, last, strict=True)]
        if all(a.contains_interior(b) for a, b in zip(box, image, strict=True)):
            return image, [power * rest for rest in last]
        growth = [a + 2 * arb((whole * rest).abs_upper()) for a, rest in zip(growth, last, strict=True)]
    return None


def _picard(flow: Flow, t: arb, span: arb, start: Sequence[arb]) -> list[arb] | None:
    """A box that no solution leaves: start + [0, h] x'(box) lies inside it."""
    image = list(start)
    for _ in range(_INFLATIONS):
        growth = _first_growth(image, span.upper())
        box = [x + arb(0, g) for x, g in zip(image, growth, strict=True)]
        rate = flow.rate(t + span, box, flow.pieces(box))
        if not all(x.is_finite() for x in rate):
            return None
        image = [x + span * v for x, v in zip(start, rate, strict=True)]
        if all(a.contains_interior(b) for a, b in zip(box, image, strict=True)):
            return image
    return None


def _first_growth(box: Sequence[arb], h: arb) -> list[arb]:
    """By how much a candidate is made larger than what it should hold: an eighth, and never by nothing."""
    half = len(box) // 2
    far, fast = (arb(max(x.abs_upper() for x in part)) for part in (box[:half], box[half:]))
    least = [(far + h * fast) * _GRAIN] * half + [(fast + far / h) * _GRAIN] * half
    return [arb((x.rad() / 8 + own).upper()) + arb(2) ** -500 for x, own in zip(box, least, strict=True)]


def _variation(
    flow: Flow, t: arb, h: arb, path: Sequence[Sequence[arb]], during: Sequence[arb], pieces: Pieces, order: int
) -> arb_mat:
    """∂x(t + h)/∂x(t) on the whole set: its Taylor polynomial, and a remainder.

    At a time between, the K-th coefficient is that of the states there, times ∂x(between)/∂x(t). With L the largest row
    sum of |∂x'/∂x| during the step, Gronwall's inequality bounds the latter: no entry differs from that of the identity
    by more than e^{Lh} − 1.
    """
    span = _interval(h)
    polynomial = flow.variation(t, path, order - 1, pieces)
    there = flow.variation(t + span, flow.taylor(t + span, during, order, pieces), order, pieces)[order]
    rows = flow.jacobian(t + span, during, pieces).tolist()
    steepest = arb(max(sum((abs(x) for x in row), arb(0)).upper() for row in rows))
    off, size = arb(0, ((steepest * h).exp() - 1).upper()), len(during)
    between = identity(size) + arb_mat(size, size, [off] * size**2)
    total = there * between * h**order
    for coefficients in reversed(list(enumerate(polynomial))):
        total += coefficients[1] * h ** coefficients[0]
    return total


def _moved(before: StateSet, moved: Sequence[arb], slope: arb_mat) -> StateSet:
    """The image of a set whose centre goes to `moved`, by the mean value theorem with derivatives in `slope`."""
    centre = tuple(x.mid() for x in moved)
    rest = column([x - y for x, y in zip(moved, centre, strict=True)])
    c, b = slope * before.c, slope * before.b
    exact = midpoints(c)
    rest += (c - exact) * column(before.start)
    frame = _frame(b, [float(x.rad()) for x in before.error])
    back = frame.inv()
    error = (back * b) * column(before.error) + back * rest
    return StateSet(centre, exact, before.start, frame, tuple(error.entries()))


def _frame(b: arb_mat, widths: Sequence[float]) -> arb_mat:
    """An exact matrix, orthogonal but for rounding, whose first column is the longest edge of the set, and so on."""
    size, widest = len(widths), max(widths)
    if widest == 0.0:
        return identity(size)
    edges = np.array([[float(x.mid()) for x in row] for row in b.tolist()])
    scaled = edges * (np.array(widths) / widest)
    longest = np.argsort(-np.linalg.norm(scaled, axis=0), kind="stable")
    q = np.linalg.qr(edges[:, longest])[0]
    if not np.isfinite(q).all():
        return identity(size)
    return arb_mat(size, size, [arb(float(x)) for x in q.ravel()])


def _interval(h: arb) -> arb:
    """[0, h]."""
    return hull(arb(0), h)


def _at(coefficients: Sequence[arb], s: arb) -> arb:
    """A polynomial at a ball (Horner)."""
    total = arb(0)
    for coefficient in reversed(coefficients):
        total = total * s + coefficient
    return total


def _largest(values: Sequence[arb]) -> arb:
    """The largest absolute value."""
    return arb(max(x.abs_upper() for x in values))
