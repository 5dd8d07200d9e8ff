"""The printed Theorem 1 on one and on two edges at rest: how short they may become, and where A_cl is Hurwitz."""

from math import sqrt

import numpy as np
import pytest

from flockana.measures.perception import both_ways
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from tests.theorems.made_up import hypothesis, judged, made_up, statuses

EPS, MU, A = np.finfo(float).eps, 3.0, 0.7


def at_rest(*lengths, rho=2.0):
    law = MinimalFlocking(edges=((0, 1), (1, 2))[: len(lengths)], spacing=rho, mu=MU, sigma=A, normalised=False)
    q = np.column_stack([np.concatenate([[0.0], np.cumsum(lengths)]), np.zeros(1 + len(lengths))])
    return judged("zone-1-printed", made_up(law, [q, q]))


@pytest.mark.parametrize("share", [0.25, 0.8, 1.0, 1.25, 1.75])
def test_an_edge_at_rest_keeps_what_its_stretch_leaves(share):
    """½μy² of ½μρ²: it keeps 1 − |y|/ρ of its desired length for ever, so that x → 0 is refuted."""
    verdict = at_rest(2.0 * share)
    edges = verdict.claim("edges")
    assert edges.status == "refuted"
    assert edges.margin == pytest.approx(abs(share - 1.0) - 1.0, abs=1e-6)
    assert edges.computed == pytest.approx([2.0 * share] * 2)
    still = verdict.claim("equilibrium")
    assert (still.status, still.margin) == ("refuted", pytest.approx(-1.0, abs=1e-6))
    assert still.computed == pytest.approx(2.0, abs=1e-5)


def test_an_edge_with_energy_enough_may_vanish_and_of_two_the_one_that_keeps_more_refutes():
    assert at_rest(4.0 + 1e-3).claim("edges").status == "inconclusive"
    assert at_rest(6.1).claim("edges").status == "inconclusive"
    edges = at_rest(2.5, 2.0).claim("edges")
    assert edges.margin == pytest.approx(0.25 - 1.0, abs=1e-6)
    assert edges.computed == pytest.approx([2.0, 2.5])


@pytest.mark.parametrize("lengths", [(1.5, 3.0), (3.0, 1.5), (1.9, 1.5), (1.5, 1.9), (3.0, 0.25), (0.25, 0.5)])
def test_an_edge_too_short_makes_a_cl_unstable(lengths):
    """By the positive root of s² + a s + μ(1 − ρ/|x|), of the shorter edge; the margin is |x|/ρ − 1."""
    claim = at_rest(*lengths).claim("hurwitz")
    w = MU * (1.0 - 2.0 / min(lengths))
    assert claim.status == "refuted"
    assert claim.margin == pytest.approx(0.5 * min(lengths) - 1.0, rel=1e-12)
    assert claim.computed == pytest.approx(0.5 * (sqrt(A * A - 4.0 * w) - A), rel=1e-12)
    assert 0.0 < claim.error < 64.0 * EPS
    assert claim.witness["|x_e|/ρ"] == pytest.approx([0.5 * x for x in lengths])


@pytest.mark.parametrize("length", [2.02, 3.0])
def test_edges_that_are_too_long_make_it_hurwitz(length):
    """Near ρ the roots are real, beyond a² = 4w they swing."""
    claim = at_rest(length).claim("hurwitz")
    w = MU * (1.0 - 2.0 / length)
    assert claim.status == "verified"
    assert claim.margin == pytest.approx(0.5 * length - 1.0, abs=1e-8)
    assert claim.computed == pytest.approx(np.roots([1.0, A, w]).real.max(), rel=1e-12)


def test_between_two_samples_an_edge_may_be_shorter():
    """It comes in and goes out with a constant force: at 3 at both ends, at 2 or 2.75 halfway."""
    law = MinimalFlocking(edges=((0, 1),), spacing=2.0, mu=MU, sigma=A, normalised=False)
    for dip, status in ((1.5, "inconclusive"), (0.25, "verified")):
        q, v, u = np.array([[0.0, 0.0], [3.0, 0.0]]), np.zeros((2, 2, 2)), np.zeros((2, 2, 2))
        v[:, 1, 0], u[:, 1, 0] = [-4.0 * dip, 4.0 * dip], 8.0 * dip
        claim = judged("zone-1-printed", made_up(law, [q, q], v, u=u)).claim("hurwitz")
        assert claim.status == status
        assert status == "inconclusive" or 0.3 < claim.margin - claim.error <= 0.5 * (3.0 - dip) - 1.0


def test_an_undirected_tree_has_no_root():
    law = MinimalFlocking(edges=both_ways([(0, 1)]), spacing=2.0, normalised=False)
    q = np.array([[0.0, 0.0], [2.5, 0.0]])
    verdict = judged("zone-1-printed", made_up(law, [q, q]))
    assert hypothesis(verdict, "spanning tree").status == "unmet"
    assert set(statuses(verdict).values()) == {"vacuous"}


def test_of_all_samples_the_one_with_the_shortest_edge_counts():
    law = MinimalFlocking(edges=((0, 1), (1, 2)), spacing=2.0, mu=MU, sigma=A, normalised=False)
    q = np.array([[[0.0], [1.9], [4.9]], [[0.0], [1.5], [5.0]], [[0.0], [1.8], [4.8]]])
    claim = judged("zone-1-printed", made_up(law, q)).claim("hurwitz")
    assert claim.witness == {"time": 1.0, "|x_e|/ρ": pytest.approx([0.75, 1.75])}
    assert claim.margin == pytest.approx(-0.25, rel=1e-12)
