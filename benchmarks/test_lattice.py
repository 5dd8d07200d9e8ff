"""Links, crossings and what is measured of a lattice, against n, as ratios."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from flockana.lattice import crossings, defects, fcc, links, rigidity, separation, triangular

from .conftest import best

D, R = 7.0, 8.4


def random_net(n: int, seed: int = 0):
    """Positions without order at about the lattice's density: nearly half of the links cross some other."""
    q = np.random.default_rng(seed).uniform(0.0, D * np.sqrt(n), (n, 2))
    return q, links(q, R)


def lattice(n: int):
    q = triangular(n, D)
    return q, links(q, R)


def space(n: int):
    cells = round((n / 4) ** (1.0 / 3.0))
    q = fcc(cells, cells, cells, D)
    return q, links(q, R)


@pytest.mark.parametrize("build", [lattice, random_net, space])
def test_crossings_grow_like_n(benchmark, ratio, build):
    per_link = []
    for n in (10_000, 100_000):
        q, pairs = build(n)
        per_link.append(best(lambda q=q, pairs=pairs: crossings(q, pairs), repeat=3) / len(pairs))
    ratio(
        f"crossings per link, {build.__name__}, n = 1e5 over 1e4", per_link[1] / per_link[0], "asked: no growth like n"
    )
    benchmark.pedantic(crossings, args=(q, pairs), rounds=3)


def test_crossings_against_the_neighbour_search(benchmark, ratio):
    q, pairs = lattice(100_000)
    value = best(lambda: crossings(q, pairs), repeat=3) / best(lambda: links(q, R), repeat=3)
    ratio("crossings, n = 1e5", value, "time over that of finding the links")
    benchmark.pedantic(links, args=(q, R), rounds=3)


def test_crossings_against_all_pairs_of_links(benchmark, ratio):
    """A vectorised test of every two links by orientations, without care for degenerate ones."""
    q, pairs = random_net(400)

    def all_pairs() -> int:
        a, b = np.array(list(combinations(range(len(pairs)), 2))).T
        i, j, g, h = q[pairs[a, 0]], q[pairs[a, 1]], q[pairs[b, 0]], q[pairs[b, 1]]

        def side(x, y, z):
            return np.sign((y - x)[:, 0] * (z - x)[:, 1] - (y - x)[:, 1] * (z - x)[:, 0])

        return int(np.sum((side(i, j, g) * side(i, j, h) < 0) & (side(g, h, i) * side(g, h, j) < 0)))

    assert all_pairs() == len(crossings(q, pairs))
    ratio(
        "all pairs of links, n = 400", best(all_pairs, repeat=2) / best(lambda: crossings(q, pairs)), "time over ours"
    )
    benchmark(crossings, q, pairs)


@pytest.mark.parametrize("measure", [defects, rigidity, lambda q, pairs: separation(q, pairs, reach=0.5 * D)])
def test_other_measures_against_crossings(benchmark, ratio, measure):
    q, pairs = lattice(20_000)
    value = best(lambda: measure(q, pairs), repeat=2) / best(lambda: crossings(q, pairs), repeat=3)
    name = "separation" if measure.__name__ == "<lambda>" else measure.__name__
    ratio(f"{name}, n = 2e4", value, "time over that of the crossings")
    benchmark.pedantic(measure, args=(q, pairs), rounds=1)
