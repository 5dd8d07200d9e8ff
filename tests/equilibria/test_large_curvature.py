"""The few curvatures of a large flock against its whole spectrum: minima, hinges, loose parts, saddles."""

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, StaticTarget
from flockana.base.errors import SolverError
from flockana.equilibria import classify, find_equilibrium, large_curvature
from flockana.equilibria.classify import landscape, spectrum
from flockana.equilibria.curvature import Landscape
from flockana.equilibria.large_curvature import LargeLandscape
from flockana.equilibria.potential import Potential
from flockana.lattice import hexagonal_patch, square

LAW = Algorithm1()
PRESSED = Algorithm2(target=StaticTarget((0.0, 0.0)))
PATCH = hexagonal_patch(5, 7.0)
HINGED = np.vstack([PATCH, PATCH + np.array([77.0, 0.0])])  # corner to corner


def doubled(q):
    """With a second agent where one in the middle stands: a saddle of index two."""
    return np.vstack([q, q[:1]])


@pytest.mark.parametrize(
    ("law", "q"),
    [
        (LAW, PATCH),
        (LAW, HINGED),
        (LAW, np.vstack([PATCH, PATCH + 500.0, [[900.0, 0.0]]])),
        (LAW, doubled(PATCH)),
        (PRESSED, PATCH),
    ],
)
def test_signs_are_those_of_the_whole_spectrum(law, q, monkeypatch):
    q = find_equilibrium(law, q).q if law is PRESSED else q
    potential = Potential(law)
    whole = spectrum(potential, q)
    monkeypatch.setattr(classify, "DENSE_SIZE", 10)
    few = spectrum(potential, q)
    assert isinstance(landscape(potential, q), LargeLandscape)
    assert (few.rigid, few.negative, few.zero) == (whole.rigid, whole.negative, whole.zero)
    scale = np.abs(whole.eigenvalues).max()
    count = few.eigenvalues.size - 1
    np.testing.assert_allclose(few.eigenvalues[:count], whole.eigenvalues[:count], atol=1e-11 * scale)
    assert few.eigenvalues[-1] == pytest.approx(whole.eigenvalues[-1], rel=1e-9)


def test_more_are_asked_for_where_more_are_soft(monkeypatch):
    """A square grid shears row by row and column by column, in more ways than are asked for at first."""
    q, potential = square(11, 11, 7.0), Potential(LAW)
    whole = spectrum(potential, q)
    assert whole.zero > large_curvature._FEW
    monkeypatch.setattr(classify, "DENSE_SIZE", 10)
    assert spectrum(potential, q)[1:] == whole[1:]
    monkeypatch.setattr(large_curvature, "_MOST", 12)
    assert spectrum(potential, q).eigenvalues.size == whole.eigenvalues.size  # of so few agents all are computed
    monkeypatch.setattr(large_curvature, "_WHOLE", 10)
    with pytest.raises(SolverError, match="too many to classify so large a flock"):
        spectrum(potential, q)


def test_an_eigenvalue_that_lanczos_missed_is_counted(monkeypatch):
    potential = Potential(LAW)
    monkeypatch.setattr(classify, "DENSE_SIZE", 10)
    asked, smallest = [], LargeLandscape._smallest

    def missing(self, count):
        asked.append(count)
        values, vectors = smallest(self, count + 1)
        kept = np.arange(count + 1) != (2 if len(asked) == 1 else count)
        return values[kept], vectors[:, kept]

    monkeypatch.setattr(LargeLandscape, "_smallest", missing)
    found = spectrum(potential, PATCH)
    assert asked == [12, 24]
    np.testing.assert_allclose(found.eigenvalues[:24], Landscape.values.func(landscape_of(PATCH))[:24], rtol=1e-9)


def landscape_of(q):
    potential = Potential(LAW)
    return Landscape(potential.stiffness, q, potential.symmetries(q), force=0.0, length=7.0, unit=potential.force_scale)
