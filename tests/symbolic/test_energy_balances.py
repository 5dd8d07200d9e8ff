"""The energy balances of compositions and of copies in sympy, and the kernels' against them."""

import numpy as np
import pytest
import sympy as sp

from flockana import CircleTarget, Copies, Gains, PeerToPeer, Spring, StaticTarget, compose
from flockana.symbolic import energy_balances as symbolic


@pytest.mark.slow
@pytest.mark.parametrize("m", [1, 2, 3])
def test_identities_hold_in_every_dimension(m):
    assert all(symbolic.given_frame_identity(m, informed=k).holds for k in range(4))
    assert symbolic.moving_frame_identity(m).holds


Q = np.array([[1.0, 0.5], [-2.0, 1.0], [0.3, -1.7]])
P = np.array([[0.4, -1.0], [1.5, 0.2], [-0.7, 0.9]])


def test_the_kernels_have_these_rates():
    numbers = {"alpha": 0.8, "beta": 0.3, "c_1": 1.2, "c_2": 0.7, "c": 0.0}
    given = symbolic.given_frame_identity(2, informed=2).result
    names = sorted(symbol.name for symbol in given.free_symbols if symbol.name[0] == "p")
    table = dict(zip(names, P.ravel(), strict=True))
    rate = given.subs({s: (numbers | table).get(s.name, 0.0) for s in given.free_symbols})
    here = StaticTarget((2.0, -1.0))
    law = compose(navigation=here, pull=1.2, match=0.7, informed=(0, 1), agents=3, speed=(0.8, 0.3))
    assert law.energy_rate(0.0, Q, P) == pytest.approx(float(rate), rel=1e-14)
    moving = symbolic.moving_frame_identity(2).result
    rate = moving.subs({s: (numbers | table | {"alpha": -0.4}).get(s.name, 0.0) for s in moving.free_symbols})
    circle = CircleTarget((2.0, -1.0), 3.0, 0.2)
    dragged = compose(navigation=circle, pull=1.2, match=0.7, feedforward=True, drag=0.4)
    assert dragged.energy_rate(0.3, Q, P) == pytest.approx(float(rate), rel=1e-13)


def test_the_balance_is_the_kernels():
    derived = symbolic.copies_balance()
    assert derived.holds
    q, place = (sp.Function(name)(symbolic.T) for name in ("q", "q_r"))
    law = PeerToPeer(Copies([[3.0]], [[-0.5]], Spring((0.0,), 0.0)), gains=Gains(c1_gamma=1.5, c2_gamma=0.7))
    numbers = {q.diff(symbolic.T): 2.0, place.diff(symbolic.T): -0.5, symbolic.PULL: 1.5, symbolic.MATCH: 0.7}
    stated = derived.result.subs(numbers).subs({q: 1.0, place: 3.0})
    assert law.energy_rate(0.0, [[1.0]], [[2.0]]) == pytest.approx(float(stated), rel=1e-14)


def test_how_copies_part_is_the_kernels():
    """The second difference of a copy's distance from the mean at t = 0."""
    derived, h = symbolic.copies_part(), 1e-3
    assert derived.holds
    own = Copies([[3.0], [0.0], [0.0]], [[1.0], [-1.0], [0.0]], Spring((5.0,), 0.3, 0.2), 0.7, 0.9)
    away = [float(x[0, 0] - x.mean()) for x in (own.state(s * h)[0] for s in (-1.0, 0.0, 1.0))]
    d = sp.Function("d")(symbolic.T)
    numbers = {symbolic.STIFFNESS: 0.3, symbolic.DRAG: 0.2, symbolic.K1: 0.7, symbolic.K2: 0.9}
    rate = derived.result.rhs.subs(d.diff(symbolic.T), 1.0).subs(d, 2.0).subs(numbers)
    assert (away[0] - 2.0 * away[1] + away[2]) / h**2 == pytest.approx(float(rate), abs=1e-4)
