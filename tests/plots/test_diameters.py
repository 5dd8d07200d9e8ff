import numpy as np
import pytest
from matplotlib.patches import Rectangle

from flockana import HeadingAveraging, plots, simulate
from flockana.base.errors import ArgumentError
from tests.plots.artists import Halving, axes

LAW = HeadingAveraging(range=1.0, speed=0.1, dt=1.0)


def meeting():
    """Two agents head-on, 1.5 apart: within 1 from the third step on."""
    return simulate(LAW, [[0.0, 0.0], [1.5, 0.0]], LAW.velocities([0.0, np.pi]), (0.0, 6.0))


def test_diameters_over_those_at_the_start():
    positions, velocities = plots.diameters(meeting(), ax=axes()).get_lines()
    np.testing.assert_allclose(positions.get_ydata()[:3], [1.0, 1.3 / 1.5, 1.1 / 1.5])
    np.testing.assert_allclose(velocities.get_ydata()[[0, -1]], [1.0, 1e-12])


def test_windows_are_bands_to_the_instant_where_the_next_begins():
    ax = plots.joint_windows(meeting(), ax=axes())
    bands = [(band.get_x(), band.get_x() + band.get_width()) for band in ax.patches if isinstance(band, Rectangle)]
    assert bands[:2] == [(0.0, 4.0), (5.0, 6.0)]
    assert ax.get_title(loc="left") == "4 windows of joint connectivity"
    assert ax.get_lines()[0].get_ydata().tolist() == [0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]


def test_what_is_left_over_is_hatched():
    run = simulate(LAW, [[0.0, 0.0], [1.5, 0.0]], LAW.velocities([np.pi, 0.0]), (0.0, 6.0))
    ax = plots.joint_windows(run, ax=axes())
    assert [band.get_hatch() for band in ax.patches] == ["//"]


def test_a_law_without_a_net_is_refused():
    with pytest.raises(ArgumentError, match="Halving has no net"):
        plots.joint_windows(simulate(Halving(), [[0.0], [1.0]], [[0.0], [0.0]], (0.0, 1.0)), ax=axes())
