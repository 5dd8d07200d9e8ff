"""The proofs about bearing-distance flocking: slips in springs, couplings and signs make their steps fail."""

from itertools import pairwise

import numpy as np
import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

import sympy as sp

from flockana.measures.perception import both_ways
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.jond_2025.symbolic.spanning_trees import S
from flockana.sources.jond_2025.theorems.j03_eigenvalue_pairs import path_matrices
from proofs import bearing_distance, bearing_distance_printed, undirected_trees


def test_all_numberings_of_rooted_trees_are_tried():
    assert [len(list(bearing_distance.trees(agents))) for agents in (2, 3, 4, 5)] == [1, 2, 6, 24]
    assert set(bearing_distance.trees(3)) == {((0, 1), (0, 2)), ((0, 1), (1, 2))}


def test_the_linearised_tree_is_that_of_the_law():
    edges = ((0, 1), (1, 2), (1, 3))
    law = MinimalFlocking(edges=edges, spacing=(1.0, 1.0, 2.0, 3.0), mu=1.0)
    units = [np.array(bearing_distance.unit_edge(i, 2).T, dtype=float).ravel() for i in (1, 2, 3)]
    q = np.zeros((4, 2))
    for (parent, child), unit in zip(edges, units, strict=True):
        q[child] = q[parent] - child * unit  # x is the vector to the parent
    jacobian = law.jacobian(0.0, q, np.zeros_like(q))
    found = sp.Poly(sp.prod([S**2 + S + 1] * 3) * (S**2 + S) ** 3 * S**4, S)  # μ = 1; the root moves freely
    expected = np.array([float(c) for c in found.all_coeffs()])
    np.testing.assert_allclose(np.poly(jacobian), expected, atol=1e-9 * np.abs(expected).max())


def test_a_coupling_that_feels_tangents_makes_zero_defective(monkeypatch):
    chain = ((0, 1), (1, 2))
    assert bearing_distance.spectrum_holds(chain, 2)
    wrong = sp.diag(sp.zeros(2), sp.zeros(2))
    wrong[2:, :2] = sp.eye(2)
    monkeypatch.setattr(bearing_distance, "parent_block", lambda curvature: wrong)
    assert not bearing_distance.spectrum_holds(chain, 2)


def test_a_repelling_spring_changes_the_spectrum(monkeypatch):
    right = bearing_distance.link_curvature
    monkeypatch.setattr(bearing_distance, "link_curvature", lambda agent, d: -right(agent, d))
    assert not bearing_distance.spectrum_holds(((0, 1),), 2)


def test_energy_identities_notice_another_force(monkeypatch):
    assert bearing_distance.energy_rate(2) == 0
    assert bearing_distance.pair_rate(3) == 0
    right = bearing_distance.spring
    monkeypatch.setattr(bearing_distance, "spring", lambda x: 2 * right(x))
    assert bearing_distance.energy_rate(2) != 0
    assert bearing_distance.pair_rate(3) != 0


def test_separation_alone_keeps_its_energy():
    assert bearing_distance.energy_rate(2, damping=sp.S.Zero) == 0


def test_the_path_of_four_is_the_erratums():
    stiffness, damping = bearing_distance_printed.path_of_four(sp.Integer(400))
    for exact, measured in zip((stiffness, damping), path_matrices(400.0), strict=True):
        nonzero = sorted(float(value) for value in exact.eigenvals() if value != 0)
        np.testing.assert_allclose(sorted(np.linalg.eigvals(measured).real), nonzero, rtol=1e-10)


@pytest.mark.parametrize(("mu", "unstable"), [(738.0, False), (740.0, True), (1000.0, True), (4000.0, True)])
def test_the_threshold_of_instability_is_that_of_the_matrices(mu, unstable):
    stiffness, damping = path_matrices(mu)
    roots = np.linalg.eigvals(np.block([[np.zeros((3, 3)), np.eye(3)], [-stiffness, -damping]]))
    assert (roots.real.max() > 0) is np.bool_(unstable)
    assert int(np.sum(roots.real > 0)) == (2 if unstable else 0)


def test_sign_changes_of_rouths_array_count_unstable_roots():
    rng = np.random.default_rng(0)
    for degree in (2, 3, 4, 5, 6):
        coefficients = [sp.Integer(1), *(sp.Rational(int(k), 7) for k in rng.choice([-9, -5, -2, 1, 4, 8, 11], degree))]
        column = [float(entry) for entry in bearing_distance_printed.routh(coefficients)]
        changes = sum(a * b < 0 for a, b in pairwise(column))
        roots = np.roots([float(c) for c in coefficients])
        assert len(column) == degree + 1
        assert changes == int(np.sum(roots.real > 0))


def test_a_sign_is_told_only_where_the_coefficients_tell_it():
    t = bearing_distance_printed.EXCESS
    assert bearing_distance_printed.one_sign((1 + t) / (2 + t**2)) == 1
    assert bearing_distance_printed.one_sign(-3 * t / (1 + t)) == -1
    assert bearing_distance_printed.one_sign(sp.Rational(-1, 2)) == -1
    assert bearing_distance_printed.one_sign(1 - t) is None


def test_the_controls_of_the_runaway_path_are_the_laws_at_any_rates():
    u, _, _ = bearing_distance_printed.three_path(2)
    law = MinimalFlocking(edges=both_ways([(0, 1), (1, 2)]))
    q, p = np.array([[-1.5, 0.2], [0.0, 0.0], [0.7, -1.1]]), np.array([[0.3, -0.4], [0.0, 0.0], [0.8, 0.5]])
    parts = (("a", q[0]), ("b", q[2]), ("v", p[0]), ("w", p[2]))
    values = {f"{name}_{k + 1}": part[k] for name, part in parts for k in (0, 1)}
    found = u.subs({symbol: values[symbol.name] for symbol in u.free_symbols})
    np.testing.assert_allclose(np.array(found.T, dtype=float), law.acceleration(0.0, q, p), atol=1e-13)


def test_another_distance_is_no_steady_state():
    u, _, behind = bearing_distance_printed.three_path(2)
    off = {symbol: value * sp.Rational(6, 5) for symbol, value in behind.items()}
    controls = u.subs(off)
    assert controls[0, 0] != controls[0, 1]


def test_a_leaf_without_length_adds_no_row():
    assert undirected_trees.leaf_row("a row", 2).holds is True
    assert undirected_trees.leaf_row("no row", 2, length=0).holds is False
