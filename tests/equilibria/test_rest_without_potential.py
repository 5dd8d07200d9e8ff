"""States of rest of laws that need not have a potential."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from flockana import Algorithm1, AlphaInteraction, Law, MinimalFlocking, SemiImplicitEuler
from flockana.base.errors import ArgumentError, SolverError
from flockana.equilibria.rest_without_potential import resting_state

TREE = ((0, 1), (1, 2), (1, 3), (0, 4))


@pytest.mark.parametrize("m", [1, 2, 3])
def test_edges_of_a_tree_take_their_lengths(m):
    law = MinimalFlocking(edges=TREE, spacing=(1.0, 1.5, 2.0, 1.0, 1.2))
    q = np.zeros((5, m))
    q[:, 0] = (0.0, 1.4, 3.0, 3.5, -1.3)
    found = resting_state(law, q)
    lengths = [np.linalg.norm(found[i] - found[j]) for j, i in TREE]
    np.testing.assert_allclose(lengths, [1.5, 2.0, 1.0, 1.2], rtol=1e-11)  # the spacing of who sees the other


def test_it_is_the_minimum_nearby_where_there_is_a_potential():
    found = resting_state(Algorithm1(), [[0.0, 0.0], [6.8, 0.3]])
    assert abs(np.linalg.norm(found[1] - found[0]) - 7.0) < 1e-11
    at_rest = np.array([[0.0], [7.0]])
    assert np.abs(resting_state(Algorithm1(), at_rest) - at_rest).max() < 1e-12


def test_where_no_state_rests():
    """A push that is the same everywhere leaves nobody at rest."""
    with pytest.raises(SolverError, match="no state of rest of Pushed found near there: the largest force left is 2;"):
        resting_state(Pushed(), [[-1.5], [0.0]])


class Pushed(Law):
    """u = 2, everywhere."""

    def flow(self, t, q, p):
        return np.full_like(q, 2.0), 0.0

    def derivatives(self, t, q, p):
        return csr_array((q.size, q.size)), csr_array((q.size, q.size))


class Silent(Law):
    """A law that tells no derivatives."""

    def flow(self, t, q, p):
        return 2.0 - q, 0.0


def test_what_is_refused():
    with pytest.raises(ArgumentError, match="expected a continuous law, as a map has no forces at rest"):
        resting_state(SemiImplicitEuler(Algorithm1()), [[0.0], [7.0]])
    np.testing.assert_allclose(resting_state(Silent(), [[1.0]]), 2.0, rtol=1e-9)  # its derivatives are differences
    with pytest.raises(ArgumentError, match="q0"):
        resting_state(Algorithm1(AlphaInteraction()), [[np.nan]])
