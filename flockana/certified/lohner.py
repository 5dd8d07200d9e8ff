"""Rigorous step of an ordinary differential equation: Lohner's method in ball arithmetic (Arb).

The set of possible states is x̂ + C r₀ + B r: a point, what is left of the start, and all that was added since, each in
coordinates that turn with the flow. A step of the Taylor polynomial moves the point, its derivative the sets, and
the coordinates B are made orthogonal again, longest edge first (QR), so that boxes are not wrapped in boxes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np
from flint import arb, arb_mat

from flockana.certified.balls import hull
from flockana.certified.flow_in_balls import Flow, Pieces
from flockana.certified.krawczyk import column, identity
from flockana.certified.pair_laws_in_series import Piece

_INFLATIONS = 12  # of a candidate enclosure, before a step is called too long
_GRAIN = arb(2) ** -64  # relative: by which a candidate of no width is made wider
_VARIATION = 14  # order of the derivative of a step


@dataclass(frozen=True)
class StateSet:
    """Set of states x̂ + C r₀ + B r, with centre x̂ and balls r₀, r (Lohner's form)."""

    centre: tuple[arb, ...]  # x̂, exact
    c: arb_mat  # c, b: C and B, exact
    start: tuple[arb, ...]  # start, error: The boxes r₀ and r, about 0
    b: arb_mat
    error: tuple[arb, ...]

    @classmethod
    def box(cls, centre: Sequence[arb], radius: Sequence[arb]) -> StateSet:
        """Return the set of all states within given radii of a centre, in Lohner's form."""
        midpoint = tuple(x.mid() for x in centre)
        spread = tuple(x - y + arb(0, r.upper()) for x, y, r in zip(centre, midpoint, radius, strict=True))
        dimension = len(midpoint)
        return cls(midpoint, identity(dimension), spread, identity(dimension), (arb(0),) * dimension)

    @property
    def hull(self) -> list[arb]:
        """Return the smallest box that contains the set of states."""
        spread = (self.c * column(self.start) + self.b * column(self.error)).entries()
        return [x + y for x, y in zip(self.centre, spread, strict=True)]


class Step(NamedTuple):
    """Proved enclosures of one integration step: states at its end and during it, with error sizes."""

    after: StateSet  # Holds the states at its end
    during: list[arb]  # Box that holds them from its begin to its end
    relative: list[list[arb]]  # Of each pair, the box that holds q_j − q_i during it
    deviations: list[list[arb]]  # Of each agent, the box that holds q_i − q_c during it
    added: float  # The largest remainder, in units of length; of a velocity, what it goes in the law's own time
    blur: float  # By what share the set may grow as the derivative of the step has a remainder


def variation_order(order: int) -> int:
    """Return the order of the Taylor polynomial of the derivative ∂x(t + h)/∂x(t)."""
    return min(_VARIATION, order - 1)


def taylor_step(flow: Flow, t: arb, h: arb, before: StateSet, order: int) -> Step | None:
    """Return the enclosure of a Taylor step; None if too long, or a pair may cross a switching distance."""
    span, box = hull(arb(0), h), before.hull
    if Piece.SWITCH in (pieces := flow.pieces(box)):
        return None
    path = flow.taylor(t, box, order - 1, pieces)
    reach = [_at(coefficients, span) for coefficients in path]
    enclosure = _enclosed(flow, t + span, h, reach, order, pieces)
    if enclosure is None:
        return None
    state_range, remainder = enclosure
    variation, tail_enclosure = _variation(flow, t, h, path, state_range, pieces, variation_order(order))
    point = flow.taylor(t, before.centre, order - 1, pieces)
    image = [_at(coefficients, h) + rest for coefficients, rest in zip(point, remainder, strict=True)]
    next_set = _moved(before, image, variation, flow.pace)
    if not all(x.is_finite() for x in next_set.hull):
        return None
    tail = [hull(arb(0), x) for x in remainder]
    relative, deviations = _seen(flow, lambda weights: _combined(weights, path, tail, span))
    return Step(next_set, state_range, relative, deviations, size(flow, remainder), _blur(flow, tail_enclosure))


def crossing_step(flow: Flow, t: arb, h: arb, before: StateSet) -> Step | None:
    """Enclose a step by Taylor's formula of second order, for C¹ right-hand sides; None if the step is too long."""
    # x(t + h) = x + h x' + ½ h² x'' at some time between, each coordinate at its own, with x'' continuous.
    span, box = hull(arb(0), h), before.hull
    during = _picard(flow, t, span, box)
    if during is None:
        return None
    remainder = [h * h / 2 * x for x in flow.acceleration(t + span, during, flow.pieces(during))]
    rate = flow.rate(t, before.centre, flow.pieces(before.centre))
    image = [x + h * v + rest for x, v, rest in zip(before.centre, rate, remainder, strict=True)]
    slope = identity(len(box)) + flow.jacobian(t, box, flow.pieces(box)) * h
    next_set = _moved(before, image, slope, flow.pace)
    if not all(x.is_finite() for x in next_set.hull):
        return None
    weighed = _seen(flow, lambda weights: sum((weight * during[k] for k, weight in weights.items()), arb(0)))
    return Step(next_set, during, *weighed, size(flow, [arb(x.rad()) for x in remainder]), _blur(flow, slope))


def _enclosed(
    flow: Flow, times: arb, h: arb, reach: Sequence[arb], order: int, pieces: Pieces
) -> tuple[list[arb], list[arb]] | None:
    """Return a box that contains the solutions during a step, and the remainder at the end; None without a proof."""
    # If the polynomial on [0, h] plus h^N times the N-th coefficient on a box E lies inside E, no solution leaves E: it
    # would be on E's boundary at a first time, and inside by Taylor's theorem up to it.
    growth = _first_growth(reach, h)
    for _ in range(_INFLATIONS):
        box = [x + arb(0, g) for x, g in zip(reach, growth, strict=True)]
        if flow.pieces(box) != pieces:
            return None
        last = [coefficients[order] for coefficients in flow.taylor(times, box, order, pieces)]
        if not all(x.is_finite() for x in last):
            return None
        power, power_range = h**order, hull(arb(0), h**order)
        image = [x + power_range * entry for x, entry in zip(reach, last, strict=True)]
        if all(a.contains_interior(b) for a, b in zip(box, image, strict=True)):
            return image, [power * entry for entry in last]
        growth = [a + 2 * arb((power_range * entry).abs_upper()) for a, entry in zip(growth, last, strict=True)]
    return None


def _picard(flow: Flow, t: arb, span: arb, start: Sequence[arb]) -> list[arb] | None:
    """Return a box that the solutions cannot leave during a step: start + [0, h] x'(box) lies inside the box."""
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
    """Return the margin by which a candidate box is enlarged: an eighth of its radius, at least a tiny number."""
    half = len(box) // 2
    far, fast = (arb(max(x.abs_upper() for x in half_vector)) for half_vector in (box[:half], box[half:]))
    margins = [(far + h * fast) * _GRAIN] * half + [(fast + far / h) * _GRAIN] * half
    return [arb((x.rad() / 8 + margin).upper()) + arb(2) ** -500 for x, margin in zip(box, margins, strict=True)]


def _variation(
    flow: Flow, t: arb, h: arb, path: Sequence[Sequence[arb]], during: Sequence[arb], pieces: Pieces, order: int
) -> tuple[arb_mat, arb_mat]:
    """Return the Taylor enclosure of ∂x(t + h)/∂x(t) over the whole set, and the remainder."""
    # At a time between, the K-th coefficient is that of the states there, times ∂x(between)/∂x(t). With L the largest
    # row sum of |∂x'/∂x| during the step, Gronwall's inequality bounds the latter: no entry differs from that of the
    # identity by more than e^{Lh} − 1.
    span = hull(arb(0), h)
    polynomial = flow.variation(t, path, order - 1, pieces)
    remainder = flow.variation(t + span, flow.taylor(t + span, during, order, pieces), order, pieces)[order]
    rows = flow.jacobian(t + span, during, pieces).tolist()
    steepest = arb(max(sum((abs(x) for x in row), arb(0)).upper() for row in rows))
    growth_radius, dimension = arb(0, ((steepest * h).exp() - 1).upper()), len(during)
    growth_enclosure = identity(dimension) + arb_mat(dimension, dimension, [growth_radius] * dimension**2)
    total = tail = remainder * growth_enclosure * h**order
    for k, coefficients in enumerate(polynomial):
        total = total + coefficients * h**k
    return total, tail


def _moved(before: StateSet, moved: Sequence[arb], slope: arb_mat, pace: float) -> StateSet:
    """Return the image of a set by the mean value theorem, from its centre's image and the derivatives on the set."""
    centre = tuple(x.mid() for x in moved)
    remainder = column([x - y for x, y in zip(moved, centre, strict=True)])
    c, b = slope * before.c, slope * before.b
    exact = c.mid()
    remainder += (c - exact) * column(before.start)
    frame = _frame(b, [float(x.abs_upper()) for x in before.error], pace)
    inverse_frame = frame.inv()
    error = (inverse_frame * b) * column(before.error) + inverse_frame * remainder
    return StateSet(centre, exact, before.start, frame, tuple(error.entries()))


def _frame(b: arb_mat, widths: Sequence[float], pace: float) -> arb_mat:
    """Return an exact, nearly orthogonal matrix whose columns follow the longest edges of the set."""
    # Velocities count by what they go in the law's own time, so that what damping shrinks is not mixed with what it
    # does not. Floating point proposes the matrix; whatever it is, the set is enclosed in it.
    dimension, widest = len(widths), max(widths)
    weights = np.repeat((1.0, 1.0 / pace), dimension // 2)[:, None]
    edges = weights * np.array([[float(x.mid()) for x in row] for row in b.tolist()])
    scaled_edges = edges * (np.array(widths) / widest if widest > 0.0 else 1.0)
    if not np.isfinite(scaled_edges).all():
        return identity(dimension)
    longest = np.argsort(-np.linalg.norm(scaled_edges, axis=0), kind="stable")
    q = np.linalg.qr(edges[:, longest])[0] / weights
    return arb_mat(dimension, dimension, [arb(float(x)) for x in q.ravel()])


def _seen(flow: Flow, combined: Callable[[Mapping[int, Any]], arb]) -> tuple[list[list[arb]], list[list[arb]]]:
    """Return the relative positions q_j − q_i and deviations q_i − q_c of all agents during a step."""
    n, m, share = flow.n, flow.m, arb(1) / flow.n
    relative = [[combined({j * m + k: 1, i * m + k: -1}) for k in range(m)] for i, j in combinations(range(n), 2)]
    deviations = [[combined({j * m + k: int(i == j) - share for j in range(n)}) for k in range(m)] for i in range(n)]
    return relative, deviations


def _combined(weights: Mapping[int, Any], path: Sequence[Sequence[arb]], tail: Sequence[arb], span: arb) -> arb:
    """Return a linear combination of coordinates during a step, from polynomials and remainders."""
    orders = range(len(path[0]))
    polynomial = [sum((weight * path[k][order] for k, weight in weights.items()), arb(0)) for order in orders]
    return _at(polynomial, span) + sum((weight * tail[k] for k, weight in weights.items()), arb(0))


def size(flow: Flow, remainder: Sequence[arb]) -> float:
    """Return the largest entry of a box of states, velocities times the law's time; for step control."""
    half = len(remainder) // 2
    far, fast = (max(float(x.abs_upper()) for x in half_vector) for half_vector in (remainder[:half], remainder[half:]))
    return max(far, fast / flow.pace)


def _blur(flow: Flow, slope: arb_mat) -> float:
    """Return the largest row sum of a derivative's radii, a measure of overestimation; for step control only."""
    weights = np.repeat((1.0, 1.0 / flow.pace), slope.nrows() // 2)
    radii = np.array([[float(x.rad()) for x in row] for row in slope.tolist()])
    return float((radii * weights[:, None] / weights).sum(axis=1).max())


def _at(coefficients: Sequence[arb], s: arb) -> arb:
    """Return the value of a polynomial at a ball (Horner's scheme)."""
    total = arb(0)
    for coefficient in reversed(coefficients):
        total = total * s + coefficient
    return total
