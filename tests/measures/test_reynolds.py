"""Reynolds' rules: their sum is Algorithm 1, friends by the sign of stress, exact small cases."""

import math

import numpy as np
import pytest

from flockana import Algorithm1, AlphaInteraction, Gains
from flockana.measures.reynolds import reynolds
from tests.refused import refused

ALPHA = AlphaInteraction(d=3.0, r=3.6, eps=0.1, h=0.2, a=4.0, b=5.0)
GAINS = Gains(c1_alpha=2.0, c2_alpha=0.3)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_the_rules_add_up_to_algorithm_1(m: int) -> None:
    rng = np.random.default_rng(m)
    q, p = rng.uniform(0.0, 4.0 * 200 ** (1.0 / m), (200, m)), rng.normal(size=(200, m))
    rules = reynolds(q, p, alpha=ALPHA, gains=GAINS)
    u = Algorithm1(ALPHA, GAINS).acceleration(0.0, q, p)
    np.testing.assert_allclose(rules.total, u, atol=1e-13 * np.abs(u).max())
    assert min(np.abs(part).max() for part in (rules.centring, rules.avoidance, rules.matching)) > 0.05


def test_stress_by_hand() -> None:
    """ε = 3/25 and distance 5: 1 + ε‖x‖² = 4, so ‖x‖_σ = 25/3 and the link bears φ_α/2."""
    alpha = AlphaInteraction(d=4.0, r=6.0, eps=3.0 / 25.0, h=0.9)
    q, p, gains = [[0.0, 0.0], [3.0, 4.0]], [[1.0, 0.0], [0.0, 2.0]], Gains(c1_alpha=1, c2_alpha=1)
    rules = reynolds(q, p, alpha=alpha, gains=gains)
    s = 25.0 / 3.0 - (math.sqrt(1.0 + 0.12 * 16.0) - 1.0) / 0.12
    phi = 5.0 * s / math.hypot(1.0, s)
    assert rules.adjacency.tolist() == [1.0]
    np.testing.assert_allclose(rules.stress, [phi / 2.0], rtol=1e-14)
    np.testing.assert_allclose(rules.centring, [[1.5 * phi, 2.0 * phi], [-1.5 * phi, -2.0 * phi]], rtol=1e-14)
    np.testing.assert_array_equal(rules.avoidance, np.zeros((2, 2)))
    np.testing.assert_array_equal(rules.matching, [[-1.0, 2.0], [1.0, -2.0]])


def test_friends_are_told_by_distance() -> None:
    """From agent 1: one too close, one too far, one out of range."""
    rules = reynolds([[0.0], [2.0], [5.2], [30.0]], np.zeros((4, 1)), alpha=ALPHA, gains=GAINS)
    assert [f.tolist() for f in rules.friends(1)] == [[2], [0], []]
    assert [f.tolist() for f in rules.friends(3)] == [[], [], []]
    assert rules.counts().tolist() == [[0, 1, 0], [1, 1, 0], [1, 0, 0], [0, 0, 0]]
    # centring pulls towards the stress-weighted mean of F⁺, here the one friend
    assert rules.centring[1, 0] == pytest.approx(2.0 * rules.stress[rules.stress > 0.0][0] * 3.2)
    assert rules.avoidance[1, 0] > 0.0


def test_coincident_agents_and_exact_neighbours() -> None:
    """At distance d there is no stress up to rounding; a neutral friend is one with none at all."""
    q = np.array([[0.0, 0.0], [3.0, 0.0], [0.0, 0.0]])
    rules = reynolds(q, np.zeros_like(q), alpha=ALPHA, gains=GAINS)
    by_pair = dict(zip(map(tuple, rules.links.tolist()), rules.stress.tolist(), strict=True))
    assert abs(by_pair[0, 1]) < 1e-14
    assert by_pair[0, 2] < -1.0
    plus, minus, neutral = rules.friends(0)
    assert sorted([*plus, *minus, *neutral]) == [1, 2]
    assert 2 in minus
    np.testing.assert_allclose(rules.total, 0.0, atol=1e-13)


test_bad_input = refused(
    (lambda: reynolds([[0.0], [1.0]], [[0.0], [0.0]]).friends(-1), "agent = -1: expected a whole number, 0 to 1"),
    (lambda: reynolds([[0.0], [1.0]], [[0.0], [0.0]]).friends(2), "agent = 2: expected a whole number, 0 to 1"),
    (lambda: reynolds([[0.0], [1.0]], [[0.0], [0.0]]).friends(True), "expected a whole number, 0 to 1"),
    (lambda: reynolds([[0.0, 1.0]], [[0.0]]), "expected equal shapes"),
)
