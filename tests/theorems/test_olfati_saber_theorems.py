"""Theorems 1 and 3, the energy identities and Definition 5, on runs whose answer is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flockana.environment.targets import LinearTarget, RescaledVelocity, StaticTarget
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.paths import contacts
from flockana.simulate import simulate
from flockana.theorems import Tolerances, verify
from flockana.theorems.asymptotics import lattice_limit
from flockana.theorems.e3 import rhombus_with_double_agent
from flockana.theorems.os_1 import _disconnected_energy
from flockana.trajectory import Trajectory

LAW1 = Algorithm1()
LAW2 = Algorithm2(target=LinearTarget((20.0, 0.0), (1.0, 0.0)))


def hexagon(seed: int = 1, shake: float = 0.2, speed: float = 0.3):
    rng = np.random.default_rng(seed)
    q = hexagonal_patch(1, 7.0)
    return q + shake * rng.uniform(-1, 1, q.shape), speed * rng.uniform(-1, 1, q.shape)


def made_up(law, q, p=None, t=(0.0, 1.0)):
    """A run that no integrator made: samples as given, paths between them by the accelerations 0."""
    q = np.array(q, dtype=float)
    p = np.zeros_like(q) if p is None else np.array(p, dtype=float)
    return Trajectory(np.array(t), q, p, np.zeros_like(q), law, {"work": np.zeros(len(t))})


@pytest.fixture(scope="module")
def hexagon_run():
    return simulate(LAW1, *hexagon(), (0.0, 30.0))


@pytest.fixture(scope="module")
def flock_run():
    rng = np.random.default_rng(3)
    return simulate(LAW2, rng.normal(0.0, 12.0, (12, 2)), rng.uniform(-2, -1, (12, 2)), (0.0, 40.0))


class TestTheorem1:
    def test_holds_in_full_where_its_hypotheses_do(self, hexagon_run):
        verdict = verify("os-1", hexagon_run)
        assert [c.status for c in verdict.claims] == ["verified"] * 4
        assert [h.status for h in verdict.hypotheses] == ["met", "assumed", "met", "met"]
        least = float(hexagon_run.metrics().min_distance.min())
        assert least * (1.0 - 1e-3) < verdict.claim("iii").computed <= least

    def test_the_energy_hypothesis_has_the_margin_c_star_less_h(self, hexagon_run):
        energy = verify("os-1", hexagon_run).hypotheses[2]
        q, p = hexagon_run.q[0], hexagon_run.p[0]
        v = p - p.mean(axis=0)
        h0 = LAW1.energy(0.0, q, v)
        assert energy.margin == pytest.approx(30.0 * 52.383811786644864 - h0, rel=1e-12)

    def test_a_common_velocity_changes_no_verdict(self, hexagon_run):
        moving = replace(hexagon_run, p=hexagon_run.p + np.array([300.0, 0.0]))
        assert verify("os-1", moving).hypotheses[2].margin == pytest.approx(
            verify("os-1", hexagon_run).hypotheses[2].margin, rel=1e-9
        )

    def test_too_short_a_run_is_inconclusive_never_refuted(self):
        verdict = verify("os-1", simulate(LAW1, *hexagon(), (0.0, 0.5)))
        assert [verdict.claim(name).status for name in ("i", "ii", "iii")] == [
            "inconclusive",
            "inconclusive",
            "verified",
        ]

    def test_a_net_that_breaks_makes_it_vacuous(self):
        verdict = verify("os-1", simulate(LAW1, [[0.0, 0.0], [7.0, 0.0]], [[0.0, 0.0], [30.0, 0.0]], (0.0, 2.0)))
        assert verdict.status == "vacuous"
        assert verdict.hypotheses[1].status == "unmet"
        assert "no flock at t" in verdict.hypotheses[1].detail

    def test_a_level_set_that_holds_a_disconnected_state_makes_it_vacuous(self):
        q, p = hexagon(speed=8.0)
        verdict = verify("os-1", simulate(LAW1, q, p, (0.0, 0.05)))
        assert verdict.hypotheses[1].status == "unmet"
        assert "Ω_c holds a disconnected state" in verdict.hypotheses[1].detail
        assert {verdict.claim(name).status for name in ("i", "ii", "iii")} == {"vacuous"}

    @pytest.mark.parametrize("n", [2, 3, 8, 20])
    def test_the_disconnected_state_exists_and_has_the_energy_named(self, n):
        from flockana.lattice import hexagonal_spiral

        apart = np.vstack([hexagonal_spiral(n - 1, 7.0), [[1e4, 0.0]]])
        assert LAW1.energy(0.0, apart, 0 * apart) == pytest.approx(_disconnected_energy(LAW1, n, 2), rel=1e-12)
        assert _disconnected_energy(LAW1, 2, 2) == pytest.approx(30.0 * 0.73590113426239231, rel=1e-13)

    def test_no_disconnected_state_is_claimed_where_the_lattice_does_not_exist(self):
        wide = Algorithm1(AlphaInteraction(d=1.0, r=1.8))
        assert _disconnected_energy(wide, 7, 2) == np.inf
        assert np.isfinite(_disconnected_energy(wide, 7, 1))

    def test_a_strict_minimum_that_is_no_lattice_refutes_the_limit(self):
        run = made_up(LAW1, [rhombus_with_double_agent(7.0)] * 2)
        claim = lattice_limit(run, [], Tolerances(), name="i")
        assert claim.status == "refuted"
        assert claim.computed == 1.0
        assert claim.witness["curvature"] > 0.03

    def test_a_strained_state_that_is_no_equilibrium_refutes_nothing(self):
        run = made_up(LAW1, [hexagonal_patch(1, 6.5)] * 2)
        assert lattice_limit(run, [], Tolerances(), name="i").status == "inconclusive"

    def test_a_crossing_between_samples_refutes_the_collision_bound(self):
        samples = [[[0.0], [7.0]], [[7.0], [0.0]]]
        speeds = [[[7.0], [-7.0]]] * 2
        light = Algorithm1(gains=Gains(c1_alpha=1e3))  # c* above the kinetic energy
        claim = verify("os-1", made_up(light, samples, speeds)).claim("iii")
        assert claim.status == "refuted"
        assert claim.witness["pair"] == (0, 1)

    def test_another_law_makes_it_vacuous(self, flock_run):
        assert verify("os-1", flock_run).status == "vacuous"


class TestTheorem3:
    def test_holds_for_a_small_flock(self, flock_run):
        verdict = verify("os-3", flock_run)
        statuses = {c.name: c.status for c in verdict.claims}
        assert (statuses["i"], statuses["ii"], statuses["iii"]) == ("verified",) * 3
        assert statuses["iv-instant"] == "verified"
        assert verdict.status == "verified"

    def test_the_cohesion_bound_is_the_explicit_one(self, flock_run):
        q, v = flock_run.q[0], flock_run.p[0] - flock_run.p[0].mean(axis=0)
        x = q - q.mean(axis=0)
        h0 = 30.0 * LAW2.alpha.potential_energy(q) + 0.55 * np.sum(x**2) + 0.5 * np.sum(v**2)
        claim = verify("os-3", flock_run).claim("i")
        radius = np.linalg.norm(flock_run.q - flock_run.q.mean(axis=1, keepdims=True), axis=2).max()
        assert claim.margin == pytest.approx(np.sqrt(2.0 * h0 / 1.1) - radius, rel=1e-10)

    def test_a_flock_that_leaves_its_bound_is_refuted(self):
        q = hexagonal_patch(1, 7.0)
        assert verify("os-3", made_up(LAW2, [q, 100.0 * q])).claim("i").status == "refuted"

    @pytest.mark.parametrize("gains", [Gains(c1_gamma=0.0), Gains(c2_gamma=0.0)])
    def test_a_vanishing_gain_makes_its_first_claims_vacuous(self, gains):
        law = Algorithm2(gains=gains, target=StaticTarget((0.0, 0.0)))
        verdict = verify("os-3", simulate(law, *hexagon(), (0.0, 1.0)))
        assert {verdict.claim(name).status for name in ("i", "ii", "iii")} == {"vacuous"}
        assert verdict.claim("iv-instant").status == "verified"

    def test_an_inconsistent_target_is_reported_and_does_not_matter(self, flock_run):
        law = Algorithm2(target=RescaledVelocity(LinearTarget((20.0, 0.0), (1.0, 0.0)), 0.1))
        verdict = verify("os-3", replace(flock_run, law=law))
        consistent = next(h for h in verdict.hypotheses if h.name == "dq_r/dt = p_r")
        assert consistent.status == "unmet"
        assert consistent.margin == pytest.approx(-0.9)
        assert verdict.claim("i").status == "verified"

    def test_a_saddle_is_not_called_a_minimum(self):
        law = Algorithm2(gains=Gains(c1_gamma=1e-9), target=StaticTarget((0.0, 0.0)))
        pair = np.array([[0.0, 0.0], [0.0, 0.0]])  # coincident, unstable: forces vanish by symmetry
        claim = verify("os-3", made_up(law, [pair, pair])).claim("ii")
        assert claim.status == "inconclusive"
        assert claim.computed < 0.0

    def test_with_energy_below_c_star_no_pair_collides(self):
        law = Algorithm2(gains=Gains(c1_gamma=1e-3), target=StaticTarget((0.0, 0.0)))
        run = simulate(law, *hexagon(), (0.0, 5.0))
        assert run.energy()[0] < 30.0 * law.alpha.c_star
        claim = verify("os-3", run).claim("iv-none")
        assert claim.status == "verified"
        assert 6.0 < claim.computed < 7.0


class TestErratum13:
    """The run of erratum E13, with its numbers."""

    @pytest.fixture
    def run(self):
        alpha = AlphaInteraction(a=5e4, b=5e4)
        law = Algorithm2(alpha, Gains(c1_alpha=1.0, c2_alpha=1.0, c1_gamma=0.01, c2_gamma=0.01), StaticTarget((0.0,)))
        p0 = [[np.sqrt(5.6 * alpha.c_star)], [0.0], [0.0]]
        return simulate(law, [[-12.0], [0.0], [30.0]], p0, (0.0, 0.05))

    def test_two_pairs_meet_where_one_is_allowed(self, run):
        verdict = verify("E13", run)
        assert run.energy()[0] / run.law.alpha.c_star == pytest.approx(1.909, abs=5e-4)
        claim = verdict.claim("printed")
        assert (claim.status, claim.computed, claim.margin) == ("refuted", 2, -1.0)
        first, second = contacts(run.t, run.q, run.p, run.u, tol=1e-9)
        assert (first.i, first.j, second.i, second.j) == (0, 1, 0, 2)
        assert first.crossed
        assert second.crossed
        assert [first.time, second.time] == pytest.approx([0.00841, 0.02745], abs=5e-6)

    def test_never_more_than_one_at_once(self, run):
        claim = verify("E13", run).claim("corrected")
        assert (claim.status, claim.computed) == ("verified", 1)
        assert verify("os-3", run).claim("iv-printed").status == "refuted"

    def test_two_pairs_in_one_step_are_both_found(self, run):
        """Sampled so sparsely that both meetings fall between two samples."""
        keep = [0, int(np.searchsorted(run.t, 0.035)), len(run.t) - 1]
        sparse = Trajectory(run.t[keep], run.q[keep], run.p[keep], run.u[keep], run.law, {})
        pairs = {w[: w.index(" at")] for w in verify("E13", sparse).claim("printed").witness}
        assert {"agents 0 and 1", "agents 0 and 2"} <= pairs


class TestEnergy:
    def test_a_good_run_balances(self, flock_run):
        verdict = verify("energy", flock_run)
        assert verdict.status == "verified"
        assert verdict.claim("balance").computed < 1e-7

    def test_a_coarse_run_does_not(self):
        run = simulate(LAW1, *hexagon(shake=1.0, speed=5.0), (0.0, 2.0), method="RK4", dt=0.1)
        assert verify("energy", run).claim("balance").status == "refuted"

    def test_a_wrong_state_does_not(self, flock_run):
        shifted = replace(flock_run, p=flock_run.p * np.linspace(1.0, 1.2, flock_run.n)[None, :, None])
        assert verify("energy", shifted).claim("balance").status == "refuted"


class TestDefinition5:
    def test_a_lattice_in_motion_flocks(self):
        q = hexagonal_patch(1, 7.0)
        run = made_up(LAW1, [q, q + 1.0, q + 2.0], [0 * q + 1.0] * 3, t=(0.0, 1.0, 2.0))
        for name in ("alpha-flocking", "alpha-flocking-strict"):
            assert verify(name, run).status == "verified"

    @pytest.mark.parametrize(
        ("name", "claim", "q", "p"),
        [
            ("alpha-flocking", "giant", [[0.0], [7.0], [100.0], [107.0]], None),
            ("alpha-flocking-strict", "flock", [[0.0], [7.0], [100.0]], None),
            ("alpha-flocking", "deviation", [[0.0], [3.0]], None),
            ("alpha-flocking-strict", "mismatch", [[0.0], [7.0]], [[0.0], [1.0]]),
        ],
    )
    def test_each_condition_is_looked_at(self, name, claim, q, p):
        q = np.array(q)
        p = 0 * q if p is None else np.array(p)
        verdict = verify(name, made_up(LAW1, [q] * 3, [p] * 3, t=(0.0, 1.0, 2.0)))
        assert verdict.claim(claim).status == "refuted"
        assert {c.status for c in verdict.claims if c.name != claim} == {"verified"}

    def test_cohesion_is_growth_over_the_window(self):
        q = np.array([[0.0], [5.0]])
        run = made_up(LAW1, [q, q, 1.4 * q, 1.6 * q], t=(0.0, 1.0, 2.0, 3.0))
        tolerances = Tolerances(settle=0.0, deviation=1.0)
        assert verify("alpha-flocking", run, tolerances=tolerances).claim("cohesive").status == "refuted"
        shorter = run.window(0.0, 2.0)
        assert verify("alpha-flocking", shorter, tolerances=tolerances).claim("cohesive").status == "verified"

    def test_the_transient_is_left_out(self):
        q = np.array([[0.0], [7.0]])
        run = made_up(LAW1, [10.0 * q, q, q], t=(0.0, 1.0, 2.0))
        assert verify("alpha-flocking", run).status == "verified"
        assert verify("alpha-flocking", run, tolerances=Tolerances(settle=0.0)).status == "refuted"


class TestTheBalance:
    """What the integrator spoils is told from an identity that is wrong."""

    @staticmethod
    def run(**options):
        return simulate(LAW1, [[0.0], [3.0]], [[20.0], [-20.0]], (0.0, 2.0), **options)

    def test_a_rough_integration_refutes_nothing(self):
        claim = verify("energy", self.run(rtol=1e-5, atol=1e-7)).claim("balance")
        assert claim.margin < 0.0
        assert claim.status == "inconclusive"

    def test_a_wrong_identity_stays_wrong_however_tightly_it_is_integrated(self, monkeypatch):
        right = Algorithm1.flow

        def flow(self, t, q, p):
            u, rate = right(self, t, q, p)
            return u, 1.001 * rate

        monkeypatch.setattr(Algorithm1, "flow", flow)
        run = self.run()
        claim = verify("energy", run).claim("balance")
        assert claim.status == "refuted"
        lost = 1.0 - run.energy()[-1] / run.energy()[0]
        assert claim.computed == pytest.approx(1e-3 * lost, rel=1e-2)

    def test_a_work_that_the_law_does_not_do_is_not_the_integrators(self):
        run = self.run(rtol=1e-5, atol=1e-7)
        forged = replace(run, extra={"work": 0.9 * run.extra["work"]})
        assert verify("energy", forged).claim("balance").status == "refuted"
