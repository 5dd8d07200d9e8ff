"""Search from many starts: what is found, and that each is found once."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from flockana import Algorithm1, find_equilibrium, links
from flockana.equilibria.congruence import congruent
from flockana.equilibria.equilibrium_search import distinct, lattice_starts, random_starts, search
from flockana.lattice import harborth, hexagonal_spiral
from tests.refused import refused

LAW = Algorithm1()


def test_starts_have_the_scale_of_the_lattice():
    for m, bonds in ((1, 4), (2, 6), (3, 7)):
        patch = lattice_starts(5, m, 7.0, 3, noise=0.0)
        for q in patch:
            lengths = np.linalg.norm(q[:, None] - q[None], axis=2)[np.triu_indices(5, 1)]
            assert lengths.min() == pytest.approx(7.0)
            assert len(links(q, 8.0)) >= min(bonds, 4)
    disc = random_starts(400, 2, 7.0, 1, density=1.0)[0]
    assert np.pi * np.linalg.norm(disc, axis=1).max() ** 2 == pytest.approx(400 * 49.0, rel=0.05)


@pytest.mark.slow
def test_a_search_reaches_harborths_count_and_finds_each_minimum_once():
    starts = random_starts(7, 2, 7.0, 12, density=3.0)
    found = search(LAW, starts)
    assert len(found.best.links) == harborth(7) == 12
    assert found.best.kind == "minimum"
    minima = [one.equilibrium for one in found.found if one.equilibrium.kind == "minimum"]
    for k, one in enumerate(minima):
        assert not any(congruent(one.q, other.q, tol=1e-4) for other in minima[k + 1 :])
    assert sum(one.count for one in found.found) + len(found.failures) == 12
    energies = np.array([one.equilibrium.energy for one in found.found])
    assert np.all(np.diff(energies) > -1e-9 * np.abs(energies).max())  # but for lattices of as many links, which tie
    with ThreadPoolExecutor(1) as executor:
        again = search(LAW, starts, executor=executor)
    assert [one.count for one in again.found] == [one.count for one in found.found]


def test_saddles_have_an_index():
    found = search(LAW, random_starts(4, 2, 7.0, 12, density=4.0), method="root")
    saddles = [one.equilibrium for one in found.found if one.equilibrium.kind == "saddle"]
    assert saddles
    for one in saddles:
        assert one.residual < 1e-9
        values, rest = one.hessian_eigenvalues, one.index + one.zero_modes
        assert 0 < one.index < values.size
        assert np.all(values[: one.index] < 0.0)
        assert np.all(values[rest:] > 0.0)
        # zeros between them: out of range, or a link that lets go at r, whose stiffness is the root of the residual
        assert np.abs(values[one.index : rest]).max(initial=0.0) < 1e-3 * np.abs(values).max()


test_search_refuses_bad_starts = refused(
    (lambda: search(LAW, [np.zeros((2, 2)), np.zeros((3, 2))]), "all of one shape"),
    (lambda: search(LAW, []), "expected at least one"),
)


def test_equal_energies_are_ranked_as_found():
    """Lattices of eight with as many links have one energy, and which of them rounds below the other is no rank."""
    one = find_equilibrium(LAW, hexagonal_spiral(8, 7.0))
    corner = np.vstack([hexagonal_spiral(7, 7.0), 7.0 * np.array([[1.5, -np.sqrt(0.75)]])])
    other = find_equilibrium(LAW, corner)
    assert one.energy == pytest.approx(other.energy, rel=1e-12)
    shift = 1e-12 * one.energy
    for first, second in ((one, other), (other, one)):
        for off in (-shift, 0.0, shift):
            found = distinct([replace(first, energy=first.energy + off), second])
            assert found[0].equilibrium.q is first.q
    lower = replace(other, energy=one.energy - 1e-6)
    assert distinct([one, lower])[0].equilibrium is lower
