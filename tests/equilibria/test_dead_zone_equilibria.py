"""Contact lattices of the dead-zone law: found by the same solver, at the spacing of the reference."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial import KDTree

from flockana.base.errors import ArgumentError
from flockana.equilibria.record import read_equilibrium, write_equilibrium
from flockana.equilibria.solve import find_equilibrium
from flockana.equilibria.terms import pair_term
from flockana.interactions import BetaInteraction, DeadZoneInteraction
from flockana.lattice import hexagonal_patch, hexagonal_spiral
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.stability import linearise


def spacing(found):
    return float(KDTree(found.q).query(found.q, k=2)[0][:, 1].mean())


def test_two_agents_rest_where_repulsion_and_the_pull_balance():
    pair = DeadZoneInteraction()
    found = find_equilibrium(DeadZoneFlocking(pair), [[0.0, 0.0], [6.0, 1.0]])
    assert np.linalg.norm(found.q[1] - found.q[0]) == pytest.approx(brentq(pair.force, 3.25, 3.5), abs=1e-10)
    assert (found.kind, found.rigid_modes) == ("minimum", 3)


def test_strain_is_that_of_contacts():
    """Three on a line: the ends attract, out of contact 7 apart, and have no length that they are held at."""
    line = find_equilibrium(DeadZoneFlocking(), [[0.0], [3.4], [6.8]])
    contact = line.q[1, 0] - line.q[0, 0]
    assert len(line.links) == 3
    assert line.strain() == pytest.approx((3.5 - contact) / 3.5, rel=1e-9)
    assert 0.0 < line.strain() < 1e-3
    # without k1 nothing draws two agents within the dead zone to contact: there is no strain to tell of
    loose = find_equilibrium(DeadZoneFlocking(DeadZoneInteraction(k1=0.0)), [[0.0, 0.0], [8.0, 0.0]])
    assert (len(loose.links), np.isnan(loose.strain())) == (1, True)


def test_it_is_written_down_and_read_again(tmp_path):
    found = find_equilibrium(DeadZoneFlocking(), hexagonal_patch(1, 3.5))
    write_equilibrium(found, tmp_path / "seven.json")
    again = read_equilibrium(tmp_path / "seven.json")
    assert (again.law, again.strain(), again.kind) == (found.law, found.strain(), "minimum")


def test_a_hexagon_is_a_strict_minimum_at_the_contact_distance():
    found = find_equilibrium(DeadZoneFlocking(), hexagonal_patch(1, 3.6))
    assert (found.kind, found.zero_modes, found.residual < 1e-12) == ("minimum", 0, True)
    assert 3.5 - 0.25 < spacing(found) < 3.5
    law = DeadZoneFlocking()
    assert np.abs(law.acceleration(0.0, found.q, 0.0 * found.q)).max() < 1e-11 * law.interaction.contact_force * 10


@pytest.mark.parametrize(
    # spacings of flocks that settled from random starts; from a hexagonal patch the lattice is a neighbouring one
    ("k1", "reference", "near"),
    [
        (0.0, 3.43, 0.03),
        (0.01, 3.40, 0.01),
        (0.05, 3.15, 0.07),
        (0.1, 2.69, 0.05),
        (0.5, 1.78, 0.03),
        (1.0, 1.53, 0.01),
    ],
)
def test_k1_compresses_the_lattice(k1, reference, near):
    start = hexagonal_spiral(50, 3.4 if k1 < 0.05 else 3.1 if k1 < 0.2 else 1.7)
    found = find_equilibrium(DeadZoneFlocking(DeadZoneInteraction(k1=k1)), start)
    assert found.kind == "minimum"
    assert spacing(found) == pytest.approx(reference, abs=near)


@pytest.mark.parametrize("s", [0.5, 3.3, 3.4, 8.0, 12.6, 14.0, 16.0])
def test_the_generated_gradient_and_hessian_are_those_of_the_kernels(s):
    pair = DeadZoneInteraction(k1=0.03)
    delta = s * np.array([0.6, 0.8])
    gradient, hessian = (np.array(part) for part in pair_term(pair, 2)(delta))
    assert gradient.ravel() == pytest.approx(pair.force(s) * np.array([0.6, 0.8]), rel=1e-12, abs=1e-13)
    block = pair.hessian(np.array([[0.0, 0.0], delta])).toarray()[2:, 2:]
    assert hessian == pytest.approx(block, rel=1e-11, abs=1e-11 * np.abs(block).max() + 1e-13)


def test_the_linearisation_has_the_roots_of_its_shape():
    """All agents in range, so λ² + k₂ n λ + ω² = 0 for each eigenvalue ω² of K, 0 of the rotation among them.

    The translations, which are not damped, give four zeros.
    """
    law, n = DeadZoneFlocking(), 7
    found = find_equilibrium(law, hexagonal_patch(1, 3.5))
    A = linearise(law, found).A
    poles = np.linalg.eigvals(A.toarray() if hasattr(A, "toarray") else A)
    stiff = np.sqrt(n**2 - 4.0 * found.hessian_eigenvalues + 0j)
    expected = np.concatenate([[0.0] * 5, [-n], (-n + stiff) / 2, (-n - stiff) / 2])
    for pole in expected:  # a double zero is computed to the root of the rounding
        assert np.abs(poles - pole).min() < 1e-5
    assert np.sum(np.abs(poles) < 1e-5) == 5


def test_hard_jumps_have_no_equilibrium_to_find():
    with pytest.raises(ArgumentError, match="ramp = 0: contacts sit where the force jumps"):
        find_equilibrium(DeadZoneFlocking(DeadZoneInteraction(ramp=0.0)), [[0.0], [5.0]])


def test_a_pair_law_without_symbols_is_refused():
    with pytest.raises(ArgumentError, match="no other has a symbolic form"):
        pair_term(BetaInteraction(), 2)
