"""Perception graphs: which are rooted out-trees, and their matrices."""

import numpy as np

from flockana.measures.perception import edge_vectors, incidence, out_tree_root, random_out_tree, receivers

TREE = ((0, 1), (1, 2), (1, 3), (0, 4))


def state(n, m, seed=0, size=3.0):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, size, (n, m)), rng.uniform(-1.0, 1.0, (n, m))


def test_trees_are_told_from_the_rest():
    assert out_tree_root(5, TREE) == 0
    assert out_tree_root(3, ((2, 1), (2, 0))) == 2
    assert out_tree_root(3, ((0, 2), (1, 2))) is None  # an in-tree: all reach agent 2, as the paper words it
    assert out_tree_root(3, ((0, 1), (1, 2), (2, 0))) is None
    assert out_tree_root(4, ((0, 1), (2, 3))) is None
    assert out_tree_root(4, ((0, 1), (1, 0), (2, 3))) is None  # n − 1 edges and a cycle
    assert out_tree_root(4, TREE[:2]) is None  # agent 3 is alone
    for seed in range(5):
        assert out_tree_root(9, random_out_tree(9, np.random.default_rng(seed))) == 0


def test_incidence_and_edge_vectors():
    chain = ((0, 1), (1, 2))
    D, D_in = incidence(3, chain), receivers(3, chain)
    np.testing.assert_array_equal(D @ D.T, [[1, -1, 0], [-1, 2, -1], [0, -1, 1]])
    np.testing.assert_array_equal(D_in @ D.T, [[0, 0, 0], [-1, 1, 0], [0, -1, 1]])
    q, _ = state(3, 2)
    np.testing.assert_allclose(edge_vectors(q, chain), -D.T @ q)
