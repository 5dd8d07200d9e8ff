"""The generated CasADi expressions against the kernels and against differences: two independent writings of one law."""

import casadi as ca
import numpy as np
import pytest
import sympy as sp

from flockana import Algorithm1, Algorithm2, Algorithm3, Capsule, Sphere, StaticTarget, Wall
from flockana.base.errors import ArgumentError
from flockana.environment.beta import ObstacleField
from flockana.equilibria import program as program_module
from flockana.equilibria.potential import Potential
from flockana.equilibria.program import Program
from flockana.equilibria.solve import all_pairs
from flockana.equilibria.terms import obstacle_term, pair_term
from flockana.equilibria.translate import to_casadi
from flockana.interactions import AlphaInteraction, BetaInteraction, DeadZoneInteraction

SETS = (
    AlphaInteraction(),
    AlphaInteraction(1.9, 2.8, 0.1, 0.4, 7.0, 9.0),
    AlphaInteraction(1.7, 2.5, 0.01, 0.9, 7.0, 15.0),
)


@pytest.mark.parametrize("alpha", SETS)
@pytest.mark.parametrize("m", [1, 2, 3])
def test_the_pair_term_is_the_kernels_force_and_hessian(alpha, m):
    term, rng = pair_term(alpha, m), np.random.default_rng(m)
    lengths = np.concatenate([rng.uniform(0.0, 1.1 * alpha.r, 40), [0.0, alpha.d, 0.999999 * alpha.r]])
    for length in lengths:
        direction = rng.standard_normal(m)
        delta = length * direction / np.linalg.norm(direction)
        pair = np.array([np.zeros(m), delta])
        gradient, hessian = (np.array(part) for part in term(delta))
        force = alpha.forces(pair, 0.0 * pair, stiffness=1.0, damping=0.0)[0][0]
        np.testing.assert_allclose(gradient.ravel(), force, rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(hessian, alpha.hessian(pair).toarray()[:m, :m], rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("obstacle", [Sphere((1.0, 2.0, 0.5), 2.0), Wall((0.0, 0.0, 1.0), (1.0, 2.0, 0.3))])
def test_the_obstacle_term_is_the_kernels_force_and_hessian(obstacle):
    term, field, near = obstacle_term(obstacle, BetaInteraction()), ObstacleField((obstacle,), BetaInteraction()), 0
    for q in np.random.default_rng(0).uniform(-6.0, 8.0, (300, 1, 3)):
        if obstacle.contains(q)[0]:
            continue
        force = np.zeros_like(q)
        field.forces(q, 0.0 * q, force, stiffness=1.0, damping=0.0)
        gradient, hessian = (np.array(part) for part in term(q[0]))
        np.testing.assert_allclose(gradient.ravel(), -force[0], rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(hessian, field.hessian_blocks(q)[0], rtol=0.0, atol=1e-11)
        near += bool(force.any())
    assert near > 30


LAWS = (
    (Algorithm1(), 2),
    (Algorithm2(target=StaticTarget((1.0, 2.0, 3.0))), 3),
    (
        Algorithm3(
            target=StaticTarget((10.0, 2.0)), obstacles=(Sphere((-3.0, 0.0), 2.0), Wall((0.0, -2.0), (0.0, 1.0)))
        ),
        2,
    ),
)


@pytest.mark.parametrize(("law", "m"), LAWS)
def test_the_assembled_program_is_the_laws_force_stiffness_and_energy(law, m):
    q = np.random.default_rng(3).uniform(0.2, 14.0, (9, m))
    potential, d = Potential(law), law.alpha.d
    program = Program(potential, q.shape, all_pairs(9), potential.symmetries(q).shape[1])
    gradient, hessian = program.derivatives(q.ravel() / d)
    scale = potential.force_scale
    np.testing.assert_allclose(np.array(gradient).ravel(), -potential.force(q).ravel() / scale, rtol=0, atol=1e-13)
    full = np.array(ca.triu2symm(hessian))
    if isinstance(law, Algorithm2):  # J about a held centre: the difference is the motion of the centre
        free = np.eye(q.size) - np.kron(np.ones((9, 9)) / 9, np.eye(m))
        full, stiffness = free @ full @ free, free @ potential.stiffness(q).toarray() @ free
    else:
        stiffness = potential.stiffness(q).toarray()
    np.testing.assert_allclose(full, stiffness * d / scale, rtol=0.0, atol=1e-12)
    step = 1e-6
    for k in range(0, q.size, 4):  # the value is the kernels', the gradient sympy's
        nudge = np.zeros(q.size)
        nudge[k] = step
        slope = (program.value(q.ravel() / d + nudge) - program.value(q.ravel() / d - nudge)) / (2.0 * step)
        assert slope == pytest.approx(float(gradient[k]), abs=1e-8)


def test_translation_knows_its_nodes_and_refuses_others():
    x, symbol = ca.SX.sym("x"), sp.Symbol("x")
    expression = sp.Piecewise((symbol**3, symbol < 1), (sp.cos(symbol) / sp.sqrt(symbol), symbol <= 2), (sp.pi, True))
    f = ca.Function("f", [x], [to_casadi(expression, {symbol: x})])
    assert float(f(0.5)) == 0.125
    assert float(f(2.0)) == pytest.approx(np.cos(2.0) / np.sqrt(2.0), rel=1e-15)
    assert float(f(3.0)) == np.pi
    with pytest.raises(ArgumentError, match="expected elementary functions"):
        to_casadi(sp.gamma(symbol), {symbol: x})
    with pytest.raises(ArgumentError, match="last branch"):
        to_casadi(sp.Piecewise((symbol, symbol < 1)), {symbol: x})


def test_an_obstacle_without_symbolic_closest_point_is_refused():
    with pytest.raises(ArgumentError, match="expected spheres and walls"):
        obstacle_term(Capsule((0.0, 0.0), (4.0, 0.0), 1.0), BetaInteraction())


@pytest.mark.parametrize("name", ["1", "2", "3"])
def test_derivatives_by_the_kernels_are_those_by_the_formulas(name, monkeypatch):
    """What IPOPT is handed for a pair law of one's own, on laws of which both are known."""
    target = StaticTarget((3.0, 1.0))
    law = {
        "1": Algorithm1(),
        "2": Algorithm2(target=target),
        "3": Algorithm3(target=target, obstacles=(Sphere((9.0, 0.0), 2.0), Wall((0.0, -6.0), (0.0, 1.0)))),
    }[name]
    q = np.array([[0.0, 0.0], [6.0, 1.5], [1.0, 5.0], [5.5, -4.0]])
    given = (Potential(law), q.shape, all_pairs(len(q)), 1)
    by_formula = Program(*given)
    monkeypatch.setattr(program_module, "has_form", lambda pair, others: False)
    by_kernels = Program(*given)
    x = q.ravel() / 7.0
    for ours, formula in zip(by_kernels.derivatives(x), by_formula.derivatives(x), strict=True):
        theirs = np.array(formula)
        if name == "2" and theirs.shape[1] == 1:  # the pull of the centre is the gauge's to take out
            theirs = theirs - np.tile(theirs.reshape(q.shape).mean(axis=0), len(q))[:, None]
        np.testing.assert_allclose(np.array(ours), theirs, rtol=1e-9, atol=1e-9 * np.abs(theirs).max())


@pytest.mark.parametrize("s", [0.5, 3.3, 3.4, 8.0, 12.6, 14.0, 16.0])
def test_the_generated_gradient_and_hessian_are_those_of_the_kernels(s):
    pair = DeadZoneInteraction(k1=0.03)
    delta = s * np.array([0.6, 0.8])
    gradient, hessian = (np.array(part) for part in pair_term(pair, 2)(delta))
    assert gradient.ravel() == pytest.approx(pair.force(s) * np.array([0.6, 0.8]), rel=1e-12, abs=1e-13)
    block = pair.hessian(np.array([[0.0, 0.0], delta])).toarray()[2:, 2:]
    assert hessian == pytest.approx(block, rel=1e-11, abs=1e-11 * np.abs(block).max() + 1e-13)


def test_a_pair_law_without_symbols_is_refused():
    with pytest.raises(ArgumentError, match="no other has a symbolic form"):
        pair_term(BetaInteraction(), 2)
