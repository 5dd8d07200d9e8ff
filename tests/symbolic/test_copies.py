"""The balance of an agent and its copy, and how copies part, against the kernels."""

import pytest
import sympy as sp

from flockana import Copies, Gains, PeerToPeer, Spring
from flockana.symbolic import composition as copies


def test_the_balance_is_the_kernels():
    derived = copies.copies_balance()
    assert derived.holds
    q, place = (sp.Function(name)(copies.T) for name in ("q", "q_r"))
    law = PeerToPeer(Copies([[3.0]], [[-0.5]], Spring((0.0,), 0.0)), gains=Gains(c1_gamma=1.5, c2_gamma=0.7))
    numbers = {q.diff(copies.T): 2.0, place.diff(copies.T): -0.5, copies.PULL: 1.5, copies.MATCH: 0.7}
    stated = derived.result.subs(numbers).subs({q: 1.0, place: 3.0})
    assert law.energy_rate(0.0, [[1.0]], [[2.0]]) == pytest.approx(float(stated), rel=1e-14)


def test_how_copies_part_is_the_kernels():
    """The second difference of a copy's distance from the mean at t = 0."""
    derived, h = copies.copies_part(), 1e-3
    assert derived.holds
    own = Copies([[3.0], [0.0], [0.0]], [[1.0], [-1.0], [0.0]], Spring((5.0,), 0.3, 0.2), 0.7, 0.9)
    away = [float(x[0, 0] - x.mean()) for x in (own.state(s * h)[0] for s in (-1.0, 0.0, 1.0))]
    d = sp.Function("d")(copies.T)
    numbers = {copies.STIFFNESS: 0.3, copies.DRAG: 0.2, copies.K1: 0.7, copies.K2: 0.9}
    rate = derived.result.rhs.subs(d.diff(copies.T), 1.0).subs(d, 2.0).subs(numbers)
    assert (away[0] - 2.0 * away[1] + away[2]) / h**2 == pytest.approx(float(rate), abs=1e-4)
