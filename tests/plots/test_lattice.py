import numpy as np
import pytest
from matplotlib.collections import LineCollection

from flockana import plots
from flockana.base.errors import ArgumentError
from flockana.equilibria.lattice_collapse import CollapseDiagram
from flockana.lattice import coordination, hexagonal_patch, links
from tests.plots.artists import axes

Q = [[0.0, 0.0], [7.0, 0.0]]


def groups(ax):
    return {c.get_label(): np.asarray(c.get_offsets()) for c in ax.collections if "neighbour" in c.get_label()}


def test_agents_are_grouped_by_neighbours_and_the_legend_counts_them():
    q = hexagonal_patch(1, 7.0)
    pairs = links(q, 8.4)
    ax = plots.defect_map(q, pairs, coordination(7, pairs), ax=axes(), title="hexagon")
    found = groups(ax)
    assert set(found) == {"3 neighbours: 6", "6 neighbours: 1"}
    np.testing.assert_allclose(found["6 neighbours: 1"], [q[0]])
    assert [t.get_text() for t in ax.get_legend().get_texts()] == list(found)
    assert "hexagon" in (ax.get_title(), ax.get_title(loc="left"))


def test_links_are_coloured_by_the_strain_that_is_given_and_grey_without():
    q, pairs = np.array([[0.0, 0.0], [7.7, 0.0], [7.7, 6.3]]), [[0, 1], [1, 2]]
    ax = plots.defect_map(q, pairs, [1, 2, 1], strain=[0.1, -0.1], limit=0.2, ax=axes())
    lines = next(c for c in ax.collections if isinstance(c, LineCollection))
    np.testing.assert_allclose(lines.get_array(), [0.1, -0.1])
    assert (lines.norm.vmin, lines.norm.vmax) == (-0.2, 0.2)
    np.testing.assert_allclose(lines.get_segments()[1], q[[1, 2]])
    grey = plots.defect_map(q, pairs, [1, 2, 1], ax=axes())
    assert next(c for c in grey.collections if isinstance(c, LineCollection)).get_array() is None
    assert "1 neighbour: 2" in groups(grey)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_every_dimension_is_drawn_and_labelled(m):
    q = np.zeros((2, m))
    q[1, 0] = 7.0
    ax = plots.defect_map(q, [[0, 1]], [1, 1], strain=[0.0], ax=axes(m))
    assert ax.get_xlabel() == "$x$ (length)"
    ax.figure.canvas.draw()


def test_no_two_numbers_of_neighbours_look_alike():
    ax = plots.defect_map(np.zeros((14, 2)), np.empty((0, 2), int), range(14), strain=[], ax=axes())
    drawn = [c for c in ax.collections if "neighbour" in c.get_label()]
    markers = [c.get_paths()[0].vertices.tobytes() for c in drawn]
    assert len({(marker, c.get_facecolor().tobytes()) for marker, c in zip(markers, drawn, strict=True)}) == 14
    assert len(set(markers[:9])) == 9  # in the plane: in grey too


def test_the_collapse_diagram_shows_lengths_coincidence_failure_and_onset():
    diagram = CollapseDiagram(
        np.array([7, 19]),
        np.array([0.1, 1.0]),
        np.array([[0.9, 0.7], [0.8, 0.0]]),
        np.array([[0, -1], [0, 3]]),
        (("minimum", "failed"), ("minimum", "minimum")),
    )
    ax = plots.collapse(diagram, ax=axes())
    dots, together, failed = ax.collections
    np.testing.assert_allclose(dots.get_offsets(), [[7, 0.1], [19, 0.1]])
    np.testing.assert_allclose(dots.get_array(), [0.9, 0.8])
    np.testing.assert_allclose(together.get_offsets(), [[19, 1.0]])
    np.testing.assert_allclose(failed.get_offsets(), [[7, 1.0]])
    np.testing.assert_allclose(ax.get_lines()[0].get_ydata(), [np.nan, 1.0])
    assert (ax.get_yscale(), ax.get_xlabel()) == ("log", "$n$, agents")


def test_brackets_are_drawn_by_size_whatever_their_order():
    ax = plots.collapse_brackets({19: (1.0, 1.2), 7: (3.0, 4.0)}, ax=axes())
    lines = {line.get_label(): line for line in ax.get_lines()}
    np.testing.assert_allclose(lines["agents coincide"].get_xydata(), [[7, 4.0], [19, 1.2]])
    np.testing.assert_allclose(lines["all stay apart"].get_xydata(), [[7, 3.0], [19, 1.0]])


def test_the_barrier_is_the_difference_in_units_of_the_printed_bound():
    ax = plots.barrier({3: 10.0, 7: 30.0}, {3: 0.0, 7: 18.0}, 10.0, ax=axes())
    lines = {line.get_label(): np.asarray(line.get_ydata()) for line in ax.get_lines()}
    np.testing.assert_allclose(lines["least V with two agents coincident"], [1.0, 3.0])
    np.testing.assert_allclose(lines["least V of all states"], [0.0, 1.8])
    np.testing.assert_allclose(lines["barrier"], [1.0, 1.2])
    assert ax.get_ylim()[0] == 0.0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ((Q, [[0, 1]], [1]), r"coordination has shape \(1,\): expected a series of 2 numbers"),
        ((Q, [[0, 1]], [1, -1]), "coordination has entries that are no counts"),
        ((Q, [[0, 5]], [1, 1]), r"links\[0\] = \[0, 5\]: expected two different agents of 0 … 1"),
        (("x", [], []), "q: expected numbers"),
    ],
)
def test_a_map_of_defects_is_of_all_agents(given, message):
    with pytest.raises(ArgumentError, match=message):
        plots.defect_map(*given)
    with pytest.raises(ArgumentError, match=r"strain has shape \(2,\): expected a series of 1 numbers"):
        plots.defect_map(Q, [[0, 1]], [1, 1], strain=[0.0, 0.0])
