"""The spectrum off the rigid motions, against an explicit basis of their complement."""

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, StaticTarget
from flockana.equilibria.classify import spectrum
from flockana.equilibria.potential import Potential


@pytest.mark.parametrize("law", [Algorithm1(), Algorithm2(target=StaticTarget((0.0, 0.0)))])
def test_it_is_the_spectrum_on_the_complement_even_where_rotations_are_no_null_vectors(law):
    """Off equilibrium the Hessian moves rotations, so both sides of it must be projected."""
    q = np.random.default_rng(5).uniform(0.0, 14.0, (6, 2))
    potential = Potential(law)
    rigid = potential.symmetries(q)
    hessian = potential.stiffness(q).toarray()
    assert np.abs(hessian @ rigid).max() > 1.0
    free = np.linalg.svd(rigid, full_matrices=True)[0][:, rigid.shape[1] :]
    expected = np.linalg.eigvalsh(free.T @ hessian @ free)
    values = spectrum(potential, q)[0]
    np.testing.assert_allclose(values, expected, atol=1e-10 * np.abs(expected).max())
