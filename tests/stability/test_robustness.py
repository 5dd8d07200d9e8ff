"""Margins of broken loops: closed forms of one agent, a delay that eats the phase margin, gains that lose stability."""

from math import atan2, degrees, hypot, inf, sqrt

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, find_equilibrium, linearise
from flockana.base.errors import ArgumentError
from flockana.lattice import hexagonal_spiral
from flockana.stability.robustness import open_loop, robustness_margins

LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))
REST = find_equilibrium(LAW, hexagonal_spiral(3, 7.0)).q


def lone(k, d):
    return Algorithm2(gains=Gains(c1_gamma=k, c2_gamma=d), target=StaticTarget((0.0,)))


@pytest.mark.parametrize(("k", "d"), [(4.0, 4.0), (4.0, 1.0), (1.0, 0.3)])
def test_one_agent_in_closed_form(k, d):
    """L = (ds + k)/s²: unit gain at ω² = (d² + √(d⁴ + 4k²))/2, phase margin atan(ωd/k), no gain margin."""
    found = robustness_margins(lone(k, d), [[0.0]])
    omega = sqrt(0.5 * (d * d + hypot(d * d, 2.0 * k)))
    assert found.phase == pytest.approx(degrees(atan2(omega * d, k)), rel=1e-6)
    assert found.gain == (0.0, inf)
    w = np.geomspace(1e-3, 1e3, 200_001)
    peak = np.abs(w * w / (w * w - k - 1j * d * w)).max()
    assert found.sensitivity == pytest.approx(max(peak, 1.0), rel=1e-4)
    balanced = 2.0 / np.abs((-(w * w) - k - 1j * d * w) / (w * w - k - 1j * d * w)).max()  # 2 over the peak of S − T
    assert found.disk == pytest.approx(balanced, rel=1e-2)


def test_the_loop_is_that_of_one_input_with_all_others_closed():
    flock = linearise(LAW, REST)
    loop = open_loop(flock, 1, 0)
    closed = loop.A + loop.B @ -loop.C  # closing it gives the flock back
    np.testing.assert_allclose(closed, flock.A, atol=1e-12)
    found = robustness_margins(LAW, REST)
    assert len(found.loops) == REST.size
    assert found.weakest.disk == found.disk <= min(one.disk for one in found.loops)


def test_phase_margins_are_what_a_lag_at_the_crossover_takes():
    found = robustness_margins(LAW, REST).weakest
    loop = open_loop(linearise(LAW, REST), found.agent, found.axis)
    w = np.geomspace(0.1, 100.0, 100_001)
    response = np.ravel(loop(1j * w))
    crossing = np.flatnonzero(np.diff(np.sign(np.abs(response) - 1.0)))
    margins = np.abs(np.degrees(np.angle(-response[crossing])))
    assert found.phase == pytest.approx(margins.min(), abs=0.05)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: robustness_margins(lone(4.0, 0.0), [[0.0]]), "the flock is not stable"),
        (lambda: open_loop(linearise(LAW, REST), 3), "agent = 3, axis = 0: expected one of 3 agents and 2 axes"),
        (lambda: robustness_margins(Algorithm1(), 1.1 * REST), "no equilibrium"),
    ],
)
def test_bad_input(call, message):
    with pytest.raises(ArgumentError, match=message):
        call()
