from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm1, Scenario
from flockana.base.errors import ArgumentError
from flockana.scenarios.lazy_start import lazy_array, lazy_state


def item(q, p):
    return Scenario("pair", "A pair", "ours", Algorithm1(), q, p, (0.0, 0.1))


def test_a_start_is_drawn_once_and_when_it_is_asked_for():
    calls = []

    def draw():
        calls.append(1)
        return np.array([[0.0], [8.0]]), np.array([[1.0], [-1.0]])

    pair = item(*lazy_state((2, 1), draw))
    assert (pair.shape, pair.theorems, calls) == ((2, 1), (), [])
    assert (pair.p0.tolist(), pair.q0.tolist()) == ([[1.0], [-1.0]], [[0.0], [8.0]])
    assert pair.q0 is pair.q0
    assert calls == [1]


def test_a_scenario_with_such_a_start_is_like_any_other():
    q = np.array([[0.0], [8.0]])
    now, then = item(q, 0.0 * q), item(lazy_array((2, 1), lambda: q), lazy_array((2, 1), lambda: 0.0 * q))
    assert then.in_units(2.0, 1.0).q0.tolist() == now.in_units(2.0, 1.0).q0.tolist() == [[0.0], [16.0]]
    assert replace(then, seed=3).q0 is q
    assert then.run().q.tolist() == now.run().q.tolist()


def test_errors_of_a_draw_are_raised_where_it_is_asked_for():
    def draw():
        raise ArgumentError("no room")

    pair = item(lazy_array((2, 1), draw), lazy_array((2, 1), draw))
    with pytest.raises(ArgumentError, match="no room"):
        _ = pair.q0
