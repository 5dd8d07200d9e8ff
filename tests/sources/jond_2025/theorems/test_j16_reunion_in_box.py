"""Erratum J16: who stays apart in a box, and why."""

import numpy as np
import pytest

from flockana import Box, ZoneFlocking, ZoneRadii, ZoneWeights, ZoneWorld
from flockana.sources.jond_2025.theorems import j16_reunion_in_box as j16

RADII = ZoneRadii(1.5, c=3.0, a=5.0)


def test_pairs_go_straight_on_and_radii_that_grow_fast_enough_find_a_mate(verdict_of):
    verdict = verdict_of("J16")
    assert verdict.claim("fragments").computed == pytest.approx(380.0, rel=1e-12)
    growing = verdict.claim("growing").computed
    assert list(growing.values())[:2] == [pytest.approx(740.0, rel=1e-3)] * 2  # 5 m/s is less than they part by
    assert list(growing.values())[2] < 5.0


def test_two_at_opposite_walls_obey_the_recursion_that_keeps_them_there(verdict_of):
    """λ² − 1.45 λ + ½ = 0 has two roots in (0, 1): with x = (v, e), v' = (v + e)/2 and e' = e − v'/10."""
    claim = verdict_of("J16").claim("at-walls")
    assert (claim.status, claim.about) == ("refuted", "limit")
    assert claim.computed["eigenvalues"] == pytest.approx(np.sort(np.roots([1.0, -1.45, 0.5])), rel=1e-12)
    off, eigenvalues = claim.computed.values()
    assert off < 1e-12
    assert claim.margin == pytest.approx(-(1.0 - (eigenvalues[0] - 0.5) / 0.5), rel=1e-9)


def test_weights_that_let_an_agent_swing_certify_nothing(monkeypatch):
    """g = 2 < √(4w): it turns round, and may come back."""
    monkeypatch.setattr(j16, "_PRINTED", ZoneWeights(speed=2.0, obstacle=5.0))
    assert j16._at_walls().status == "inconclusive"


def test_ten_minutes_decide_nothing_about_sooner_or_later(verdict_of):
    claim = verdict_of("J16").claim("circling")
    assert (claim.status, claim.about) == ("inconclusive", "limit")
    assert 0 < claim.computed["meet"] < claim.computed["of"] == 40


@pytest.mark.parametrize("gaps", [(4.0, 740.0, 1.0), (740.0, 4.0, 1.0), (740.0, 740.0, 6.0)])
def test_growing_is_refuted_by_any_one_of_its_three_gaps(monkeypatch, gaps):
    monkeypatch.setattr(j16, "_last_gap", lambda growth, q, p: gaps[(0.0, 5.0, 10.0).index(growth)])
    assert j16._growing_radii().status == "refuted"


def test_the_mirror_image_of_an_agent_never_meets_it():
    law = ZoneFlocking(RADII, ZoneWeights(cohesion_gain=1.0, alignment_gain=1.0), ZoneWorld(box=Box((0, 0), (50, 50))))
    q, p = np.array([[12.0, 40.0], [38.0, 10.0]]), np.array([[2.0, 1.5], [-2.0, -1.5]])
    path = law.iterate(0.0, q, p, law.start(q, p), 3000)[0]
    np.testing.assert_allclose(path[:50, 0] + path[:50, 1], 50.0, atol=1e-12)
    assert np.linalg.norm(path[:, 1] - path[:, 0], axis=1).min() > 20.0
