"""The plainest step: exact for constant inputs, of first order, and the notebook's own loop written out."""

import numpy as np

from flockana import AlphaInteraction, Gains, StaticTarget, TaylorStep, simulate
from flockana.sources.notebook_r2.laws import PushedAlgorithm2
from tests.refused import refused

UNIT = Gains(c1_alpha=1.0, c2_alpha=1.0, c1_gamma=0.0, c2_gamma=0.5)
LAW = PushedAlgorithm2(AlphaInteraction(1.7, 2.5, 0.01, 0.2, 7.0, 15.0), UNIT, StaticTarget((5.0, 5.0), (0.7, 0.1)))


def as_written(q, p, dt):
    """One pass of the notebook's loop: agent by agent, neighbours by a_ij > 0, pairs below 0.05 times ten."""
    alpha, u = LAW.alpha, np.zeros_like(q)
    for i in range(len(q)):
        delta, slip = np.delete(q - q[i], i, axis=0), np.delete(p - p[i], i, axis=0)
        z = alpha.sigma_norm(np.linalg.norm(delta, axis=1))
        adjacency = alpha.adjacency(z)
        delta[np.linalg.norm(delta, axis=1) < 0.05] *= 10.0
        near = adjacency > 0.0
        n = delta / np.sqrt(1.0 + alpha.eps * np.sum(delta**2, axis=1))[:, None]
        u[i] = np.sum((alpha.phi_alpha(z)[:, None] * n)[near], axis=0) + np.sum(
            (adjacency[:, None] * slip)[near], axis=0
        )
        u[i] -= 0.5 * (p[i] - (0.7, 0.1))
    return q + p * dt + 0.5 * u * dt**2, p + u * dt


def test_the_notebooks_loop():
    rng = np.random.default_rng(3)
    q, p = rng.uniform(0.0, 6.0, (14, 2)), rng.standard_normal((14, 2))
    q[1] = q[0] + (0.02, 0.01)  # pushed
    run = simulate(TaylorStep(LAW, 0.1), q, p, (0.0, 1.0))
    for k in range(10):
        q, p = as_written(q, p, 0.1)
        np.testing.assert_allclose(run.q[k + 1], q, atol=1e-11)
        np.testing.assert_allclose(run.p[k + 1], p, atol=1e-11)


test_refusals = refused(
    (lambda: TaylorStep(LAW, 0.0), "dt = 0: expected a number > 0"),
    (lambda: TaylorStep(TaylorStep(LAW)), "expected a continuous law"),
)
