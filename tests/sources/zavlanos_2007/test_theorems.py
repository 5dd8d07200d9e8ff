"""Links that are kept: verified, vacuous where nothing joins the flock, contradicted where a run is of another law."""

from dataclasses import replace

import numpy as np
import pytest

import flockana as fl
from flockana.sources.zavlanos_2007.laws import LinkKeeping
from flockana.sources.zavlanos_2007.theorems import theorem
from flockana.theorems.observed_run import Observed
from tests.theorems.made_up import statuses


def checked(run):
    return {claim.name: claim for claim in theorem.check(Observed.alone(run), fl.Tolerances())[1]}


@pytest.fixture(scope="module")
def run():
    return fl.scenario("links-kept").run()


def test_a_chain_holds(run):
    verdict = fl.verify("links-kept", run)
    assert statuses(verdict) == dict.fromkeys(("rate", "balance", "links", "connected", "velocities"), "verified")
    longest = max(np.linalg.norm(np.diff(q, axis=0), axis=1).max() for q in run.q)
    links = verdict.claim("links")
    assert links.computed == pytest.approx(longest, rel=1e-9)
    assert 0.0 < links.error < links.margin < 1.0 - longest


def test_without_damping_velocities_swing(run):
    verdict = fl.verify("links-kept", law=replace(run.law, c=0.0), q0=run.q[0], p0=run.p[0], t_span=(0.0, 1.0))
    assert {claim.name for claim in verdict.claims if claim.status == "vacuous"} == {"velocities"}


@pytest.mark.parametrize("level", [True, False])
def test_longer_links_than_the_level_or_the_range_allows_contradict_the_proof(run, level):
    far = replace(run, law=replace(run.law, r=0.72 if level else 0.65))  # no run of this law: links grow to 0.7175
    claims = checked(far)
    claim = claims["links" if level else "connected"]
    assert (claim.status, claim.contradicts) == ("inconclusive", "links-kept")
    assert claim.margin + claim.error < -0.02


def test_a_link_that_swings_out_between_two_samples_is_bounded_by_both_its_ends():
    """At rest at 0.25 each, and back there a second later at a speed of 2: a control point of each path is at 1.05."""
    q, p = np.array([[[-0.25], [0.25]]] * 2), np.array([[[0.0], [0.0]], [[2.0], [-2.0]]])
    law, still = LinkKeeping(((0, 1),)), {"work": [0.0, 0.0]}
    for order, sign in ((slice(None), 1.0), (slice(None, None, -1), -1.0)):  # or back in time
        run = fl.Trajectory([0.0, 1.0], q[order], sign * p[order], 0.0 * q, law, extra=still)
        claim = checked(run)["connected"]
        assert (claim.status, claim.rigour, claim.computed) == ("verified", "smt", 0.5)  # by the proof alone
        assert claim.margin - claim.error == pytest.approx(1.0 - 2.52, abs=0.005)
        assert "0.5 at a sample and at most 2.52 between" in claim.detail  # twice 1.05, and the path's own error
