"""What Tanner's law keeps apart: near the minimum of V, where rounding moves the bound, and between samples."""

import numpy as np
import pytest

from flockana import Algorithm1, FixedNetFlocking, LogPotential, simulate, verify
from flockana.sources.tanner_2007.theorems.common_claims import _energy_error
from flockana.theorems.bounds_between_samples import least_distance, spread_over
from flockana.theorems.observed_run import Observed


def test_the_error_of_few_samples_holds_what_many_find():
    law, q, p = FixedNetFlocking(edges=((0, 1),)), [[0.0, 0.0], [1.2, 0.0]], [[0.0, 0.0], [0.0, 0.1]]
    runs = (simulate(law, q, p, (0.0, 2.0), t_eval=times) for times in ([0.0, 2.0], np.linspace(0.0, 2.0, 101)))
    few, many = (verify("tanner-fixed", run).claim("no-collision") for run in runs)
    assert many.error < 1e-3 < few.margin - many.margin
    assert few.margin - few.error <= many.margin
    assert few.status == many.status == "verified"


@pytest.mark.parametrize("level", [1e-24, 1e-16, 4e-9, 1e-8, 1.0, 50.0])
def test_the_distance_of_an_energy_has_it(level):
    from mpmath import log, mp, mpf

    # a distance holds 1 - s/d = √(level/2) to ε only
    near = LogPotential(2.0, 3.0).nearest(2.0 * level)
    mp.dps = 60
    w = -2 * log(mpf(near) / 3)
    assert float((mp.e**w - 1 - w) / level) == pytest.approx(1.0, abs=1e-12 + 1e-15 / level**0.5)
    assert 0.0 < near < 3.0


def test_between_two_samples_a_pair_is_nearer_and_the_flock_wider():
    """Two agents that pass at a distance of 30, free of forces, sampled at the ends alone: 40 away from there."""
    q, p = np.array([[-40.0, 0.0], [0.0, 30.0]]), np.array([[40.0, 0.0], [0.0, 0.0]])
    run = simulate(Algorithm1(), q, p, (0.0, 2.0), t_eval=[0.0, 2.0])
    seen = Observed.alone(run)
    assert 15.0 < float(least_distance(seen, [0], [1]).lo) <= 30.0
    assert float(spread_over(seen).hi.max()) >= 50.0 / np.sqrt(2.0) * (1.0 - 1e-12)


def test_at_the_minimum_an_error_of_the_distance_counts_squared():
    """V = k (d²/s² − 1 − ln d²/s²) is flat at d: far from the origin rounding moves the bound by itself, no more."""
    q = np.array([[1e6, 0.0], [1e6 + 1.0, 0.0]])
    run = simulate(FixedNetFlocking(edges=((0, 1),)), q, 0.0 * q, (0.0, 1.0))
    claim = verify("tanner-fixed", run).claim("no-collision")
    assert claim.status != "refuted"
    assert 1e-9 < claim.error < 1e-7


def test_off_the_minimum_an_error_of_the_distance_moves_the_bound_by_half_as_much():
    """Of 8ε(s + |q|) in d²/s² half of that, times s: V' = 2k(1 − d²/s²)/s."""
    q = np.array([[1e6, 0.0], [1e6 + 0.8, 0.0]])
    run = simulate(FixedNetFlocking(edges=((0, 1),)), q, 0.0 * q, (0.0, 0.1))
    slope = 2.0 * abs(1.0 - 1.0 / 0.64) / 0.8
    error = _energy_error(Observed.alone(run), [0], [1])
    assert error / slope == pytest.approx(4.0 * np.finfo(float).eps * 1e6, rel=1e-5)
