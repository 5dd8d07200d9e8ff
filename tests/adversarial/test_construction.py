"""Verdicts that the mechanism makes impossible: cases that were wrong, and a fuzz over laws, starts and tolerances."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import flockana as fl
from flockana import DirectedNet, FixedNetFlocking, LogPotential, ProximityFlocking, RationalWeight
from flockana.sources.zavlanos_2007.laws import LinkKeeping
from flockana.theorems import theorem, theorems, verify
from tests.adversarial.cases import effort

TRIANGLE = ([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], [[0.1, 0.0], [0.0, -0.2], [0.0, 0.1]])
TOLERANCES = [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14]


SPANS, DECAYS = [10.0, 30.0, 100.0, 300.0], [0.0, 0.25, 0.5, 1.0]
CROSSED = [(decay, until, rtol) for decay in DECAYS for until in SPANS for rtol in TOLERANCES]
SAMPLED = [CROSSED[k] for k in range(0, len(CROSSED), 5)]  # each decay and span with several tolerances


@pytest.mark.parametrize(
    ("decay", "until", "rtol"),
    [pytest.param(*one, marks=() if one in SAMPLED else pytest.mark.attack) for one in CROSSED],
)
def test_a_true_rate_is_never_refuted_however_long_and_loose_the_run(decay, until, rtol):
    law = fl.CuckerSmale(RationalWeight(1.0, decay, 1.0))
    run = fl.simulate(law, *TRIANGLE, (0.0, until), rtol=rtol)
    for name in ("ha-liu", "ha-liu-sharp", "cucker-smale"):
        for claim in verify(name, run).claims:
            assert claim.status in ("verified", "vacuous"), (name, claim)
            assert not claim.contradicts


def test_without_its_proof_the_rate_is_open_in_the_noise_and_verified_before(monkeypatch):
    from flockana.sources.cucker_smale_2007.theorems import spread_functional
    from flockana.theorems.observed_run import Observed

    monkeypatch.setattr(spread_functional, "PROOF", "")
    law = fl.CuckerSmale(RationalWeight(1.0, 0.5, 1.0))
    for until in (10.0, 100.0):
        seen = Observed.of(fl.simulate(law, *TRIANGLE, (0.0, until)))
        _, (bounded, rate, limit) = spread_functional.guarantee_of(seen, 2.0).claims([])
        assert (bounded.status, rate.status, limit.status) == ("verified", "verified", "inconclusive")
        assert f"to t = {min(until, 11.57):.4g}" in rate.detail


def test_an_agent_that_is_dragged_away_after_the_run_is_not_said_to_follow():
    law = fl.Algorithm2(gains=fl.Gains(c1_gamma=(4, 0, 0), c2_gamma=(2, 0, 0)), target=fl.StaticTarget((0.0, 0.0)))
    q, p = [[0.1, 0.0], [7.2, 0.0], [9.0, -6000.0]], [[3.0, 0.0], [-5.0, 0.0], [0.0, 60.0]]
    run = fl.simulate(law, q, p, (0.0, 50.0), t_eval=np.linspace(0.0, 50.0, 401), rtol=1e-10)
    assert verify("su-informed", run).claim("linked").status == "inconclusive"


@pytest.mark.parametrize("how", [{"rtol": 1e-4}, {"method": "RK45", "rtol": 1e-3}, {}])
@pytest.mark.parametrize("gap", [1e-8, 1e-5, 1e-2])
def test_a_link_that_is_kept_is_never_refuted(how, gap):
    law = LinkKeeping(((0, 1),), r=1.0, k=1.0, c=0.0)
    run = fl.simulate(law, [[0.0], [1.0 - gap]], [[0.0], [1e-3]], (0.0, 20.0 * gap**0.5), **how)
    statuses = {claim.name: claim.status for claim in verify("links-kept", run).claims}
    assert statuses.pop("velocities") == "vacuous"  # nothing is damped
    assert {*statuses.values()} <= {"verified", "inconclusive"}


@pytest.mark.parametrize("speed", [1e-13, 1e-9, 1e-5, 1.0])
def test_the_balance_of_a_tiny_energy_is_not_refuted(speed):
    law = fl.compose(pair=fl.AlphaInteraction(), gradient=30.0, consensus=10.0, drag=0.1)
    run = fl.simulate(law, [[0.0, 0.0]], [[speed, 0.0]], (0.0, 60.0))
    assert verify("energy", run).claim("balance").status in ("verified", "inconclusive")
    if speed >= 1.0:
        assert verify("energy", run).claim("balance").status == "verified"


HERE, FEW = fl.StaticTarget((0.0, 0.0)), fl.Gains(c1_gamma=(2.0, 0.0, 0.0), c2_gamma=(2.0, 0.0, 0.0))
OBSTACLES = fl.Sphere((3.0, 20.0), 3.0), fl.Wall((-15.0, 0.0), (1.0, 0.0))
FORMULA = fl.pair_law("(1 - exp(1 - s/d))**2*(1 - (s/r)**2)**2", adjacency="(1 - s/r)**2", range=11.2, length=7.0)
LAWS = {
    "algorithm 1": lambda: fl.Algorithm1(),
    "undamped": lambda: fl.Algorithm1(gains=fl.Gains(c2_alpha=0.0)),
    "algorithm 2": lambda: fl.Algorithm2(target=HERE),
    "weak centre": lambda: fl.Algorithm2(gains=fl.Gains(c1_gamma=1e-3, c2_gamma=1e-3), target=HERE),
    "one informed": lambda: fl.Algorithm2(gains=FEW, target=fl.LinearTarget((0.0, 0.0), (1.0, 0.0))),
    "cucker-smale": lambda: fl.CuckerSmale(RationalWeight(1.0, 0.5, 7.0)),
    "sum of all": lambda: fl.CuckerSmale(RationalWeight(1.0, 1.0, 7.0), mean=False),
    "fixed net": lambda: FixedNetFlocking(((0, 1), (1, 2)), LogPotential(49.0, 7.0)),
    "links kept": lambda: LinkKeeping(((0, 1), (1, 2)), r=12.0, k=30.0, c=1.0),
    "dead zone": lambda: fl.DeadZoneFlocking(),
    "obstacles": lambda: fl.Algorithm3(target=HERE, obstacles=OBSTACLES),
    "own formula": lambda: fl.Algorithm1(FORMULA),
    "switching net": lambda: ProximityFlocking(LogPotential(49.0, 7.0), 11.2),
    "ranges of their own": lambda: DirectedNet(fl.Algorithm1(), ranges=(8.4, 10.0, 12.0)),
    "limited thrust": lambda: fl.Saturated(fl.Algorithm2(target=HERE), 2.0),
    "windy": lambda: fl.Disturbed(fl.Algorithm2(target=HERE), force=(0.3, 0.0)),
    "in steps": lambda: fl.TaylorStep(fl.Algorithm2(target=HERE), 0.01),
}
TRUE_CLAIMS = {  # true of every run of the laws that each theorem is about
    "energy": ("rate", "balance"),
    "os-3": ("i", "iv-instant", "iv-none"),
    "os-1": ("iii",),
    "collision-energy": ("below",),
    "cohesion": ("bound",),
    "ha-liu": ("bounded", "rate", "flock"),
    "ha-liu-sharp": ("bounded", "rate", "flock"),
    "tanner-fixed": ("energy", "no-collision", "velocities", "critical"),
    "links-kept": ("rate", "balance", "links", "connected"),
    "any-potential": ("cohesion", "velocities", "critical", "one-instant", "no-collision"),
    "tanner-switching": ("velocities", "no-collision"),
    "su-informed": ("energy", "distance", "informed", "one-instant", "no-collision"),
    "dead-zone-1-corrected": ("rate", "balance", "components", "distance"),
    "dead-zone-1-printed": ("collision",),
}
LIMITS = {"os-1": ("i", "ii"), "os-3": ("ii", "iii"), "tanner-fixed": ("velocities", "critical")}
LIMITS["su-informed"] = ("informed", "linked")
SIZES = (0.3, 1.0, 1.5), (0.0, 1e-8, 1e-2, 1.0, 5.0), (1e-3, 0.3, 3.0, 40.0), TOLERANCES[:5]


@effort(1.7)
@given(st.sampled_from(list(LAWS)), st.integers(0, 2**32 - 1), st.tuples(*map(st.sampled_from, SIZES)))
def test_no_true_claim_reads_refuted_and_no_limit_verified_without_a_certificate(law, seed, sizes):
    (spread, speed, until, rtol), rng = sizes, np.random.default_rng(seed)
    q = 7.0 * np.array([[0.0, 0.0], [1.0, 0.0], [0.5, 0.9]]) * spread + rng.uniform(-0.5, 0.5, (3, 2))
    p = speed * rng.uniform(-1.0, 1.0, (3, 2))
    run = fl.simulate(LAWS[law](), q, p, (0.0, until), rtol=rtol)
    for name in theorems():
        if theorem(name).kind != "trajectory" or name in ("E11", "E12", "linearised-decay-terminal"):
            continue
        verdict = verify(name, run)
        statuses = {claim.name: claim.status for claim in verdict.claims}
        assert not verdict.contradictions, verdict
        for claim in TRUE_CLAIMS.get(name, ()):
            assert statuses.get(claim) != "refuted", verdict  # about a map or a wrapped law fewer claims are made
        for claim in verdict.claims:
            if claim.name in LIMITS.get(name, ()) and claim.status == "verified":
                assert "certified to stay" in claim.detail or claim.proof, claim


def test_the_fuzz_knows_claims_by_their_names():
    for name, claims in {**TRUE_CLAIMS, **LIMITS}.items():
        assert set(claims) <= set(theorem(name).claims), name
