"""Flocks that are one up to motion, mirror and numbering."""

import numpy as np
import pytest

from flockana.equilibria.congruence import congruent
from flockana.lattice import hexagonal_spiral
from flockana.sources.geschwender_2016.theorems.e03_strained_limits import rhombus_with_double_agent


@pytest.mark.parametrize("m", [1, 2, 3])
def test_congruence_up_to_motion_mirror_and_numbering(m):
    rng = np.random.default_rng(m)
    q = rng.standard_normal((6, m))
    turn = np.linalg.qr(rng.standard_normal((m, m)))[0]
    assert congruent(q, (q @ turn)[rng.permutation(6)] + 3.0, tol=1e-9)
    assert congruent(q, -q, tol=1e-9)
    assert congruent(q, q * np.append(np.ones(m - 1), -1.0), tol=1e-9)  # a reflection; -q in the plane is none
    moved = q.copy()
    moved[2, 0] += 1e-3
    assert not congruent(q, moved, tol=1e-6)


def test_equal_distances_are_not_enough_and_coincident_agents_are_counted():
    assert not congruent(
        np.array([[0.0], [1.0], [4.0], [10.0], [12.0], [17.0]]),
        np.array([[0.0], [1.0], [8.0], [11.0], [13.0], [17.0]]),
        tol=1e-9,
    )
    double = rhombus_with_double_agent(7.0)
    assert congruent(double, double[::-1] * [1.0, -1.0], tol=1e-9)
    flat = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]])
    assert congruent(flat, flat[:, [2, 0, 1]], tol=1e-9)


@pytest.mark.parametrize("length", [1e-9, 1e-6, 1.0, 1e6])
def test_congruence_has_no_unit(length):
    q = hexagonal_spiral(7, 7.0)
    q[3] += [0.4, -0.2]
    turned = length * (q[::-1] @ np.array([[0.6, -0.8], [0.8, 0.6]]) + 3.0)
    assert congruent(length * q, turned, tol=1e-9 * length)
    turned[2, 0] += 1e-3 * length
    assert not congruent(length * q, turned, tol=1e-6 * length)
