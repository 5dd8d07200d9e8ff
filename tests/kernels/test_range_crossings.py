"""Who comes into range between two samples: against the roots of the same polynomials, and on straight ways exactly."""

import numpy as np
import pytest
from scipy.interpolate import BPoly

from flockana.kernels.range_crossings import follow_pairs, follow_steps

R = 1.0


def found(h, start, end, was_out=False, noise=1e-12, place=0.0, speed=0.0):
    """(enters, unsure, is out afterwards) of one pair over one interval."""
    out, unsure = np.array([was_out]), np.array([False])
    pair = follow_pairs(h, tuple(start), tuple(end), R, (noise, place, speed), out, unsure)
    return pair == (0, 1), bool(unsure[0]), bool(out[0])


def quintic(h, start, end):
    """The relative way of two agents, as a function of time: another construction of the same quintic."""
    ends = [[np.array(x[1] - x[0]) for x in state] for state in (start, end)]
    return BPoly.from_derivatives([0.0, h], ends)


def by_roots(h, start, end):
    """(enters, how near ρ² - r² comes to a double root) along the quintic."""
    times = np.linspace(0.0, h, 20001)
    square = np.sum(quintic(h, start, end)(times) ** 2, axis=1) - R**2
    out = np.maximum.accumulate(square > 0.0)
    return bool((out & (square < 0.0)).any())


@pytest.mark.slow
def test_what_is_certain_is_so_along_the_quintic():
    wrong = []
    for seed in range(300):
        rng = np.random.default_rng(seed)
        m, h = int(rng.integers(1, 4)), 10.0 ** rng.uniform(-1.5, 0.5)
        start, end = ([rng.normal(scale=s, size=(2, m)) for s in (0.7, 1.0, 1.0)] for _ in range(2))
        end[0] = start[0] + h * 0.5 * (start[1] + end[1]) + 0.1 * h**2 * rng.normal(size=(2, m))  # not too wild a way
        enters, unsure, _ = found(h, start, end)
        if (enters or not unsure) and by_roots(h, start, end) != enters:
            wrong.append(seed)
    assert wrong == []


def test_most_of_what_is_well_resolved_is_decided():
    decided = 0
    for seed in range(300):
        rng = np.random.default_rng(seed)
        x, v, turn = rng.uniform(-1.6, 1.6, 2), rng.normal(size=2), rng.normal()
        h = 0.1

        def at(t, x=x, v=v, turn=turn):
            """A circle: place, velocity and acceleration at times t, shape (3, 2, ...)."""
            c, s = np.cos(turn * t), np.sin(turn * t)
            velocity = np.array([c * v[0] - s * v[1], s * v[0] + c * v[1]])
            way = np.array([s * v[0] + (c - 1.0) * v[1], (1.0 - c) * v[0] + s * v[1]]) / turn
            place = x.reshape(2, *[1] * np.ndim(t)) + way
            return np.array([place, velocity, turn * np.array([-velocity[1], velocity[0]])])

        start, end = ([np.array([np.zeros(2), each]) for each in at(t)] for t in (0.0, h))  # the first agent is at rest
        enters, unsure, _ = found(h, start, end)
        gap = np.linalg.norm(at(np.linspace(0.0, h, 2001))[0], axis=0) - R
        truth = bool((np.maximum.accumulate(gap > 0.0) & (gap < 0.0)).any())
        assert unsure or enters == truth
        decided += not unsure
    assert decided > 295


@pytest.mark.parametrize("offset", [0.5, 1.0 - 1e-3, 1.0 - 1e-9, 1.0, 1.0 + 1e-9, 1.0 + 1e-3, 3.0])
@pytest.mark.parametrize("leap", [1.0, 1e3, 1e6])
def test_an_encounter_in_one_long_interval_is_seen(offset, leap):
    """Straight past each other, from far to far: nothing happens at either sample."""
    state = [np.array([[-leap, 0.0], [leap, offset]]), np.array([[1.0, 0.0], [-1.0, 0.0]]), np.zeros((2, 2))]
    end = [state[0] + 2.0 * leap * state[1], *state[1:]]
    enters, unsure, _ = found(2.0 * leap, state, end, noise=1e-15 * leap)
    assert not enters if offset >= 1.0 else enters or unsure
    if abs(offset - 1.0) > 1e-12 * leap**2:  # the squares of such lengths are rounded by so much
        assert (enters, unsure) == (offset < 1.0, False)


def test_leaving_is_not_entering_and_coming_back_is():
    def way(x0, x1, v0, v1, u):
        """Uniformly accelerated, in one dimension."""
        return [[np.array([[0.0], [y]]) for y in state] for state in ((x0, v0, u), (x1, v1, u))]

    leaves = way(0.5, 1.5, 1.0, 1.0, 0.0)
    assert found(1.0, *leaves) == (False, False, True)
    assert found(1.0, *leaves, was_out=True)[0]
    back = way(0.9, 0.9, 1.0, -1.0, -2.0)  # to 1.15 and back within one unit of time
    assert found(1.0, *back)[0]
    turns = way(0.5, 0.5, 0.4, -0.4, -0.8)  # to 0.6 and back
    assert found(1.0, *turns) == (False, False, False)
    outside = way(1.5, 1.5, -0.8, 0.8, 1.6)  # to 1.3 and away again
    assert found(1.0, *outside) == (False, False, True)
    grazes = way(1.5, 1.5, -2.0, 2.0, 4.0)  # to 1.0 exactly
    assert found(1.0, *grazes)[:2] == (False, True)


def test_steps_of_a_map_have_nothing_between_them():
    out, unsure = np.zeros(3, bool), np.zeros(3, bool)
    places = [[0.0, 1.5, 5.0], [0.0, 1.2, 5.0], [0.0, 0.7, 5.0]]
    seen = [follow_steps(np.array(x)[:, None], R, 1e-12, out, unsure) for x in places]
    assert seen == [(-1, -1), (-1, -1), (0, 1)]
    assert not unsure.any()
    follow_steps(np.array([[0.0], [1.0 + 1e-13], [5.0]]), R, 1e-12, out, unsure)
    assert unsure.tolist() == [True, False, False]


@pytest.mark.parametrize(("speed", "unsure"), [(0.0, False), (0.4, False), (2.0, True)])
def test_who_leaves_at_a_known_speed_does_not_come_in_however_little_is_known_of_the_place(speed, unsure):
    """From R − 1e-9 to R + 1e-9, known to 1e-6 and parting at 1: in so short a step the sign of the rate decides."""
    zero = np.zeros((2, 1))
    states = [(np.array([[0.0], [R + x]]), np.array([[0.0], [1.0]]), zero) for x in (-1e-9, 1e-9)]
    assert found(2e-9, *states, place=1e-6, speed=speed)[:2] == (False, unsure)
