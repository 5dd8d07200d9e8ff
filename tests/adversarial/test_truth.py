"""The oracles themselves, against published numbers and against each other: a wrong truth would prove anything."""

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains, StaticTarget
from tests.adversarial import truth
from tests.reference.values import ALPHA

FREE = Algorithm2(AlphaInteraction(), Gains(0.0, 0.0, 0.0, 0.0, 2.0, 0.0), StaticTarget((0.0, 0.0)))


@pytest.mark.parametrize(("par", "values"), ALPHA.items())
def test_potentials(par, values):
    alpha = AlphaInteraction(*par)
    assert float(truth.psi_alpha(0.0, alpha)) == pytest.approx(values[3], rel=1e-14)
    assert float(truth.far(alpha)) == pytest.approx(values[4], rel=1e-14)


def test_the_force_is_the_slope_of_the_potential():
    alpha = AlphaInteraction(1.9, 2.8, 0.1, 0.4, 7.0, 9.0, unit=0.5)
    for s in (0.3, 1.0, 1.7, 2.4):
        slope = (truth.psi_alpha(s + 1e-5, alpha) - truth.psi_alpha(s - 1e-5, alpha)) / 2e-5
        assert float(slope) == pytest.approx(truth.pull(s, alpha), rel=1e-7)


def test_the_reduced_problem_is_the_whole_one():
    law = Algorithm1(gains=Gains(c1_alpha=1.0, c2_alpha=0.05))
    s0 = 7.0
    for share, meet in ((1.5, True), (1.01, False)):
        speed = 2.0 * np.sqrt(share * float(truth.c_star(law)))
        q, p = [[0.0], [s0]], [[0.5 * speed], [-0.5 * speed]]
        when = truth.head_on(law, s0, speed, 6.0)
        assert (when is not None) is meet
        whole = truth.motion(law, q, p, 6.0)
        assert bool(whole.crossings()) is meet
        if meet:
            k = int(np.argmax(whole.x[:, 1, 0] < whole.x[:, 0, 0]))
            assert whole.t[k - 1] <= when <= whole.t[k]


def test_without_damping_the_reference_keeps_its_energy():
    law = Algorithm1(gains=Gains(c1_alpha=1.0, c2_alpha=0.0))
    q, p = np.array([[0.0, 0.0], [6.0, 1.0], [3.0, 7.0]]), np.array([[1.0, 0.0], [0.0, -1.0], [0.5, 0.2]])
    end = truth.motion(law, q, p, 5.0)
    before, after = (truth.structural_energy(law, end.x[k], end.v[k]) for k in (0, -1))
    assert float(after / before) == pytest.approx(1.0, abs=1e-10)


@pytest.mark.parametrize("drag", [0.0, 1.0, 2.0 * np.sqrt(2.0), 9.0])
def test_springs(drag):
    law = Algorithm2(FREE.alpha, Gains(0.0, 0.0, 0.0, 0.0, 2.0, drag), FREE.target)
    q, p = np.array([[1.0, 0.0], [0.0, 2.0]]), np.array([[0.0, 1.0], [3.0, 0.0]])
    times = np.linspace(0.0, 4.0, 50)
    x, v = truth.harmonic(law, q, p, times)
    np.testing.assert_allclose(x[0], q - q.mean(axis=0))
    np.testing.assert_allclose(v[0], p - p.mean(axis=0), atol=1e-14)
    far = truth.motion(law, q, p, 4.0)
    np.testing.assert_allclose(x[-1], far.x[-1], atol=1e-8)
    np.testing.assert_allclose(v[-1], far.v[-1], atol=1e-8)


def test_a_balanced_pair_has_no_force():
    law = Algorithm2(AlphaInteraction(), Gains(1.0, 2.0, 0.0, 0.0, 0.1, 1.0), StaticTarget((0.0,)))
    s = truth.balanced_length(law)
    assert s < 7.0
    u = truth.structural(law, np.array([[-0.5 * s], [0.5 * s]]), np.zeros((2, 1)))
    assert np.abs(u).max() < 1e-12
    spring, damping = truth.pair_rates(law, s)
    assert spring > 0.0 < damping
    assert truth.decay_rate(2.0, 3.0) == pytest.approx(1.0)


def test_integer_lattices():
    hexagon = [(0, 0), (1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1)]
    assert len(truth.lattice_links(hexagon)) == 12 == truth.harborth(7)
    assert [truth.harborth(n) for n in range(1, 13)] == [0, 1, 3, 5, 7, 9, 12, 14, 16, 19, 21, 24]
    square = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]
    assert truth.crossing_count(square, [(0, 1), (2, 3), (0, 2)]) == 1
    assert truth.filter_gain(70.0, 2 * np.sqrt(70.0), 3.490658503988659) == pytest.approx(1.109, abs=1e-3)
