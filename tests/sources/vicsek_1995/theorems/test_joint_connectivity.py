"""The theorem of Jadbabaie, Lin and Morse on headings written by hand."""

from dataclasses import replace

import numpy as np
import pytest

from flockana.sources.vicsek_1995.laws import HeadingAveraging
from tests.theorems.made_up import hypothesis, judged, made_up, statuses

LAW = HeadingAveraging(range=1.0, speed=0.01, dt=0.5)
NEAR, APART = [[0.0, 0.0], [0.5, 0.0]], [[0.0, 0.0], [5.0, 0.0]]


def verdict_of(headings, places=None, dt=0.5, law=LAW):
    """Two agents that stay where they are told, whatever their headings."""
    q = [NEAR] * len(headings) if places is None else places
    run = made_up(law, q, t=dt * np.arange(len(headings)))
    return judged("jlm-headings", replace(run, extra={"heading": np.array(headings, dtype=float)}))


def test_two_that_hear_each_other_agree_after_one_step():
    verdict = verdict_of([[0.0, 1.0], [0.5, 0.5], [0.5, 0.5]])
    assert set(statuses(verdict).values()) == {"verified"}
    assert {h.status for h in verdict.hypotheses} == {"met"}
    assert verdict.claim("hull").computed == 0.0
    assert verdict.claim("contraction").computed == 0.0  # ½(1, 1) of both: nothing is left of a spread
    assert verdict.claim("contraction").witness == {"blocks": 2, "steps of the first missed": None}
    assert verdict.claim("agreement").witness == {"heading": 0.5}
    assert "2 windows seen, of 1 steps at most" in hypothesis(verdict, "at all later times").detail


@pytest.mark.parametrize(
    ("headings", "out", "first"),
    [
        ([[0.0, 1.0], [0.5, 0.5], [0.5, 0.5 + 1e-15]], 1, 1),
        ([[0.0, 1.0], [0.0, 1.0 + 1e-15], [0.0, 1.0]], 1, 0),
        ([[0.0, 1.0], [-1e-15, 1.0], [-1e-15, 1.0]], 1, 0),
        ([[0.0, 1.0], [-0.1, 1.1], [-0.2, 1.2]], 2, 0),
        ([[0.0, 1.0], [0.0, 1.0], [0.1, 0.9]], 0, None),
    ],
)
def test_every_step_at_which_a_heading_leaves_the_span_counts(headings, out, first):
    claim = verdict_of(headings).claim("hull")
    assert claim.witness == {"steps at which one does": out, "first": first}
    assert (claim.margin, claim.error) == (-out or 1.0, 0.0)
    assert (claim.status, claim.contradicts) == (("inconclusive", "headings") if out else ("verified", ""))
    assert claim.computed == pytest.approx(np.ptp(headings[-1]))


@pytest.mark.parametrize(("left", "missed"), [(0.0, False), (1e-16, False), (1e-12, True), (0.5, True)])
def test_what_the_nets_do_not_leave_of_a_spread_is_missed(left, missed):
    verdict = verdict_of([[0.0, 1.0], [0.5 - 0.5 * left, 0.5 + 0.5 * left], [0.5, 0.5]])
    claim = verdict.claim("contraction")
    assert (claim.status, claim.contradicts) == (("inconclusive", "headings") if missed else ("verified", ""))
    assert claim.margin == (-1.0 if missed else 1.0)
    assert claim.witness["steps of the first missed"] == ((0, 1) if missed else None)


def test_two_that_do_not_hear_each_other_are_in_no_window_and_may_meet_after_the_run():
    verdict = verdict_of([[3.0, 0.1]] * 3, [APART] * 3)
    assert statuses(verdict) == {"hull": "verified", "contraction": "vacuous", "agreement": "vacuous"}
    assert hypothesis(verdict, "at all later times").status == "unmet"  # the second is ahead, and they head apart
    assert "0 windows seen, of 0 steps at most" in hypothesis(verdict, "at all later times").detail
    verdict = verdict_of([[0.1, 3.0]] * 3, [APART] * 3)
    assert hypothesis(verdict, "at all later times").status == "assumed"
    assert verdict.claim("agreement").status == "inconclusive"
    assert verdict.claim("agreement").witness is None


def test_a_window_is_as_long_as_it_takes_to_meet():
    verdict = verdict_of([[0.0, 1.0], [0.0, 1.0], [0.0, 1.0], [0.5, 0.5]], [APART, APART, NEAR, NEAR])
    assert "1 windows seen, of 3 steps at most" in hypothesis(verdict, "at all later times").detail
    assert verdict.claim("contraction").status == "verified"


@pytest.mark.parametrize(
    ("dt", "kept"), [(0.5, True), (0.5 * (1.0 + 1e-7), True), (0.5 * (1.0 + 3e-6), False), (1.0, False)]
)
def test_samples_are_a_step_apart(dt, kept):
    verdict = verdict_of([[0.0, 1.0], [0.5, 0.5]], dt=dt)
    assert hypothesis(verdict, "every step").status == ("met" if kept else "unmet")
    assert (statuses(verdict)["hull"] == "vacuous") is not kept


def test_headings_must_be_kept():
    run = made_up(LAW, [NEAR, NEAR], t=[0.0, 0.5])
    assert hypothesis(judged("jlm-headings", run), "every step").status == "unmet"


def test_what_lasts_is_that_of_the_end():
    verdict = verdict_of([[0.0, 300.0], [150.0, 150.0], [150.0, 150.0]], [APART, NEAR, NEAR])
    assert hypothesis(verdict, "at all later times").status == "met"
    assert verdict.claim("agreement").witness == {"heading": 150.0}
    unsettled = verdict_of([[150.0, 150.0], [150.0, 150.0], [0.0, 300.0]])
    assert hypothesis(unsettled, "at all later times").status == "assumed"
