"""The survey of informed agents: ensemble, shares with intervals, and its plot."""

import numpy as np
import pytest

import flockana as fl
from flockana import plots
from flockana.base.errors import ArgumentError


@pytest.fixture(scope="module")
def runs():
    return fl.ensemble(
        "informed-survey",
        range(4),
        theorems=["source"],
        parameters={"informed": [2, 12, 60]},
        metrics=["followers"],
        jobs=1,
    )


def test_more_informed_agents_are_followed_by_more(runs):
    """All are informed at the right end, so all follow; two of sixty, strewn far apart, lead not all."""
    share = runs["followers"].transpose("informed", "seed").values
    assert share[2].tolist() == [1.0] * 4
    assert share[0].mean() < 1.0


def test_intervals_come_from_the_shares_of_runs(runs):
    table = fl.shares(runs)
    low, high = fl.clopper_pearson(4, 4)
    assert (low, high) == (pytest.approx(0.025**0.25), 1.0)
    assert int(table["verified"].sel(claim="source:most-follow", informed=60)) == 4


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
