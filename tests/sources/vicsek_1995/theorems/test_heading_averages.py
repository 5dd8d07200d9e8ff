"""Certificates of averaged headings: what they say lasts, and they say nothing where it does not."""

import sys

import numpy as np
import pytest

from flockana import HeadingAveraging, simulate, verify
from flockana.sources.vicsek_1995.theorems import heading_averages
from flockana.sources.vicsek_1995.theorems.joint_connectivity import _contraction

LAW = HeadingAveraging(range=1.0, speed=0.05, dt=1.0)


def certain(certificate):
    return certificate.margin > certificate.error


def flock(seed, size, low, high, n=8):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, size, (n, 2)), rng.uniform(low, high, n)


@pytest.mark.slow
def test_a_net_that_is_certified_stays_as_it_is():
    seen = 0
    for seed in range(30):
        q, heading = flock(seed, 1.1, 1.0, 1.0 + 0.02 * (seed % 10))
        if not certain(heading_averages.permanently_connected(LAW, q, heading)):
            continue
        seen += 1
        run = simulate(LAW, q, LAW.velocities(heading), (0.0, 200.0))
        assert all(np.array_equal(LAW.links(x), LAW.links(q)) for x in run.q)
        weights = heading_averages.neighbourhood_sizes(len(q), LAW.links(q))
        assert run.extra["heading"][-1] == pytest.approx(np.full(len(q), weights @ heading / weights.sum()), abs=1e-9)
    assert seen > 5


def test_the_bound_of_what_may_change_is_near_what_does():
    """Two agents: headings agree after one step, so that only it counts, and ρ = 0."""
    q, step = np.array([[0.0, 0.0], [0.9, 0.0]]), 0.05
    alike = np.array([1.5, 1.5])
    for apart, held in ((0.9, True), (1.0, False), (1.5, False)):  # on the circle or apart nothing is certain
        assert certain(heading_averages.permanently_connected(LAW, q * apart / 0.9, alike)) is held
    for half in (0.9, 1.1):  # v dt √(1/2 + 1/2) 2 half, against a room of 0.1
        heading = np.array([1.5 + half, 1.5 - half])
        assert certain(heading_averages.permanently_connected(LAW, q, heading)) == (2.0 * step * half < 0.1)


def test_a_net_that_averages_slowly_may_change_for_long():
    """A path of three, w = (2, 3, 2), ρ = ½: headings (δ, 0, −δ) move two neighbours by 0.2 √(1/2 + 1/3) δ at most."""
    q, integral_to_infinity = np.array([[0.0, 0.0], [0.7, 0.0], [1.4, 0.0]]), 0.3
    limit = integral_to_infinity / (0.05 * np.sqrt(1.0 / 2.0 + 1.0 / 3.0) * 2.0 / 0.5)
    for share in (0.98, 1.02):
        heading = 1.5 + share * limit * np.array([1.0, 0.0, -1.0])
        assert certain(heading_averages.permanently_connected(LAW, q, heading)) == (share < 1.0)


@pytest.mark.slow
def test_groups_that_are_certified_to_part_never_meet():
    seen = 0
    for seed in range(30):
        q, heading = flock(seed, 3.0, 0.2, 6.0, n=4)
        if not certain(heading_averages.permanently_separated(LAW, q, heading)):
            continue
        seen += 1
        run = simulate(LAW, q, LAW.velocities(heading), (0.0, 300.0))
        assert run.metric("connectivity").max() < 1.0
        assert np.ptp(run.extra["heading"][-1]) > 0.0
    assert seen > 5


def test_who_meets_later_is_not_parted():
    q = np.array([[0.0, 0.0], [1.5, 0.0]])
    assert not certain(heading_averages.permanently_separated(LAW, q, np.array([0.0, np.pi])))
    assert not certain(heading_averages.permanently_separated(LAW, q, np.array([1.0, 1.0])))
    assert certain(heading_averages.permanently_separated(LAW, q, np.array([np.pi, 0.0])))
    q, heading = np.array([[0.0, 0.0], [0.5, 1.5]]), np.radians([85.0, 280.0])  # they pass within range
    assert simulate(LAW, q, LAW.velocities(heading), (0.0, 20.0)).metric("connectivity").max() == 1.0
    assert not certain(heading_averages.permanently_separated(LAW, q, heading))
    q = np.array([[0.0, 0.0], [0.5, 0.0], [3.0, 0.0]])  # a span that passes a turn parts from nothing
    assert not certain(heading_averages.permanently_separated(LAW, q, np.array([0.1, 6.2, 3.0])))


def test_contraction_is_dobrushins():
    assert heading_averages.contraction(np.eye(3)) == 1.0
    assert heading_averages.contraction(np.full((3, 3), 1.0 / 3.0)) == 0.0
    path = heading_averages.averaging_matrix(3, np.array([[0, 1], [1, 2]]))
    assert path.tolist() == [[0.5, 0.5, 0.0], [1 / 3, 1 / 3, 1 / 3], [0.0, 0.5, 0.5]]
    assert heading_averages.contraction(path) == 0.5


@pytest.mark.parametrize("options", [{"average": "vectors"}, {"noise": 0.1}])
def test_other_rules_are_not_the_theorems(options):
    law = HeadingAveraging(1.0, 0.05, 1.0, **options)
    q, heading = flock(0, 1.0, 1.0, 2.0)
    verdict = verify("jlm-headings", simulate(law, q, law.velocities(heading), (0.0, 5.0)))
    assert {claim.status for claim in verdict.claims} == {"vacuous"}


def test_a_guarantee_that_rounds_to_nothing_is_not_missed():
    """A long path contracts by 1 - 1e-30, which is 1 in floating point; who hears whom is not."""
    headings = np.array([[0.0, 1.0], [0.0, 1.0]])
    for mixes, contradicts in ((True, ""), (False, "headings")):
        assert _contraction(headings, (heading_averages.Block(0, 1, 1.0, 1e-12, mixes),), []).contradicts == contradicts


def test_who_hears_one_agent_is_counted_in_whole_numbers():
    headings, path = np.zeros((5, 5)), np.array([[k, k + 1] for k in range(4)])
    (joined,) = heading_averages.blocks([path] * 4, headings, [(k, k + 1) for k in range(4)])
    (cut,) = heading_averages.blocks([path[[0, 3]]] * 4, headings, [(k, k + 1) for k in range(4)])
    assert joined.mixes
    assert joined.factor < 1.0
    assert not cut.mixes


def test_a_block_is_of_its_own_steps_and_rounds_with_each():
    both = np.array([[0, 1]])
    headings = np.tile([0.25, 1.5], (6, 1))
    first, second = heading_averages.blocks([both] * 5, headings, [(0, 2), (2, 5)])
    assert [(b.start, b.stop) for b in (first, second)] == [(0, 2), (2, 5)]
    assert second.error == pytest.approx(1.5 * first.error, rel=1e-12, abs=0.0)
    assert 2.0 * 2.0 * np.finfo(float).eps * 1.5 < first.error < 1e-13
    assert (first.factor, first.mixes) == (0.0, True)
    apart = np.empty((0, 2), dtype=int)
    (lonely,) = heading_averages.blocks([apart] * 2, headings, [(0, 2)])
    assert (lonely.factor, lonely.mixes) == (1.0, False)


def test_nothing_is_certain_where_rounding_hides_how_fast_the_net_averages(monkeypatch):
    """With numbers so coarse that 1 − ρ of a path of three is within (3 + 4) ε: ρ = ½."""
    q, heading = np.array([[0.0, 0.0], [0.7, 0.0], [1.4, 0.0]]), np.full(3, 1.5)
    for eps, certainly in ((1e-6, True), (0.51 / 7.0, False), (0.9 / 7.0, False)):
        monkeypatch.setattr(sys.modules["flockana.sources.vicsek_1995.theorems.heading_averages"], "EPS", eps)
        found = heading_averages.permanently_connected(LAW, q, heading)
        assert certain(found) is certainly
        assert ("rounding hides" in found.text) is not certainly
