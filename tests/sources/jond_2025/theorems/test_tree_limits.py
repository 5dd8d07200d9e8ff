"""Planted truths of the bearing-distance theorem on trees: verdicts are right, or open, at all sizes, in all units.

What is true or false of a start is known by algebra here; sizes go from far above to far below the numerical error.
"""

from dataclasses import replace

import numpy as np
import pytest

from flockana import MinimalFlocking, rescale, simulate
from flockana.measures.perception import both_ways, random_out_tree
from flockana.sources.jond_2025.theorems.tree_case import tree_case
from flockana.sources.jond_2025.theorems.tree_limits import edge_shares, settles, state
from flockana.sources.jond_2025.theorems.tree_spectrum import POLYNOMIAL, tree_spectrum
from tests.theorems.made_up import said

TREE = ((0, 1), (1, 2), (1, 3), (0, 4))
PAIR = ((0, 1),)
UNITS = [(1.0, 1.0), (1e6, 1.0), (1e-3, 1.0), (1.0, 1e3), (1e-3, 1e-3)]  # metres to µm, km; seconds to ms, ks
SIZES = [1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15]


def oriented(law, n, seed=0, m=2, far=0.0):
    """A point of the manifold of equilibria, the root far from the origin if asked to."""
    q = np.random.default_rng(seed).uniform(-1.0, 1.0, (n, m))
    q[0] = far
    return tree_case(law, n).on_manifold(q)


def random_state(case, rng, m, energy):
    """A state with at most a share of the barrier in each edge: lengths off by up to √share ρ, rates alike."""
    x = rng.normal(size=(len(case.links), m))
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    angle, share = rng.uniform(0.0, 2.0 * np.pi, len(x)), np.sqrt(energy * rng.uniform(0.2, 0.9, len(x)))
    lengths = case.rho * (1.0 + share * np.cos(angle))
    rates = rng.normal(size=x.shape)
    rates *= (np.sqrt(case.mu) * case.rho * share * np.abs(np.sin(angle)) / np.linalg.norm(rates, axis=1))[:, None]
    T = np.linalg.pinv(np.array([[(v == j) - (v == i) for v in range(case.n)] for j, i in case.links], float))
    return T @ (x * lengths[:, None]), T @ rates


def energies_of(case, q, p):
    exact = np.zeros(len(q))
    return case.energies(case.edges_of(q, exact), case.edges_of(p, exact)).mid


@pytest.mark.parametrize("seed", range(12))
def test_no_edge_ever_has_more_energy_than_the_certificate_allows(seed):
    rng = np.random.default_rng(seed)
    n, m = int(rng.integers(3, 6)), int(rng.integers(1, 4))
    edges, spacing = random_out_tree(n, rng), tuple(rng.uniform(0.5, 2.0, n))
    mu, sigma = rng.uniform(0.3, 3.0, (n, n)), rng.uniform(0.5, 2.0, (n, n))
    law = MinimalFlocking(edges=edges, spacing=spacing, mu=mu, sigma=sigma, normalised=False)
    case = tree_case(law, n)
    q, p = random_state(case, rng, m, 10.0 ** rng.uniform(-12.0, -4.0))
    shares = edge_shares(case, state(q, p))
    first = [e for e, (j, _) in enumerate(case.links) if j == case.root]
    run = simulate(law, q, p, (0.0, 60.0), t_eval=np.linspace(0.0, 60.0, 600), rtol=1e-11, atol=1e-14)
    found = np.array([energies_of(case, x, v) for x, v in zip(run.q, run.p, strict=True)]).max(axis=0) / case.barrier
    assert (found <= shares * (1.0 + 1e-6) + 1e-20).all()
    assert found[first] == pytest.approx(shares[first], rel=1e-6)  # at the root nothing is felt
    if shares.max() < 1.0:
        assert settles(case, state(q, p)).margin > 0.0
        assert np.abs(case.lengths(run.q[-1]) / case.rho - 1.0).max() < 1e-2 * np.sqrt(found.max())


@pytest.mark.parametrize("off", [*SIZES, 0.0])
@pytest.mark.parametrize("inside", [True, False])
def test_the_barrier_is_sharp_but_for_rounding(off, inside):
    """V(0) next to ½μρ²: below it the limit is certain, above it nothing is known, at it neither is said."""
    rate = np.sqrt((1.0 - off) if inside else (1.0 + off))  # ½ rate² against ½ μ ρ² with μ = ρ = 1
    law, q = MinimalFlocking(edges=PAIR, spacing=1.0), [[0.0, 0.0], [1.0, 0.0]]
    near = simulate(law, q, [[0, 0], [-rate, 0.3]], (0.0, 1e-9))
    assert said("zone-1-corrected", near)["lengths"] in ("inconclusive", "verified")
    status = said("zone-1-corrected", simulate(law, q, [[0, 0], [0, rate]], (0.0, 1e-12)))["lengths"]
    if off >= 1e-9:
        assert status == ("verified" if inside else "inconclusive")
    assert status != "refuted"


@pytest.mark.parametrize("n", [3, 20, 40])
def test_the_spectrum_of_a_chain_is_right_though_its_eigenvalues_cannot_be_computed(n):
    """Equal edges make one Jordan block of n - 1 rows: computed eigenvalues scatter, here to positive real parts."""
    law = MinimalFlocking(edges=tuple((k, k + 1) for k in range(n - 1)), spacing=1.0, mu=4.0)
    case, q = tree_case(law, n), oriented(law, n)
    found = tree_spectrum(case, q)
    assert (found.zeros, found.slowest) == (n - 1, pytest.approx(0.5))
    assert found.margin > found.error
    assert found.error * POLYNOMIAL == pytest.approx(64.0 * (4.0 * (n - 1)) ** 2 * 2.0**-52)  # of rows 2 (n - 1) m
    if n == 40:
        assert np.sort(np.linalg.eigvals(case.edge_system(q)).real)[-n] > -0.4  # not -0.5: what eigenvalues would say


def test_a_wrong_spectrum_is_told():
    """μ of one edge read 1e-4 too large: another polynomial. A triangle taken for a path: one zero less."""
    law = MinimalFlocking(edges=TREE, spacing=1.0)
    case, q = tree_case(law, 5), oriented(law, 5)
    assert tree_spectrum(case, q).margin > 0.0
    case.mu[2] *= 1.0001
    assert tree_spectrum(case, q).margin < 0.0
    nets = ((0, 1), (1, 2)), ((0, 1), (1, 2), (0, 2))
    path, triangle = (MinimalFlocking(edges=both_ways(links), spacing=1.0, normalised=False) for links in nets)
    case, q = tree_case(path, 3), np.array([[0.0, 0.0], [1.0, 0.0], [0.5, np.sqrt(0.75)]])
    assert tree_spectrum(case, q).margin > 0.0
    assert tree_spectrum(replace(case, law=triangle), q).margin < 0.0


@pytest.mark.parametrize(("length", "time"), UNITS)
def test_by_how_much_matrices_are_not_symmetric_is_an_error_in_every_unit(length, time):
    """The one pulls at the other with 3, and is pulled at with 2: K is off its transpose by a third of the largest."""
    path, uneven = both_ways(((0, 1), (1, 2))), np.full((3, 3), 3.0)
    uneven[0, 1] = 2.0
    mutual, shared = (MinimalFlocking(edges=path, spacing=2.0, mu=each, normalised=False) for each in (3.0, uneven))
    case = tree_case(rescale(mutual, length=length, time=time), 3)
    q = length * np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0]])
    assert tree_spectrum(case, q).error < 1e-12
    found = tree_spectrum(replace(case, law=rescale(shared, length=length, time=time)), q)
    assert found.error == pytest.approx(1.0 / 3.0, rel=1e-6)


def test_forces_that_are_mutual_but_for_rounding_are_mutual():
    law = MinimalFlocking((3.0, 0.1), beta=(0.1, 3.0), edges=both_ways(PAIR), normalised=False)
    assert 3.0 * 0.1 != 0.1 * 3.0 or law.reciprocal
    for length in (1.0, 1e-3, 7.0, 1e6):
        assert rescale(law, length=length).reciprocal
    assert not MinimalFlocking((3.0, 0.1), beta=(0.1, 3.001), edges=both_ways(PAIR), normalised=False).reciprocal


@pytest.mark.parametrize("off", [-1e-9, 1e-9, -1e-6])
def test_a_share_near_rest_is_that_of_the_stretch_and_not_of_its_rounding(off):
    """V/(½μρ²) of an edge of length (1 + x) ρ is x²: rounding adds some 10⁻¹⁵ x to it, and not 10⁻¹⁵."""
    case = tree_case(MinimalFlocking(edges=PAIR, spacing=2.0), 2)
    q = np.array([[0.0], [2.0 * (1.0 + off)]])
    assert edge_shares(case, state(q, 0.0 * q)) == pytest.approx([off**2], rel=1e-4, abs=0.0)
