"""Each theorem about runs is fed a violation that an integrator did not make, and one that it may have made.

A run is edited at one instant, and so is the tighter second run that `verify` holds it against. If both show nearly the
same violation it is far beyond the error of integration, and the claim is refuted; if only the first one does, the
violation is within that error, and the claim is inconclusive. Neither ever reads verified.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from flockana import compose, simulate, verify
from flockana.environment.obstacles import Sphere
from flockana.environment.targets import CircleTarget, StaticTarget
from flockana.interactions import AlphaInteraction
from flockana.interactions.weights import RationalWeight
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.cucker_smale import CuckerSmale
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.laws.link_keeping import LinkKeeping
from flockana.laws.minimal import MinimalFlocking
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.laws.tanner import FixedNetFlocking, ProximityFlocking
from flockana.laws.vicsek import HeadingAveraging
from flockana.theorems import Tolerances, theorem, theorems
from flockana.theorems.second_run import corroborated

HERE, ROUND = StaticTarget((0.0, 0.0)), CircleTarget((0.0, 0.0), 9.0, 0.05)
APART, NEAR = [[0.0, 0.0], [7.5, 0.0]], [[0.0, 0.0], [1.2, 0.0]]
ALONG, SLOW = [[0.0, 0.0], [0.2, 0.0]], [[0.0, 0.0], [0.0, 0.1]]
TOLD = {"pair": AlphaInteraction(), "consensus": 9.0, "navigation": ROUND, "told": True}
RUNS = {
    "algorithm 1": lambda: (Algorithm1(), APART, ALONG),
    "algorithm 2": lambda: (Algorithm2(target=HERE), APART, ALONG),
    "algorithm 3": lambda: (Algorithm3(target=HERE, obstacles=(Sphere((100.0, 0.0), 2.0),)), APART, ALONG),
    "informed": lambda: (Algorithm2(target=HERE), APART, ALONG),
    "told": lambda: (compose(**TOLD), APART, ALONG),
    "dead zone": lambda: (DeadZoneFlocking(), APART, ALONG),
    "fixed net": lambda: (FixedNetFlocking(edges=((0, 1),)), NEAR, SLOW),
    "proximity": lambda: (ProximityFlocking(), NEAR, SLOW),
    "three": lambda: (Algorithm2(target=HERE), [*APART, [15.0, 0.0]], [*ALONG, [0.0, 0.0]]),
    "alignment": lambda: (CuckerSmale(RationalWeight(decay=0.4)), NEAR, SLOW),
    "alignment of two": lambda: (CuckerSmale(), [[0.0], [1.0]], [[0.0], [0.1]]),
    "links": lambda: (LinkKeeping(((0, 1),), r=2.0), NEAR, SLOW),
    "tree": lambda: (MinimalFlocking(edges=((0, 1),), normalised=True), NEAR, SLOW),
}


@cache
def run_of(name):
    return simulate(*RUNS[name](), (0.0, 2.0), t_eval=np.linspace(0.0, 2.0, 21))


def away(run, size):
    """The first agent is a hundred lengths of the law off, at one sample."""
    return at_half_time(run, q=100.0 * size * run.scales.length)


def hurried(run, size):
    """It is a hundred speeds too fast."""
    return at_half_time(run, p=100.0 * size * run.scales.speed)


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
    """It is almost where the first one is."""
    q, k = run.q.copy(), len(run.q) // 2
    q[k, 1] += 0.95 * size * (q[k, 0] - q[k, 1])
    return replace(run, q=q, between=None)


def at_half_time(run, **added):
    changed = {name: getattr(run, name).copy() for name in added}
    for name, value in added.items():
        changed[name][len(run.t) // 2, 0] += value
    return replace(run, **changed, between=None)


# theorem, claim, run, violation
PLANTED = [
    ("alpha-flocking", "cohesive", "algorithm 1", closer),
    ("alpha-flocking", "mismatch", "algorithm 1", hurried),
    ("alpha-flocking-strict", "deviation", "algorithm 1", closer),
    ("alpha-flocking-strict", "mismatch", "algorithm 2", hurried),
    ("cohesion", "bound", "algorithm 2", away),
    ("collision-energy", "below", "algorithm 1", crossed),
    ("cucker-smale", "bounded", "alignment", away),
    ("cucker-smale-pair", "invariant", "alignment of two", hurried),
    ("dead-zone-1-corrected", "balance", "dead zone", lifted),
    ("dead-zone-1-printed", "energy", "dead zone", away),
    ("energy", "balance", "algorithm 1", lifted),
    ("energy", "balance", "algorithm 2", lifted),
    ("energy", "balance", "algorithm 3", lifted),
    ("ha-liu", "bounded", "alignment", away),
    ("ha-liu", "rate", "alignment", hurried),
    ("ha-liu-sharp", "bounded", "alignment", away),
    ("ha-liu-sharp", "rate", "alignment", hurried),
    ("links-kept", "balance", "links", lifted),
    ("links-kept", "links", "links", away),
    ("os-3", "i", "algorithm 2", away),
    ("os-3", "iv-none", "algorithm 2", crossed),
    ("os-6", "balance", "algorithm 3", lifted),
    ("su-informed", "distance", "informed", away),
    ("su-varying", "centre", "told", away),
    ("tanner-fixed", "energy", "fixed net", lifted),
    ("tanner-fixed", "no-collision", "fixed net", closer),
    ("tanner-switching", "energy", "proximity", lifted),
    ("tanner-switching", "no-collision", "proximity", closer),
    ("zone-1-corrected", "root-edge", "tree", closer),
    ("E13", "printed", "three", crossed),
]
EXCEPT = {
    "energy-printed": "it is false of the run as it is; test_planted_energy",
    "jlm-headings": "a map has no second run; headings keep their span to the bit: test_a_heading_that_leaves_its_span",
    "lattice-limit-printed": "about a limit, judged by the equilibrium beside the end; test_planted_limits",
    "linearised-decay-terminal": "about the linearisation at the end; test_following",
    "os-1": "what fails under an assumed hypothesis is never refuted: test_a_collision_may_refute_what_is_assumed",
    "os-5-terminal": "about a configuration, the end of the run; test_planted_nets",
    "zone-1-printed": "false of the run as it is; test_trees",
    "E11": "about a limit, judged by the equilibrium beside the end; test_planted_limits",
    "E12": "it makes its own runs; test_following",
}


def claim_of(name, part, first, second):
    """A claim on one run, held against another as `verify` holds it against a tighter one."""
    first.remembered("second run", lambda: second)
    second.remembered("second run", lambda: second)  # some claims ask for it themselves
    tolerances, item = Tolerances(), theorem(name)
    claims = corroborated(item.examine(first, tolerances)[1], first, lambda again: item.examine(again, tolerances)[1])
    return next(claim for claim in claims if claim.name == part)


@pytest.mark.parametrize(("name", "part", "base", "plant"), PLANTED)
def test_a_violation_is_refuted_if_it_is_larger_than_the_error_and_inconclusive_if_not(name, part, base, plant):
    run = run_of(base)
    assert claim_of(name, part, replace(run), replace(run)).status in ("verified", "inconclusive")
    found = claim_of(name, part, plant(run, 1.0), plant(run, 0.98))
    assert found.status == "refuted"
    assert 0.0 <= found.error < -found.margin
    assert claim_of(name, part, plant(run, 1.0), replace(run)).status == "inconclusive"
    assert claim_of(name, part, replace(run), plant(run, 1.0)).status == "inconclusive"


def test_every_theorem_about_runs_is_fed_one_or_says_why_not():
    about_runs = {name for name in theorems() if theorem(name).kind == "trajectory"}
    assert {row[0] for row in PLANTED} | set(EXCEPT) == about_runs
    assert not {row[0] for row in PLANTED} & set(EXCEPT)


@pytest.mark.parametrize("part", ["iii", "iii-barrier"])
def test_a_collision_may_refute_what_is_assumed(part):
    """Theorem 1 speaks of all solutions of a level set: a collision may as well mean that one of them is no flock."""
    run = run_of("algorithm 1")
    found = claim_of("os-1", part, crossed(run, 1.0), crossed(run, 0.98))
    assert (found.status, found.margin < -found.error) == ("inconclusive", True)


@pytest.mark.parametrize(("out", "hull"), [(0.0, "verified"), (1e-15, "refuted"), (1.0, "refuted")])
def test_a_heading_that_leaves_its_span(out, hull):
    """A map is exact: one bit beyond the span of the headings before is too much."""
    law = HeadingAveraging(range=1.0, speed=0.2, dt=1.0)
    run = simulate(law, [[0.0, 0.0], [0.5, 0.0]], law.velocities([1.0, 2.0]), (0.0, 12.0))
    heading = run.extra["heading"].copy()
    heading[6, 0] += out
    edited = replace(run, extra={**run.extra, "heading": heading})
    assert next(c for c in theorem("jlm-headings").examine(edited, Tolerances())[1] if c.name == "hull").status == hull


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


def test_what_an_integrator_spoils_is_inconclusive():
    """The balance of a run at steps of half a unit of time is off by far more than is allowed."""
    run = simulate(*RUNS["algorithm 1"](), (0.0, 2.0), method="RK4", dt=0.5)
    balance = verify("energy", run).claim("balance")
    assert balance.margin < -1e-6
    assert balance.status == "inconclusive"
