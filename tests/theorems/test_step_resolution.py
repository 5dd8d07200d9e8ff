"""Features of a pair law that two runs would leap over alike: noticed, or the verdict says that they may be there."""

from dataclasses import replace

import numpy as np
import pytest

import flockana as fl
from flockana.interactions.distance_functions import LawFunction
from flockana.theorems import Claim, step_resolution
from flockana.theorems.observed_run import Observed, with_resolution
from flockana.theorems.second_runs import second_run
from flockana.theorems.step_resolution import NAME, _hidden, demand_of, steps_of

SPIKE = "exp(-((s - 2.05)*width)**2)"
FORMULA = f"0.1*(r - s)**2*(s - 1)**2 + barrier*{SPIKE}", f"(1 - s/r)**2*(1 + brake*{SPIKE})"  # for all, compiled once
START, SPEED = [[-1.4, 0.0], [1.4, 0.0]], [[1.0, 0.0], [-1.0, 0.0]]


def meeting(barrier=0.0, brake=0.0, width=700.0, **options):
    """Two agents that fly towards each other, in range from the start on."""
    numbers = {"barrier": barrier, "brake": brake, "width": width}
    pair = fl.pair_law(FORMULA[0], adjacency=FORMULA[1], range=3.0, length=1.0, parameters=numbers)
    law = fl.Algorithm1(pair, fl.Gains(c1_alpha=1.0, c2_alpha=1e-3))
    return fl.simulate(law, START, SPEED, (0.0, 0.6), **options)


@pytest.mark.slow
@pytest.mark.parametrize(
    "how", [{"barrier": 1.5}, {"brake": 3000.0, "t_eval": np.linspace(0.0, 0.6, 301)}], ids=["force", "adjacency"]
)
def test_a_spike_that_tighter_tolerances_alone_leap_over_too_is_noticed(how):
    run = meeting(**how)
    alone = second_run(run, run.path.t, 1e-2, None)
    assert np.abs(alone.p[-1] - run.p[-1]).max() < 1e-6  # both alike, and both wrong
    seen = Observed.of(run)
    assert np.abs(seen.run.p[-1] - run.p[-1]).max() > 1e-4
    assert seen.speed_error[-1].min() > 1e-4
    assert seen.unresolved == ""
    assert demand_of(alone, 0.0).missed.size


@pytest.mark.slow
def test_a_spike_too_narrow_for_any_number_of_steps_is_assumed_not_to_be_there():
    run = meeting(barrier=1.5, width=1e9)
    verdict = fl.verify("energy", run)
    (need,) = [one for one in verdict.hypotheses if one.name == NAME]
    assert need.status == "assumed"
    for claim in verdict.claims:
        assert claim.proof or claim.status != "refuted"
        assert claim.rigour != "numeric" or NAME in [one.name for one in claim.needs]


@pytest.mark.slow
@pytest.mark.parametrize(("place", "status"), [(2.99, "assumed"), (2.5, None)])
def test_a_pole_counts_where_a_pair_comes_near_it(place, status):
    pair = fl.pair_law("0.01*s**2/(r - s)", adjacency="(1 - s/r)**2", range=3.0, length=1.0)
    run = fl.simulate(fl.Algorithm1(pair), [[0.0], [place]], [[0.0], [0.0]], (0.0, 0.5))
    found = {one.name: one.status for one in fl.verify("os-1", run).hypotheses}
    assert found.get(NAME) == status


def test_slopes_count_where_the_pair_is():
    """ψ = 0.01 (3 − s)²/s has ψ″ = 0.18/s³: a pole at contact, and 0.01152 at 2.5."""
    pair = fl.pair_law("0.01*(r - s)**2/s", adjacency="(1 - s/r)**2", range=3.0, length=1.0)
    apart = np.zeros((3, 6, 3))
    apart[:, :, 0] = [[0.001], [2.5], [3.5]]
    rates, ways = _hidden(LawFunction("the pair law", pair, 1.0, 1.0), apart, np.zeros(3), 1.0)
    assert rates[0] > 2e6
    assert rates[1] == pytest.approx(2.0 * 0.01152, rel=0.1)
    assert (rates[2], *ways) == (0.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("about", ["run", "limit", "all"])
@pytest.mark.parametrize("status", ["verified", "refuted"])
def test_nothing_but_a_fact_about_the_run_rests_on_steps_that_may_leap(about, status):
    seen = replace(Observed.of(meeting()), unresolved="somewhere")
    given = Claim("i", status, about=about), Claim("ii", status, "smt", about=about)
    (need,), (first, proved) = with_resolution((), given, seen)
    kept = status == "verified" and about == "run"
    assert (first.status, need.status) == (status if kept else "inconclusive", "assumed")
    assert NAME in first.detail
    assert proved == given[1]


@pytest.mark.parametrize("samples", [[0.0, 0.6], np.linspace(0.0, 0.6, 61), None], ids=["few", "many", "all"])
def test_steps_are_those_of_the_solver_whatever_samples_are_kept(samples):
    run, every = meeting(t_eval=samples), meeting()
    steps, containing = steps_of(run)
    np.testing.assert_allclose(steps, np.diff(every.t), rtol=1e-9)
    assert len(containing) == len(run.path.t) - 1
    assert (containing >= np.diff(run.path.t) * (1.0 - 1e-9)).all()


def test_the_second_run_shares_no_stage_and_keeps_the_bound_of_the_first():
    for options in ({}, {"max_step": 0.01}):
        run = meeting(**options)
        again = Observed.of(run).run
        longest = steps_of(again)[0].max()
        assert longest <= 0.618 * steps_of(run)[0].max() * (1.0 + 1e-9)
        assert longest <= options.get("max_step", np.inf)


@pytest.mark.parametrize("m", [1, 2])
def test_pairs_looked_at_all_at_once_ask_for_the_steps_of_those_found_interval_by_interval(m, monkeypatch):
    """A flock that spreads, so that pairs come and go: the same bits, in blocks of whatever size."""
    rng, numbers = np.random.default_rng(m), {"barrier": 0.1, "brake": 0.5, "width": 20.0}
    pair = fl.pair_law(FORMULA[0], adjacency=FORMULA[1], range=3.0, length=1.0, parameters=numbers)
    law, q = fl.Algorithm1(pair), 1.5 * np.arange(9.0)[:, None] * np.eye(m)[0] + 0.1 * rng.normal(size=(9, m))
    run = fl.simulate(law, q, rng.normal(size=(9, m)), (0.0, 2.0))
    monkeypatch.setattr(step_resolution, "_BLOCK", 100)
    blocks = demand_of(run, 1e-12)
    monkeypatch.setattr(step_resolution, "_FEW", 0)
    found = demand_of(run, 1e-12)
    np.testing.assert_array_equal(blocks.longest, found.longest)
    assert np.isfinite(found.longest).sum() > 10
