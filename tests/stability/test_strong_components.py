"""Strongly connected components: of chains, cycles and trees known by hand, and against networkx."""

import networkx
import numpy as np
import pytest
from scipy.sparse import csr_array

from flockana.stability.strong_components import strong_components


def rows(parts):
    return [part.tolist() for part in parts.indices]


def test_a_chain_has_one_component_for_each_agent_the_leader_first():
    backwards = np.triu(np.ones((4, 4)), 1)  # agent i hears all that follow it in the numbering
    found = strong_components(backwards)
    assert rows(found) == [[3], [2], [1], [0]]
    assert found.downstream(1).tolist() == [1, 0]


def test_an_entry_of_either_matrix_is_a_link_and_only_an_exact_zero_is_none():
    there, back = np.array([[1.0, 0.0], [1.0, 1.0]]), np.array([[0.0, 1e-300], [0.0, 0.0]])
    assert rows(strong_components(there, back)) == [[0, 1]]
    assert len(strong_components(there, 0.0 * back)) == 2
    explicit = csr_array(([1.0, 0.0], ([1, 0], [0, 1])), shape=(2, 2))
    assert len(strong_components(explicit)) == 2


@pytest.mark.parametrize("seed", range(12))
def test_random_nets_against_networkx(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 30))
    matrix = (rng.random((n, n)) < 1.5 / n).astype(float)
    graph = networkx.from_numpy_array(matrix, create_using=networkx.DiGraph)
    found = strong_components(csr_array(matrix))
    assert {frozenset(part) for part in rows(found)} == {
        frozenset(part) for part in networkx.strongly_connected_components(graph)
    }
    order = np.concatenate(found.indices)
    block = np.concatenate([np.full(len(part), k) for k, part in enumerate(found.indices)])
    i, j = np.nonzero(matrix[np.ix_(order, order)])
    assert np.all(block[j] <= block[i])  # block lower triangular
    for k, part in enumerate(found.indices):
        reach = set().union(*({*networkx.descendants(graph, i)} for i in part.tolist())) - set(part.tolist())
        heard = [found.indices[j].tolist() for j in found.heard[k]]
        assert {i for rows in heard for i in rows} <= reach
        hear = set().union(*({*networkx.ancestors(graph, i)} for i in part.tolist())) - set(part.tolist())
        assert set(found.downstream(k).tolist()) == hear
