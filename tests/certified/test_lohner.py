"""A rigorous step against a system that is solved in closed form: the exact solutions lie in what the step encloses."""

from itertools import product

import pytest
from flint import arb, arb_mat

from flockana.certified import lohner
from flockana.certified.krawczyk import column, identity
from flockana.certified.lohner import StateSet, crossing_step, taylor_step


class Linear:
    """x' = A x, n = 2 agents on a line that part exponentially: q'' = λ² q, each with its own λ."""

    n, m, pace = 2, 1, 1.0

    def __init__(self, *rates):
        self.rates = rates
        squares = [arb(rate) ** 2 for rate in rates]
        self.a = arb_mat([[0, 0, 1, 0], [0, 0, 0, 1], [squares[0], 0, 0, 0], [0, squares[1], 0, 0]])

    def solution(self, s, x):
        """The exact state after s, from x."""
        (a, b), half = (arb(rate) for rate in self.rates), x[:2]
        q = [x0 * (k * s).cosh() + v0 * (k * s).sinh() / k for k, x0, v0 in zip((a, b), half, x[2:], strict=True)]
        p = [x0 * k * (k * s).sinh() + v0 * (k * s).cosh() for k, x0, v0 in zip((a, b), half, x[2:], strict=True)]
        return [*q, *p]

    def pieces(self, box):
        return ()

    def power(self, k):
        """A^k / k!."""
        made = identity(4)
        for j in range(1, k + 1):
            made = made * self.a / j
        return made

    def rate(self, t, box, pieces):
        return (self.a * column(box)).entries()

    def acceleration(self, t, box, pieces):
        return (self.a * self.a * column(box)).entries()

    def jacobian(self, t, box, pieces):
        return self.a

    def taylor(self, t, box, order, pieces):
        columns = [(self.power(k) * column(box)).entries() for k in range(order + 1)]
        return [[each[i] for each in columns] for i in range(4)]

    def variation(self, t, path, order, pieces):
        return [self.power(k) for k in range(order + 1)]


class Scalar:
    """x' = g(t, x) of one coordinate, by ∂g/∂x: a bound of the derivative of a step at first order asks for no more."""

    def __init__(self, slope):
        self.slope = slope

    def jacobian(self, t, box, pieces):
        return arb_mat([[self.slope(t, box[0])]])

    def taylor(self, t, box, order, pieces):
        return [[box[0]] * (order + 1)]

    def variation(self, t, path, order, pieces):
        return [arb_mat([[1]]), arb_mat([[self.slope(t, path[0][0])]])][: order + 1]


FLOW = Linear(1, arb(3) / 2)
CENTRE = [arb(1), arb(-1), arb(1) / 4, arb(1) / 2]
RADIUS = arb(1) / 64
CORNERS = [[x + sign * RADIUS for x, sign in zip(CENTRE, signs, strict=True)] for signs in product((-1, 1), repeat=4)]


def stepped(kind, h, order):
    before = StateSet.box(CENTRE, [RADIUS] * 4)
    return taylor_step(FLOW, arb(0), h, before, order) if kind == "taylor" else crossing_step(FLOW, arb(0), h, before)


def ensure_holds(step, h):
    """All that a step says, of the solutions from the corners, at ten times: the exact ones are inside."""
    for start in [CENTRE, *CORNERS]:
        end = FLOW.solution(h, start)
        assert all(box.contains(x) for box, x in zip(step.after.hull, end, strict=True))
        for k in range(11):
            x = FLOW.solution(h * k / 10, start)
            assert all(box.contains(value) for box, value in zip(step.during, x, strict=True))
            mean = (x[0] + x[1]) / 2
            assert step.relative[0][0].contains(x[1] - x[0])
            assert all(step.deviations[i][0].contains(x[i] - mean) for i in range(2))


@pytest.mark.parametrize("order", [2, 3, 8])
@pytest.mark.parametrize("h", [arb(1) / 8, arb(1) / 3])
def test_a_taylor_step_holds_what_the_polynomial_lacks(order, h):
    """At second order what it lacks is a tenth of the way: a remainder left out, or halved, is seen at once."""
    step = stepped("taylor", h, order)
    ensure_holds(step, h)


@pytest.mark.parametrize("h", [arb(1) / 64, arb(1) / 8])
def test_a_crossing_step_holds_half_of_h_squared_times_the_acceleration(h):
    ensure_holds(stepped("crossing", h, 2), h)


def test_a_box_holds_what_its_centre_leaves_open():
    box = StateSet.box([arb(1, 1), arb(0), arb(0), arb(0)], [arb(1) / 2] * 4)
    assert box.hull[0].contains(arb(5) / 2)
    assert box.hull[0].contains(arb(-1) / 2)


@pytest.mark.parametrize(("kind", "order", "excess"), [("taylor", 12, 1.0001), ("crossing", 2, 1.03)])
def test_a_step_is_hardly_wider_than_the_solutions(kind, order, excess):
    h = arb(1) / 16
    step = stepped(kind, h, order)
    ends = [FLOW.solution(h, start) for start in CORNERS]
    for k, box in enumerate(step.after.hull):
        low, high = (extreme(float(end[k]) for end in ends) for extreme in (min, max))
        assert 2.0 * float(box.rad()) < excess * (high - low)


def test_a_step_that_is_too_long_is_none():
    """No box holds e^{3t} to t = 10 that a first guess leads to."""
    assert stepped("taylor", arb(10), 2) is None
    assert stepped("crossing", arb(10), 2) is None


@pytest.mark.parametrize(
    ("slope", "during", "h", "exact"),
    [
        (lambda t, x: arb(1) / 2, arb(1), arb(1), (arb(1) / 2).exp()),  # x' = x/2
        (lambda t, x: arb(3), arb(1), arb(1), arb(3).exp()),  # 1 + 3 for e³ holds too little
        (lambda t, x: 2 * t, arb(1), arb(6) / 5, (arb(36) / 25).exp()),  # x' = 2tx: nothing at the begin
        (lambda t, x: 2 * t, arb(1), arb(1) / 10, (arb(1) / 100).exp()),  # the same in a short step: it grows
        (lambda t, x: 2 * (x - 1), arb(1, 1), arb(1), arb(4)),  # x' = (x - 1)² from 3/2: nothing at the box's middle
    ],
)
def test_the_derivative_of_a_step_is_bounded_by_gronwalls_inequality(slope, during, h, exact):
    """At first order all but the identity is remainder."""
    whole, tail = lohner._variation(Scalar(slope), arb(0), h, [[during]], [during], (), 1)
    assert whole[0, 0].contains(exact)
    assert tail[0, 0].contains(exact - 1)
    steepest = max(float(slope(t, during).abs_upper()) for t in (arb(0), h))
    assert float(whole[0, 0].abs_upper()) <= 1.0 + 1.001 * float(h) * steepest * float((steepest * h).exp())


def test_a_set_keeps_its_states_when_its_axes_turn():
    """A shear by which one edge overtakes another: whatever axes are proposed, each corner's image is inside."""
    slope = arb_mat([[1, 3, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [2, 0, 0, arb(1) / 8]])
    zero = (arb(0),) * 4
    edges = (arb(0, 1), arb(0, arb(1) / 4), arb(0, 2), arb(0, arb(1) / 2))
    before = StateSet(zero, identity(4), zero, identity(4), edges)
    after = lohner._moved(before, list(zero), slope, 1.0)
    for signs in product((-1, 1), repeat=4):
        corner = column([sign * arb(edge.rad()) for sign, edge in zip(signs, edges, strict=True)])
        image = slope * corner
        assert all(box.contains(x) for box, x in zip(after.hull, image.entries(), strict=True))


def test_a_derivative_that_is_not_known_exactly_widens_what_is_left_of_the_start():
    zero, slope = (arb(0),) * 4, identity(4) + arb_mat(4, 4, [arb(0, arb(1) / 8)] * 16)
    after = lohner._moved(StateSet.box(CENTRE, [RADIUS] * 4), list(zero), slope, 1.0)
    most = RADIUS + 4 * RADIUS / 8
    assert all(box.contains(most) and box.contains(-most) for box in after.hull)
