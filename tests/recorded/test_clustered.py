"""Standard errors from residuals that are dependent for each agent: how often intervals hold the truth."""

import numpy as np
import pytest
from scipy.stats import t

from flockana.recorded.clustered import covariance_over_agents


@pytest.mark.parametrize("n", [2, 3, 6])
def test_intervals_of_few_agents_hold_the_truth_as_often_as_they_say(n):
    """Two parameters, errors that an agent keeps for all its samples: 0.95 of 2000 intervals, within 4 deviations."""
    rng, inside = np.random.default_rng(n), []
    for _ in range(1000):
        slopes = rng.normal(size=(1, n, 2, 2)) + 0.3 * rng.normal(size=(20, n, 2, 2))
        y = rng.normal(size=(1, n, 2)) + 0.1 * rng.normal(size=(20, n, 2))
        a = slopes.reshape(-1, 2)
        found = np.linalg.lstsq(a, y.ravel(), rcond=None)[0]
        covariance, freedom = covariance_over_agents(slopes, y - slopes @ found)
        inside += (np.abs(found) <= t.ppf(0.975, freedom) * np.sqrt(np.diag(covariance))).tolist()
    assert 0.93 < np.mean(inside) < (0.97 if n > 3 else 0.995)  # on the safe side of very few


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
