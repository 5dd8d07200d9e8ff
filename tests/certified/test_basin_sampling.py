"""Sampled basins: starts that must return do, starts that cannot do not, and the picture says both."""

import numpy as np
import pytest

from flockana import plots, sample_basin
from tests.certified.conftest import basin_of
from tests.plots.artists import axes
from tests.refused import refused


@pytest.mark.parametrize("algorithm", [1, 2])
def test_what_is_proved_returns_and_what_is_torn_apart_does_not(algorithm):
    basin = basin_of("triangle", algorithm)
    proved = np.sqrt(float(basin.level) / 400.0)  # U - U* <= ½ 400 δ² there
    found = sample_basin(basin, [proved, 60.0], runs=3, t_end=2.0)  # within 2 nothing comes back from far away
    assert found.returned.tolist() == [3, 0]
    low, high = found.interval()
    assert np.all((low <= found.shares) & (found.shares <= high))


def test_the_picture_shows_shares_and_the_certified_radius():
    basin = basin_of("pair", 1)
    found = sample_basin(basin, [0.2, 5.0], runs=3)
    ax = plots.sampled_basin(found, ax=axes())
    points = ax.containers[0].lines[0].get_xydata()
    np.testing.assert_allclose(points[:, 0], [0.2 / 7.0, 5.0 / 7.0])
    assert points[0, 1] == 1.0
    texts = [text.get_text() for text in ax.get_legend().get_texts()]
    assert rf"certified $\rho$ = {basin.share:.3f} d" in texts


test_bad_distances_are_named = refused(
    (lambda: sample_basin(basin_of("pair", 1), []), "expected one or more numbers > 0"),
    (lambda: sample_basin(basin_of("pair", 1), [-1.0]), "distances"),
)
