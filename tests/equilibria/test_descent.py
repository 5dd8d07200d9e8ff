"""Minima of large flocks: against IPOPT from the same starts, by their residuals, and where the net gives way."""

import numpy as np
import pytest
from scipy.spatial.distance import pdist

from flockana import Algorithm3, DeadZoneFlocking, Gains, Sphere, StaticTarget, find_equilibrium, rescale
from flockana.base.errors import SolverError
from flockana.equilibria.descent import anneal, descend, newton, pairs_collapsed
from flockana.equilibria.equilibrium_search import random_starts
from flockana.equilibria.potential import Potential
from flockana.lattice import hexagonal_patch, hexagonal_spiral
from flockana.laws.olfati_saber import Algorithm1, Algorithm2

PRESSED = Algorithm2(target=StaticTarget((0.0, 0.0)))


def disturbed(n: int, seed: int):
    return hexagonal_spiral(n, 7.0) + 0.3 * np.random.default_rng(seed).standard_normal((n, 2))


@pytest.mark.parametrize("n", [61, 250])
def test_a_net_that_holds_comes_to_the_minimum_that_ipopt_finds(n):
    one, other = (find_equilibrium(PRESSED, disturbed(n, 1), method=method) for method in ("descent", "ipopt"))
    assert one.energy == pytest.approx(other.energy, rel=1e-13)
    np.testing.assert_allclose(one.hessian_eigenvalues, other.hessian_eigenvalues, rtol=1e-7)
    assert (one.kind, one.message, len(one.links)) == (other.kind, "Converged", len(other.links))
    assert one.residual < 1e-12


@pytest.mark.parametrize(
    ("law", "start"),
    [
        (Algorithm2(gains=Gains(c1_gamma=6.0), target=StaticTarget((0.0, 0.0))), disturbed(150, 0)),
        (Algorithm1(), random_starts(210, 2, 7.0, 1)[0]),
        (DeadZoneFlocking(), random_starts(60, 2, 3.5, 1)[0]),
    ],
)
def test_where_the_net_gives_way_the_minimum_is_no_worse_than_that_of_ipopt(law, start):
    """Which minimum either comes to hangs on rounding; from one start to the next energies differ by 1.5 % at most."""
    one, other = (find_equilibrium(law, start, method=method) for method in ("descent", "ipopt"))
    assert one.energy < other.energy + 0.02 * abs(other.energy)
    assert one.kind in ("minimum", "degenerate")
    assert one.residual < 1e-12


def test_the_large_ones_descend_unless_ipopt_is_asked_for():
    start = disturbed(201, 0)
    assert find_equilibrium(Algorithm1(), start).message == "Converged"
    assert find_equilibrium(Algorithm1(), start, method="ipopt").message == "Solve_Succeeded"
    assert find_equilibrium(Algorithm1(), start[:200]).message == "Solve_Succeeded"


@pytest.mark.parametrize(("length", "time"), [(1e-3, 1.0), (1.0, 1e4), (5e2, 1e-2)])
def test_the_descent_is_the_same_in_every_unit(length, time):
    start = disturbed(150, 2)
    here = find_equilibrium(PRESSED, start, method="descent")
    there = find_equilibrium(rescale(PRESSED, length=length, time=time), length * start, method="descent")
    assert (there.kind, len(there.links)) == (here.kind, len(here.links))
    np.testing.assert_allclose(pdist(there.q) / length, pdist(here.q), rtol=1e-7)  # as it turned is rounding


def test_newton_leaves_a_saddle_downhill_and_ends_at_a_minimum():
    """Two agents almost at one place: the Hessian is negative, and a plain Newton step leads back to the saddle."""
    potential = Potential(Algorithm1())
    start = np.vstack([hexagonal_spiral(3, 7.0), [[0.3, 0.1]]])
    assert np.linalg.eigvalsh(potential.stiffness(start).toarray())[0] < -1.0
    found, done = newton(potential, start, 300)
    assert done
    assert potential.energy(found) < potential.energy(start)
    assert np.linalg.eigvalsh(potential.stiffness(found).toarray())[0] > -1e-6
    assert not newton(potential, start, 1)[1]


def test_a_net_gives_way_where_neighbours_part_and_not_where_all_move():
    potential, q = Potential(Algorithm1()), hexagonal_patch(2, 7.0)
    assert not pairs_collapsed(potential, q, q + 100.0)
    assert not pairs_collapsed(potential, q, 0.9 * q)
    swapped = q.copy()
    swapped[[0, 1]] = swapped[[1, 0]]
    assert pairs_collapsed(potential, q, swapped)


def test_annealing_keeps_the_centre_and_is_the_same_every_time():
    potential, q = Potential(PRESSED), disturbed(40, 0)
    warm = anneal(potential, q, 0.01)
    np.testing.assert_allclose(warm.mean(axis=0), q.mean(axis=0), atol=1e-9)
    np.testing.assert_array_equal(warm, anneal(potential, q, 0.01))
    assert np.abs(warm - q).max() > 0.1


def test_nobody_ends_inside_an_obstacle():
    law = Algorithm3(target=StaticTarget((0.0, 0.0)), obstacles=(Sphere((0.0, 0.0), 10.0),))
    start = hexagonal_spiral(60, 7.0) + np.array([45.0, 0.0])
    found = find_equilibrium(law, start, method="descent")
    assert np.linalg.norm(found.q, axis=1).min() > 10.0
    assert found.residual < 1e-9


def test_what_does_not_converge_says_so():
    start = 50.0 * disturbed(30, 0)  # farther than a hundred strides
    assert not descend(Potential(PRESSED), start, 1).converged
    with pytest.raises(SolverError, match="Newton's method did not converge"):
        find_equilibrium(PRESSED, start, method="descent", max_iter=1)
