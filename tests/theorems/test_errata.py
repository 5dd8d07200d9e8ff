"""The errata that need no run: what is printed fails, what is corrected holds, with the figures known beforehand."""

from __future__ import annotations

import numpy as np
import pytest

from flockana.environment.targets import StaticTarget
from flockana.interactions import Gains
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.scenarios.scenario import differences
from flockana.theorems import theorem, theorems, verify
from flockana.theorems.slides.e03 import random_disc, rhombus_with_double_agent
from flockana.theorems.slides.e11 import collapses


@pytest.fixture(scope="module")
def e3():
    return verify("E3")


@pytest.mark.parametrize("name", [n for n in theorems() if theorem(n).kind == "fixed"])
def test_every_fixed_erratum_reads_as_expected(name, e3):
    verdict = e3 if name == "E3" else verify(name)
    assert differences(verdict, theorem(name).expected) == ()
    assert all(claim.detail for claim in verdict.claims)


def test_e1_the_printed_energy_climbs_by_the_kinetic_energy():
    claim = verify("E1").claim("printed-run")
    # two agents fall from 8 to 7: what V loses becomes ½Σp² less what damping takes, and the printed H counts it twice
    drop = 30.0 * Algorithm1().alpha.psi_alpha(Algorithm1().alpha.sigma_norm(8.0))
    assert 0.5 * drop < claim.computed < drop
    assert claim.error < 1e-6 * claim.computed


def test_e1_rests_on_algebra():
    verdict = verify("E1")
    assert (verdict.claim("printed").rigour, verdict.claim("corrected").rigour) == ("symbolic", "symbolic")
    assert verdict.claim("corrected").computed == "residual 0"
    assert verdict.claim("printed").computed == "a residual that is not 0"
    assert "phi_alpha" in verdict.claim("printed").witness


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


def test_e3_the_share_falls_and_its_interval_excludes_one(e3):
    claim = e3.claim("share")
    assert claim.computed[10]["exact"] == claim.computed[10]["of"] == 20
    assert claim.computed[40]["exact"] < 20
    assert claim.computed[40]["share"][1] < 1.0


def test_e3_starts_are_reproducible_and_inside_their_disc():
    start = random_disc(40, 7, d=7.0)
    np.testing.assert_array_equal(start, random_disc(40, 7, d=7.0))
    assert np.linalg.norm(start, axis=1).max() <= 0.6 * 7.0 * np.sqrt(40)


def test_e3_the_compressed_hexagon_has_the_spacing_of_its_force_balance(e3):
    """Independent of the flow: an outer agent of a hexagon feels −2 c1α s w(s) outwards and λ s inwards."""
    from scipy.optimize import brentq

    alpha, gains = Algorithm1().alpha, Gains()

    def balance(s: float) -> float:
        stress = alpha.phi_alpha(alpha.sigma_norm(s)) / np.sqrt(1.0 + alpha.eps * s**2)
        return 2.0 * gains.c1_alpha * stress + gains.c1_gamma

    spacing = brentq(balance, 6.5, 7.0, xtol=1e-13)
    assert e3.claim("algorithm-2").computed == pytest.approx(1.0 - spacing / 7.0, rel=1e-8)


def test_e7_and_e8_give_the_figures_of_the_source():
    assert (verify("E7").claim("printed").computed, verify("E7").claim("corrected").computed) == (1.0, 0.96)
    assert verify("E8").claim("printed").computed == pytest.approx(2.0 / 3.0)
    assert verify("E8").claim("corrected").computed == 1.0


def test_e10_is_a_jump_by_one():
    assert verify("E10").claim("printed").computed == "ρ₁(1⁻) - ρ₁(1⁺) = 1"


def test_e11_a_hexagon_collapses_between_three_and_five_times_the_gain():
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    assert not collapses(law, 1, 3.0)
    assert collapses(law, 1, 5.0)
    assert len(hexagonal_patch(1, 7.0)) == 7
