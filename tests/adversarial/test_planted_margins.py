"""Every claim of every theorem is made again with a margin of 10⁶ times its error to 10⁻⁶ of it, on either side of 0.

What a claim names beside its numbers, such as hypotheses, proof and what it is about, is its own; the numbers are
planted. So each theorem is fed a truth and a falsehood, far above and far below what its numbers can tell.
"""

from functools import cache

import pytest

import flockana as fl
from flockana import HeadingAveraging, SemiImplicitEuler
from flockana.theorems import claims, theorem, theorems, verify
from flockana.theorems.enclosure import Enclosure
from tests.adversarial.test_any_potential import pair
from tests.adversarial.test_fixed import SLOW
from tests.adversarial.test_planted_violations import APART, NEAR, PLANTED, run_of
from tests.adversarial.test_planted_violations import SLOW as SLOWLY

RATIOS = [side * size for side in (1.0, -1.0) for size in (1e6, 1e2, 1e-2, 1e-6)]  # margin over error
HEADINGS = HeadingAveraging(range=1.0, speed=0.2, dt=1.0)
RUNS = {name: lambda base=base: run_of(base) for name, _, base, _ in PLANTED} | {
    "average-consensus": lambda: fl.simulate(fl.AverageConsensus([[0, 1], [1, 0]]), NEAR, None, (0.0, 2.0)),
    "safety-filter": lambda: fl.scenario("safety-head-on").run(),
    "average-switching": lambda: fl.scenario("average-switching").run(),
    "any-potential": lambda: fl.simulate(fl.Algorithm1(pair("morse")[0]), NEAR, SLOWLY, (0.0, 2.0)),
    "cucker-smale-steps": lambda: fl.simulate(SemiImplicitEuler(fl.CuckerSmale(), 0.1), NEAR, SLOWLY, (0.0, 2.0)),
    "jlm-headings": lambda: fl.simulate(HEADINGS, NEAR, HEADINGS.velocities([1.0, 2.0]), (0.0, 12.0)),
    "net-consensus": lambda: fl.simulate(fl.NetConsensus([[0, 1], [1, 0]]), NEAR, SLOWLY, (0.0, 2.0)),
    "growing-windows": lambda: fl.scenario("averaging-ever-later").run(),
    "rooted-averaging": lambda: fl.scenario("averaging-in-turn").run(),
    "singular-alignment": lambda: run_of("singular"),
    "os-6": lambda: run_of("algorithm 3"),
    "zone-1-printed": lambda: run_of("tree"),
}
for name in ("linearised-decay-terminal", "E11", "E12"):
    RUNS[name] = lambda: run_of("algorithm 2")
for name in ("os-5-terminal", "lattice-limit-printed", "energy-printed", "disturbed-basin"):
    RUNS[name] = lambda: run_of("algorithm 1")
CONFIGURATION = {"q": [*APART, [3.5, 6.0]], "d": 7.0, "r": 8.4}
SLOWER = {*SLOW, "J14", "J16", "E11", "E12", "E16"}


@cache
def subject_of(name):
    """What a theorem is checked on: nothing, a configuration or a run."""
    kind = theorem(name).kind
    return ((), {}) if kind == "fixed" else ((), CONFIGURATION) if kind == "configuration" else ((RUNS[name](),), {})


def expected(ratio, needs, about, proof, disproof):
    """(status, whether it contradicts its proof) of a claim with a margin of so many times its error."""
    known = {need.status for need in needs}
    if "unmet" in known:
        return "vacuous", False
    by_numbers = "inconclusive" if abs(ratio) < 1.0 or about == "limit" else "verified" if ratio > 0.0 else "refuted"
    if about == "all" and by_numbers == "verified":
        by_numbers = "inconclusive"
    if "assumed" in known:
        return (by_numbers if (by_numbers, about) == ("verified", "run") else "inconclusive"), False
    proved = "verified" if proof else "refuted" if disproof else by_numbers
    opposed = {proved, by_numbers} == {"verified", "refuted"}
    return ("inconclusive" if opposed else proved), opposed


@pytest.fixture
def planted(monkeypatch):
    """All claims that a theorem makes from margins with an error, made with each planted margin instead."""
    made, conclude = [], claims.conclude

    def recorded(name, by_numbers, margin, needs=(), *, about, **fields):
        if 0.0 < (half := float(margin.half_width)) < float("inf"):
            for ratio in RATIOS:
                number = Enclosure.around(ratio * half, half)
                status = claims._status_of(number, about)
                made.append((ratio, conclude(name, status, number, tuple(needs), about=about, **fields)))
        return conclude(name, by_numbers, margin, needs, about=about, **fields)

    monkeypatch.setattr(claims, "conclude", recorded)
    return made


CASES = [pytest.param(name, marks=pytest.mark.attack if name in SLOWER else ()) for name in theorems()]


@pytest.mark.parametrize("name", CASES)
def test_a_planted_margin_decides_above_the_noise_alone_and_never_against_a_proof(name, planted):
    given, options = subject_of(name)
    verdict = verify(name, *given, **options)
    for ratio, claim in planted:
        said = expected(ratio, claim.needs, claim.about, claim.proof, claim.disproof)
        assert (claim.status, bool(claim.contradicts)) == said, (ratio, claim)
        if claim.status in ("verified", "refuted") and claim.rigour == "numeric":
            assert (claim.margin > 0.0) == (ratio > 0.0), (ratio, claim)
    numbers = [claim for claim in verdict.claims if claim.error and claim.about != "limit"]
    assert planted or not numbers  # algebra and counts have no noise
