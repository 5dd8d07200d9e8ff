"""Formations by distances: the law, its neighbourhood in closed form, lines and folds that are never left."""

from math import sqrt

import numpy as np
import pytest

import flockana as fl
from flockana.scenarios import scenario
from tests.refused import refused
from tests.theorems.made_up import statuses

TRIANGLE = ((0, 1), (1, 2), (0, 2))
LAW = fl.DistanceFormation(TRIANGLE, (1.0, 1.2, 1.5), gain=0.7)
Q = np.random.default_rng(4).normal(size=(3, 2))


def test_velocities_are_those_written_out_and_minus_the_gradient():
    d = {(0, 1): 1.0, (1, 2): 1.2, (0, 2): 1.5}
    own = np.zeros((3, 2))
    for (i, j), length in d.items():
        pull = 0.7 * (np.sum((Q[j] - Q[i]) ** 2) - length**2) * (Q[j] - Q[i])
        own[i] += pull
        own[j] -= pull
    np.testing.assert_allclose(LAW.velocity(0.0, Q), own, atol=1e-15)
    np.testing.assert_allclose(-0.7 * LAW.rows(Q).T @ LAW.errors(Q), own.ravel(), atol=1e-15)
    slopes = np.asarray(LAW.jacobian(0.0, Q))
    np.testing.assert_allclose(slopes, slopes.T, atol=1e-9)


def test_one_link_is_the_logistic_equation_of_its_square():
    """x = s²: x' = −4k (x − d²) x, so that x = d²/(1 − (1 − d²/x₀) e^{−4kd²t})."""
    run = fl.simulate(fl.DistanceFormation(((0, 1),), 1.5, gain=0.4), [[0.0, 0.0], [2.0, 0.0]], None, (0.0, 1.3))
    x = 2.25 / (1.0 - (1.0 - 2.25 / 4.0) * np.exp(-4.0 * 0.4 * 2.25 * 1.3))
    assert np.sum((run.q[-1, 1] - run.q[-1, 0]) ** 2) == pytest.approx(x, rel=1e-7)


@pytest.mark.slow
def test_lengths_that_no_line_leaves_and_none_has_die_out_as_one_over_t():
    """Lengths 1, 1, 2 on a line are reached along it; across, errors of 1/t are left: doubled time halves them."""
    law = fl.DistanceFormation(TRIANGLE, (1.0, 1.0, 2.0))
    run = fl.simulate(law, [[-1.0, 0.0], [0.0, 0.3], [1.0, 0.0]], None, (0.0, 4000.0), t_eval=[1000.0, 2000.0, 4000.0])
    error = run.metric("length_error")
    np.testing.assert_allclose(error[:-1] / error[1:], 2.0, rtol=0.01)
    line = scenario("formation-line").run()
    assert np.abs(line.q[..., 1]).max() == 0.0


def test_two_triangles_that_start_folded_end_folded():
    half = sqrt(3.0) / 2.0
    law = fl.DistanceFormation(((0, 1), (0, 2), (1, 2), (0, 3), (1, 3)))
    start = np.array([[0.0, 0.0], [1.0, 0.0], [0.45, half], [0.55, 0.9 * half]])
    run = fl.simulate(law, start, None, (0.0, 40.0))
    assert run.metric("length_error")[-1] < 1e-6
    assert np.linalg.norm(run.q[-1, 3] - run.q[-1, 2]) < 1e-6  # and not √3 apart


@pytest.mark.parametrize("side", [1.0 - 1e-9, 1.0 + 1e-9])
def test_the_neighbourhood_of_one_link(side):
    """σ² = 2 s² > 4 |s² − d²| below s² = 2 d²."""
    law = fl.DistanceFormation(((0, 1),), 3.0)
    verdict = fl.verify(
        "distance-formation", law=law, q0=[[0.0, 0.0], [3.0 * sqrt(2.0 * side), 0.0]], t_span=(0.0, 0.1)
    )
    told = statuses(verdict)
    assert told["formation"] == told["nearby"] == ("verified" if side < 1.0 else "vacuous")
    assert verdict.claim("nearby").stated == "no agent is farther than 1.5 from its start"  # ‖e‖/σ = 9/6
    assert verdict.claim("formation").stated.endswith("at the rate 18")
    assert 0.0 < verdict.claim("nearby").computed <= 3.0 * (sqrt(0.5) - 0.5)


test_what_is_refused = refused(
    (lambda: fl.DistanceFormation(()), "expected at least one link"),
    (lambda: fl.DistanceFormation(TRIANGLE, (1.0, 2.0)), "2 lengths of 3 links"),
    (lambda: fl.DistanceFormation(TRIANGLE, 0.0), "lengths = 0"),
    (lambda: fl.simulate(LAW, Q[:2], None, (0.0, 1.0)), "edges"),
)
