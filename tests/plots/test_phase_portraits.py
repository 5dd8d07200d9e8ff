import numpy as np

from flockana.plots.phase_portraits import phase_portrait
from tests.refused import refused


def test_each_column_is_a_curve_from_start_to_end():
    t = np.linspace(0.0, 1.0, 5)
    x, v = np.column_stack([t, 2.0 * t]), np.column_stack([1.0 - t, t])
    ax = phase_portrait(x, v)
    curves = [line.get_xydata() for line in ax.lines if len(line.get_xdata()) == 5]
    assert [np.array_equal(curve, np.column_stack([x[:, k], v[:, k]])) for k, curve in enumerate(curves)] == [True] * 2
    start, end = (mark.get_offsets() for mark in ax.collections)
    assert start.tolist() == [[0.0, 1.0], [0.0, 0.0]]
    assert end.tolist() == [[1.0, 0.0], [2.0, 1.0]]


def test_level_curves_are_of_the_energy_given():
    x, v = np.linspace(-2.0, 2.0, 41), np.linspace(-2.0, 2.0, 41)
    ax = phase_portrait([1.0], [0.0], energy=(x, v, x**2 + v[:, None] ** 2))
    level = ax.collections[0]
    for path, value in zip(level.get_paths(), level.levels, strict=True):
        radii = np.hypot(*path.vertices.T) if len(path.vertices) else np.array([np.sqrt(value)])
        if value <= 3.5:  # whole circles
            assert np.abs(radii**2 - value).max() < 0.02


test_bad_input_is_refused = refused(
    (lambda: phase_portrait([0.0, 1.0, 2.0], [0.0, 1.0]), r"position \(3,\), velocity \(2,\): expected equal shapes"),
    (lambda: phase_portrait([1.0], [0.0], separatrix=1.0), "separatrix = 1 without an energy"),
)


def test_the_separatrix_is_drawn_between_orbits_of_less_and_of_more_energy():
    """A pendulum: H = ½v² − cos x; its separatrix is H = 1, v² = 2 + 2 cos x."""
    x, v = np.linspace(-3.0, 3.0, 121), np.linspace(-2.5, 2.5, 121)
    ax = phase_portrait([1.0], [0.0], energy=(x, v, 0.5 * v[:, None] ** 2 - np.cos(x)), separatrix=1.0)
    orbits, dividing = ax.collections[:2]
    assert dividing.levels.tolist() == [1.0]
    assert sum(orbits.levels < 1.0) >= 4
    assert sum(orbits.levels > 1.0) >= 2
    (path,) = dividing.get_paths()
    assert len(path.vertices) > 100
    assert np.abs(path.vertices[:, 1] ** 2 - 2.0 - 2.0 * np.cos(path.vertices[:, 0])).max() < 0.01
    assert "separatrix" in [text.get_text() for text in ax.get_legend().get_texts()]
