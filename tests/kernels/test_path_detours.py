"""What leaving out a step changes of the paths, against the curves themselves."""

import numpy as np
import pytest

from flockana.kernels.path_detours import detours
from flockana.kernels.quintic_paths import bernstein

TIMES = 1.0, 1.3, 2.1
BINOMIALS = 1, 5, 10, 10, 5, 1


def bernstein_polynomials(s):
    return np.array([c * s**k * (1.0 - s) ** (5 - k) for k, c in enumerate(BINOMIALS)])


def by_knot(states):
    """(q, p, u) of each of the three."""
    return tuple(states[0:3]), tuple(states[3:6]), tuple(states[6:9])


def curve(a, b, states, t):
    """The quintics between two of the three states, at a time."""
    h = TIMES[b] - TIMES[a]
    points = bernstein(h, *states[3 * a : 3 * a + 3], *states[3 * b : 3 * b + 3])[0]
    return np.einsum("k,nkc->nc", bernstein_polynomials((t - TIMES[a]) / h), points[:, :, : states.shape[2]])


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("n", [1, 7, 600])
def test_it_is_how_far_the_control_points_of_the_difference_get(n, m):
    """Those found from six places of the curve; no place of it is farther off."""
    rng = np.random.default_rng(n)
    states, slacks = rng.normal(size=(9, n, m)), 0.1 * rng.uniform(size=(2, n))
    bound, off, expected = detours(TIMES, *by_knot(states), *slacks), np.zeros(n), np.zeros(n)
    for k in range(2):
        shares = np.linspace(0.0, 1.0, 61)
        times = TIMES[k] + shares * (TIMES[k + 1] - TIMES[k])
        apart = np.array([curve(0, 2, states, t) - curve(k, k + 1, states, t) for t in times])
        points = np.linalg.solve(bernstein_polynomials(shares[::12]).T, apart[::12].reshape(6, -1)).reshape(6, n, m)
        off = np.maximum(off, np.linalg.norm(apart, axis=2).max(axis=0) + slacks[k])
        expected = np.maximum(expected, np.linalg.norm(points, axis=2).max(axis=0) + slacks[k])
    assert bound == pytest.approx(expected, rel=1e-9)
    assert (off <= bound * (1.0 + 1e-12)).all()


def test_a_middle_step_on_the_long_one_is_no_detour():
    """Of a motion that is a quintic itself, slacks are all that is left: the larger one."""
    coefficients = np.random.default_rng(0).normal(size=(6, 40, 2))
    states = []
    for t in TIMES:
        for order in range(3):
            powers = [np.polyder(np.eye(6)[5 - k], order) for k in range(6)]
            states.append(sum(np.polyval(power, t) * c for power, c in zip(powers, coefficients, strict=True)))
    assert detours(TIMES, *by_knot(states), np.full(40, 0.3), np.full(40, 0.2)) == pytest.approx(0.3, abs=1e-11)
    assert detours(TIMES, *by_knot(states), np.full(40, 0.2), np.full(40, 0.4)) == pytest.approx(0.4, abs=1e-11)
