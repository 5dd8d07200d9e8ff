import pytest

from flockana import Algorithm2, StaticTarget, simulate


@pytest.fixture(scope="module")
def run():
    return simulate(Algorithm2(target=StaticTarget((0.0, 0.0))), [[0.0, 0.0], [9.0, 1.0]], [[0.0, 1.0]] * 2, (0.0, 2.0))


def test_a_notebook_shows_the_player(run):
    film = run.animate(seconds=0.5, fps=6.0)
    assert film._repr_html_() == run.player()._repr_html_()
    assert repr(film) == f"<Film of {run!r}, 0.5 s; .save(path) writes it>"
