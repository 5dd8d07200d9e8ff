"""The derived Jacobian blocks: residuals, and the numbers they give against the kernels'."""

import numpy as np
import pytest
import sympy as sp

from flockana import Algorithm1, Algorithm2, Algorithm3, Sphere, StaticTarget, Wall
from flockana.base.errors import ArgumentError
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains
from flockana.symbolic import linearisation as lin
from flockana.symbolic.generic_pair import ADJACENCY, PHI
from flockana.symbolic.obstacles import PHI_BETA, RADIUS, WEIGHT, GenericObstacle
from flockana.symbolic.parameter_symbols import GAINS, AlphaSymbols, BetaSymbols
from flockana.symbolic.scalar_functions import adjacency, bump, phi_alpha, phi_beta
from flockana.symbolic.sigma_norms import EPS

DIMENSIONS = pytest.mark.parametrize("m", [1, 2, 3])
Z = sp.Symbol("Z")


@DIMENSIONS
def test_every_block_of_a_pair_is_the_derivative_of_its_force(m):
    found = lin.derive_pair_jacobian(m)
    assert found.holds
    assert len(found.residuals) == 8 * m * m


@DIMENSIONS
@pytest.mark.parametrize("bounded", [False, True])
def test_every_block_of_the_gamma_agent_is_the_derivative_of_its_pull(m, bounded):
    found = lin.derive_agent_jacobian(m, bounded=bounded)
    assert found.holds
    assert len(found.residuals) == 4 * m * m


@pytest.mark.slow
@DIMENSIONS
@pytest.mark.parametrize("kind", ["wall", "sphere"])
def test_every_block_of_an_obstacle_is_the_derivative_of_its_force(kind, m):
    found = lin.derive_obstacle_jacobian(kind, m)
    assert found.holds
    assert len(found.residuals) == 2 * m * m


def test_a_wrong_turn_of_the_closest_point_is_found_out(monkeypatch):
    monkeypatch.setattr(lin, "turn", lambda obstacle: sp.zeros(obstacle.m, obstacle.m))
    assert not lin.derive_obstacle_jacobian("sphere", 2).holds


def test_bad_dimensions_are_refused():
    with pytest.raises(ArgumentError, match="expected a dimension"):
        lin.derive_agent_jacobian(4)


def numbers(block, functions, values):
    """A derived block with the paper's functions of z and numbers for all symbols."""
    for generic, concrete in functions.items():
        block = block.replace(generic, lambda z, f=concrete: f.subs(Z, z))
    return np.array(block.subs(values).evalf(30).tolist(), dtype=float)


@pytest.mark.parametrize("length", [1.5, 5.0, 7.7])
def test_the_pairs_block_is_what_the_kernels_compute(length):
    """At moving agents, where ρ_h = 1 and on the taper; the two programs share no line."""
    gains, alpha = Gains(c1_alpha=3.0, c2_alpha=2.0), AlphaInteraction(a=1.0, b=5.0)
    symbols = AlphaSymbols(eps=0.1, h=0.2, a=1, b=5, d=7, r=sp.Rational(42, 5))
    q = np.array([[0.3, -0.2], [0.3 + 0.6 * length, -0.2 + 0.8 * length]])
    p = np.array([[1.0, -2.0], [0.5, 3.0]])
    whole = Algorithm1(alpha=alpha, gains=gains).jacobian(0.0, q, p)
    force, weight = phi_alpha(Z, alpha=symbols), adjacency(Z, alpha=symbols)
    functions = {PHI: force, ADJACENCY: weight, lin.PHI_SLOPE: force.diff(Z), lin.ADJACENCY_SLOPE: weight.diff(Z)}
    root = np.sqrt(1.0 + 0.1 * length**2)
    values = {sp.Symbol("z_ij", nonnegative=True): (root - 1.0) / 0.1, lin.ROOT: root, EPS: 0.1}
    values |= {GAINS.c1_alpha: 3.0, GAINS.c2_alpha: 2.0}
    for name, state in (("q", q), ("p", p)):
        for end, agent in zip("ij", state, strict=True):
            values |= {sp.Symbol(f"{name}_{end}{k}", real=True): x for k, x in enumerate(agent.tolist(), start=1)}
    expected = numbers(lin.derive_pair_jacobian(2).result, functions, values)
    np.testing.assert_allclose(np.hstack([whole[4:6, 2:4], whole[4:6, 6:8]]), expected, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("bounded", [False, True])
def test_the_agents_block_is_what_the_kernels_compute(bounded):
    gains, target = Gains(c1_gamma=3.0, c2_gamma=0.7), StaticTarget((1.0, 2.0, 0.5))
    law = Algorithm3(gains=gains, target=target) if bounded else Algorithm2(gains=gains, target=target)
    q = np.array([[0.5, -1.0, 2.0]])
    values = {GAINS.c1_gamma: 3.0, GAINS.c2_gamma: 0.7}
    for name, state in (("q_i", q[0]), ("q_r", np.array(target.q))):
        values |= {sp.Symbol(f"{name}{k}", real=True): x for k, x in enumerate(state.tolist(), start=1)}
    expected = numbers(lin.derive_agent_jacobian(3, bounded=bounded).result, {}, values)
    np.testing.assert_allclose(law.jacobian(0.0, q, 0.0 * q)[3:], expected, rtol=1e-14, atol=1e-15)


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["wall", "sphere"])
@pytest.mark.parametrize("clearance", [1.0, 4.0])
def test_the_obstacles_block_is_what_the_kernels_compute(kind, clearance):
    """Where the bump is 1, and on its taper, from d' times about 0.94 on."""
    gains = Gains(c1_alpha=0.0, c2_alpha=0.0, c1_beta=2.0, c2_beta=0.5, c1_gamma=0.0, c2_gamma=0.0)
    outward, velocity = np.array([0.6, 0.8]), np.array([1.0, -0.3])
    obstacle = Wall((0.0, 0.0), tuple(outward)) if kind == "wall" else Sphere((0.0, 0.0), 2.0)
    x = (clearance + (0.0 if kind == "wall" else 2.0)) * outward
    law = Algorithm3(gains=gains, target=StaticTarget((0.0, 0.0)), obstacles=(obstacle,))
    generic, beta = GenericObstacle(kind, 2), BetaInteraction()
    force = phi_beta(Z, beta=BetaSymbols(eps=beta.eps, h=beta.h, d=beta.d))
    weight = bump(Z / beta.d_beta, h=sp.Float(beta.h))
    functions = {PHI_BETA: force, WEIGHT: weight, lin.PHI_BETA_SLOPE: force.diff(Z), lin.WEIGHT_SLOPE: weight.diff(Z)}
    root = np.sqrt(1.0 + 0.1 * clearance**2)
    values = {generic.z: (root - 1.0) / 0.1, lin.ROOT: root, EPS: 0.1, RADIUS: 2.0}
    values |= {GAINS.c1_beta: 2.0, GAINS.c2_beta: 0.5}
    values |= dict(zip((*generic.x, *generic.p), (*x, *velocity), strict=True))
    if kind == "wall":
        values |= dict(zip(generic.normal, outward, strict=True))
    expected = numbers(lin.derive_obstacle_jacobian(kind, 2).result, functions, values)
    found = law.jacobian(0.0, [x], [velocity])[2:]
    assert np.abs(found).max() > 0.1
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12)
