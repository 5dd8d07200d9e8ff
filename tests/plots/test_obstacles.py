import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.patches import Polygon as Outline

from flockana import Algorithm1, Algorithm3, Capsule, Polygon, Sphere, StaticTarget, Trajectory, Wall, plots, simulate
from flockana.base.errors import ArgumentError
from flockana.interactions import BetaInteraction
from flockana.measures.reynolds import reynolds
from flockana.report.figures import middle_sample, pictures
from tests.plots.artists import axes, segments


def outline(solid, **options):
    ax = plots.obstacles([solid], ax=axes(), **options)
    (patch,) = [p for p in (*ax.patches, *ax.artists) if isinstance(p, Outline)]
    return ax, patch.get_xy()[:-1]


def area(corners):
    x, y = corners.T
    return 0.5 * abs(float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))))


@pytest.mark.parametrize(
    ("solid", "size"),
    [
        (Sphere((3.0, -2.0), 5.0), np.pi * 25.0),
        (Capsule((0.0, 0.0), (8.0, 6.0), 2.0), 40.0 + np.pi * 4.0),
        (Polygon([(0.0, 0.0), (4.0, 0.0), (4.0, 3.0)]), 6.0),
        (Polygon([(0.0, 0.0), (40.0, 0.0), (40.0, 0.5), (0.0, 0.5)]), 20.0),
    ],
)
def test_the_outline_is_the_boundary_of_the_whole_solid(solid, size):
    _, corners = outline(solid)
    np.testing.assert_allclose(solid.clearance(corners), 0.0, atol=1e-9)
    # the polygon of 720 points misses at most 1 − sin(2π/720)/(2π/720) = 1.3e-5 of a disc
    assert area(corners) == pytest.approx(size, rel=3e-5)


def test_a_wall_fills_its_side_of_the_view_and_does_not_widen_it():
    view = np.array([[0.0, 0.0], [10.0, 10.0]])
    ax, corners = outline(Wall((0.0, 2.0), (0.0, 1.0)), view=view)
    assert corners[:, 1].max() == pytest.approx(2.0)
    assert corners[:, 1].min() < -10.0
    assert corners[:, 0].min() < 0.0 < 10.0 < corners[:, 0].max()
    assert not np.isfinite(ax.dataLim.get_points()).any() or ax.dataLim.y0 > -10.0


def test_on_a_line_an_obstacle_is_an_interval_and_in_space_a_mesh_on_the_surface():
    (patch,) = plots.obstacles([Sphere((4.0,), 1.5)], ax=axes()).patches
    assert (patch.get_xy()[:, 0].min(), patch.get_xy()[:, 0].max()) == (2.5, 5.5)
    solid = Sphere((1.0, 2.0, 3.0), 2.0)
    (mesh,) = plots.obstacles([solid], ax=axes(3)).collections
    lines = np.concatenate(segments(mesh))
    np.testing.assert_allclose(solid.clearance(lines), 0.0, atol=1e-12)
    assert np.ptp(lines[:, 2]) == pytest.approx(4.0)
    wall = Wall((0.0, 0.0, 1.0), (0.0, 0.0, 1.0))
    (mesh,) = plots.obstacles([wall], ax=axes(3), view=np.array([[-5.0, -5.0, 0.0], [5.0, 5.0, 5.0]])).collections
    lines = np.concatenate(segments(mesh))
    np.testing.assert_allclose(lines[~np.isnan(lines[:, 2]), 2], 1.0)


def test_beta_agents_are_drawn_within_their_range_only():
    beta, solids = BetaInteraction(), [Sphere((0.0, 0.0), 3.0), Wall((0.0, -20.0), (0.0, 1.0))]
    q = np.array([[8.0, 0.0], [8.05, 1e3], [0.0, -15.5]])  # 5 and 4.5 away are within r' = 5.04
    ax = plots.configuration(q, obstacles=solids, beta=beta, ax=axes())
    marks = next(c for c in ax.collections if c.get_label() == "β-agents")
    np.testing.assert_allclose(marks.get_offsets(), [[3.0, 0.0], [0.0, -20.0]])
    joins = next(c for c in ax.collections if isinstance(c, LineCollection))
    np.testing.assert_allclose(joins.get_segments(), [[[8.0, 0.0], [3.0, 0.0]], [[0.0, -15.5], [0.0, -20.0]]])
    without = plots.configuration(q, obstacles=solids, ax=axes())
    assert not any(c.get_label() == "β-agents" for c in without.collections)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_a_snapshot_shows_the_obstacles_of_the_law(m):
    centre = (20.0, *(0.0,) * (m - 1))
    law = Algorithm3(target=StaticTarget((0.0,) * m), obstacles=(Sphere(centre, 5.0), Wall((-30.0,) * m, (1.0,) * m)))
    q = np.zeros((2, m))
    q[1, 0] = 10.5
    ax = plots.snapshot(Trajectory(np.zeros(1), q[None], 0.0 * q[None], 0.0 * q[None], law), 0.0, ax=axes(m))
    assert any(c.get_label() == "β-agents" for c in ax.collections)
    ax.get_figure().canvas.draw()
    assert ax.get_xlim()[1] >= 25.0


def test_axes_of_their_own_show_all_of_them_round():
    ax = plots.obstacles((Sphere((25.0, 0.0), 5.0), Sphere((0.0, 40.0), 2.0)))
    ax.get_figure().canvas.draw()
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    assert left < -2.0 < 30.0 < right
    assert low < -5.0 < 42.0 < high
    assert ax.get_aspect() == 1.0


def two_discs():
    """A made-up run: two agents part round a disc and meet again, sampled coarsely."""
    law = Algorithm3(target=StaticTarget((0.0, 0.0)), obstacles=(Sphere((0.0, 0.0), 1.0), Sphere((0.0, 90.0), 1.0)))
    q = np.array([[[-9.0, 4.0], [-9.0, -4.0]], [[0.0, 6.0], [0.0, -7.0]], [[9.0, 4.0], [9.0, -4.0]]])
    p = np.broadcast_to((9.0, 0.0), q.shape)
    return Trajectory(np.array([0.0, 1.0, 2.0]), q, p, 0.0 * q, law)


def test_clearances_and_components_are_those_of_the_run():
    run = two_discs()
    ax = plots.clearances(run, ax=axes())
    near, far, distance, zero = ax.get_lines()  # no bound: of samples alone nothing is known between them
    assert [(line.get_label(), line.get_linestyle()) for line in (near, far)] == [("sphere 1", "-"), ("sphere 2", "-.")]
    np.testing.assert_allclose(near.get_ydata(), [np.hypot(9, 4) - 1, 5.0, np.hypot(9, 4) - 1])
    np.testing.assert_allclose(far.get_ydata(), [np.hypot(9, 86) - 1, 83.0, np.hypot(9, 86) - 1])
    flown = simulate(run.law, run.q[0], run.p[0], (0.0, 0.1))
    assert plots.clearances(flown, ax=axes()).get_lines()[2].get_ydata()[0] == flown.clearance().lower
    assert (distance.get_ydata()[0], zero.get_ydata()[0]) == (pytest.approx(4.2), 0.0)
    (steps,) = plots.components(run, ax=axes()).get_lines()
    assert steps.get_ydata().tolist() == [1, 2, 1]
    assert middle_sample(run) == 1
    free = simulate(Algorithm1(), [[0.0, 0.0], [7.0, 0.0]], np.zeros((2, 2)), (0.0, 1.0))
    assert "no obstacles" in plots.clearances(free, ax=axes()).texts[0].get_text()


def test_the_report_adds_a_figure_where_there_are_obstacles():
    drawn = pictures(two_discs())
    assert len(drawn) == 4
    assert "clearance" in drawn[3].caption
    assert drawn[0].source.count('<circle class="solid"') == 6  # two discs, three instants


def test_rules_draw_links_by_sign_and_the_parts_of_u_on_one_scale():
    q = np.array([[0.0, 0.0], [5.0, 0.0], [13.0, 0.0], [13.0, 40.0]])
    p = np.array([[0.0, 1.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]])
    parts = reynolds(q, p)
    ax = plots.rules(parts, q, ax=axes())
    lines = {c.get_label(): c.get_segments() for c in ax.collections if isinstance(c, LineCollection)}
    np.testing.assert_array_equal(lines["F⁻, pushes"], [q[[0, 1]]])
    np.testing.assert_array_equal(lines["F⁺, pulls"], [q[[1, 2]]])
    arrows = {c.get_label(): c for c in ax.collections if hasattr(c, "U")}
    assert set(arrows) == {"flock centring", "collision avoidance", "velocity matching"}
    avoidance = arrows["collision avoidance"]
    np.testing.assert_allclose(np.column_stack([avoidance.U, avoidance.V]), parts.avoidance[:2])
    centring = arrows["flock centring"]
    np.testing.assert_allclose(np.column_stack([centring.U, centring.V]), parts.centring[1:3])
    np.testing.assert_allclose(arrows["velocity matching"].V, parts.matching[:2, 1])
    assert len({c.scale for c in arrows.values()}) == 1
    longest = np.linalg.norm(parts.avoidance, axis=1).max()
    assert f"longest arrow: {longest:.3g}" in ax.get_legend().get_title().get_text()
    with pytest.raises(ArgumentError, match=r"q of shape \(3, 2\), rules of shape \(4, 2\)"):
        plots.rules(parts, q[:3], ax=axes())
    with pytest.raises(ArgumentError, match="expected \\(n, 2\\)"):
        plots.rules(reynolds(q[:, :1], p[:, :1]), q[:, :1], ax=axes())
