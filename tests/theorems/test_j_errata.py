"""Errata J1 to J12 of the bearing-distance paper: statuses, and the figures known beforehand."""

from __future__ import annotations

from math import tanh

import numpy as np
import pytest
from scipy.stats import beta

from flockana.measures.metrics import min_distance
from flockana.measures.nets import components, links
from flockana.scenarios.scenario import differences
from flockana.theorems import theorem, verify
from flockana.theorems.bearing_distance.j01 import random_forest
from flockana.theorems.bearing_distance.j03 import path_matrices
from flockana.theorems.bearing_distance.j07 import dragged_speed
from flockana.theorems.bearing_distance.j11 import minimal_start
from flockana.theorems.bearing_distance.random_starts import separated_start, zone_start
from flockana.theorems.shares import always, mostly, share

NAMES = [f"J{k}" for k in range(1, 13)]


@pytest.fixture(scope="module")
def verdicts():
    return {name: verify(name) for name in NAMES}


@pytest.mark.parametrize("name", NAMES)
def test_every_erratum_reads_as_expected(name, verdicts):
    assert theorem(name).expected
    assert differences(verdicts[name], theorem(name).expected) == ()
    assert all(claim.detail for claim in verdicts[name].claims)


def test_j1_every_tree_ends_at_its_spacing_and_none_at_zero(verdicts):
    claim = verdicts["J1"].claim("corrected")
    assert claim.computed["trees"] == 200
    # 200 of 200: the exact lower end is (α/2)^(1/200)
    assert claim.computed["interval"][0] == pytest.approx(0.025 ** (1 / 200))
    assert verdicts["J1"].claim("printed").computed["trees whose edges might all vanish"] == 0


def test_j1_the_forest_is_made_of_trees():
    law, q, _ = random_forest(40, 5)
    labels = components(len(q), np.array(law.edges, dtype=np.int32))
    assert labels.max() == 39
    sizes = np.bincount(labels)
    assert sizes.min() >= 2
    assert sizes.max() <= 8
    assert np.bincount([i for _, i in law.edges], minlength=len(q)).max() == 1


def test_j2_the_eigenvalues(verdicts):
    verdict = verdicts["J2"]
    assert verdict.claim("hurwitz").margin == pytest.approx(-(5**0.5 - 1) / 2)
    assert verdict.claim("hurwitz").witness["largest real part of the law's Jacobian there"] == pytest.approx(0.618034)
    assert verdict.claim("positive-definite").margin == pytest.approx(1 - 5**0.5 / 2)


def test_j3_the_path_of_four(verdicts):
    assert verdicts["J3"].claim("printed").computed == pytest.approx(0.2494, abs=1e-4)
    assert verdicts["J3"].claim("hurwitz").computed == pytest.approx(0.0108, abs=1e-4)
    stiffness, damping = path_matrices(1.0)
    # by hand: ends want 1 and have 2.05, the middle ones want 2; an edge's row is minus the difference of two agents
    end, own, middle = 1 - 1 / 2.05, 1 - 2 / 2.05, 1 - 2 / 2.7
    np.testing.assert_allclose(stiffness[0], [end + own, -middle, 0.0], atol=1e-12)
    np.testing.assert_allclose(stiffness[1], [-own, 2 * middle, -own], atol=1e-12)
    np.testing.assert_allclose(damping, [[1.5, -0.5, 0.0], [-0.5, 1.0, -0.5], [0.0, -0.5, 1.5]], atol=1e-12)


def test_j5_the_runaway(verdicts):
    found = verdicts["J5"].claim("runaway").computed
    assert found["acceleration"] == pytest.approx(2 / 3, abs=1e-6)
    assert found["edges"] == pytest.approx(5 / 3, abs=1e-6)
    assert found["ends apart"] < 1e-6


def test_j7_the_drag(verdicts):
    assert dragged_speed(0.1) == pytest.approx(2.0083, abs=5e-5)
    found = [dragged_speed(dt) for dt in (0.05, 0.01, 0.001)]
    np.testing.assert_allclose(found, [1.628, 0.974, 0.457], atol=1e-3)  # found by iteration, to three digits
    v = dragged_speed(0.1)
    assert 4.0 * tanh((v + 0.2) / 4.0) == pytest.approx(v, abs=1e-12)
    assert verdicts["J7"].claim("speed").witness["mean speed over seeds"] == pytest.approx(1.98, abs=0.03)
    assert verdicts["J7"].claim("clip").witness["mean speed over seeds"] == pytest.approx(3.0, abs=0.03)


def test_j8_the_estimate_scatters_the_flock(verdicts):
    assert np.median(verdicts["J8"].claim("holds-together").witness["components by seed"]) == 10
    assert min(verdicts["J8"].claim("equivalent").witness["mean error of the estimate, by seed"]) > 5.0


def test_j9_the_alien_walks_through(verdicts):
    assert verdicts["J9"].claim("printed").computed < -10.0  # the agent is far beyond the alien
    assert verdicts["J9"].claim("corrected").computed == pytest.approx(3.0, abs=1e-6)


def test_j10_starts_violate_the_distance_at_once(verdicts):
    found = verdicts["J10"].claim("distances").computed
    assert 1.0 - found["holds"] / found["of"] == pytest.approx(0.96, abs=0.01)


def test_j12_the_stand_off(verdicts):
    claim = verdicts["J12"].claim("stand-off")
    assert claim.computed.keys() == claim.stated.keys()
    for case, distance in claim.computed.items():
        assert distance == pytest.approx(claim.stated[case], abs=1e-9)
    assert abs(verdicts["J12"].claim("contact").computed["distance from the wall"]) < 1e-6


def test_starts_are_what_they_say():
    q, p = zone_start(3)
    assert q.shape == p.shape == (10, 2)
    assert p.min() > 0.0
    q, _ = separated_start(3)
    assert min_distance(q) > 2.0
    assert components(10, links(q, 5.0)).max() == 0
    q, p = minimal_start(2, 0)
    assert q.max() < 30.0
    assert p.min() < -0.9
    np.testing.assert_array_equal(minimal_start(2, 7)[0], minimal_start(2, 7)[0])


def test_shares_have_exact_intervals():
    count, size, interval = share([True] * 7 + [False] * 13)
    assert (count, size) == (7, 20)
    assert interval == pytest.approx((beta.ppf(0.025, 7, 14), beta.ppf(0.975, 8, 13)))


def test_a_sample_never_verifies_always_and_refutes_only_what_it_excludes():
    assert always("x", [True] * 50, "it holds", "always").status == "inconclusive"
    assert always("x", [True] * 19 + [False], "it holds", "always").status == "refuted"
    assert mostly("x", [True] * 20, "it holds", "mostly").status == "verified"
    assert mostly("x", [True] * 3, "it holds", "mostly").status == "inconclusive"
    assert mostly("x", [False] * 20, "it holds", "mostly").status == "refuted"
