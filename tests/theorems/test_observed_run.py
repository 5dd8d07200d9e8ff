"""What is known of a run: enclosures hold the exact motion where that is known, however the run was integrated."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

import flockana as fl
from flockana import LinkKeeping, RationalWeight, SemiImplicitEuler
from flockana.theorems import Claim, Theorem, verify
from flockana.theorems import second_runs as module
from flockana.theorems.attraction_basin import final_basin
from flockana.theorems.claims import judged
from flockana.theorems.observed_run import Observed, by_both_runs, observed, with_doubt
from flockana.theorems.second_runs import failure

SPRING = fl.Algorithm2(gains=fl.Gains(0.0, 0.0, c1_gamma=1.0, c2_gamma=0.0), target=fl.StaticTarget((0.0,)))
START = ([[1.0], [-1.0]], [[0.0], [0.0]], (0.0, 6.0))
TOLERATED = [{"rtol": 1e-2}, {"rtol": 1e-5, "atol": 1e-4}, {}, {"rtol": 1e-13}, {"method": "RK23", "rtol": 1e-3}]
HOW = [*TOLERATED, {"method": "RK4", "dt": 0.2}, {"t_eval": [0.0, 5.0, 6.0]}]


@pytest.mark.parametrize("how", HOW, ids=str)
def test_two_springs_swing_as_the_cosine_within_every_enclosure(how):
    seen = observed(SPRING, *START, **how)
    exact = np.abs(np.cos(seen.t))
    for found, true in (
        (seen.radius, exact),
        (seen.distances([0], [1])[:, 0], 2.0 * exact),
        (seen.relative_speeds[:, 0], np.abs(np.sin(seen.t))),
        (seen.spread, np.sqrt(2.0) * exact),
        (seen.mismatch, 0.5 * np.sin(seen.t) ** 2),
        (seen.energy, 1.0),
    ):
        assert ((found.lo <= true) & (true <= found.hi)).all()
    assert np.abs(seen.residual.mid).max() <= seen.residual.half_width.max()


def test_the_start_is_exact_and_what_comes_after_is_as_wide_as_the_runs_differ():
    seen = observed(SPRING, *START, rtol=1e-4)
    assert seen.radius.half_width[0] < 1e-14
    apart = np.abs(seen.given.q - seen.run.q).max()
    assert seen.shape_error.max() == pytest.approx(max(2.0 * apart, seen.floors.place), rel=0.01)
    assert seen.run.stats["rtol"] == pytest.approx(1e-6)
    assert seen.other is seen.given
    assert Observed.of(seen.given) is seen


def test_a_difference_of_0_proves_nothing_below_the_solvers_floors():
    seen = observed(fl.Algorithm1(), [[0.0], [99.0]], [[-1.0], [1.0]], (0.0, 1.0))
    assert np.array_equal(seen.run.q, seen.other.q)
    assert seen.shape_error[-1].min() >= seen.other.floors.place > 0.0


def test_widths_follow_the_motion_and_forget_what_was_longer_ago_than_a_law_time():
    case = fl.scenario("paper-flocking")
    seen = Observed.of(fl.simulate(case.law, case.q0, case.p0, case.t_span))
    widths = seen.shape_error.max(axis=1)
    assert widths.max() > 1e-4
    assert widths[-1] < 1e-5


@pytest.mark.parametrize(("length", "time"), [(1e-6, 1.0), (25.4, 60.0), (2.0**30, 2.0**-12)])
def test_half_widths_have_their_units(length, time):
    run = fl.simulate(SPRING, *START, rtol=1e-5)
    one, two = Observed.of(run), Observed.of(fl.rescale(run, length=length, time=time))
    assert two.shape_error[1:] == pytest.approx(length * one.shape_error[1:], rel=0.5)
    assert two.mismatch.half_width[1:] == pytest.approx((length / time) ** 2 * one.mismatch.half_width[1:], rel=0.5)


def test_what_decays_is_known_until_it_is_noise_and_to_no_time_if_that_is_too_soon():
    law = fl.CuckerSmale(RationalWeight(1.0, 0.0, 1.0))
    seen = observed(law, [[0.0], [1.0]], [[0.1], [-0.1]], (0.0, 100.0))
    count = seen.known_samples(seen.velocity_spread.lo > 0.0)
    assert 5.0 < seen.t[count - 1] < 40.0  # 0.1 e^(-2t) is 1e-10 at t = 10
    assert seen.until(count) == f"to t = {seen.t[count - 1]:.4g}"
    known = np.ones(len(seen.t), dtype=bool)
    assert seen.known_samples(known) == len(seen.t)
    known[1:] = seen.t[1:] < 0.5 * seen.scales.time
    assert seen.known_samples(known) == 0
    assert seen.until(0) == "at no time"


def test_orbits_from_nudged_starts_estimate_the_error_of_a_map_that_has_no_ball_form():
    """Two agents at rest but for 0.1 in k2 = 1: a nudge of 1e-13 of the largest number moves q by some of them."""
    seen = observed(SemiImplicitEuler(fl.DeadZoneFlocking(), dt=0.02), [[0.0], [8.0]], [[0.1], [0.0]], (0.0, 1.0))
    assert seen.run is seen.given
    assert seen.other is not seen.given
    assert seen.shape_error[0].max() < 2e-14  # the start is exact, its centre rounded
    assert 1e-13 < seen.shape_error[-1].max() < 1e-10
    assert (seen.known, seen.known_until, seen.enclosed) == (51, 50, False)


@dataclass(frozen=True)
class Doubling(fl.DiscreteLaw):
    """q' = 2 q mod 1, exact in binary: two orbits part by a factor of 2 in each step."""

    dt: float = 1.0

    def step(self, t, q, p, memory):
        return np.mod(2.0 * q, 1.0), p, 0.0 * q, memory


def test_nothing_is_known_of_a_map_after_two_orbits_part():
    """From 1e-13 to 1e-6 of its extent it takes log2(1e7) = 23 steps, one less for the doubling of the difference."""
    start = np.array([[0.1], [0.7]])
    seen = observed(Doubling(), start, 0.0 * start, (0.0, 40.0))
    assert 18 <= seen.known_until <= 24
    assert np.isinf(seen.shape_error[seen.known :]).all()
    assert np.isfinite(seen.shape_error[: seen.known]).all()
    assert np.isinf(seen.series(lambda run: run.q[:, 0, 0]).half_width[seen.known :]).all()


@pytest.mark.parametrize(
    ("claim", "status"),
    [
        (Claim("late", "verified"), "inconclusive"),
        (Claim("late", "refuted", witness={"time": 39.0}), "inconclusive"),
        (Claim("early", "refuted", witness={"time": 3.0}), "refuted"),
        (Claim("proved", "verified", "smt", proof="headings"), "verified"),
    ],
)
def test_claims_after_two_orbits_part_are_not_decided_by_numbers(claim, status):
    start = np.array([[0.1], [0.7]])
    seen = observed(Doubling(), start, 0.0 * start, (0.0, 40.0))
    (judged,) = with_doubt([claim], seen)
    assert judged.status == status
    assert (f"known to step {seen.known_until} only" in judged.detail) == (status == "inconclusive")


@pytest.mark.parametrize(
    ("spoil", "doubt"),
    [
        (lambda run: replace(run, status="failed", message="no step"), "the run failed: no step"),
        (lambda run: run.window(0.0, 0.0), "one sample shows no motion"),
    ],
)
def test_of_a_run_that_shows_no_motion_nothing_is_known(spoil, doubt):
    seen = Observed.of(spoil(fl.simulate(SPRING, *START)))
    assert seen.doubt == doubt
    assert np.isinf(seen.radius.half_width).all()


def test_a_second_run_that_ends_early_leaves_nothing_known(monkeypatch):
    run = fl.simulate(SPRING, *START)
    short = SimpleNamespace(status="failed", t=run.t[:2], message="no step")
    monkeypatch.setattr(module, "second_run", lambda *of, **how: short)
    seen = Observed.of(run)
    assert seen.doubt == f"a tighter second run ended at t = {run.t[1]:.6g}: no step"
    assert np.isinf(seen.energy.half_width).all()


def test_a_run_that_left_the_domain_of_its_law_decides_nothing():
    """As no step does, the samples are moved: over the pole of ψ = k s²/(r − s) at r."""
    law = LinkKeeping(((0, 1),), r=1.0, k=1.0, c=0.0)
    run = fl.simulate(law, [[0.0], [1.0 - 1e-5]], [[0.0], [1e-3]], (0.0, 0.05), rtol=1e-4)
    assert failure(run) == ""
    moved = replace(run, q=2.0 * run.q)
    assert failure(moved).startswith("the run left the domain of its law before t = ")
    told = with_doubt([Claim("links", "verified", "smt"), Claim("a", "verified", "symbolic")], Observed.of(moved))
    assert [claim.status for claim in told] == ["inconclusive", "verified"]


def test_a_claim_of_both_runs_is_as_sure_as_they_agree():
    seen = observed(SPRING, *START, rtol=1e-4)

    def claimed(one, other):
        status = {True: "verified", False: "refuted"}
        margin = {id(seen.run): one, id(seen.other): other}
        found = {key: Claim("i", status[x > 0], margin=x, error=0.1) for key, x in margin.items()}
        return by_both_runs(seen, lambda run: found[id(run)])

    assert (claimed(1.0, 0.9).status, claimed(1.0, 0.9).error) == ("verified", pytest.approx(0.3))
    assert claimed(1.0, 0.4).status == "inconclusive"
    assert claimed(1.0, -1.0).status == "inconclusive"
    assert claimed(-1.0, -1.0).status == "refuted"


def test_a_window_keeps_what_is_known_and_begins_inexactly():
    seen = observed(SPRING, *START, rtol=1e-5)
    part = seen.window(2.0, 6.0)
    assert seen.begins_exactly
    assert not part.begins_exactly
    assert part.shape_error[-1] == pytest.approx(seen.shape_error[-1], rel=1e-12)
    assert part.shape_error[0].min() > 0.0


def test_what_is_computed_once_is_kept_with_what_is_known_of_the_errors():
    run = fl.simulate(fl.Algorithm1(), [[0.0], [7.5]], [[0.0], [0.0]], (0.0, 20.0), rtol=1e-13)
    exact = final_basin(Observed.alone(run))
    known = Observed.of(run)
    assert known.run is run
    assert final_basin(known).distance > 5.0 * exact.distance
    assert final_basin(known) is final_basin(Observed.of(run))


def test_the_error_that_is_shown_holds_the_error_of_the_run():
    """Twice what the run is off by, x = cos t being exact, at worst within one law time."""

    def back(seen, tolerances):
        away = seen.series(lambda run: np.abs(run.q[:, 0, 0] - run.q[0, 0, 0]))[-1]
        return [], [judged("back", 0.5 - away)]

    run = fl.simulate(SPRING, [[1.0]], [[0.0]], (0.0, 2.0 * np.pi), method="RK4", dt=0.3)
    late = run.t >= run.t[-1] - run.scales.time
    claim = verify(Theorem("ours", "back after a period", "It is back.", "ours", "trajectory", back), run).claims[0]
    assert claim.status == "verified"
    assert claim.error == pytest.approx(2.0 * np.abs(run.q[late, 0, 0] - np.cos(run.t[late])).max(), rel=1e-2)
    assert claim.error > 1e-4
