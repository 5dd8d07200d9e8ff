"""Delayed consensus: the margin and its roots in closed form, and what is no Laplacian."""

from math import pi

import networkx
import numpy as np
import pytest
from scipy.special import lambertw

from flockana import laplacian
from flockana.stability import consensus_root, consensus_system, delay_margin, rightmost_roots
from tests.refused import refused


def net(n, pairs, weights=None):
    return laplacian(n, np.array(pairs, dtype=np.int32), weights).toarray()


@pytest.mark.parametrize("seed", range(4))
def test_a_directed_net_bears_what_its_eigenvalues_do(seed):
    rng = np.random.default_rng(seed)
    weights = (rng.random((9, 9)) < 0.4) * rng.uniform(0.1, 3.0, (9, 9))
    np.fill_diagonal(weights, 0.0)
    matrix = np.diag(weights.sum(axis=1)) - weights
    values = np.linalg.eigvals(matrix)
    system = consensus_system(matrix)
    assert system.neutral == 9 + np.sum(np.abs(values) < 1e-9)
    values = values[np.abs(values) > 1e-9]
    closed = ((pi / 2.0 - np.abs(np.angle(values))) / np.abs(values)).min()
    found = delay_margin(system)
    assert found.delay == pytest.approx(closed, rel=1e-9)
    for share, sign in ((0.98, -1.0), (1.02, 1.0)):
        assert np.sign(rightmost_roots(system, share * found.delay, count=1)[0].real) == sign


def test_a_chain_that_nobody_answers_is_as_good_as_one_link():
    """L is one Jordan block of ten: its eigenvalues, as a matrix's, would be off by a tenth root of rounding."""
    matrix = np.diag([0.0] + [1.0] * 10) - np.diag([1.0] * 10, -1)
    found = delay_margin(consensus_system(matrix))
    assert found.delay == pytest.approx(pi / 2.0, rel=1e-14)


def test_networkx_laplacians_are_taken_as_they_are():
    graph = networkx.cycle_graph(6)
    assert delay_margin(consensus_system(networkx.laplacian_matrix(graph))).delay == pytest.approx(pi / 8.0)
    directed = networkx.laplacian_matrix(networkx.cycle_graph(3, create_using=networkx.DiGraph))
    assert delay_margin(consensus_system(directed)).delay == pytest.approx(0.6046, abs=5e-5)


@pytest.mark.parametrize("share", [0.3, 0.9, 1.1, 3.0])
def test_the_root_is_one_and_no_other_is_to_its_right(share):
    delay = share * pi / 4.0
    root = consensus_root(2.0, delay)
    assert abs(root + 2.0 * np.exp(-root * delay)) < 1e-13
    found = rightmost_roots(consensus_system(net(2, [(0, 1)])), delay, count=1)[0]
    assert abs(found.real - root.real) < 1e-10
    assert (root.real > 0.0) == (share > 1.0)


@pytest.mark.parametrize("delay", [1.0, 0.25, 4.0])
def test_the_double_root_is_exact(delay):
    assert consensus_root(1.0 / delay / np.e, delay) == -1.0 / delay
    for beside in (np.nextafter(1.0 / np.e, 0.0), np.nextafter(1.0 / np.e, 1.0)):  # a square root: half of the digits
        assert abs(consensus_root(beside / delay, delay) + 1.0 / delay) < 3e-8 / delay


def test_roots_at_zero_are_counted_for_each_component():
    assert consensus_system(net(3, [(0, 1), (1, 2)])).neutral == 4
    assert consensus_system(net(3, [(0, 1)])).neutral == 5


test_what_is_no_laplacian = refused(
    ([[1.0, 0.0], [0.0, 1.0]], "row 0 sums to 1: expected rows that sum to 0"),
    ([[1.0, -1.0], [-2.0, 3.0]], "row 1 sums to 1"),
    ([1.0, -1.0], r"shape \(2,\)"),
    ([[float("nan")]], "finite"),
    ("net", "square array of numbers"),
    make=consensus_system,
)


test_bad_roots = refused(
    (lambda: consensus_root(0.0, 1.0), "eigenvalue = 0"), (lambda: consensus_root(1.0, -1.0), "delay = -1")
)


@pytest.mark.parametrize("delay", [0.1, 0.3, 1.0])
def test_rightmost_roots_of_a_path_are_those_of_each_follower(delay):
    """S8: each of 18 followers adds s + e^(−sτ), the leader nothing."""
    matrix = np.diag([0.0] + [1.0] * 18) - np.diag([1.0] * 18, -1)
    system = consensus_system(matrix)
    found = rightmost_roots(system, delay, count=6)
    assert np.abs(found.real - consensus_root(1.0, delay).real).max() < 1e-12
    assert found.size == 6


def test_roots_of_a_star_a_tree_and_a_ring_are_lamberts():
    star = np.zeros((6, 6))
    star[1:, 0], star[np.arange(1, 6), np.arange(1, 6)] = -np.arange(1.0, 6.0), np.arange(1.0, 6.0)
    found = rightmost_roots(consensus_system(star), 0.1, count=5)
    expected = sorted((consensus_root(float(k), 0.1) for k in range(1, 6)), key=lambda s: -s.real)
    assert np.abs(found[0] - expected[0]) < 1e-12
    ring = np.eye(5) - np.roll(np.eye(5), -1, axis=1)
    values = 1.0 - np.exp(2j * pi * np.arange(1, 5) / 5)
    roots = lambertw(-values * 0.2) / 0.2
    best = rightmost_roots(consensus_system(ring), 0.2, count=2)
    assert np.abs(best[0].real - roots.real.max()) < 1e-11
    below = np.zeros((8, 8))  # the ring leads a chain of three, the last of which hears one of the ring as well
    below[:5, :5] = ring
    for k, heard in ((5, (0,)), (6, (5,)), (7, (6, 2))):
        below[k, list(heard)], below[k, k] = -1.0, len(heard)
    both = np.concatenate([roots, lambertw(-np.array([1.0, 1.0, 2.0]) * 0.2) / 0.2])
    assert np.abs(rightmost_roots(consensus_system(below), 0.2, count=1)[0].real - both.real.max()) < 1e-11


def test_a_net_without_links_has_no_roots_but_its_neutral_ones():
    system = consensus_system(np.zeros((3, 3)))
    assert rightmost_roots(system, 0.3).size == 0
    one_link = np.array([[0.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    found = rightmost_roots(consensus_system(one_link), 0.3, count=2)
    assert found[0] == pytest.approx(consensus_root(1.0, 0.3), abs=1e-12)
