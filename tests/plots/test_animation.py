import numpy as np
import pytest
from PIL import Image

from flockana import Algorithm1, Algorithm3, Sphere, StaticTarget, Trajectory, plots, simulate
from flockana.base.errors import ArgumentError, FileError
from flockana.plots.animation import ensure_film, equal_times, film_size, film_view
from tests.plots.artists import Halving, frame, title


def a_run(m=2):
    law = Algorithm3(target=StaticTarget((0.0,) * m), obstacles=(Sphere((30.0, *(0.0,) * (m - 1)), 5.0),))
    q = np.random.default_rng(0).uniform(0.0, 14.0, (4, m))
    return simulate(law, q, 0.0 * q, (0.0, 2.0), method="scipy-DOP853")  # which compiles no integrator


def test_between_samples_the_path_is_the_cubic_of_values_and_slopes():
    """A cubic path sampled at uneven times is met exactly; velocities of constant jerk are, too."""
    t = np.array([0.0, 0.3, 1.0, 2.0])
    q, p, u = (x[:, None, None] for x in (t**3, 3 * t**2, 6 * t))
    run = Trajectory(t, q, p, u, Algorithm1())
    film = equal_times(run, 9)
    np.testing.assert_allclose(film.t, np.linspace(0.0, 2.0, 9))
    np.testing.assert_allclose(film.q[:, 0, 0], film.t**3, atol=1e-12)
    np.testing.assert_allclose(film.p[:, 0, 0], 3 * film.t**2, atol=1e-12)
    np.testing.assert_allclose(film.u[:, 0, 0], 6 * film.t, atol=1e-12)


def test_of_a_map_the_nearest_steps_are_shown():
    run = simulate(Halving(), [[8.0]], [[0.0]], (0.0, 2.0))
    film = equal_times(run, 4)  # 0, 0.667, 1.333, 2 lie next to 0, 0.5, 1.5, 2
    np.testing.assert_array_equal(film.t, [0.0, 0.5, 1.5, 2.0])
    np.testing.assert_array_equal(film.q[:, 0, 0], [8.0, 4.0, 1.0, 0.5])


def test_a_film_may_have_more_frames_than_a_map_has_steps(tmp_path):
    run = simulate(Halving(), [[8.0]], [[0.0]], (0.0, 1.0))
    assert equal_times(run, 9).t.tolist() == [0.0, 0.5, 1.0]
    path = plots.animate(run, tmp_path / "film.gif", seconds=0.9, fps=10)
    with Image.open(path) as film:
        shown = [film.seek(k) or film.info["duration"] for k in range(film.n_frames)]
    assert sum(shown) == 900  # pictures that are the same are written as one that lasts
    assert len(shown) == 3


@pytest.mark.slow
@pytest.mark.parametrize("m", [1, 2, 3])
def test_a_gif_holds_every_frame_of_one_size(m, tmp_path):
    seen = []
    path = plots.animate(a_run(m), tmp_path / "film.gif", seconds=0.4, fps=10, progress=lambda *now: seen.append(now))
    with Image.open(path) as film:
        assert film.n_frames == 4
        assert film.info["duration"] == 100
        assert all(side % 2 == 0 for side in film.size)
    assert seen == [(1, 4), (2, 4), (3, 4), (4, 4)]
    assert [p.name for p in tmp_path.iterdir()] == ["film.gif"]


@pytest.mark.parametrize("m", [2, 3])
def test_the_view_holds_still_and_holds_everything(m):
    run = a_run(m)
    film = plots.animation(run, seconds=0.4, fps=10)
    views = []
    for k in (0, 3):
        ax = frame(film, k)
        views.append([getattr(ax, f"get_{name}lim")() for name in "xyz"[:m]])
        assert title(ax) == f"$t$ = {[0, None, None, 2][k]}"
    assert views[0] == views[1]
    low, high = np.array(views[0]).T
    everything = np.vstack([run.q.reshape(-1, m), np.zeros((1, m))])
    assert np.all(low <= everything.min(axis=0))
    assert np.all(high >= everything.max(axis=0))
    assert high[0] >= 35.0  # the far side of the disc


def test_sizes_are_whole_even_numbers_of_pixels():
    for view in ([[0.0, 0.0], [100.0, 33.3]], [[0.0, 0.0], [1.0, 50.0]], [[0.0], [1.0]], [[0.0] * 3, [1.0] * 3]):
        width, height = (100.0 * side for side in film_size(np.array(view)))
        assert width % 2 == pytest.approx(0.0, abs=1e-9)
        assert round(height) % 2 == 0
        assert height == pytest.approx(round(height), abs=1e-9)
    still = Trajectory(np.array([0.0]), *(np.zeros((1, 1, 2)),) * 3, Algorithm1())
    assert np.all(film_view(still)[1] > film_view(still)[0])


@pytest.mark.parametrize(
    ("name", "options", "error", "message"),
    [
        ("film.avi", {}, ArgumentError, "expected a file name that ends in .gif or .mp4"),
        ("film.gif", {"fps": 51.0}, ArgumentError, "expected at most 50 frames per second"),
        ("film.gif", {"seconds": 1e5}, ArgumentError, "20000 in all"),
        ("none/film.gif", {}, FileError, "there is no folder .*none; make it first"),
    ],
)
def test_what_cannot_be_filmed_is_refused(name, options, error, message, tmp_path):
    with pytest.raises(error, match=message):
        ensure_film(tmp_path / name, **({"seconds": 1.0, "fps": 10.0} | options))


@pytest.mark.slow
def test_the_axes_hold_still_in_the_file(tmp_path):
    path = plots.animate(a_run(2), tmp_path / "run.gif", seconds=0.5, fps=10)
    edges = []
    with Image.open(path) as film:
        for k in range(film.n_frames):
            film.seek(k)
            dark = np.asarray(film.convert("L")) < 140
            edges.append((int(np.argmax(dark.sum(axis=0) > 100)), int(np.argmax(dark.sum(axis=1) > 300))))
    assert len(edges) == 5
    assert len(set(edges)) == 1  # the spines: left and bottom
