"""Builders: links counted by hand, ratios by brute force, Harborth's number."""

import math

import numpy as np
import pytest

from flockana.lattice import bcc, fcc, harborth, hcp, is_alpha_lattice, links, max_ratio, simple_cubic
from flockana.lattice.builders import hexagonal_patch, hexagonal_spiral, honeycomb, line, square, triangular
from flockana.measures import nets
from flockana.measures.metrics import min_distance
from flockana.measures.nets import link_lengths
from tests.refused import refused

D = 7.0
# each with a block large enough that its middle agents have all first and second neighbours, and few enough to pair all
PATTERNS = {
    "line": (line(9, D), 2),
    "triangular": (triangular(100, D), 6),
    "hexagonal_patch": (hexagonal_patch(4, D), 6),
    "hexagonal_spiral": (hexagonal_spiral(70, D), 6),
    "square": (square(7, 8, D), 4),
    "honeycomb": (honeycomb(6, 7, D), 3),
    "simple_cubic": (simple_cubic(5, 5, 5, D), 6),
    "fcc": (fcc(4, 4, 4, D), 12),
    "hcp": (hcp(5, 4, 4, D), 12),
    "bcc": (bcc(5, 5, 5, D), 8),
}


def shells(q) -> np.ndarray:
    """All different distances of a configuration, in units of the shortest."""
    i, j = np.triu_indices(len(q), 1)
    lengths = np.linalg.norm(q[i] - q[j], axis=1)
    return np.unique(np.round(lengths / lengths.min(), 9))


@pytest.mark.parametrize("name", PATTERNS)
def test_first_and_second_neighbours_by_brute_force(name):
    q, coordination = PATTERNS[name]
    assert min_distance(q) == pytest.approx(D, rel=1e-13)
    assert shells(q)[1] == pytest.approx(max_ratio(name), rel=1e-8)
    count = np.bincount(links(q, 1.05 * D).ravel())
    assert count.max() == coordination


@pytest.mark.parametrize("name", PATTERNS)
def test_the_largest_ratio_itself_is_allowed_and_nothing_beyond_it(name):
    q, _ = PATTERNS[name]
    kappa = max_ratio(name)
    assert is_alpha_lattice(q, D, kappa * D)
    assert not is_alpha_lattice(q, D, kappa * D * (1.0 + 1e-9))
    assert len(links(q, kappa * D)) == len(links(q, 1.05 * D))


def test_a_guard_is_needed_at_the_ratio_and_only_there():
    """What is stored decides the laws' own strict comparison either way; 1/7 of these nets would gain a diagonal."""
    gained = 0
    for d in np.linspace(1.0, 9.0, 50):
        q = square(6, 6, d)
        plain, guarded = nets.links(q, max_ratio("square") * d), links(q, max_ratio("square") * d)
        assert len(guarded) == 60
        gained += len(plain) > 60
        np.testing.assert_array_equal(links(q, 1.2 * d), nets.links(q, 1.2 * d))
    assert gained > 5


@pytest.mark.parametrize(
    ("build", "size", "count"),
    [
        (lambda: line(9, D), 9, 8),
        (lambda: square(3, 5, D), 15, 3 * 4 + 5 * 2),
        (lambda: honeycomb(3, 5, D), 30, 3 * 15 - 3 - 5),  # one inside each cell, one to the next in either direction
        (lambda: simple_cubic(2, 3, 4, D), 24, 1 * 12 + 2 * 8 + 3 * 6),
        (lambda: fcc(2, 3, 4, D), 96, 2 * (3 * 5 * 4 + 5 * 7 * 2 + 3 * 7 * 3)),
        (lambda: bcc(2, 3, 4, D), 48, 3 * 5 * 7),
        # rows of 4 and 4 shifted: 3 in each row, 4 + 3 between each two rows
        (lambda: triangular(12, D), 12, 3 * 3 + 2 * 7),
        (lambda: hcp(1, 1, 1, D), 4, 5),  # two pairs within the layers; three between them
    ],
)
def test_links_counted_by_hand(build, size, count):
    q = build()
    r = 1.1 * D
    assert (len(q), len(links(q, r))) == (size, count)
    assert is_alpha_lattice(q, D, r)


@pytest.mark.parametrize(
    ("q", "extent"),  # between the first and the last site along each axis, in distances
    [
        (line(9, D), [8.0]),
        (square(3, 5, D), [4.0, 2.0]),
        (simple_cubic(2, 3, 4, D), [1.0, 2.0, 3.0]),
        (fcc(2, 3, 4, D), [1.5 * math.sqrt(2.0), 2.5 * math.sqrt(2.0), 3.5 * math.sqrt(2.0)]),
        (bcc(2, 3, 4, D), [3.0 / math.sqrt(3.0), 5.0 / math.sqrt(3.0), 7.0 / math.sqrt(3.0)]),
        # along y two cells and two thirds of the last, in which the second layer stands over the triangles of the first
        (hcp(2, 3, 4, D), [1.5, (2.0 + 2.0 / 3.0) * math.sqrt(3.0), 3.5 * math.sqrt(8.0 / 3.0)]),
    ],
    ids=["line", "square", "simple_cubic", "fcc", "bcc", "hcp"],
)
def test_a_block_begins_at_the_origin_and_is_as_long_as_its_cells(q, extent):
    assert q[0].tolist() == q.min(axis=0).tolist() == [0.0] * len(extent)
    np.testing.assert_allclose(q.max(axis=0), np.multiply(D, extent), rtol=1e-14)


def test_hcp_is_not_fcc():
    """Both have twelve neighbours; only in HCP do two neighbours stand at √(8/3) d, across a layer."""
    assert math.sqrt(8.0 / 3.0) == pytest.approx(shells(PATTERNS["hcp"][0])[2], rel=1e-8)
    assert shells(PATTERNS["fcc"][0])[2] == pytest.approx(math.sqrt(3.0), rel=1e-8)


def test_harborth_is_the_floor_even_where_floats_fail():
    for n in (1, 2, 3, 12, 37, 1000, 10**12):
        root = math.isqrt(12 * n - 3)
        assert harborth(n) == 3 * n - root - (root * root != 12 * n - 3), n


def test_the_spiral_is_a_lattice_with_the_most_links():
    for n in range(1, 80):
        q = hexagonal_spiral(n, D)
        pairs = links(q, 8.4)
        assert len(pairs) == harborth(n)
        np.testing.assert_allclose(link_lengths(q, pairs), D, rtol=1e-13)
        assert n == 1 or min_distance(q) == pytest.approx(D, rel=1e-13)


def test_a_patch_is_a_full_spiral():
    assert [len(hexagonal_patch(k, 1.0)) for k in range(4)] == [1, 7, 19, 37]
    q = hexagonal_patch(2, 1.0)
    np.testing.assert_allclose(q.mean(axis=0), 0.0, atol=1e-14)


test_bad_input = refused(
    (lambda: line(10**13, D), r"of shape \(4, 10000000000000, 1\) would take"),
    (lambda: triangular(10**13, D), r"of shape \(4, 10000000000000, 2\) would take"),
    (lambda: hexagonal_spiral(10**13, D), r"of shape \(4, 10000000000000, 2\) would take"),
    (lambda: hcp(10**5, 10**4, 10**4, D), r"of shape \(4, 40000000000000, 3\) would take"),
    (lambda: max_ratio("hpc"), "unknown lattice 'hpc'; did you mean 'hcp'"),
)
