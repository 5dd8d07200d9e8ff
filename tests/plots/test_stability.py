import numpy as np
import pytest
from matplotlib.collections import LineCollection
from matplotlib.quiver import Quiver
from PIL import Image

from flockana import Algorithm1, plots
from flockana.base.errors import ArgumentError
from flockana.lattice import hexagonal_patch, links
from flockana.stability import linearise, mode_motion
from tests.plots.artists import axes
from tests.refused import refused

POLES = np.array([0.0, 0.0, -1.0 + 2.0j, -1.0 - 2.0j, -4.0, 0.5])


def lines(ax):
    return {line.get_label(): line.get_xydata() for line in ax.lines if not line.get_label().startswith("_")}


def test_poles_are_where_they_are_and_zeros_and_growth_stand_out():
    ax = plots.pole_map(POLES, ax=axes())
    found = lines(ax)
    np.testing.assert_array_equal(found["eigenvalues"], [[-1.0, 2.0], [-1.0, -2.0], [-4.0, 0.0]])
    np.testing.assert_array_equal(found["growing"], [[0.5, 0.0]])
    assert "zero eigenvalues: 2" in found
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Re $s$ (1/time)", "Im $s$ (rad/time)")
    assert r"$\zeta$ = 0.5" in [text.get_text() for text in ax.texts]
    low, high = ax.get_ylim()
    assert low == -high
    ax.figure.canvas.draw()


def test_a_ray_is_at_its_damping_ratio():
    ax = plots.pole_map([-3.0 + 4.0j, -3.0 - 4.0j], ax=axes())
    ends = [line.get_xydata()[1] for line in ax.lines if not line.get_xdata()[0] and line.get_xdata()[1] < 0.0]
    slopes = [y / x for x, y in ends]
    ratios = [1.0 / np.sqrt(1.0 + slope**2) for slope in slopes]
    np.testing.assert_allclose(sorted(ratios), np.repeat([0.1, 0.3, 0.5, 0.7, 0.9], 2), rtol=1e-12)


def test_groups_of_poles_have_their_own_marks_and_real_poles_a_view():
    ax = plots.pole_map({"shape": [-1.0], "centre": [-2.0]}, ax=axes())
    assert list(lines(ax)) == ["shape", "centre"]
    assert ax.get_ylim()[1] == pytest.approx(0.4)
    marks = {line.get_marker() for line in ax.lines if line.get_label() in ("shape", "centre")}
    assert len(marks) == 2


def test_a_complex_shape_is_drawn_with_arrows_and_orbits():
    q = hexagonal_patch(1, 7.0)
    pairs = links(q, 8.4)
    shape = np.zeros((7, 2), complex)
    shape[3] = [1.0, 1.0j]  # a circle
    ax = plots.mode_shape(q, pairs, shape, target=(0.0, 1.0), ax=axes(), title="one agent runs round")
    (arrows,) = (c for c in ax.collections if isinstance(c, Quiver))
    longest = 0.09 * 14.0
    np.testing.assert_allclose(np.stack([arrows.U, arrows.V], axis=1), longest * shape.real, atol=1e-12)
    net, orbits = (c for c in ax.collections if isinstance(c, LineCollection))
    assert len(net.get_segments()) == 12
    np.testing.assert_allclose(np.linalg.norm(orbits.get_segments()[3] - q[3], axis=1), longest, rtol=1e-12)
    np.testing.assert_allclose(orbits.get_segments()[0], np.tile(q[0], (49, 1)))
    real = plots.mode_shape(q, pairs, shape.real, ax=axes())
    assert sum(isinstance(c, LineCollection) for c in real.collections) == 1
    (low, high) = ax.get_xlim()
    assert low < q[:, 0].min() < q[:, 0].max() < high


@pytest.mark.parametrize("m", [1, 2, 3])
def test_every_dimension_is_drawn(m):
    q = np.zeros((2, m))
    q[1, 0] = 7.0
    ax = plots.mode_shape(q, [[0, 1]], 1j * q, ax=axes(m))
    assert ax.get_xlabel() == "$x$ (length)"
    ax.figure.canvas.draw()


def test_a_mode_moves_as_its_eigenvalue_says():
    found = linearise(Algorithm1(), [[0.0], [7.0]])
    (mode,) = found.modes[:1]
    run = mode_motion(found, mode, amplitude=0.1, periods=1.0, samples=401)
    assert run.t[-1] == pytest.approx(2.0 * np.pi / mode.frequency)
    dq = run.q[:, 1, 0] - 7.0
    expected = 0.1 * np.sign(mode.shape[1, 0].real) * np.exp(mode.eigenvalue * run.t).real
    np.testing.assert_allclose(dq, expected, atol=1e-12)
    np.testing.assert_allclose(run.p[1:-1, 1, 0], np.gradient(dq, run.t)[1:-1], atol=2e-3 * np.abs(run.p).max())
    np.testing.assert_allclose(
        run.u[:, 1, 0], -2.0 * mode.decay_rate * run.p[:, 1, 0] - abs(mode.eigenvalue) ** 2 * dq, atol=1e-9
    )
    steady = mode_motion(found, mode, amplitude=0.1, damped=False, periods=1.0)
    np.testing.assert_allclose(steady.q[-1], steady.q[0], atol=1e-12)
    patch = linearise(Algorithm1(), hexagonal_patch(1, 7.0))
    turn = mode_motion(patch, patch.zero_modes[-1], periods=1.0)
    assert turn.t[-1] == pytest.approx(1.0)
    assert np.linalg.norm(turn.q[0] - patch.q, axis=1).max() == pytest.approx(0.3 * 14.0 / (np.sqrt(7.0) - 1.0))
    with pytest.raises(ArgumentError, match=r"mode.shape is \(2, 1\): expected \(7, 2\)"):
        mode_motion(patch, mode)
    with pytest.raises(ArgumentError, match=r"linearisation = 3: expected what linearise\(...\) gives"):
        mode_motion(3, mode)
    with pytest.raises(ArgumentError, match="mode = 3: expected one of linearisation"):
        mode_motion(patch, 3)


def test_a_film_of_a_mode(tmp_path):
    found = linearise(Algorithm1(), hexagonal_patch(1, 7.0))
    path = plots.animate_mode(found, found.modes[0], tmp_path / "mode.gif", seconds=0.5, fps=8.0)
    with Image.open(path) as film:
        assert film.n_frames == 4
        pictures = []
        for k in (0, 1):
            film.seek(k)
            pictures.append(np.asarray(film.convert("RGB"), dtype=int))
    assert np.abs(pictures[0] - pictures[1]).max() > 100


test_what_is_no_mode_and_no_pole_is_refused = refused(
    (lambda: plots.pole_map([]), r"poles = \[\]: expected at least one eigenvalue"),
    (lambda: plots.pole_map({}), r"poles = {}: expected at least one eigenvalue"),
    (lambda: plots.pole_map("x"), "poles = 'x': expected complex numbers"),
    (
        lambda: plots.mode_shape([[0.0], [7.0]], [], [[1.0]]),
        r"shape is \(1, 1\) of float64: expected real numbers of shape \(2, 1\)",
    ),
    (lambda: plots.mode_shape([[0.0], [7.0]], [], [["x"], ["y"]]), "shape is .* of <U1: expected real numbers"),
    (lambda: plots.mode_shape([[0.0], [7.0]], [[0, 2]], [[1.0], [1.0]]), r"links\[0\] = \[0, 2\]: expected two"),
)
