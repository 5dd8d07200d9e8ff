"""A film shows itself, saves itself, and refuses what cannot be filmed before any work."""

import pytest
from PIL import Image

from flockana import Algorithm2, StaticTarget, simulate
from flockana.base.errors import ArgumentError


@pytest.fixture(scope="module")
def run():
    return simulate(Algorithm2(target=StaticTarget((0.0, 0.0))), [[0.0, 0.0], [9.0, 1.0]], [[0.0, 1.0]] * 2, (0.0, 2.0))


def test_a_notebook_shows_every_frame(run):
    page = run.animate(seconds=0.5, fps=6.0)._repr_html_()
    assert page.count("data:image/png;base64") == 3


def test_a_file_holds_every_frame(run, tmp_path):
    path = run.animate(seconds=0.5, fps=6.0).save(tmp_path / "run.gif")
    with Image.open(path) as film:
        assert film.n_frames == 3


def test_a_film_without_length_is_refused_at_once(run):
    with pytest.raises(ArgumentError, match=r"seconds = -1.*expected a"):
        run.animate(seconds=-1.0)
