"""Directed nets: the ordinary laws where all see alike, forces by hand where not, and the follower's energy."""

from math import cos, pi, sin

import numpy as np
import pytest
import sympy as sp

from flockana import Algorithm1, Algorithm2, Algorithm3, DirectedNet, LinearTarget, Sphere, simulate
from flockana.base.finite_differences import differences
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains
from tests.refused import refused

UNIT = Gains(c1_alpha=1.0, c2_alpha=1.0)


@pytest.mark.parametrize("m", [1, 2, 3])
def test_with_one_range_all_round_it_is_the_law(m):
    rng = np.random.default_rng(m)
    q, p = rng.uniform(-12.0, 12.0, (30, m)), rng.normal(0.0, 1.0, (30, m))
    target = LinearTarget((0.0,) * m, (1.0,) * m)
    laws = [Algorithm1(), Algorithm2(target=target)]
    if m > 1:
        laws.append(Algorithm3(target=target, beta=BetaInteraction(), obstacles=(Sphere((40.0,) * m, 5.0),)))
    for law in laws:
        u = law.acceleration(1.0, q, p)
        for directed in (DirectedNet(law), DirectedNet(law, 8.4), DirectedNet(law, [8.4] * 30, 2.0 * pi)):
            np.testing.assert_allclose(directed.acceleration(1.0, q, p), u, atol=1e-13 * np.abs(u).max())


def test_each_agent_has_the_bump_of_its_own_range():
    """Two agents 6 apart: each feels the pair law that ends at its own range; one that is too far off, nothing."""
    q, p = np.array([[0.0], [6.0]]), np.array([[0.0], [2.0]])
    u = DirectedNet(Algorithm1(gains=UNIT), (7.5, 20.0)).acceleration(0.0, q, p)[:, 0]
    for k, (r, sign) in enumerate(((7.5, 1.0), (20.0, -1.0))):
        own = AlphaInteraction(r=r)
        z = own.sigma_norm(6.0)
        expected = sign * (own.phi_alpha(z) * 6.0 / np.sqrt(1.0 + 0.1 * 36.0) + 2.0 * own.adjacency(z))
        assert u[k] == pytest.approx(expected, rel=1e-13)
    assert DirectedNet(Algorithm1(), (5.9, 20.0)).acceleration(0.0, q, p)[0, 0] == 0.0


@pytest.mark.parametrize("view", [0.5 * pi, 2.0 * pi / 3.0])
@pytest.mark.parametrize("angle", [0.0, 0.3, 0.7, 0.8, 0.9, 1.04, 1.06, 2.0, pi])
def test_a_cone_fades_as_a_range_does(angle, view):
    """An agent that moves along x, another at an angle from there: ρ_h((1 − cos θ)/(1 − cos ½ view))."""
    alpha, slow = AlphaInteraction(), 1e-3
    law, whole = DirectedNet(Algorithm1(gains=UNIT), view=view, slow=slow), Algorithm1(gains=UNIT)
    q, p = [[0.0, 0.0], [6.0 * cos(angle), 6.0 * sin(angle)]], [[2.0, 0.0], [2.0, 0.0]]
    cone = alpha.bump((1.0 - cos(angle)) / (1.0 - cos(0.5 * view)))
    share = (slow**2 + 4.0 * cone) / (slow**2 + 4.0)
    np.testing.assert_allclose(
        law.acceleration(0.0, q, p)[0], share * whole.acceleration(0.0, q, p)[0], atol=1e-12, rtol=1e-10
    )
    still = [[0.0, 0.0], [0.0, 0.0]]
    np.testing.assert_allclose(law.acceleration(0.0, q, still), whole.acceleration(0.0, q, still), atol=1e-13)


def test_edges_by_hand():
    law = DirectedNet(Algorithm1(), (8.0, 3.0, 8.0), view=pi)
    q, p = [[0.0, 0.0], [5.0, 0.0], [-2.0, 0.0]], [[1.0, 0.0], [1.0, 0.0], [1.0, 0.0]]
    assert law.perceived(q, p) == ((0, 2), (1, 0), (1, 2))  # (j, i): i sees j; agent 1 sees nobody behind it
    measures = simulate(law, q, p, (0.0, 0.1)).metrics()
    assert measures.one_way[0] == 1.0
    assert measures.momentum[0] == pytest.approx(3.0)


def test_the_followers_energy_falls_as_algebra_says():
    """d/dt [c1 ψ(z(x)) + ½ s²], x' = s, s' = −c1 ψ'(z) z'(x) − c2 a s, is −c2 a s²; and along a run."""
    t, c1, c2, a = sp.symbols("t c1 c2 a")
    x, psi = sp.Function("x")(t), sp.Function("psi")
    energy = c1 * psi(x) + x.diff(t) ** 2 / 2
    along = energy.diff(t).subs(x.diff(t, 2), -c1 * psi(x).diff(x) - c2 * a * x.diff(t)).doit()
    assert sp.simplify(along + c2 * a * x.diff(t) ** 2) == 0
    law = DirectedNet(Algorithm1(), (8.4, 3.0))
    run = simulate(law, [[0.0], [6.5]], [[0.5], [1.0]], (0.0, 2.0), t_eval=np.linspace(0.0, 2.0, 401), rtol=1e-11)
    slip, length = run.p[:, 0, 0] - run.p[:, 1, 0], run.q[:, 1, 0] - run.q[:, 0, 0]
    alpha, gains = law.alpha, law.law.gains
    own = gains.c1_alpha * alpha.energy(length) + 0.5 * slip**2
    rate = -gains.c2_alpha * alpha.adjacency(alpha.sigma_norm(length)) * slip**2
    lost = np.trapezoid(rate, run.t)
    assert own[-1] - own[0] == pytest.approx(lost, rel=1e-3)
    np.testing.assert_array_equal(run.p[:, 1, 0], 1.0)


def test_speeds_whose_squares_all_but_vanish_look_round():
    law = DirectedNet(Algorithm1(), view=1.0)
    u = law.acceleration(0.0, [[0.0], [1e-5]], [[1e-160], [1e-160]])
    np.testing.assert_allclose(u, Algorithm1().acceleration(0.0, [[0.0], [1e-5]], np.zeros((2, 1))), rtol=1e-12)


@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("view", [2.0 * pi, 2.5])
def test_the_derivatives_are_those_of_the_input(m, view):
    """By differences of order 6, for moving agents of different ranges whose cones end among their neighbours."""
    rng = np.random.default_rng(m)
    q, p = rng.uniform(-9.0, 9.0, (8, m)), rng.normal(0.0, 1.0, (8, m))
    law = DirectedNet(Algorithm2(target=LinearTarget((0.0,) * m, (1.0,) * m)), rng.uniform(5.0, 12.0, 8), view, 0.5)
    by_position, by_velocity = (part.toarray() for part in law.derivatives(0.0, q, p))
    for exact, found in (
        (by_position, differences(lambda x: law.flow(0.0, x, p)[0], q, 7.0).matrix),
        (by_velocity, differences(lambda v: law.flow(0.0, q, v)[0], p, 1.0).matrix),
    ):  # the bump's second derivative jumps where it begins: differences across that are less exact
        np.testing.assert_allclose(found, exact, atol=1e-7 * np.abs(exact).max())
    assert np.abs(by_position - by_position.T).max() > 0.01 * np.abs(by_position).max()  # action is not reaction


test_refusals = refused(
    (lambda: DirectedNet(3), "law = 3: expected Algorithm1"),
    (lambda: DirectedNet(Algorithm1(), (1.0, -1.0)), r"ranges\[1\] = -1: expected a number > 0"),
    (lambda: DirectedNet(Algorithm1(), ()), r"ranges has shape \(0,\): expected one number"),
    (lambda: DirectedNet(Algorithm1(), ((8.0, 3.0),)), r"ranges has shape \(1, 2\): expected one number"),
    (lambda: DirectedNet(Algorithm1(), view=7.0), "view = 7: expected an angle in radians"),
    (lambda: DirectedNet(Algorithm1(), view=0.0), "view = 0: expected an angle in radians"),
    (lambda: DirectedNet(Algorithm1(), slow=0.0), "slow = 0: expected a number > 0"),
    (
        lambda: DirectedNet(Algorithm1(), (1.0, 2.0)).acceleration(0.0, [[0.0]], [[0.0]]),
        "2 ranges and 1 agents: expected one range each",
    ),
)
