"""Equilibria against force balances solved by hand, known indices, and the ways to fail."""

import signal

import casadi
import numpy as np
import pytest
from scipy.optimize import brentq

from flockana import Algorithm1, Algorithm2, Algorithm3, DeadZoneFlocking, Sphere, Wall, find_equilibrium
from flockana.base.errors import ArgumentError, SolverError, UnknownNameError
from flockana.environment.targets import LinearTarget, StaticTarget
from flockana.equilibria import solve as solve_module
from flockana.equilibria.ipopt_program import Program
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import finish
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_patch, hexagonal_spiral
from flockana.sources.li_dead_zone import DeadZoneInteraction

ALPHA = AlphaInteraction()


def stress(s: float) -> float:
    """φ_α(‖s‖_σ)/√(1 + εs²), from the scalar functions."""
    return float(ALPHA.phi_alpha(ALPHA.sigma_norm(s))) / np.sqrt(1.0 + ALPHA.eps * s * s)


def test_two_agents_under_algorithm_2_sit_where_the_pull_balances_the_push():
    gains = Gains()
    law = Algorithm2(target=StaticTarget((3.0, -1.0)))
    found = find_equilibrium(law, [[0.0, 0.0], [6.0, 1.0]])
    # each agent is s/2 from the γ-agent: c1α w(s) s + c1γ s/2 = 0
    spacing = brentq(lambda s: gains.c1_alpha * stress(s) + 0.5 * gains.c1_gamma, 6.0, 7.0, xtol=1e-13)
    assert np.linalg.norm(found.q[1] - found.q[0]) == pytest.approx(spacing, abs=1e-9)
    np.testing.assert_allclose(found.q.mean(axis=0), [3.0, -1.0], atol=1e-12)
    assert (found.kind, found.rigid_modes, found.zero_modes, found.success) == ("minimum", 3, 0, True)
    assert np.abs(law.acceleration(0.0, found.q, np.zeros((2, 2)))).max() < 1e-9 * 474.0
    expected = 30.0 * ALPHA.psi_alpha(ALPHA.sigma_norm(spacing)) + 1.1 * 0.25 * spacing**2
    assert found.energy == pytest.approx(expected, rel=1e-12)


def test_two_agents_at_one_place_are_a_maximum_on_a_line_and_in_the_plane():
    for m in (1, 2):
        found = find_equilibrium(Algorithm1(), np.zeros((2, m)), method="root")
        assert (found.kind, found.index, found.rigid_modes) == ("maximum", m, m)
        np.testing.assert_allclose(found.hessian_eigenvalues, 60.0 * ALPHA.phi_alpha(0.0), rtol=1e-12)


def test_a_doubled_end_of_a_link_is_a_saddle_of_index_one_and_a_doubled_corner_of_a_triangle_too():
    """The coincident pair splits along φ_α(0) < 0, which a link stiffens by ψ'' = φ' s²/(1 + εs²) along itself."""
    stiff = float(ALPHA.phi_alpha_slope(ALPHA.d_alpha)) * 49.0 / 5.9
    split = 2.0 * float(ALPHA.phi_alpha(0.0))
    found = find_equilibrium(Algorithm1(), [[0.0], [0.0], [7.0]], method="root")
    assert (found.kind, found.index) == ("saddle", 1)
    assert found.hessian_eigenvalues[0] == pytest.approx(30.0 * (split + stiff), rel=1e-9)
    triangle = hexagonal_spiral(3, 7.0)
    found = find_equilibrium(Algorithm1(), np.vstack([triangle, triangle[:1]]), method="root")
    assert (found.kind, found.index) == ("saddle", 1 + (split + 1.5 * stiff < 0.0))
    assert found.hessian_eigenvalues[0] == pytest.approx(30.0 * (split + 0.5 * stiff), rel=1e-9)


@pytest.mark.parametrize(("m", "rigid"), [(1, 1), (2, 3), (3, 6)])
def test_a_simplex_is_a_minimum_in_every_dimension(m, rigid):
    corners = np.linalg.svd(np.eye(m + 1) - 1.0 / (m + 1))[0][:, :m]  # of a regular simplex of edge √2
    found = find_equilibrium(Algorithm1(), 6.5 / np.sqrt(2.0) * corners)
    assert (found.kind, found.rigid_modes, found.strain()) == ("minimum", rigid, 0.0)
    assert len(found.links) == m * (m + 1) // 2


def test_a_hinge_and_a_drifting_component_are_soft_modes_and_not_rigid_ones():
    chain = find_equilibrium(Algorithm1(), [[-7.2, 0.1], [0.0, 0.0], [6.9, 0.0]])
    assert (chain.kind, chain.rigid_modes, chain.zero_modes) == ("degenerate", 3, 1)
    apart = find_equilibrium(Algorithm1(), [[0.0, 0.0], [7.1, 0.0], [50.0, 0.0]])
    assert (apart.kind, apart.zero_modes) == ("degenerate", 2)
    nothing = find_equilibrium(Algorithm1(), [[0.0, 0.0], [20.0, 0.0], [50.0, 9.0]])
    assert (nothing.kind, nothing.zero_modes, len(nothing.links)) == ("degenerate", 3, 0)


def test_an_agent_between_a_wall_and_the_target_rests_where_the_forces_cancel():
    law = Algorithm3(target=StaticTarget((0.0, -5.0)), obstacles=(Wall((0.0, 0.0), (0.0, 1.0)),))
    found = find_equilibrium(law, [[0.3, 2.0]])

    def balance(y: float) -> float:
        z = law.beta.d_beta if y >= 4.2 else (np.sqrt(1.0 + 0.1 * y * y) - 1.0) / 0.1
        push = -1500.0 * float(law.beta.phi_beta(z)) * y / np.sqrt(1.0 + 0.1 * y * y)
        return push - 1.1 * (y + 5.0) / np.sqrt(1.0 + (y + 5.0) ** 2)

    height = brentq(balance, 1.0, 4.2, xtol=1e-14)
    np.testing.assert_allclose(found.q, [[0.0, height]], atol=1e-9)
    assert (found.kind, found.rigid_modes) == ("minimum", 0)


def test_what_algorithm_3_leaves_free_is_the_rotation_that_moves_no_obstacle():
    q = np.random.default_rng(0).uniform(5.0, 9.0, (4, 3))
    target, on_axis = StaticTarget((0.0, 0.0, 0.0)), Sphere((0.0, 0.0, 30.0), 1.0)
    for obstacles, rigid in (((), 3), ((on_axis,), 1), ((on_axis, Sphere((30.0, 0.0, 0.0), 1.0)), 0)):
        potential = Potential(Algorithm3(target=target, obstacles=obstacles))
        basis = potential.symmetries(q)
        assert basis.shape[1] == rigid
        assert np.abs(basis.T @ potential.force(q).ravel()).max(initial=0.0) < 1e-11
    off = Potential(Algorithm3(target=target, obstacles=(Wall((0.0, 0.0, -9.0), (0.0, 0.0, 1.0)),)))
    assert off.symmetries(q).shape[1] == 1


def test_a_moving_target_is_taken_at_its_time_and_its_velocity_does_not_push():
    law = Algorithm3(target=LinearTarget((0.0, 0.0), (2.0, 1.0)))
    found = find_equilibrium(law, [[1.0, 2.0]], t=3.0)
    np.testing.assert_allclose(found.q, [[6.0, 3.0]], atol=1e-9)


def test_the_pair_list_is_checked_again_and_renewed(monkeypatch):
    listed = []

    class Counted(Program):
        def __init__(self, potential, shape, pairs, gauge):
            listed.append(len(pairs))
            super().__init__(potential, shape, pairs, gauge)

    monkeypatch.setattr("flockana.equilibria.ipopt_program.Program", Counted)
    monkeypatch.setattr(solve_module, "ALL_PAIRS", 2)
    law = Algorithm2(target=StaticTarget((0.0,)), gains=Gains(c1_gamma=0.5))
    start = np.array([[-20.0], [0.0], [20.0], [40.0]])  # nothing is in range until the target has pulled them in
    found = find_equilibrium(law, start)
    assert len(listed) >= 2
    assert listed[0] == 0
    assert len(found.links) == 3
    assert found.residual < 1e-12


def test_failures_are_clear():
    start = hexagonal_patch(1, 7.0) + np.random.default_rng(0).standard_normal((7, 2))
    with pytest.raises(SolverError, match="Maximum_Iterations_Exceeded"):
        find_equilibrium(Algorithm1(), start, max_iter=1)
    kept = find_equilibrium(Algorithm1(), start, max_iter=1, strict=False)
    assert (kept.success, kept.message) == (False, "Maximum_Iterations_Exceeded")
    with pytest.raises(SolverError, match="residual force"):
        finish(Potential(Algorithm1()), np.array([[0.0], [6.0]]), True, "claimed")
    with pytest.raises(UnknownNameError, match="did you mean 'root'"):
        find_equilibrium(Algorithm1(), start, method="roots")
    with pytest.raises(
        ArgumentError, match="expected a sum of a pair term and others whose forces are gradients, such"
    ):
        find_equilibrium("Algorithm1", start)
    for method, most in (("minimise", 60_000), ("descent", 60_000), ("ipopt", 6000), ("root", 6000)):
        with pytest.raises(ArgumentError, match=f"expected n m <= {most}"):
            find_equilibrium(Algorithm1(), np.zeros((most // 2 + 1, 2)), method=method)
    inside = Algorithm3(target=StaticTarget((9.0, 0.0)), obstacles=(Sphere((0.0, 0.0), 2.0),))
    with pytest.raises(ArgumentError, match="starts inside"):
        find_equilibrium(inside, [[0.5, 0.0]])


def test_ctrl_c_stops_the_solver_where_it_is(answering, monkeypatch):
    """CasADi would take it for an evaluation that failed, or lose it."""
    start, value, evaluations = 1.3 * hexagonal_patch(2, 7.0), Program.value, []

    def counted(self, x):
        evaluations.append(x)
        if len(evaluations) == 2:
            signal.raise_signal(signal.SIGINT)
        return value(self, x)

    monkeypatch.setattr(Program, "value", counted)
    with pytest.raises(KeyboardInterrupt):
        find_equilibrium(Algorithm1(), start)
    stopped = len(evaluations)
    find_equilibrium(Algorithm1(), start)
    assert 2 * stopped <= len(evaluations) - stopped


def test_ctrl_c_while_a_program_is_made_comes_when_it_is_made(answering, monkeypatch):
    """The signal comes with the first function that CasADi makes; what follows it is still made."""
    function, made = casadi.Function, []

    def interrupted(name, *arguments):
        if not made:
            signal.raise_signal(signal.SIGINT)
        made.append(name)
        return function(name, *arguments)

    monkeypatch.setattr(casadi, "Function", interrupted)
    with pytest.raises(KeyboardInterrupt):
        find_equilibrium(Algorithm1(), [[0.0], [6.0]])
    assert made[-2:] == ["grad_f", "hess_lag"]


def test_two_agents_rest_where_repulsion_and_the_pull_balance():
    pair = DeadZoneInteraction()
    found = find_equilibrium(DeadZoneFlocking(pair), [[0.0, 0.0], [6.0, 1.0]])
    assert np.linalg.norm(found.q[1] - found.q[0]) == pytest.approx(brentq(pair.force, 3.25, 3.5), abs=1e-10)
    assert (found.kind, found.rigid_modes) == ("minimum", 3)


def test_strain_is_that_of_contacts():
    """Three on a line: the ends attract, out of contact 7 apart, and have no length that they are held at."""
    line = find_equilibrium(DeadZoneFlocking(), [[0.0], [3.4], [6.8]])
    contact = line.q[1, 0] - line.q[0, 0]
    assert len(line.links) == 3
    assert line.strain() == pytest.approx((3.5 - contact) / 3.5, rel=1e-9)
    assert 0.0 < line.strain() < 1e-3
    # without k1 nothing draws two agents within the dead zone to contact: there is no strain to tell of
    loose = find_equilibrium(DeadZoneFlocking(DeadZoneInteraction(k1=0.0)), [[0.0, 0.0], [8.0, 0.0]])
    assert (len(loose.links), np.isnan(loose.strain())) == (1, True)
