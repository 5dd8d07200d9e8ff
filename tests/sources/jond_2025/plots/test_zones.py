import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.patches import Circle

from flockana import Algorithm1, ZoneFlocking, plots, scenario, simulate
from flockana.base.errors import ArgumentError
from flockana.report.figures import pictures
from flockana.sources.jond_2025.theorems.random_starts import crowd_start
from tests.plots.artists import axes


def heights(ax):
    return {line.get_label(): line.get_ydata() for line in ax.get_lines()}


@pytest.fixture(scope="module")
def run():
    entry = scenario("zone-52")
    return simulate(entry.law, entry.q0, entry.p0, (0.0, 3.0))


def test_buffers_instead_of_triangles():
    entry = scenario("zone-gap-buffer")
    ax = plots.zones(simulate(entry.law, entry.q0, entry.p0, (0.0, 1.0)), ax=axes())
    assert [type(patch) for patch in ax.patches].count(Circle) == 1
    assert not any(isinstance(c, PolyCollection) for c in ax.collections)


def test_series_hold_the_numbers_and_their_bounds(run):
    lines = heights(plots.zone_distances(run, ax=axes()))
    np.testing.assert_allclose(lines["least (D)"], run.metrics().min_distance)
    assert [lines[name][0] for name in "rca"] == [1.5, 3.0, 5.0]
    lines = heights(plots.zone_speeds(run, ax=axes()))
    assert (lines["desired"][0], lines["bound"][0]) == (3.0, 4.0)
    lines = heights(plots.zone_controls(run, ax=axes()))
    np.testing.assert_allclose(lines["mean"], np.linalg.norm(run.u, axis=2).mean(axis=1))
    assert lines["bound"][0] == 10.0
    np.testing.assert_allclose(heights(plots.zone_safety(run, ax=axes()))["wall"], run.metrics().wall_distance)
    conflict = heights(plots.zone_populations(run, ax=axes()))["conflict"]
    np.testing.assert_allclose(conflict, run.metrics().in_conflict)


def test_an_empty_plane_says_so():
    ax = plots.zone_safety(simulate(ZoneFlocking(), [[0.0, 0.0]], [[1.0, 0.0]], (0.0, 1.0)), ax=axes())
    assert ax.texts[0].get_text() == "nothing to keep clear of"


def test_other_laws_and_lines_are_refused():
    other = simulate(Algorithm1(), [[0.0, 0.0]], [[1.0, 0.0]], (0.0, 1.0))
    for draw in (plots.zones, plots.zone_distances, plots.zone_safety):
        with pytest.raises(ArgumentError, match="expected a run of ZoneFlocking"):
            draw(other, ax=axes())
    with pytest.raises(ArgumentError, match="agents live on a line"):
        plots.zones(simulate(ZoneFlocking(), [[0.0]], [[1.0]], (0.0, 1.0)), ax=axes())
    with pytest.raises(ArgumentError, match="time = 9: expected a time of the run, 0 to 1"):
        plots.zones(simulate(ZoneFlocking(), [[0.0, 0.0]], [[1.0, 0.0]], (0.0, 1.0)), 9.0, ax=axes())


def test_the_report_draws_a_law_by_its_own_module(run):
    own = pictures(run)
    assert len(own) == 3
    assert "the alien" in own[0].caption
    assert "obstacles" in own[2].caption
    assert all("<svg" in picture.source for picture in own)


def test_a_crowd_is_drawn_by_its_profile():
    crowd = simulate(ZoneFlocking(), *crowd_start(0, 110), (0.0, 0.3))
    lines = heights(plots.zone_distances(crowd, ax=axes()))
    np.testing.assert_allclose(lines["least (D)"], crowd.metric("min_distance"), rtol=1e-12)
    assert {"median", "r", "c", "a"} < set(lines)
    assert len(lines) == 5


def test_triangles_are_as_long_as_the_speed_makes_them():
    q, p = [[0.0, 0.0], [20.0, 0.0], [40.0, 0.0]], [[1e-9, 0.0], [2.0, 0.0], [4.0, 0.0]]
    start = simulate(ZoneFlocking(zone_length="speed"), q, p, (0.0, 0.1))
    (found,) = (c for c in plots.zones(start, 0.0, ax=axes()).collections if isinstance(c, PolyCollection))
    tips = [path.vertices[0, 0] - x for path, (x, _) in zip(found.get_paths(), q, strict=True)]
    assert tips == pytest.approx([1.5, 3.25, 5.0])
