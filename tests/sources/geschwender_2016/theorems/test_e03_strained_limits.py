"""Erratum E3: minima that are no lattices, and the share of random starts that end in one."""

import numpy as np
import pytest
from scipy.stats import beta

from flockana import Algorithm1, Gains, Tolerances, min_distance
from flockana.equilibria.final_state import terminal_state
from flockana.equilibria.gradient_flow import gradient_flow
from flockana.sources.geschwender_2016.theorems.e03_strained_limits import (
    _is_lattice,
    _Limit,
    random_disc,
    rhombus_with_double_agent,
)


@pytest.fixture(scope="module")
def e3(verdict_of):
    return verdict_of("E3")


@pytest.mark.slow
def test_e3_the_double_agent_is_a_minimum_by_differences_of_the_force_alone(e3):
    law, q = Algorithm1(), rhombus_with_double_agent(7.0)
    assert np.abs(law.acceleration(0.0, q, 0 * q)).max() < 1e-12
    step, columns = 1e-5, []
    for k in range(q.size):
        nudge = np.zeros(q.size)
        nudge[k] = step
        nudge = nudge.reshape(q.shape)
        force = law.acceleration(0.0, q + nudge, 0 * q) - law.acceleration(0.0, q - nudge, 0 * q)
        columns.append(-force.ravel() / (2 * step))
    eigenvalues = np.linalg.eigvalsh(0.5 * (np.array(columns) + np.array(columns).T))
    assert np.abs(eigenvalues[:3]).max() < 1e-4  # two translations and the rotation
    assert eigenvalues[3] > 10.0
    assert e3.claim("double-agent").computed == pytest.approx(eigenvalues[3] / eigenvalues[-1], rel=1e-5)


@pytest.mark.slow
def test_e3_the_share_falls_and_its_interval_excludes_one(e3):
    claim = e3.claim("share")
    assert claim.computed[10]["holds"] == claim.computed[10]["of"] == 20
    assert claim.computed[20]["share"][1] == 1.0  # three are no lattices, but of no limit there it is certain
    assert claim.computed[40]["holds"] == 11
    assert claim.computed[40]["share"][1] == pytest.approx(beta.ppf(0.975, 19, 2))  # two are certainly none


def test_e3_a_flow_that_did_not_end_or_is_not_certain_is_undecided():
    """A rhombus whose double agent is certified, and links of 7.1 that are not."""
    law, tolerances = Algorithm1(), Tolerances()
    stretched = np.array([[0.0, 0.0], [7.1, 0.0]])

    def limit(q, converged=True):
        return _Limit(((q, terminal_state(law, q, 0.0 * q)),), converged)

    assert _is_lattice(law, limit(7.0 / 7.1 * stretched), tolerances) is True
    assert _is_lattice(law, limit(stretched), tolerances) is None
    assert _is_lattice(law, limit(rhombus_with_double_agent(7.0)), tolerances) is False
    assert _is_lattice(law, limit(rhombus_with_double_agent(7.0), converged=False), tolerances) is None


def test_e3_the_strained_limit_is_rigid_at_rest_and_of_distinct_agents(e3):
    claim, law = e3.claim("strained"), Algorithm1()
    q = gradient_flow(law, random_disc(40, 14, d=7.0)).q
    assert claim.witness["agents"] == 40
    assert min_distance(q) > 0.9 * 7.0
    assert np.abs(law.acceleration(0.0, q, 0.0 * q)).max() < 1e-8
    eigenvalues = np.linalg.eigvalsh(law.stiffness(q).toarray())
    assert np.abs(eigenvalues[:3]).max() < 1e-6 * eigenvalues[-1]
    assert eigenvalues[3] == pytest.approx(0.0074 * eigenvalues[-1], rel=0.01)


def test_e3_starts_are_reproducible_and_inside_their_disc():
    start = random_disc(40, 7, d=7.0)
    np.testing.assert_array_equal(start, random_disc(40, 7, d=7.0))
    assert np.linalg.norm(start, axis=1).max() <= 0.45 * 7.0 * np.sqrt(40)


def test_e3_the_compressed_hexagon_has_the_spacing_of_its_force_balance(e3):
    """Independent of the flow: an outer agent of a hexagon feels −2 c1α s w(s) outwards and λ s inwards."""
    from scipy.optimize import brentq

    alpha, gains = Algorithm1().alpha, Gains()

    def balance(s: float) -> float:
        stress = alpha.phi_alpha(alpha.sigma_norm(s)) / np.sqrt(1.0 + alpha.eps * s**2)
        return 2.0 * gains.c1_alpha * stress + gains.c1_gamma

    spacing = brentq(balance, 6.5, 7.0, xtol=1e-13)
    assert e3.claim("algorithm-2").computed == pytest.approx(1.0 - spacing / 7.0, rel=1e-8)
