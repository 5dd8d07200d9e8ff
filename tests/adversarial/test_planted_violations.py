"""Each theorem about runs is fed a violation that an integrator did not make, and one that it may have made.

A run is edited at one instant, and so is the tighter second run that encloses it. If both show nearly the same
violation it is far beyond the error of integration: the claim is refuted, or contradicts its proof aloud. If only one
does, the violation is within that error, and the numbers decide nothing. Neither ever verifies.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from flockana import (
    Algorithm3,
    CuckerDong,
    CuckerSmale,
    CyclicPursuit,
    DistanceFormation,
    FiniteTimeAlignment,
    GaziPassino,
    MinimalFlocking,
    MotschTadmor,
    RationalWeight,
    SingularAlignment,
    SingularWeight,
    Sphere,
    compose,
    simulate,
    verify,
)
from flockana.environment.targets import CircleTarget, StaticTarget
from flockana.interactions import AlphaInteraction
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.tanner_2007.laws import FixedNetFlocking, ProximityFlocking
from flockana.sources.vicsek_1995.laws import HeadingAveraging
from flockana.sources.zavlanos_2007.laws import LinkKeeping
from flockana.theorems import Tolerances, second_runs, theorem, theorems
from flockana.theorems.observed_run import Observed, with_doubt

HERE, ROUND = StaticTarget((0.0, 0.0)), CircleTarget((0.0, 0.0), 9.0, 0.05)
APART, NEAR = [[0.0, 0.0], [7.5, 0.0]], [[0.0, 0.0], [1.2, 0.0]]
ALONG, SLOW = [[0.0, 0.0], [0.2, 0.0]], [[0.0, 0.0], [0.0, 0.1]]
TOLD = {"pair": AlphaInteraction(), "consensus": 9.0, "navigation": ROUND, "feedforward": True}
RUNS = {
    "algorithm 1": lambda: (Algorithm1(), APART, ALONG),
    "algorithm 2": lambda: (Algorithm2(target=HERE), APART, ALONG),
    "algorithm 3": lambda: (Algorithm3(target=HERE, obstacles=(Sphere((100.0, 0.0), 2.0),)), APART, ALONG),
    "informed": lambda: (Algorithm2(target=HERE), APART, ALONG),
    "feedforward": lambda: (compose(**TOLD), APART, ALONG),
    "dead zone": lambda: (DeadZoneFlocking(), APART, ALONG),
    "finite time": lambda: (FiniteTimeAlignment(((0, 1),)), NEAR, [[0.0, 0.0], [9.0, 8.0]]),
    "fixed net": lambda: (FixedNetFlocking(edges=((0, 1),)), NEAR, SLOW),
    "proximity": lambda: (ProximityFlocking(), NEAR, SLOW),
    "three": lambda: (Algorithm2(target=HERE), [*APART, [15.0, 0.0]], [*ALONG, [0.0, 0.0]]),
    "alignment": lambda: (CuckerSmale(RationalWeight(decay=0.4)), NEAR, SLOW),
    "alignment of two": lambda: (CuckerSmale(), [[0.0], [1.0]], [[0.0], [0.1]]),
    "own sums": lambda: (MotschTadmor(RationalWeight(decay=0.4)), NEAR, SLOW),
    "avoiding": lambda: (CuckerDong(RationalWeight(decay=0.4), distance=0.8), NEAR, SLOW),
    "singular": lambda: (SingularAlignment(SingularWeight(decay=0.5)), [[0.0], [1.0]], [[0.0], [-2.0]]),
    "swarm": lambda: (GaziPassino(), NEAR, None),
    "pursuit": lambda: (CyclicPursuit(1.0, 30.0), NEAR, None),
    "formation": lambda: (DistanceFormation(((0, 1),)), NEAR, None),
    "links": lambda: (LinkKeeping(((0, 1),), r=2.0), NEAR, SLOW),
    "tree": lambda: (MinimalFlocking(edges=((0, 1),), normalised=True), NEAR, SLOW),
}


@cache
def run_of(name):
    return simulate(*RUNS[name](), (0.0, 2.0), t_eval=np.linspace(0.0, 2.0, 21))


def away(run, size):
    """The first agent is a hundred lengths of the law off, at one sample."""
    return at_half_time(run, "q", 100.0 * size * run.scales.length)


def aside(run, size):
    """The first agent leaves the line."""
    return at_half_time(run, "q", np.array([0.0, size * run.scales.length]))


def hurried(run, size):
    return at_half_time(run, "p", 100.0 * size * run.scales.speed)


def lifted(run, size):
    """The integral of dH/dt is off by a hundred times the energy."""
    work = run.extra["work"].copy()
    work[len(work) // 2] += 100.0 * size * np.abs(run.energy()).max()
    return replace(run, extra={**run.extra, "work": work})


def crossed(run, size):
    """The second agent is on the other side of the first for an instant; the balance of the energy is as before."""
    q, k = run.q.copy(), len(run.q) // 2
    q[k, 1] += 2.0 * size * (q[k, 0] - q[k, 1])
    found = replace(run, q=q, between=None)
    return replace(found, extra={**run.extra, "work": found.energy() - found.energy()[0]})


def closer(run, size):
    q, k = run.q.copy(), len(run.q) // 2
    q[k, 1] += 0.95 * size * (q[k, 0] - q[k, 1])
    return replace(run, q=q, between=None)


def stretched(run, size):
    """A link half as long again as at the start: longer than any energy allows, and shorter than the range."""
    q, k = run.q.copy(), len(run.q) // 2
    q[k, 1] = q[k, 0] + 1.5 * size * (q[0, 1] - q[0, 0])
    return replace(run, q=q, between=None)


def at_half_time(run, name, added):
    changed = getattr(run, name).copy()
    changed[len(run.t) // 2, 0] += added
    return replace(run, **{name: changed}, between=None)


# theorem, claim, run, violation
PLANTED = [
    ("alpha-flocking", "cohesive", "algorithm 1", closer), ("alpha-flocking", "mismatch", "algorithm 1", hurried),
    ("alpha-flocking-strict", "deviation", "algorithm 1", closer),
    ("alpha-flocking-strict", "mismatch", "algorithm 2", hurried), ("cohesion", "bound", "algorithm 2", away),
    ("collision-energy", "below", "algorithm 1", crossed), ("cucker-smale", "bounded", "alignment", away),
    ("cucker-dong", "functional", "avoiding", hurried), ("cucker-dong", "bounded", "avoiding", away),
    ("cucker-dong", "apart", "avoiding", closer), ("cucker-smale-pair", "invariant", "alignment of two", hurried),
    ("dead-zone-1-corrected", "balance", "dead zone", lifted), ("dead-zone-1-printed", "energy", "dead zone", away),
    ("cyclic-pursuit", "centroid", "pursuit", away), ("cyclic-pursuit", "motion", "pursuit", away),
    ("distance-formation", "centroid", "formation", away), ("distance-formation", "nearby", "formation", away),
    ("distance-formation", "collinear", "formation", aside),
    ("gazi-passino", "centroid", "swarm", away), ("gazi-passino", "rate", "swarm", away),
    ("energy", "balance", "algorithm 1", lifted), ("energy", "balance", "algorithm 2", lifted),
    ("energy", "balance", "algorithm 3", lifted), ("ha-liu", "bounded", "alignment", away),
    ("ha-liu", "rate", "alignment", hurried), ("ha-liu-sharp", "bounded", "alignment", away),
    ("ha-liu-sharp", "rate", "alignment", hurried), ("finite-time", "bound", "finite time", hurried),
    ("motsch-tadmor", "bounded", "own sums", away),
    ("motsch-tadmor", "rate", "own sums", hurried), ("motsch-tadmor-sharp", "bounded", "own sums", away),
    ("motsch-tadmor-sharp", "rate", "own sums", hurried), ("links-kept", "balance", "links", lifted),
    ("links-kept", "links", "links", stretched), ("os-1", "iii", "algorithm 1", crossed),
    ("os-1", "iii-barrier", "algorithm 1", crossed), ("os-3", "i", "algorithm 2", away),
    ("os-3", "iv-none", "algorithm 2", crossed), ("su-informed", "distance", "informed", away),
    ("singular-pair", "apart", "singular", closer),
    ("su-varying", "centre", "feedforward", away), ("tanner-fixed", "energy", "fixed net", lifted),
    ("tanner-fixed", "no-collision", "fixed net", closer), ("tanner-switching", "energy", "proximity", lifted),
    ("tanner-switching", "no-collision", "proximity", closer), ("zone-1-corrected", "root-edge", "tree", closer),
    ("E13", "printed", "three", crossed),
]  # fmt: skip
EXCEPT = {
    "safety-filter": "a proof decides it, and what is near its bound is at rest; test_safety",
    "average-switching": "as average-consensus; test_first_order",
    "average-consensus": "its rate is attained to the last bit by two agents; test_first_order",
    "any-potential": "os-1's and os-3's claims under another name; test_any_potential",
    "cucker-smale-steps": "a map has no second run; test_matching",
    "disturbed-basin": "proved of the law, its samples stand beside; test_disturbed",
    "energy-printed": "it is false of the run as it is; test_planted_energy",
    "jlm-headings": "a map has no second run; headings keep their span to the bit: test_a_heading_that_leaves_its_span",
    "growing-windows": "a map has no second run; test_rooted_averaging",
    "lattice-limit-printed": "about a limit, judged by the equilibrium beside the end; test_planted_limits",
    "net-consensus": "about the law alone, nothing is measured on the run; test_net_consensus",
    "linearised-decay-terminal": "about the linearisation at the end; test_following",
    "os-5-terminal": "about a configuration, the end of the run; test_planted_nets",
    "rooted-averaging": "about the law but for the hull, which a map keeps to the bit; test_rooted_averaging",
    "singular-alignment": "a distance is never below 0, so its numbers refute nothing; test_singular",
    "zone-1-printed": "false of the run as it is; test_trees",
    "os-6": "an assumed hypothesis: test_a_violation_refutes_nothing_under_what_is_assumed",
    "E11": "about a limit, judged by the equilibrium beside the end; test_planted_limits",
    "E12": "it makes its own runs; test_following",
}


@pytest.fixture
def claim_of(monkeypatch):
    """A claim of a theorem about one run that another encloses, as if that were its tighter second run."""

    def found(name, part, first, second):
        monkeypatch.setattr(second_runs, "second_run", lambda *_, **__: replace(second, between=None))
        seen = Observed.of(replace(first, between=None))
        claims = with_doubt(theorem(name).examine(seen, Tolerances())[1], seen)
        return next(claim for claim in claims if claim.name == part)

    return found


@pytest.mark.parametrize("ratio", [1e6, 1e4, 1e-2, 1e-6], ids="{:g} times the noise".format)
@pytest.mark.parametrize(("name", "part", "base", "plant"), PLANTED)
def test_a_violation_decides_if_it_is_larger_than_the_error_and_nothing_if_not(
    claim_of, name, part, base, plant, ratio
):
    run = run_of(base)
    unharmed = claim_of(name, part, run, run)
    assert unharmed.status in ("verified", "inconclusive")
    assert not unharmed.contradicts
    found = claim_of(name, part, plant(run, 1.0), plant(run, ratio / (1.0 + ratio)))
    if ratio > 1.0:
        assert found.status == ("inconclusive" if found.contradicts else "refuted")
        assert bool(found.contradicts) == bool(unharmed.proof)
        assert 0.0 <= found.error < -found.margin
        return
    for claim in (found, claim_of(name, part, run, plant(run, 1.0))):
        assert not claim.contradicts
        assert claim.status == "inconclusive" or (claim.status == "verified" and claim.proof)


def test_every_theorem_about_runs_is_fed_one_or_says_why_not():
    about_runs = {name for name in theorems() if theorem(name).kind == "trajectory"}
    assert {row[0] for row in PLANTED} | set(EXCEPT) == about_runs
    assert not {row[0] for row in PLANTED} & set(EXCEPT)


def test_a_violation_refutes_nothing_under_what_is_assumed(claim_of):
    """Theorem 6: of an edited run it is not known whether an agent enters an obstacle between two samples."""
    run = run_of("algorithm 3")
    found = claim_of("os-6", "balance", lifted(run, 1.0), lifted(run, 1.0 - 1e-6))
    assert "assumed" in {need.status for need in found.needs}
    assert (found.status, found.contradicts, found.margin < -found.error) == ("inconclusive", "", True)


@pytest.mark.parametrize(("out", "hull"), [(0.0, "verified"), (1e-15, "inconclusive"), (1.0, "inconclusive")])
def test_a_heading_that_leaves_its_span(out, hull):
    law = HeadingAveraging(range=1.0, speed=0.2, dt=1.0)
    run = simulate(law, [[0.0, 0.0], [0.5, 0.0]], law.velocities([1.0, 2.0]), (0.0, 12.0))
    heading = run.extra["heading"].copy()
    heading[6, 0] += out
    edited = replace(run, extra={**run.extra, "heading": heading})
    claims = theorem("jlm-headings").examine(Observed.of(edited), Tolerances())[1]
    claim = next(claim for claim in claims if claim.name == "hull")
    assert (claim.status, claim.contradicts) == (hull, "headings" if out else "")


ROUGH = [{"rtol": 1e-2, "atol": 1e-2}, {"rtol": 1e-4, "atol": 1e-4}, {"method": "RK4", "dt": 0.5}]


@pytest.mark.parametrize("how", ROUGH, ids=["1e-2", "1e-4", "RK4"])
@pytest.mark.parametrize("base", RUNS)
def test_a_loosely_integrated_run_reads_inconclusive_and_never_the_opposite(base, how):
    law, q, p = RUNS[base]()
    loose = simulate(law, q, p, (0.0, 2.0), t_eval=np.linspace(0.0, 2.0, 21), **how)
    for name in sorted({name for name, _, of, _ in PLANTED if of == base}):
        fine = {claim.name: claim.status for claim in verify(name, run_of(base)).claims}
        for claim in verify(name, loose).claims:
            assert {claim.status, fine[claim.name]} != {"verified", "refuted"}, (name, claim)
