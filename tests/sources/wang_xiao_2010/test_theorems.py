"""Agreement in a finite time: the force by hand, the time of a pair, the bound of a ring, and no linearisation."""

import numpy as np
import pytest

import flockana as fl
from flockana import FiniteTimeAlignment, verify
from flockana.base.errors import ArgumentError
from tests.refused import refused
from tests.theorems.made_up import statuses

PATH = FiniteTimeAlignment(((0, 1), (1, 2)), gain=2.0, exponent=0.5, speed=4.0)
RING = FiniteTimeAlignment([(k, (k + 1) % 5) for k in range(5)])
P = np.array([[0.0, 1.0], [1.0, -8.0], [-3.0, 1.0]])


def test_the_force_and_the_power_by_hand():
    """a s √(1/4) = 4, a s √(4/4) = 8, a s √(9/4) = 12."""
    u, power = PATH.flow(0.0, np.zeros((3, 2)), P)
    np.testing.assert_allclose(u, [[4.0, -12.0], [-12.0, 24.0], [8.0, -12.0]], rtol=1e-15)
    assert power == pytest.approx(-(4.0 + 32.0 + 108.0 + 108.0), rel=1e-15)
    assert PATH.energy(0.0, np.zeros((3, 2)), P) == pytest.approx(0.5 * np.sum((P - P.mean(axis=0)) ** 2), rel=1e-15)


def test_slopes_are_those_of_differences_and_none_at_rest():
    jacobian = PATH.jacobian(0.0, np.zeros((3, 2)), P)[6:, 6:]
    near = [PATH.acceleration(0.0, np.zeros((3, 2)), P + 1e-6 * e.reshape(3, 2)).ravel() for e in np.eye(6)]
    u = PATH.acceleration(0.0, np.zeros((3, 2)), P).ravel()
    np.testing.assert_allclose(jacobian, (np.array(near) - u).T / 1e-6, atol=1e-5)
    with pytest.raises(ArgumentError, match=r"FiniteTimeAlignment has no derivative.* 0 and 1 .*exponent=1"):
        fl.linearise(RING, np.zeros((5, 1)))
    poles = fl.linearise(FiniteTimeAlignment(((0, 1),), exponent=1.0), [[0.0], [1.0]]).eigenvalues
    assert sorted(poles.real) == pytest.approx([-2.0, 0.0, 0.0, 0.0], abs=1e-14)


def test_a_pair_agrees_at_its_time_and_attains_the_bound():
    """w' = −2√w from 4: √w = 2 − t."""
    law, start = FiniteTimeAlignment(((0, 1),)), ([[0.0], [1.0]], [[0.0], [4.0]])
    run = fl.simulate(law, *start, (0.0, 1.9), t_eval=[1.0, 1.9])
    np.testing.assert_allclose(np.diff(run.p[:, :, 0], axis=1)[:, 0], [1.0, 0.01], rtol=1e-5)
    verdict = verify("finite-time", law=law, q0=start[0], p0=start[1], t_span=(0.0, 1.5))
    assert verdict.claim("settle").stated == "all velocities are p̄ from T = 2 on"
    assert abs(verdict.claim("bound").margin) < 1e-6


def test_the_bound_of_a_ring_in_other_units():
    """λ₂ = 2 − 2cos(2π/5) of the ring, T = √v/(½ λ₂^¾) for α = ½; lengths of 10 and times of 1/4."""
    rng = np.random.default_rng(4)
    q, p = rng.normal(size=(5, 2)), rng.normal(size=(5, 2))
    v = np.sqrt(np.sum((p - p.mean(axis=0)) ** 2))
    last = np.sqrt(v) / (0.5 * (2.0 - 2.0 * np.cos(0.4 * np.pi)) ** 0.75)
    law = fl.rescale(RING, length=10.0, time=0.25)
    verdict = verify("finite-time", law=law, q0=10.0 * q, p0=40.0 * p, t_span=(0.0, 0.1))
    assert verdict.claim("settle").stated == f"all velocities are p̄ from T = {0.25 * last:.6g} on"
    assert statuses(verdict) == {"bound": "verified", "settle": "verified", "some-start": "vacuous"}


test_what_is_refused = refused(
    (lambda: FiniteTimeAlignment(((0, 1),), exponent=1.5), "exponent = 1.5: expected 0 < exponent <= 1"),
    (lambda: FiniteTimeAlignment(((0, 5),)).acceleration(0.0, P, P), "links name agent 5"),
)


@pytest.mark.slow
def test_a_run_far_beyond_agreement_is_refused_after_so_many_steps():
    """Steps of about 2e-4 of the law's time, made in Python: to t = 30 they would take minutes."""
    law = FiniteTimeAlignment(((0, 1), (1, 2)), exponent=0.5)
    run = fl.simulate(law, np.zeros((3, 1)), [[1.0], [-2.0], [0.0]], (0.0, 30.0))
    assert (run.status, run.stats["steps"]) == ("failed", 10_000)
    assert "more steps to t = 30" in run.message
