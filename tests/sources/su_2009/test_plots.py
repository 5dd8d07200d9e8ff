import numpy as np
import pytest
import xarray

from flockana import plots
from flockana.base.errors import ArgumentError


@pytest.fixture
def runs():
    """Four runs each of 2, 12 and 60 informed agents: in the last all agents follow."""
    shares = [[0.1, 0.3, 0.2, 0.6], [0.9, 0.7, 0.4, 0.8], [1.0] * 4]
    return xarray.Dataset({"followers": (("informed", "seed"), shares)}, {"informed": [2, 12, 60], "seed": range(4)})


def test_the_plot_shows_runs_means_and_intervals(runs):
    ax = plots.informed_shares(runs, agents=60)
    means = next(line for line in ax.lines if "mean" in str(line.get_label()))
    np.testing.assert_allclose(means.get_xdata(), np.array([2, 12, 60]) / 60)
    np.testing.assert_allclose(means.get_ydata(), runs["followers"].mean("seed").values)
    segments = ax.containers[0].lines[2][0].get_segments()
    np.testing.assert_allclose(segments[-1][:, 1], [0.025**0.25, 1.0])
    nobody = plots.informed_shares(runs.assign(followers=0.1 * runs["followers"])).containers[0].lines[2][0]
    np.testing.assert_allclose(nobody.get_segments()[-1][:, 1], [0.0, 1.0 - 0.025**0.25], atol=1e-12)


def test_a_dataset_without_followers_is_refused(runs):
    with pytest.raises(ArgumentError, match="expected 'followers' over 'informed'"):
        plots.informed_shares(runs.drop_vars("followers"))
    with pytest.raises(ArgumentError, match=r"majority = 1\.5: expected a share"):
        plots.informed_shares(runs, majority=1.5)
