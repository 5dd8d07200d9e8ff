"""Ultimate bounds: their scaling, their edge, a push that a run survives, bad input."""

from dataclasses import replace
from fractions import Fraction
from math import sqrt

import numpy as np
import pytest

from flockana import Algorithm1, Disturbed, certify, simulate, ultimate_bound
from tests.adversarial import truth
from tests.refused import refused

PAIR = certify([[0.0], [7.0]], law=Algorithm1())


def test_the_bound_is_that_of_the_formula():
    found, own = ultimate_bound(PAIR, 0.1), PAIR.proof.decay
    e = float(own.eps) / sqrt(float(PAIR.curvature))
    gain = sqrt(2.0 * (1.0 + e * e) / (1.0 - e)) / (2.0 * float(own.rate))
    assert float(found.excess) == pytest.approx((0.1 * gain) ** 2 / (1.0 - e), rel=1e-3)
    assert float(found.largest) == pytest.approx(sqrt((1.0 - e) * float(PAIR.level)) / gain, rel=1e-3)
    assert float(found.distance) == pytest.approx(sqrt(2.0 * float(found.excess) / float(PAIR.curvature)), rel=1e-3)
    assert ultimate_bound(PAIR, 0.0).distance == 0


def test_a_flock_stays_if_the_push_is_less_than_what_could_leave():
    found = ultimate_bound(PAIR, 0.1)
    assert found.stays
    assert not ultimate_bound(PAIR, float(found.largest) * 1.0001).stays
    assert found.holds([[0.0], [7.05]], [[0.0], [0.0]])
    assert not found.holds([[0.0], [7.45]], [[0.0], [0.0]])  # in the ball, not deep enough
    assert not ultimate_bound(PAIR, 1.0).holds([[0.0], [7.0]], [[0.0], [0.0]])


@pytest.mark.parametrize("frequency", [0.05, 0.7, 1.0])
def test_runs_keep_within_the_bound(frequency):
    """A pair pushed apart and together, at a fixed frequency; 0.3 in each coordinate is 0.42 in all.

    It swings as its linearisation does, s'' + D s' + K s = 0.6 sin ωt.
    """
    law = Disturbed(Algorithm1(), swing=[[0.3], [-0.3]], frequency=frequency)
    bound = ultimate_bound(PAIR, 0.3 * sqrt(2.0))
    run = simulate(law, [[0.0], [7.0]], [[0.0], [0.0]], (0.0, 40.0))
    away = np.abs(run.q[:, 1, 0] - run.q[:, 0, 0] - 7.0) / sqrt(2.0)
    assert bound.stays
    assert away.max() < float(bound.distance)
    alpha, gains, step, omega = run.law.law.alpha, run.law.law.gains, 1e-5, 2.0 * np.pi * frequency
    stiff = gains.c1_alpha * (truth.pull(7.0 + step, alpha) - truth.pull(7.0 - step, alpha)) / step
    drag = 2.0 * gains.c2_alpha * truth.adjacency(7.0, alpha)
    amplitude = 0.6 / abs(stiff - omega**2 + 1j * omega * drag) / sqrt(2.0)
    assert away[run.t > 20.0].max() == pytest.approx(amplitude, rel=5e-3)


test_bad_input = refused(
    (lambda: ultimate_bound(PAIR, -0.1), "disturbance = -0.1"),
    (lambda: ultimate_bound("basin", 0.1), "basin = 'basin': expected a basin"),
    (lambda: ultimate_bound(replace(PAIR, rate=Fraction(9)), 0.1), "a basin as certify returned it"),
)
