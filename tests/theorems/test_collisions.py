"""Collisions: who certainly meets, who may, and how many the energy allows; erratum E13."""

from math import sqrt
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flockana import Algorithm1, Algorithm2, StaticTarget, Tolerances, Trajectory, simulate, verify
from flockana.interactions import AlphaInteraction, Gains
from flockana.measures.path_bounds import contacts
from flockana.theorems import collisions
from flockana.theorems.collisions import below_multiple, contacts_of, near, pairs_at_one_instant, passed
from flockana.theorems.theorem_toolkit import Enclosure, Observed
from tests.theorems.made_up import judged, statuses

ALPHA = AlphaInteraction(a=5e4, b=5e4)
E13_LAW = Algorithm2(ALPHA, Gains(c1_alpha=1.0, c2_alpha=1.0, c1_gamma=0.01, c2_gamma=0.01), StaticTarget((0.0,)))
E13_START = [[-12.0], [0.0], [30.0]], [[sqrt(5.6 * ALPHA.c_star)], [0.0], [0.0]]


@pytest.fixture(scope="module")
def e13():
    return simulate(E13_LAW, *E13_START, (0.0, 0.05))


@given(st.floats(-16.0, -1.0).map(lambda x: 10.0**x), st.sampled_from((-1.0, 1.0)))
@settings(max_examples=15)
def test_energy_at_c_star_is_decided_by_what_rounding_leaves(off, side):
    """H(0) = (1 ± off) c*: the hypothesis is met, unmet, or assumed, never the wrong one of the first two."""
    c_star, error = 50.0, 1e-10
    found = below_multiple(Enclosure.around((1.0 + side * off) * c_star, error), c_star).status
    right = "met" if side < 0.0 else "unmet"
    assert found == (right if off * c_star > 2.0 * error else found)
    assert found in (right, "assumed")


def test_one_sample_excludes_no_collision():
    run = simulate(Algorithm1(), [[0.0], [7.0]], [[1.0], [-1.0]], (0.0, 1.0), t_eval=[1.0])
    assert statuses(judged("collision-energy", run)) == {"below": "inconclusive", "twice": "inconclusive"}


class TestErratum13:
    """The run of erratum E13, with its numbers."""

    def test_two_pairs_meet_where_one_is_allowed(self, e13):
        verdict = verify("E13", e13)
        assert e13.energy()[0] / ALPHA.c_star == pytest.approx(1.909, abs=5e-4)
        claim = verdict.claim("printed")
        assert (claim.status, claim.computed, claim.margin) == ("refuted", 2, -0.5)
        first, second = contacts(e13.t, e13.q, e13.p, e13.u, tol=1e-9)
        assert (first.i, first.j, second.i, second.j) == (0, 1, 0, 2)
        assert first.crossed
        assert second.crossed
        assert [first.time, second.time] == pytest.approx([0.00841, 0.02745], abs=5e-6)

    def test_never_more_than_one_at_once(self, e13):
        claim = verify("E13", e13).claim("corrected")
        assert (claim.status, claim.computed) == ("verified", 1)
        assert verify("os-3", e13).claim("iv-printed").status == "refuted"

    def test_two_pairs_in_one_step_are_both_found(self, e13):
        keep = [0, int(np.searchsorted(e13.t, 0.035)), len(e13.t) - 1]
        t, q, p, u, work = (x[keep] for x in (e13.t, e13.q, e13.p, e13.u, e13.extra["work"]))
        sparse = Trajectory(t, q, p, u, e13.law, {"work": work})
        seen = Observed.alone(sparse)
        assert set(passed(seen, Tolerances())) == {(0, 1), (0, 2)}
        assert judged("E13", sparse).claim("printed").status == "refuted"
        assert pairs_at_one_instant(seen, [], Tolerances(), name="corrected").status == "inconclusive"
        assert judged("E13", sparse).claim("corrected").rigour == "smt"  # by the proof alone

    def test_without_pair_forces_there_is_no_c_star(self):
        law = Algorithm2(gains=Gains(c1_alpha=0.0), target=StaticTarget((0.0,)))
        assert verify("E13", simulate(law, *E13_START, (0.0, 0.01))).status == "vacuous"


@pytest.mark.parametrize(("slack", "pairs"), [(0.4, set()), (0.6, {(0, 1)})])
def test_what_a_path_may_be_off_by_brings_agents_near(slack, pairs):
    """Two at rest at the distance 1, each known up to the slack of its path."""
    t, q, zeros = np.array([0.0, 1.0]), np.array([[[0.0], [1.0]]] * 2), np.zeros((2, 2, 1))
    path, nearest = (t, q, zeros, zeros, np.full((1, 2), slack)), SimpleNamespace(lower_by_interval=np.zeros(1))
    run = SimpleNamespace(t=t, q=q, law=Algorithm1(), path=path, closest_approach=lambda: nearest)
    seen = SimpleNamespace(run=run, law=run.law, between_error=np.zeros(1), cached=lambda key, compute: compute())
    assert near(seen, Tolerances()) == [pairs]


def test_contacts_are_sought_where_agents_may_be_so_near_and_all_are_found(e13):
    sparse = simulate(e13.law, e13.q[0], e13.p[0], (0.0, 0.05), t_eval=[0.0, 0.02, 0.05])
    for run in (e13, sparse):
        found = contacts_of(run, Tolerances())
        assert [(each.i, each.j) for each in found] == [(0, 1), (0, 2)]
        assert found == contacts(*run.path[:4], tol=Tolerances().contact * ALPHA.d)
        t, intervals = run.path[0], collisions._intervals(run, Tolerances().contact * ALPHA.d)[0]
        assert all(((t[intervals] <= each.time) & (each.time <= t[intervals + 1])).any() for each in found)
        assert run is sparse or intervals.size < 0.5 * t.size


def test_pairs_at_one_place_are_counted_at_each_instant():
    one = [0.0, 1.0]
    q = np.array([[one, [0.0, 2.0], [3.0, 0.0]], [one, one, [-0.0, 1.0]], [one, one, [5.0, 1.0]]])
    assert collisions._at_one_place(q).tolist() == [0, 3, 1]
    assert collisions._at_one_place(q[:, :1]).tolist() == [0, 0, 0]


def test_pairs_that_end_at_one_place_never_certainly_met():
    """Squeezed together they come nearer for ever: they may meet, and the count of those that must have is 0."""
    gains = Gains(c1_alpha=1.0, c2_alpha=1.0, c1_gamma=20.0, c2_gamma=9.0)
    law = Algorithm2(gains=gains, target=StaticTarget((0.0, 0.0)))
    rng = np.random.default_rng(0)
    run = simulate(law, rng.normal(0.0, 5.0, (3, 2)), np.zeros((3, 2)), (0.0, 80.0))
    seen = Observed.of(run)
    assert passed(seen, Tolerances()) == {}
    assert len(near(seen, Tolerances())[-1]) == 3
    assert judged("E13", run).claim("printed").status != "refuted"
    assert judged("E13", run).claim("corrected").status != "refuted"
