"""The law with own sums: its force and motion against formulas and integrals of their own."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

import flockana as fl
from flockana import MotschTadmor, RationalWeight
from tests.refused import refused

RNG = np.random.default_rng(11)
Q, P = RNG.normal(size=(5, 2)), RNG.normal(size=(5, 2))
LAW = MotschTadmor(RationalWeight(decay=0.7, length=1.3), gain=2.0)


def force(q, p):
    """Written out agent by agent."""
    phi = [[(1.0 + np.sum((b - a) ** 2) / 1.3**2) ** -0.7 for b in q] for a in q]
    return np.array(
        [2.0 * sum(f / sum(row) * (b - a) for f, b in zip(row, p, strict=True)) for row, a in zip(phi, p, strict=True)]
    )


def test_the_force_is_the_mean_by_influence_and_of_the_strength_nothing_is_left():
    np.testing.assert_allclose(LAW.acceleration(0.0, Q, P), force(Q, P), rtol=0.0, atol=1e-14)
    strong = MotschTadmor(RationalWeight(strength=7.0, decay=0.7, length=1.3), gain=2.0)
    np.testing.assert_allclose(strong.acceleration(0.0, Q, P), force(Q, P), rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(LAW.influences(Q).sum(axis=1), 1.0, rtol=1e-15)
    assert np.isnan(LAW.energy(0.0, Q, P))


def test_a_run_is_that_of_another_solver():
    run = fl.simulate(LAW, Q, P, (0.0, 2.0), rtol=1e-10)
    other = solve_ivp(
        lambda t, y: np.concatenate([y[10:], force(y[:10].reshape(5, 2), y[10:].reshape(5, 2)).ravel()]),
        (0.0, 2.0),
        np.concatenate([Q.ravel(), P.ravel()]),
        rtol=1e-11,
        atol=1e-13,
    )
    np.testing.assert_allclose(np.concatenate([run.q[-1].ravel(), run.p[-1].ravel()]), other.y[:, -1], atol=1e-8)


@pytest.mark.parametrize("speed", [0.3, 1.0, 1.3])
def test_a_pair_stops_parting_where_the_integral_says(speed):
    """w − ∫ 2φ/(1 + φ) from 1 to the distance is kept: 2φ/(1 + φ) = 2/(2 + s²) for φ = 1/(1 + s²)."""
    run = fl.simulate(
        MotschTadmor(RationalWeight(decay=1.0)), [[0.0], [1.0]], [[0.0], [speed]], (0.0, 30.0), rtol=1e-10
    )
    s, w = run.q[-1, 1, 0] - run.q[-1, 0, 0], run.p[-1, 1, 0] - run.p[-1, 0, 0]
    assert speed - w == pytest.approx(quad(lambda x: 2.0 / (2.0 + x * x), 1.0, s)[0], abs=1e-8)


test_what_is_refused = refused(
    (lambda: MotschTadmor(gain=0.0), "gain = 0"),
    (lambda: MotschTadmor("weight"), "weight = 'weight': expected RationalWeight"),
)
