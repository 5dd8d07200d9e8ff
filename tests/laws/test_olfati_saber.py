"""Algorithms 1 and 2: facts by hand, and what the boundary refuses. Sums against the reference: tests/kernels."""

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains, Law, LinearTarget, StaticTarget
from flockana.base.scales import Scales
from flockana.laws.discrete import DiscreteLaw, ensure_law
from flockana.laws.gained import alpha_scales
from flockana.measures.frame import moving_frame
from tests.refused import refused

TWO = Algorithm2(gains=Gains(c1_gamma=2.0, c2_gamma=3.0), target=LinearTarget((10.0, 0.0), (1.0, 0.0)))


def test_the_gamma_agent_by_hand():
    """One agent: −2 (q − (12, 0)) − 3 (p − (1, 0)) at t = 2; its own frame holds no energy."""
    u = TWO.acceleration(2.0, [[13.0, 1.0]], [[2.0, 5.0]])
    assert u.tolist() == [[-2.0 - 3.0, -2.0 - 15.0]]
    assert TWO.energy(2.0, [[13.0, 1.0]], [[2.0, 5.0]]) == 0.0
    assert TWO.energy_rate(2.0, [[13.0, 1.0]], [[2.0, 5.0]]) == 0.0


def test_energies_by_hand():
    """Two agents at d = 7: V = 0. K = ½(1 + 1), J = ½·2·3.5²; the frame's own motion counts for Algorithm 1 only."""
    q, p = [[0.0, 0.0], [7.0, 0.0]], [[3.0, 1.0], [3.0, -1.0]]
    one = Algorithm1()
    assert one.energy(0.0, q, p) == pytest.approx(10.0, rel=1e-15)
    assert one.structural_energy(q, p) == pytest.approx(1.0, rel=1e-14)
    assert TWO.energy(0.0, q, p) == pytest.approx(1.0 + 2.0 * 12.25, rel=1e-15)
    assert TWO.structural_energy(q, p) == TWO.energy(5.0, q, p)
    a = one.alpha.adjacency(one.alpha.d_alpha)
    dissipation = Gains().c2_alpha * a * 4.0
    assert one.energy_rate(0.0, q, p) == pytest.approx(-dissipation, rel=1e-15)
    assert TWO.energy_rate(0.0, q, p) == pytest.approx(-dissipation - 3.0 * 2.0, rel=1e-15)


def test_moving_frame():
    assert moving_frame(np.array([[1.0, 0.0], [3.0, 4.0]])).tolist() == [[-1.0, -2.0], [1.0, 2.0]]


test_refusals = refused(
    (lambda: Algorithm1(alpha=3), "alpha = 3: expected AlphaInteraction(...)"),
    (lambda: Algorithm1(gains=(1, 2)), "gains = (1, 2): expected Gains(...)"),
    (lambda: Algorithm2(), "target = None: expected a γ-agent such as StaticTarget((0.0, 0.0))"),
    (lambda: Algorithm2(target=(0.0, 0.0)), "target = (0.0, 0.0): expected a γ-agent"),
    (lambda: Algorithm2(alpha=None, target=StaticTarget((0.0,))), "alpha = None: expected AlphaInteraction(...)"),
    (lambda: TWO.acceleration(0.0, [[0.0]], [[0.0]]), "the target has 2 components but the agents have 1"),
    (lambda: TWO.energy(np.nan, [[0.0, 0.0]], [[0.0, 0.0]]), "t = nan: expected a finite number"),
    (lambda: TWO.energy_rate(0.0, [[np.inf, 0.0]], [[0.0, 0.0]]), "q[0] = [inf  0.]: expected finite numbers"),
    (lambda: Algorithm1().acceleration(0.0, [0.0], [0.0]), "q has shape (1,): expected (n, m)"),
    (lambda: Algorithm1().structural_energy([[0.0]], [[0.0, 1.0]]), "expected equal shapes"),
    (lambda: Algorithm1().stiffness([[np.nan]]), "q[0] = [nan]: expected finite numbers"),
    (lambda: ensure_law("os"), "law = 'os': expected a law such as Algorithm2(target=StaticTarget((0, 0)))"),
    (lambda: ensure_law(Algorithm1), "did you forget the parentheses?"),
    exact=True,
)


def test_a_law_without_energy_says_nan():
    class Drift(Law):
        def flow(self, t, q, p):
            return np.zeros_like(q), float("nan")

    class Map(DiscreteLaw):
        def step(self, t, q, p, memory):
            return q, p, 0 * q, memory

    assert np.isnan(Drift().energy(0.0, [[0.0]], [[0.0]]))
    assert np.isnan(Map().hamiltonian(0.0, np.zeros((1, 1)), np.zeros((1, 1))))
    assert ensure_law(Map()).check_dimension(3) is None
    assert Map().start(np.zeros((1, 1)), np.zeros((1, 1))) == {}


def test_huge_positions_do_not_break_the_law():
    """10²⁰⁰ apart: no force between them, the constant potential of a far pair, no NaN."""
    law = Algorithm1()
    q, p = np.array([[0.0, 0.0], [1e200, -1e200]]), np.ones((2, 2))
    with np.errstate(over="ignore"):
        assert law.acceleration(0.0, q, p).tolist() == [[0.0, 0.0], [0.0, 0.0]]
        assert law.energy(0.0, q, p) == 30.0 * law.alpha.far_potential + 2.0


def test_the_time_of_a_law_is_that_of_its_leading_term():
    assert alpha_scales(AlphaInteraction(d=4.0, r=5.0), Gains(c1_alpha=0.0, c1_gamma=0.25)) == Scales(4.0, 2.0)
