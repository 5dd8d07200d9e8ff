"""Theorem 3, on runs whose answer is known."""

import numpy as np
import pytest

from flockana import Algorithm2, Gains, LinearTarget, RescaledVelocity, StaticTarget, Tolerances, simulate, verify
from flockana.base.integrity_seals import sealed
from flockana.theorems.collisions import pairs_at_one_instant
from flockana.theorems.observed_run import Observed
from tests.theorems.made_up import hexagon, hypothesis, judged, made_up, statuses

LAW = Algorithm2(target=LinearTarget((20.0, 0.0), (1.0, 0.0)))
ORIGIN = StaticTarget((0.0, 0.0))


def start(seed: int = 3, n: int = 12):
    rng = np.random.default_rng(seed)
    return rng.normal(0.0, 12.0, (n, 2)), rng.uniform(-2, -1, (n, 2))


@pytest.fixture(scope="module")
def run():
    return simulate(LAW, *start(), (0.0, 40.0))


def test_holds_for_a_small_flock(run):
    verdict = verify("os-3", run)
    found = statuses(verdict)
    assert (found["i"], found["ii"], found["iii"]) == ("verified",) * 3
    assert found["iv-instant"] == "verified"
    assert verdict.status == "verified"
    assert hypothesis(verdict, "dq_r/dt").status == "met"


@pytest.mark.parametrize("until", [1e-7, 1e-4, 0.3])
def test_a_start_from_rest_is_no_limit(until):
    """10⁻⁷ time units after a start from rest K̃ has not grown yet: only the proof decides."""
    q, _ = start()
    verdict = verify("os-3", simulate(LAW, q, np.zeros_like(q), (0.0, until)))
    assert (verdict.claim("ii").status, verdict.claim("iii").status) == ("inconclusive", "verified")
    assert verdict.claim("iii").detail.endswith("proved for every start")


def rk4(law, q, p, dt, steps):
    """Plain RK4, which looks at nothing that a step may leap over."""

    def rate(t, x):
        return np.stack([x[1], law.flow(t, *x)[0]])

    times, states = dt * np.arange(steps + 1.0), [np.stack([q, p])]
    for t in times[:-1]:
        x = states[-1]
        k1 = rate(t, x)
        k2 = rate(t + 0.5 * dt, x + 0.5 * dt * k1)
        k3 = rate(t + 0.5 * dt, x + 0.5 * dt * k2)
        states.append(x + dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + rate(t + dt, x + dt * k3)))
    (q, p), u = np.stack(states, axis=1), [rate(t, x)[1] for t, x in zip(times, states, strict=True)]
    return made_up(law, q, p, t=times, u=u)


def test_a_run_that_blew_up_refutes_nothing():
    q, p = hexagon()
    wild = rk4(LAW, q, p, 0.8, 25)
    assert judged("os-3", wild).claim("i").contradicts == "cohesion"  # by this run alone
    verdict = verify("os-3", sealed(wild))  # whose second run is the law's
    assert "refuted" not in {claim.status for claim in verdict.claims}
    assert (verdict.claim("ii").status, verdict.claim("iv-barrier").status) == ("inconclusive", "inconclusive")
    assert verdict.claim("i").error > 500.0  # what the two runs differ by


def test_the_cohesion_bound_is_the_explicit_one(run):
    q, v = run.q[0], run.p[0] - run.p[0].mean(axis=0)
    x = q - q.mean(axis=0)
    h0 = 30.0 * LAW.alpha.potential_energy(q) + 0.55 * np.sum(x**2) + 0.5 * np.sum(v**2)
    claim = verify("os-3", run).claim("i")
    radius = np.linalg.norm(run.q - run.q.mean(axis=1, keepdims=True), axis=2).max()
    assert claim.margin == pytest.approx(np.sqrt(2.0 * h0 / 1.1) - radius, rel=1e-10)
    assert 0.0 < claim.error < 0.1


def test_a_radius_between_samples_counts():
    law = Algorithm2(gains=Gains(c1_alpha=0.0, c2_alpha=0.0, c1_gamma=1.0, c2_gamma=1.0), target=StaticTarget((0.0,)))
    q, p = [[-1.0], [1.0]], [[-5.0], [5.0]]
    run = made_up(law, [q, q], [p, [[5.0], [-5.0]]], t=(0.0, 40.0), u=[[[0.25], [-0.25]]] * 2)
    bound = np.sqrt(2.0 * run.energy()[0])
    assert 1.0 < bound < 1.0 + 5.0 * 20.0 - 0.125 * 20.0**2  # where the path turns
    claim = judged("os-3", run).claim("i")
    assert 0.0 < claim.margin < claim.error
    assert claim.rigour == "smt"  # by the proof


@pytest.mark.parametrize("gains", [Gains(c1_gamma=0.0), Gains(c2_gamma=0.0)])
def test_a_vanishing_gain_makes_its_first_claims_vacuous(gains):
    verdict = verify("os-3", simulate(Algorithm2(gains=gains, target=ORIGIN), *hexagon(), (0.0, 1.0)))
    assert {verdict.claim(name).status for name in ("i", "ii", "iii")} == {"vacuous"}
    assert verdict.claim("iv-instant").status == "verified"


def test_an_inconsistent_target_is_reported_and_does_not_matter():
    law = Algorithm2(target=RescaledVelocity(LinearTarget((20.0, 0.0), (1.0, 0.0)), 0.1))
    verdict = verify("os-3", simulate(law, *start(), (0.0, 40.0)))
    consistent = hypothesis(verdict, "dq_r/dt = p_r")
    assert consistent.status == "unmet"
    assert consistent.margin == pytest.approx(-0.9)
    assert verdict.claim("i").status == "verified"


def test_a_saddle_is_not_called_a_minimum():
    law = Algorithm2(gains=Gains(c1_gamma=1e-9), target=ORIGIN)
    pair = np.array([[0.0, 0.0], [0.0, 0.0]])  # coincident, unstable: forces vanish by symmetry
    claim = verify("os-3", simulate(law, pair, 0.0 * pair, (0.0, 5.0))).claim("ii")
    assert claim.status == "inconclusive"
    assert claim.computed < 0.0


def test_one_sample_verifies_no_claim_about_a_run(run):
    one = simulate(LAW, *start(), (0.0, 40.0), t_eval=[40.0])
    verdict = judged("os-3", one)
    assert verdict.claim("iv-barrier").status != "verified"
    assert pairs_at_one_instant(Observed.alone(one), [], Tolerances(), name="iv-instant").status == "inconclusive"
    assert verdict.claim("iii").status == "verified"  # one state will do: it is near a strict minimum
