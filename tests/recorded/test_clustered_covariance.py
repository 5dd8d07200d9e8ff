"""Standard errors from residuals that are dependent for each agent."""

import numpy as np

from flockana.recorded.clustered_covariance import covariance_over_agents


def test_what_one_agent_alone_tells_has_the_error_of_independent_residuals():
    rng = np.random.default_rng(0)
    slopes, rest = rng.normal(size=(30, 4, 2, 2)), rng.normal(size=(30, 4, 2))
    slopes[:, 1:, :, 1] = 0.0
    for part in (slice(None), slice(1)):  # of four agents, and of one by itself
        x, y = slopes[:, part], rest[:, part]
        covariance, freedom = covariance_over_agents(x, y)
        assert freedom == y.size - 2
        a = x.reshape(-1, 2)
        np.testing.assert_allclose(covariance, np.linalg.inv(a.T @ a) * np.sum(y**2) / freedom, rtol=1e-12)


def test_it_is_the_jackknife_of_estimates_without_each_agent():
    """(n − 1)/n Σ (β₋ᵢ − β)(β₋ᵢ − β)ᵀ, by least squares without agent i."""
    rng = np.random.default_rng(3)
    slopes, y = rng.normal(size=(9, 5, 2, 3)), rng.normal(size=(9, 5, 2))

    def estimate(agents):
        return np.linalg.lstsq(slopes[:, agents].reshape(-1, 3), y[:, agents].ravel(), rcond=None)[0]

    whole = estimate(np.arange(5))
    off = np.array([estimate(np.delete(np.arange(5), i)) - whole for i in range(5)])
    found, _ = covariance_over_agents(slopes, y - slopes @ whole)
    np.testing.assert_allclose(found, 0.8 * off.T @ off, rtol=1e-10)
