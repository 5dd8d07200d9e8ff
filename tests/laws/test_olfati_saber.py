"""Algorithms 1 and 2: facts by hand, and what the boundary refuses. Sums against the reference: tests/kernels."""

import numpy as np

from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains, Law, LinearTarget
from flockana.base.natural_scales import Scales
from flockana.laws.discrete import DiscreteLaw, ensure_law
from flockana.laws.gain_laws import alpha_scales
from tests.refused import refused

TWO = Algorithm2(gains=Gains(c1_gamma=2.0, c2_gamma=3.0), target=LinearTarget((10.0, 0.0), (1.0, 0.0)))


test_refusals = refused(
    (lambda: TWO.acceleration(0.0, [[0.0]], [[0.0]]), "the target has 2 components but the agents have 1"),
    (lambda: TWO.energy(np.nan, [[0.0, 0.0]], [[0.0, 0.0]]), "t = nan: expected a finite number"),
    (lambda: TWO.energy_rate(0.0, [[np.inf, 0.0]], [[0.0, 0.0]]), "q[0] = [inf  0.]: expected finite numbers"),
    (lambda: Algorithm1().acceleration(0.0, [0.0], [0.0]), "q has shape (1,): expected (n, m)"),
    (lambda: Algorithm1().structural_energy([[0.0]], [[0.0, 1.0]]), "expected equal shapes"),
    (lambda: Algorithm1().stiffness([[np.nan]]), "q[0] = [nan]: expected finite numbers"),
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
