"""Search, congruence, collapse and the recorded minimum."""

from __future__ import annotations

import json
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from flockana.base.errors import ArgumentError, FileError, SolverError
from flockana.equilibria.coincidence import hessian_trace, least_with_coincidence
from flockana.equilibria.collapse import CollapseDiagram, collapse_diagram, collapse_threshold, threshold
from flockana.equilibria.congruence import congruent
from flockana.equilibria.record import read_equilibrium, smallest_strained, write_equilibrium
from flockana.equilibria.search import distinct, lattice_starts, random_starts, search
from flockana.equilibria.solve import find_equilibrium
from flockana.interactions import AlphaInteraction
from flockana.lattice import harborth, hexagonal_spiral
from flockana.laws.olfati_saber import Algorithm1
from flockana.measures.nets import links
from flockana.theorems.slides.e03 import rhombus_with_double_agent

LAW = Algorithm1()


@pytest.mark.parametrize("m", [1, 2, 3])
def test_congruence_up_to_motion_mirror_and_numbering(m):
    rng = np.random.default_rng(m)
    q = rng.standard_normal((6, m))
    turn = np.linalg.qr(rng.standard_normal((m, m)))[0]
    assert congruent(q, (q @ turn)[rng.permutation(6)] + 3.0, tol=1e-9)
    assert congruent(q, -q, tol=1e-9)
    assert congruent(q, q * np.append(np.ones(m - 1), -1.0), tol=1e-9)  # a reflection; -q in the plane is none
    moved = q.copy()
    moved[2, 0] += 1e-3
    assert not congruent(q, moved, tol=1e-6)


def test_equal_distances_are_not_enough_and_coincident_agents_are_counted():
    assert not congruent(
        np.array([[0.0], [1.0], [4.0], [10.0], [12.0], [17.0]]),
        np.array([[0.0], [1.0], [8.0], [11.0], [13.0], [17.0]]),
        tol=1e-9,
    )
    double = rhombus_with_double_agent(7.0)
    assert congruent(double, double[::-1] * [1.0, -1.0], tol=1e-9)
    flat = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]])
    assert congruent(flat, flat[:, [2, 0, 1]], tol=1e-9)


def test_starts_have_the_scale_of_the_lattice():
    for m, bonds in ((1, 4), (2, 6), (3, 7)):
        patch = lattice_starts(5, m, 7.0, 3, noise=0.0)
        for q in patch:
            lengths = np.linalg.norm(q[:, None] - q[None], axis=2)[np.triu_indices(5, 1)]
            assert lengths.min() == pytest.approx(7.0)
            assert len(links(q, 8.0)) >= min(bonds, 4)
    disc = random_starts(400, 2, 7.0, 1, density=1.0)[0]
    assert np.pi * np.linalg.norm(disc, axis=1).max() ** 2 == pytest.approx(400 * 49.0, rel=0.05)


def test_a_search_reaches_harborths_count_and_finds_each_minimum_once():
    starts = random_starts(7, 2, 7.0, 30, density=3.0)
    found = search(LAW, starts)
    assert len(found.best.links) == harborth(7) == 12
    assert found.best.kind == "minimum"
    minima = [one.equilibrium for one in found.found if one.equilibrium.kind == "minimum"]
    for k, one in enumerate(minima):
        assert not any(congruent(one.q, other.q, tol=1e-4) for other in minima[k + 1 :])
    assert sum(one.count for one in found.found) + len(found.failures) == 30
    energies = np.array([one.equilibrium.energy for one in found.found])
    assert np.all(np.diff(energies) > -1e-9 * np.abs(energies).max())  # but for lattices of as many links, which tie
    with ThreadPoolExecutor(1) as executor:
        again = search(LAW, starts, executor=executor)
    assert [one.count for one in again.found] == [one.count for one in found.found]


def test_copies_of_one_minimum_are_one_and_mirror_images_too():
    hexagon = find_equilibrium(LAW, hexagonal_spiral(8, 7.0))
    mirrored = find_equilibrium(LAW, hexagonal_spiral(8, 7.0)[::-1] * [-1.0, 1.0] + 40.0)
    groups = distinct([hexagon, mirrored])
    assert [one.count for one in groups] == [2]


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


def test_search_refuses_bad_starts():
    with pytest.raises(ArgumentError, match="all of one shape"):
        search(LAW, [np.zeros((2, 2)), np.zeros((3, 2))])
    with pytest.raises(ArgumentError, match="expected at least one"):
        search(LAW, [])


def test_the_recorded_minimum_is_strained_by_the_kernels_alone():
    """Nothing of the solver: forces vanish, links are not d, and differences of the force give a positive Hessian."""
    found = smallest_strained()
    q, alpha = found.q, LAW.alpha
    assert np.abs(LAW.acceleration(0.0, q, 0.0 * q)).max() < 1e-9
    lengths = np.linalg.norm(q[found.links[:, 1]] - q[found.links[:, 0]], axis=1)
    assert (len(q), len(lengths)) == (13, 24)
    assert (lengths.min(), lengths.max()) == pytest.approx((6.848808, 7.116341), abs=1e-6)
    assert np.linalg.norm(q[:, None] - q[None], axis=2)[np.triu_indices(13, 1)].min() > 6.0
    step, columns = 1e-5, []
    for k in range(q.size):
        nudge = np.zeros(q.size)
        nudge[k] = step
        nudge = nudge.reshape(q.shape)
        columns.append(
            (LAW.acceleration(0.0, q - nudge, 0 * q) - LAW.acceleration(0.0, q + nudge, 0 * q)).ravel() / (2 * step)
        )
    eigenvalues = np.linalg.eigvalsh(0.5 * (np.array(columns) + np.array(columns).T))
    assert np.abs(eigenvalues[:3]).max() < 1e-4
    assert eigenvalues[3] == pytest.approx(39.342, abs=1e-2)
    assert alpha.d == 7.0


def test_a_record_is_verified_when_read(tmp_path):
    path = tmp_path / "found.json"
    write_equilibrium(smallest_strained(), path)
    again = read_equilibrium(path)
    np.testing.assert_allclose(again.q, smallest_strained().q, atol=1e-12)
    data = json.loads(path.read_text())
    for change, message in (
        ({"kind": "saddle"}, "claims kind"),
        ({"q": (2.0 * again.q).tolist()}, "no equilibrium"),
        ({"hessian_eigenvalues": [1.0] * 23}, "Hessian eigenvalues"),
        ({"energy": 1.0}, "claims an energy"),
        ({"format": "other"}, "its format is 'other'"),
    ):
        path.write_text(json.dumps(data | change))
        with pytest.raises(FileError, match=message):
            read_equilibrium(path)
    with pytest.raises(FileError, match="cannot write"):
        write_equilibrium(again, tmp_path / "no" / "such.json")


def test_coincident_agents_need_enough_neighbours():
    alpha = AlphaInteraction()
    for m in (1, 2, 3):
        for length in (0.0, 2.0, 6.5, 8.0):
            pair = np.zeros((2, m))
            pair[1, 0] = length
            trace = float(np.trace(alpha.hessian(pair).toarray()[:m, :m]))
            assert float(hessian_trace(alpha, np.array([length]), m)[0]) == pytest.approx(trace, abs=1e-11)
    assert [least_with_coincidence(alpha, m) for m in (1, 2, 3)] == [4, 5, 6]
    # five is reached in the plane, four on a line: a pair between two others
    assert find_equilibrium(LAW, rhombus_with_double_agent(7.0), method="root").kind == "minimum"
    line = find_equilibrium(LAW, [[-7.0], [0.0], [0.0], [7.0]], method="root")
    assert (line.kind, line.curvature > 0.01) == ("minimum", True)
    triangle = np.vstack([hexagonal_spiral(3, 7.0), hexagonal_spiral(1, 7.0)])
    assert find_equilibrium(LAW, triangle, method="root").kind == "saddle"


def test_collapse_by_equilibria():
    diagram = collapse_diagram(AlphaInteraction(), [7, 19], [0.1, 2.0, 4.5])
    assert isinstance(diagram, CollapseDiagram)
    assert diagram.closest[0, 0] == pytest.approx(0.99, abs=0.02)
    assert diagram.onset().tolist() == [4.5, 2.0]
    assert diagram.closest[1, 1] == 0.0
    assert (diagram.coincident[:, 0] == 0).all()
    low, high = collapse_threshold(AlphaInteraction(), 7, halvings=2)
    assert 3.0 < low < high < 5.0  # as the gradient flow has it: tests/theorems/slides/test_e11.py
    with pytest.raises(ArgumentError, match="expected rising"):
        collapse_diagram(AlphaInteraction(), [7], [1.0, 0.5])
    with pytest.raises(SolverError, match="no collapse"):
        threshold(lambda ratio: False)


@pytest.mark.parametrize("length", [1e-9, 1e-6, 1.0, 1e6])
def test_congruence_has_no_unit(length):
    q = hexagonal_spiral(7, 7.0)
    q[3] += [0.4, -0.2]
    turned = length * (q[::-1] @ np.array([[0.6, -0.8], [0.8, 0.6]]) + 3.0)
    assert congruent(length * q, turned, tol=1e-9 * length)
    turned[2, 0] += 1e-3 * length
    assert not congruent(length * q, turned, tol=1e-6 * length)


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


def test_a_lattice_without_energy_reads_back(tmp_path):
    """A bond of length d has the energy 0, to rounding: relative to itself no other machine would agree."""
    bond = find_equilibrium(LAW, [[0.0], [6.9]])
    assert abs(bond.energy) < 1e-12
    for energy in (0.0, 1e-13, -1e-28):
        write_equilibrium(replace(bond, energy=energy), tmp_path / "bond.json")
        assert read_equilibrium(tmp_path / "bond.json").kind == "minimum"
    write_equilibrium(replace(bond, energy=1.0), tmp_path / "bond.json")
    with pytest.raises(FileError, match="claims an energy"):
        read_equilibrium(tmp_path / "bond.json")
