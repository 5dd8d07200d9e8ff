from dataclasses import dataclass

import numpy as np
import pytest
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection
from matplotlib.patches import Polygon, Rectangle
from matplotlib.quiver import Quiver
from mpl_toolkits.mplot3d.art3d import Line3DCollection

import flockana as fl
from flockana import Algorithm1, Box, DirectedNet, Law, Sphere, Trajectory, ZoneFlocking, plots, scenario, simulate
from flockana.base.errors import ArgumentError
from flockana.plots.animation import film_view
from flockana.plots.snapshot import draw_sample, in_view
from flockana.solvers.semi_implicit_euler import SemiImplicitEuler
from flockana.sources.jond_2025.environment.zone_world import Alien, ZoneWorld
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from tests.plots.artists import a_run, axes, frame, points, segments, title
from tests.refused import refused

EDGES = ((0, 1), (1, 2), (2, 1))


@pytest.fixture(scope="module")
def hunted():
    entry = scenario("zone-52")
    return simulate(entry.law, entry.q0, entry.p0, (0.0, 5.0))


def of(ax, kind):
    return [one for one in ax.collections if type(one) is kind]


def a_tree(**options):
    law = MinimalFlocking(edges=EDGES, spacing=(9.0, 2.0, 4.0), **options)
    q = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 3.0]])
    return at_rest(law, q)


def at_rest(law, q):
    q = np.array(q)[None]
    return Trajectory(np.zeros(1), q, 0.0 * q, 0.0 * q, law)


def test_a_snapshot_of_a_zone_law_shows_its_world(hunted):
    ax = plots.snapshot(hunted, 2.0, ax=axes())
    assert [type(patch) for patch in ax.patches] == [Polygon, Polygon, Rectangle]
    (triangles,) = of(ax, PolyCollection)
    corners, q = triangles.get_paths()[3].vertices[:3], hunted.q[20, 3]
    np.testing.assert_allclose(corners[0], q + 3.0 * hunted.extra["heading"][20, 3])
    np.testing.assert_allclose(0.5 * (corners[1] + corners[2]), q)
    assert np.linalg.norm(corners[1] - corners[2]) == pytest.approx(3.0)
    np.testing.assert_allclose(ax.collections[-2].get_offsets(), hunted.extra["alien"][20])
    fastest = np.linalg.norm(hunted.p[20], axis=1).max()
    assert title(ax) == f"$t$ = 2   longest arrow: {fastest:.3g} length/time"
    assert len(of(ax, Quiver)) == 1
    assert not of(plots.snapshot(hunted, ax=axes(), velocities=False), Quiver)


def test_in_view_are_all_places_of_an_alien():
    """Of a flock that stays at the origin, without obstacles or box, only the alien is far away."""
    law = ZoneFlocking(world=ZoneWorld(aliens=(Alien((40.0, -30.0)),)))
    run = simulate(law, [[0.0, 0.0], [1.0, 0.0]], np.zeros((2, 2)), (0.0, 0.5))
    low, high = film_view(run)
    assert high[0] > 40.0
    assert low[1] < -30.0


def test_zones_in_space_and_on_a_line():
    rng = np.random.default_rng(0)
    law = ZoneFlocking(world=ZoneWorld((Sphere((20.0,) * 3, 3.0),), Box((0.0,) * 3, (40.0,) * 3)))
    solid = simulate(law, rng.uniform(1.0, 9.0, (5, 3)), rng.uniform(0.0, 1.0, (5, 3)), (0.0, 0.5))
    ax = plots.snapshot(solid, ax=axes(3))
    box = next(one for one in ax.collections if type(one) is Line3DCollection and len(segments(one)) == 12)
    lengths = np.linalg.norm(np.diff(np.array(segments(box)), axis=1)[:, 0], axis=1)
    np.testing.assert_array_equal(lengths, 40.0)
    np.testing.assert_allclose(in_view(law, solid).max(axis=0), 40.0)
    flat = at_rest(ZoneFlocking(), [[0.0], [4.0], [9.5]])
    (line,) = of(plots.snapshot(flat, ax=axes()), LineCollection)
    np.testing.assert_array_equal(np.array(line.get_segments())[:, :, 0], [[0.0, 4.0]])  # within a = 5


def test_links_of_a_dead_zone_law_and_of_a_map_that_steps_it():
    law = DeadZoneFlocking()
    d, r = law.interaction.length, law.interaction.range
    q = np.array([[0.0, 0.0], [1.2 * d, 0.0], [1.2 * d + 1.001 * r, 0.0]])
    for one in (law, SemiImplicitEuler(law)):
        (lines,) = of(plots.snapshot(at_rest(one, q), ax=axes()), LineCollection)
        np.testing.assert_allclose(lines.get_array(), [0.2])
        assert lines.norm.vmax == 1.0  # r is more than twice d


def test_who_perceives_whom():
    """(0, 1) goes one way and is 3 long, agent 1 wants 2; 1 and 2 perceive each other, 3 apart, and want 2 and 4."""
    ax = plots.snapshot(a_tree(), ax=axes(), velocities=False)
    (lines,) = of(ax, LineCollection)
    assert [segment[0].tolist() for segment in lines.get_segments()] == [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0]]
    np.testing.assert_allclose(lines.get_array(), [0.5, -0.25, 0.5])
    (head,) = of(ax, Quiver)
    np.testing.assert_allclose([head.U, head.V], [[1.0], [0.0]])
    np.testing.assert_allclose(head.get_offsets(), [[1.65, 0.0]])
    step = at_rest(a_tree().law.discrete(0.1), a_tree().q[0])
    (same,) = of(plots.perception(step, ax=axes()), LineCollection)
    np.testing.assert_array_equal(same.get_array(), lines.get_array())
    run = simulate(Algorithm1(), [[0.0, 0.0]], [[1.0, 0.0]], (0.0, 1.0))
    with pytest.raises(ArgumentError, match="expected a run of MinimalFlocking"):
        plots.perception(run)


def test_of_many_links_the_relaxed_ones_lie_above():
    q = np.random.default_rng(0).uniform(0.0, 6.0, (12, 2))
    ax = plots.configuration(q, d=7.0, r=8.4, ax=axes())  # 66 links, 5.5 for each agent
    (many,) = of(ax, LineCollection)
    assert np.all(np.diff(np.abs(many.get_array())) <= 0.0)
    assert many.get_linewidths()[0] == pytest.approx(1.8 * (4.0 * 12 / 66) ** 0.5)
    lengths = np.linalg.norm(np.diff(np.array(many.get_segments()), axis=1)[:, 0], axis=1)
    np.testing.assert_allclose(lengths / 7.0 - 1.0, many.get_array())


def test_a_centre_that_stands_still_is_not_blown_up_to_its_rounding():
    run = simulate(Algorithm1(), [[0.0, 0.0], [6.0, 0.0], [3.0, 5.0]], np.zeros((3, 2)), (0.0, 1.0))
    low, high = plots.centre_path(run, ax=axes()).get_xlim()
    assert (low + high) / 2 == pytest.approx(3.0)
    assert high - low == pytest.approx(np.ptp(run.q, axis=(0, 1)).max())


def test_a_law_of_ones_own_says_how_it_is_drawn():
    @dataclass(frozen=True)
    class Still(Law):
        def flow(self, t, q, p):
            return 0.0 * q, float("nan")

    @draw_sample.register(Still)
    def _(law, trajectory, k, *, ax, velocities, bar):
        ax.set_title(f"sample {k}")
        return ax

    run = simulate(Still(), [[0.0, 0.0]], [[1.0, 0.0]], (0.0, 1.0), t_eval=[0.0, 0.5, 1.0])
    assert plots.snapshot(run, 0.6, ax=axes()).get_title() == "sample 1"
    film = plots.animation(run, seconds=0.4, fps=10)
    assert title(frame(film, 3)) == "sample 3"


def test_links_are_coloured_by_strain():
    q = np.array([[0.0, 0.0], [7.0, 0.0], [7.0, 7.7], [100.0, 0.0]])
    ax = plots.configuration(q, d=7.0, r=8.4, ax=axes())
    links = next(c for c in ax.collections if isinstance(c, LineCollection))
    np.testing.assert_allclose(links.get_array(), [0.0, 0.1], atol=1e-12)
    np.testing.assert_allclose(links.get_segments()[1], q[[1, 2]])
    assert (links.norm.vmin, links.norm.vmax) == pytest.approx((-0.2, 0.2))
    assert len(ax.child_axes) == 1  # the bar
    apart = plots.configuration([[0.0, 0.0], [20.0, 0.0]], d=7.0, r=8.4, ax=axes())
    assert (apart.child_axes, of(apart, LineCollection)) == ([], [])
    (plain,) = of(plots.configuration(q, r=8.4, ax=axes()), LineCollection)
    assert plain.get_array() is None
    assert not of(plots.configuration(q, ax=axes()), LineCollection)


def test_the_longest_arrow_is_labelled_with_the_largest_speed_and_rest_has_no_arrows():
    q, p = np.zeros((2, 2)), np.array([[3.0, 4.0], [1.0, 0.0]])
    assert "longest arrow: 5 length/time" in title(plots.configuration(q, p, ax=axes()))
    assert "arrow" not in title(plots.configuration(q, 0.0 * p, ax=axes()))


@pytest.mark.parametrize("m", [1, 2, 3])
def test_a_snapshot_shows_the_nearest_sample_and_the_target_then(m):
    run = a_run(m)
    ax = plots.snapshot(run, 0.52, ax=axes(m))
    assert "$t$ = 0.5" in title(ax)
    dots, star = (next(c for c in ax.collections if c.get_label() == name) for name in ("agents", "γ-agent"))
    np.testing.assert_allclose(points(dots)[:, :m], run.q[5])
    np.testing.assert_allclose(points(star)[:, :m], [[2.0] * m])


def test_a_time_before_or_after_the_run_is_refused_and_one_within_rounding_of_its_end_is_not():
    run = simulate(Algorithm1(), [[0.0, 0.0], [6.0, 1.0]], np.zeros((2, 2)), (0.5, 1.0))
    with pytest.raises(ArgumentError, match="time = nan: expected a finite number"):
        plots.snapshot(run, float("nan"), ax=axes())
    for time, shown in ((99, "99"), (0.0, "0"), (1.01, "1.01")):
        with pytest.raises(ArgumentError, match=f"time = {shown}: expected a time of the run, 0.5 to 1$"):
            plots.snapshot(run, time)
    drawn = plots.snapshot(run, np.nextafter(1.0, 2.0), ax=axes(), velocities=False)
    assert drawn.get_title(loc="left") == "$t$ = 1"


def test_circles_of_interaction_stand_about_the_agents():
    """Radius r about each; that of each agent on a directed net; refused where there is none to draw."""
    q, p = [[0.0, 0.0], [6.0, 1.0]], [[1.0, 0.0], [0.0, 0.0]]
    for law, radii in ((Algorithm1(), [8.4, 8.4]), (DirectedNet(Algorithm1(), (5.0, 3.0)), [5.0, 3.0])):
        ax = plots.snapshot(simulate(law, q, p, (0.0, 0.1)), 0.0, ranges=True)
        (circles,) = (drawn for drawn in ax.collections if isinstance(drawn, EllipseCollection))
        np.testing.assert_allclose(circles.get_widths(), 2.0 * np.array(radii))
        np.testing.assert_allclose(circles.get_heights(), circles.get_widths())
        np.testing.assert_allclose(circles.get_offsets(), q)
    with pytest.raises(ArgumentError, match="ranges = True: expected a law with a range in the plane"):
        plots.snapshot(simulate(Algorithm1(), [[0.0]], [[1.0]], (0.0, 0.1)), ranges=True)


def test_agents_in_one_place_carry_their_number():
    q = [[0.0, 0.0], [0.0, 0.0], [0.0, 1e-7], [7.0, 0.0], [7.0, 7.0], [7.0, 7.0]]
    ax = plots.configuration(q, ax=axes())
    found = {text.get_text().strip(): text.get_position() for text in ax.texts}
    assert set(found) == {"×3", "×2"}
    np.testing.assert_allclose(found["×2"], (7.0, 7.0))
    assert [text.get_text().strip() for text in plots.configuration([[1.0], [1.0]], ax=axes()).texts] == ["×2"]
    assert not plots.configuration([[0.0, 0.0], [7.0, 0.0]], ax=axes()).texts


def test_a_flock_at_rest_has_no_arrows():
    law = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)))
    q = fl.lattice.hexagonal_patch(1, 7.0)
    still = fl.simulate(law, q, np.full_like(q, 1e-7), (0.0, 1e-6))
    moving = fl.simulate(law, q, np.full_like(q, 1.0), (0.0, 1e-6))
    assert "arrow" not in title(plots.snapshot(still, ax=axes()))
    assert "longest arrow: 1.41" in title(plots.snapshot(moving, ax=axes()))


test_a_configuration_of_bad_links_is_refused = refused(
    ({"d": 0, "r": 8}, "d = 0: expected a number > 0"),
    ({"d": [7.0, 7.0], "r": 8}, r"d = \[7.0, 7.0\]: expected one real number"),
    ({"d": [7.0, 7.0], "edges": [[0, 1]]}, r"d has shape \(2,\): expected a series of 1 numbers"),
    ({"d": [0.0], "edges": [[0, 1]]}, "d has the entry 0: expected numbers > 0"),
    ({"edges": [[0, 5]]}, r"edges\[0\] = \[0, 5\]: expected two different agents of 0 … 1"),
    make=lambda **given: plots.configuration([[0.0, 0.0], [7.0, 0.0]], **given),
)
