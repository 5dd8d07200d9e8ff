"""Steps of the dead-zone law: those of Python's floats to the bit, whatever is kept of them."""

from math import sqrt

import numpy as np
import pytest

from flockana.sources.li_dead_zone import DeadZoneInteraction
from flockana.sources.li_dead_zone.kernels.steps import _square_of_range, semi_implicit_steps


def euler_step_in_python(q, p, pair, k2, dt):
    """One semi-implicit Euler step in Python's own floats, every operation in the order that the kernel writes down."""
    n, m = q.shape
    x, v = q.T.tolist(), p.T.tolist()
    z = [[pair.k1 * (x[c][i] - x[c][0]) + k2 * (v[c][i] - v[c][0]) for i in range(n)] + [0.0] * 3 for c in range(m)]
    u, pushed = [[0.0] * n for _ in range(m)], []
    near = [[0.0] * n for _ in range(n + 3)]
    steep = 1.0 / pair.ramp if pair.ramp > 0.0 else 1e300
    for i in range(n):
        for j in range(i + 1, n):
            s2 = 0.0
            for c in range(m):
                s2 += (x[c][j] - x[c][i]) * (x[c][j] - x[c][i])
            s = sqrt(s2)
            if s >= pair.r:
                continue
            gap = s if s < pair.d1 else pair.r_d - s
            gap *= gap
            share = max(0.0, min(1.0, (s - pair.d2) * steep)) - max(0.0, min(1.0, (pair.d1 - s) * steep))
            w = share * (2.0 * pair.k_r + pair.k_delta * gap) / (gap * sqrt(1.0 + pair.eta * s2))
            pushed.append((i, j, w))
            near[i][j] = near[j][i] = 1.0
    for c in range(m):
        for i in range(n):
            for j in range(0, n, 4):
                terms = [near[j + k][i] * z[c][j + k] for k in range(4)]
                u[c][i] += (terms[0] + terms[1]) + (terms[2] + terms[3])
            u[c][i] -= sum(near[j][i] for j in range(n)) * z[c][i]
        for i, j, w in pushed:  # most push nobody: what the kernel leaves out is zero
            u[c][i] += w * (x[c][j] - x[c][i])
            u[c][j] -= w * (x[c][j] - x[c][i])
    v = [[v[c][i] + dt * u[c][i] for i in range(n)] for c in range(m)]
    x = [[x[c][i] + dt * v[c][i] for i in range(n)] for c in range(m)]
    return np.array(x).T, np.array(v).T, np.array(u).T


@pytest.mark.parametrize(("ramp", "m"), [(0.25, 2), (0.0, 2), (0.25, 3), (0.25, 1)])
def test_the_compiled_steps_give_the_same_bits_on_every_processor(ramp, m):
    """Those of Python's floats: no sum is reordered and no product fused, whatever the compiler may do elsewhere."""
    pair, rng = DeadZoneInteraction(ramp=ramp), np.random.default_rng(m)
    q, p = rng.uniform(0.0, 20.0, (21, m)), rng.uniform(-1.0, 1.0, (21, m))
    found = semi_implicit_steps(q, p, pair.par, 1.0, 0.01, np.arange(1, 61))  # more than a list lasts
    for step in range(60):
        q, p, u = euler_step_in_python(q, p, pair, 1.0, 0.01)
        for mine, theirs in zip((q, p, u), found, strict=True):
            np.testing.assert_array_equal(mine, theirs[step])


@pytest.mark.parametrize("r", [15.0, 0.1, 1e-170, 3.3333333333333335, 1e150])
def test_a_square_tells_the_range_to_the_bit(r):
    square = _square_of_range(r)
    assert sqrt(square) >= r > sqrt(np.nextafter(square, 0.0))


def test_steps_that_leap_out_of_the_lists_skin_make_a_new_list():
    """From rest, with a step so long that the first one already moves agents far: as steps taken one by one."""
    pair, rng = DeadZoneInteraction(), np.random.default_rng(3)
    q, p, dt = rng.uniform(0.0, 2.0 * pair.range, (12, 2)), np.zeros((12, 2)), 1.0
    together = semi_implicit_steps(q, p, pair.par, 1.0, dt, np.arange(1, 7))
    for step in range(6):
        one = semi_implicit_steps(q, p, pair.par, 1.0, dt, np.array([1]))
        q, p = one[0][0], one[1][0]
        for found, wanted in zip(together, one, strict=True):
            np.testing.assert_allclose(found[step], wanted[0], rtol=1e-9, atol=1e-9)


def test_of_some_steps_it_is_what_all_steps_are():
    pair, rng = DeadZoneInteraction(), np.random.default_rng(4)
    q, p = rng.uniform(0.0, 20.0, (9, 2)), rng.uniform(-1.0, 1.0, (9, 2))
    every = semi_implicit_steps(q, p, pair.par, 1.0, 0.01, np.arange(1, 41))
    for wanted in ([1], [40], [2, 3, 17], [39, 40]):
        for found, all_of_them in zip(
            semi_implicit_steps(q, p, pair.par, 1.0, 0.01, np.array(wanted)), every, strict=True
        ):
            np.testing.assert_array_equal(found, all_of_them[np.array(wanted) - 1])


def test_a_list_does_not_outlast_distances_that_overflow():
    """The third agent leaps from 1e200 to the others; no pair with it was on a list while its distance was infinite."""
    pair = DeadZoneInteraction()
    q, p = np.array([[0.0, 0.0], [8.0, 0.0], [4.0, 1e200]]), np.array([[0.0, 0.0], [0.0, 0.0], [0.0, -1e200]])
    together = semi_implicit_steps(q, p, pair.par, 1.0, 1.0, np.array([1, 2]))
    for step in range(2):
        one = semi_implicit_steps(q, p, pair.par, 1.0, 1.0, np.array([1]))
        q, p = one[0][0], one[1][0]
        for found, wanted in zip(together, one, strict=True):
            np.testing.assert_array_equal(found[step], wanted[0])
    assert together[2][1, 2, 1] == 2e200


def test_no_steps_are_none():
    pair, q = DeadZoneInteraction(), np.array([[0.0, 0.0], [3.0, 0.0]])
    assert [found.shape for found in semi_implicit_steps(q, 0.0 * q, pair.par, 1.0, 0.01, np.arange(1, 1))] == [
        (0, 2, 2)
    ] * 3
