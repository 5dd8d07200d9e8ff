"""Symmetries and identities of the laws, for any configuration."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana import Algorithm1, AlphaInteraction, Gains, metrics

GAINS = Gains(c1_alpha=2.0, c2_alpha=0.8, c1_gamma=0.4, c2_gamma=0.6)
ALPHAS = [AlphaInteraction(), AlphaInteraction(h=0.9, a=2.0, b=7.0), AlphaInteraction(d=2.0, r=9.0, eps=1.0)]
flocks = st.tuples(st.integers(0, 2**32 - 1), st.integers(1, 25), st.integers(1, 3), st.sampled_from(ALPHAS))


def state(seed, n, m, *, spread=5.0):
    rng = np.random.default_rng(seed)
    return rng.uniform(-1, 1, (n, m)) * spread * n ** (1 / m), rng.normal(0.0, 1.0, (n, m)), rng


@given(flocks)
def test_rigid_motions_and_relabelling(flock):
    seed, n, m, alpha = flock
    q, p, rng = state(seed, n, m)
    law = Algorithm1(alpha, GAINS)
    turn = np.linalg.qr(rng.normal(size=(m, m)))[0]
    shift, order = rng.normal(0.0, 50.0, m), rng.permutation(n)
    q2, p2 = (q @ turn + shift)[order], (p @ turn)[order]
    u, u2 = law.acceleration(0.0, q, p), law.acceleration(0.0, q2, p2)
    np.testing.assert_allclose(u2, (u @ turn)[order], atol=1e-10 * (1 + np.abs(u).max()))
    for f in (law.energy, law.energy_rate):
        assert f(0.0, q2, p2) == pytest.approx(f(0.0, q, p), rel=1e-10, abs=1e-10)
    assert metrics.net_measures(q2, alpha.d, alpha.r) == pytest.approx(metrics.net_measures(q, alpha.d, alpha.r))
    for f in (metrics.cohesion_radius, metrics.inertia, metrics.min_distance):
        assert f(q2) == pytest.approx(f(q), rel=1e-9, abs=1e-12)
    assert metrics.velocity_mismatch(p2) == pytest.approx(metrics.velocity_mismatch(p), rel=1e-10)
    assert metrics.order(p2) == pytest.approx(metrics.order(p), rel=1e-10)
