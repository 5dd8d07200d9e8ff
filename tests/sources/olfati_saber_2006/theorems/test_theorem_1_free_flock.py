"""Theorem 1, on runs whose answer is known: its hypotheses, its limits, its energy bound."""

import numpy as np
import pytest

from flockana import Algorithm1, AlphaInteraction, Gains, Tolerances, simulate, verify
from flockana.lattice import hexagonal_spiral
from flockana.sources.geschwender_2016.theorems.e03_strained_limits import rhombus_with_double_agent
from flockana.sources.olfati_saber_2006.theorems.any_potential import disconnected_energy
from flockana.theorems.limit_claims import lattice_limit
from flockana.theorems.theorem_toolkit import Observed
from tests.theorems.made_up import hexagon, hypothesis, statuses

LAW = Algorithm1()
CLAIMS = ("i", "ii", "iii", "iii-barrier")


@pytest.fixture(scope="module")
def run():
    return simulate(LAW, *hexagon(), (0.0, 30.0))


def test_holds_in_full_where_its_hypotheses_do(run):
    verdict = verify("os-1", run)
    assert statuses(verdict) == dict.fromkeys(CLAIMS, "verified")
    assert {h.name: h.status for h in verdict.hypotheses} == {
        "Algorithm 1 is applied": "met",
        "c1α > 0": "met",
        "c2α > 0": "met",
        "every solution from Ω_c is a cohesive dynamic flock": "assumed",
        "H(0) < c*": "met",
        "H(0) < min{V : two agents coincide}": "met",
    }
    assert all(verdict.claim(name).margin > verdict.claim(name).error > 0.0 for name in CLAIMS[2:])
    assert [h.error is not None for h in verdict.hypotheses] == [False] * 4 + [True] * 2
    least = float(run.metric("min_distance").min())
    assert least * (1.0 - 1e-3) < verdict.claim("iii").computed <= least


@pytest.mark.parametrize("damping", [1e-6, 1e-3])
def test_a_hardly_damped_pair_has_not_shown_its_limit(damping):
    law = Algorithm1(gains=Gains(c2_alpha=damping))
    verdict = verify("os-1", simulate(law, [[0.0], [7.05]], [[0.0], [0.0]], (0.0, 3.0)))
    assert [verdict.claim(name).status for name in ("i", "ii")] == ["inconclusive", "verified"]
    assert verdict.claim("ii").detail.endswith("proved for every start")  # too little energy to part


@pytest.mark.parametrize("gains", [Gains(c1_alpha=0.0), Gains(c2_alpha=0.0), Gains(c1_alpha=0.0, c2_alpha=0.0)])
def test_a_gain_that_vanishes_makes_it_vacuous(gains):
    verdict = verify("os-1", law=Algorithm1(gains=gains), q0=hexagon()[0], p0=hexagon()[1], t_span=(0.0, 0.1))
    assert statuses(verdict) == dict.fromkeys(CLAIMS, "vacuous")
    for name in ("collision-energy", "lattice-limit-printed"):
        found = verify(name, law=Algorithm1(gains=gains), q0=hexagon()[0], p0=hexagon()[1], t_span=(0.0, 0.1))
        assert found.status == ("vacuous" if gains.c1_alpha == 0.0 else found.status)


def test_the_energy_hypothesis_has_the_margin_c_star_less_h(run):
    energy = hypothesis(verify("os-1", run), "H(0) < c*")
    h0 = LAW.energy(0.0, run.q[0], run.p[0] - run.p[0].mean(axis=0))
    assert energy.margin == pytest.approx(30.0 * 52.383811786644864 - h0, rel=1e-12)


def test_a_net_that_breaks_makes_it_vacuous():
    verdict = verify("os-1", simulate(LAW, [[0.0, 0.0], [7.0, 0.0]], [[0.0, 0.0], [30.0, 0.0]], (0.0, 2.0)))
    assert verdict.status == "vacuous"
    assert "no flock at t" in hypothesis(verdict, "Ω_c").detail


@pytest.mark.parametrize("n", [2, 3, 8, 20])
def test_the_disconnected_state_exists_and_has_the_energy_named(n):
    apart = np.vstack([hexagonal_spiral(n - 1, 7.0), [[1e4, 0.0]]])
    assert LAW.energy(0.0, apart, 0 * apart) == pytest.approx(disconnected_energy(LAW, n, 2), rel=1e-12)
    assert disconnected_energy(LAW, 2, 2) == pytest.approx(30.0 * 0.73590113426239231, rel=1e-13)


def test_no_disconnected_state_is_claimed_where_the_lattice_does_not_exist():
    wide = Algorithm1(AlphaInteraction(d=1.0, r=1.8))
    assert disconnected_energy(wide, 7, 2) == np.inf
    assert np.isfinite(disconnected_energy(wide, 7, 1))


class TestLatticeLimit:
    def test_a_strict_minimum_that_is_no_lattice_refutes_it(self):
        run = simulate(LAW, rhombus_with_double_agent(7.0), np.zeros((5, 2)), (0.0, 1.0))
        claim = lattice_limit(Observed.of(run), [], Tolerances(), name="i")
        assert claim.status == "refuted"
        assert claim.computed == 1.0
        assert claim.witness["curvature"] > 0.03
        assert verify("lattice-limit-printed", run).status == "refuted"
