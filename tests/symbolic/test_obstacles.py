"""Theorem 6 as a theorem of the algebra: envelope, signs, identity, E2, and mutants that must not pass."""

import math
from typing import Any

import pytest
import sympy as sp

from flockana.symbolic import GAINS, algorithm3_energy, generic_pair, obstacles, sigma_norms, sums_over_pairs
from flockana.symbolic.algorithm3_energy import condition_76_residual, e2_counterexample, e2_identity, theorem6_identity
from flockana.symbolic.obstacles import KINDS, GenericObstacle, derive_braking, derive_envelope, sphere_beta, wall_beta
from tests.refused import refused

DIMENSIONS = pytest.mark.parametrize("m", [1, 2, 3])
OBSTACLES = pytest.mark.parametrize("kind", KINDS)


@DIMENSIONS
@OBSTACLES
def test_the_gradient_needs_no_derivative_of_the_foot(kind: str, m: int) -> None:
    derivation = derive_envelope(kind, m)
    assert derivation.holds
    assert len(derivation.residuals) == 3 * m + m * m
    assert derivation.result != sp.zeros(m, m) or m == 1


@DIMENSIONS
@OBSTACLES
def test_outside_an_obstacle_every_term_is_nonpositive(kind: str, m: int) -> None:
    braking = derive_braking(kind, m)
    assert braking.residual == 0
    assert braking.holds


@DIMENSIONS
@OBSTACLES
def test_one_obstacle_leaves_its_braking_and_nothing_else(kind: str, m: int) -> None:
    assert GenericObstacle(kind, m).energy_residual() == 0


@pytest.mark.slow
@pytest.mark.parametrize("moving", [False, True])
@DIMENSIONS
def test_theorem_6_holds_for_generic_n_and_any_obstacles(m: int, moving: bool) -> None:
    identity = theorem6_identity(m, moving=moving)
    assert identity.residual == 0
    assert identity.rate == identity.claimed
    assert identity.rate.has(sums_over_pairs.N)
    assert identity.rate.has(algorithm3_energy.COUNT)


def test_the_closed_form_is_the_printed_one() -> None:
    """m = 1, term by term."""
    i, j, k = sums_over_pairs.I_, sums_over_pairs.J_, sums_over_pairs.K_
    p, p_r, s, q_r = sums_over_pairs.P, *sp.symbols("p_r1 s1 q_r1", real=True)
    consensus = -GAINS.c2_alpha * sums_over_pairs.over_pairs(
        generic_pair.ADJACENCY(sums_over_pairs.Z[i, j]) * (p[i, 1] - p[j, 1]) ** 2
    )
    term = obstacles.WEIGHT(algorithm3_energy.CLEARANCE[i, k]) * algorithm3_energy.BRAKING[i, k]
    walls = GAINS.c2_beta * sp.Sum(term, (k, 1, algorithm3_energy.COUNT), (i, 1, sums_over_pairs.N))
    drag = -GAINS.c2_gamma * (sums_over_pairs.over_agents(p[i, 1] ** 2) - p_r * sums_over_pairs.over_agents(p[i, 1]))
    assert sp.expand(theorem6_identity(1).claimed - consensus - walls - drag) == 0
    moving = theorem6_identity(1, moving=True).claimed.coeff(s)
    x = sums_over_pairs.Q[i, 1] - q_r
    by_hand = sums_over_pairs.over_agents(sp.expand(-GAINS.c1_gamma * x / sp.sqrt(sp.expand(x**2) + 1)))
    assert sp.expand(moving - by_hand) == 0


@DIMENSIONS
def test_condition_76_is_the_sign_of_the_drag(m: int) -> None:
    assert condition_76_residual(m) == 0


@DIMENSIONS
def test_e2_leaves_exactly_the_rate_of_v_alpha(m: int) -> None:
    i, j = sums_over_pairs.I_, sums_over_pairs.J_
    z = sums_over_pairs.Z[i, j]
    relative = [
        (sums_over_pairs.Q[i, k] - sums_over_pairs.Q[j, k]) * (sums_over_pairs.P[i, k] - sums_over_pairs.P[j, k])
        for k in range(1, m + 1)
    ]
    v_rate = GAINS.c1_alpha * generic_pair.PHI(z) / (1 + sigma_norms.EPS * z) * sp.Add(*relative)
    identity = e2_identity(m)
    assert not identity.holds
    assert identity.residual == sums_over_pairs.over_pairs(v_rate)
    assert identity.steps[-1].equation == identity.residual


def test_the_printed_hamiltonian_rises_at_a_rational_state() -> None:
    """By hand: dV/dt of two agents 2 apart that approach at 1/5, less (1/5)² for consensus and for drag."""
    found = e2_counterexample()
    assert all(number.is_Rational for number in (*found.q, *found.p, found.alpha.eps, found.alpha.h, found.alpha.r))
    z, d_alpha = (math.sqrt(1.4) - 1) / 0.1, (math.sqrt(5.9) - 1) / 0.1
    v_rate = 5 * (z - d_alpha) / math.hypot(1, z - d_alpha) * 2 / math.sqrt(1.4) * -0.2
    assert float(found.rate) == pytest.approx(v_rate - 2 * 0.04, rel=1e-14)
    assert found.rate.is_positive
    assert found.true_rate == -sp.Rational(2, 25)


def _no_mu(q: Any, p: Any, centre: Any, radius: Any) -> Any:
    foot, rate = sphere_beta(q, p, centre, radius)
    x = q - centre
    return foot, rate * sp.sqrt(x.dot(x)) / radius


def _static_foot(q: Any, p: Any, point: Any, normal: Any) -> Any:
    return wall_beta(q, p, point, normal)[0], sp.zeros(len(q), 1)


def _oblique(q: Any, p: Any, point: Any, normal: Any) -> Any:
    foot, rate = wall_beta(q, p, point, normal)
    return foot + sp.Matrix([rate[1], *[0] * (len(q) - 1)]).subs(dict(zip(p, q, strict=True))), rate


def test_a_wrong_beta_agent_leaves_a_residual(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obstacles, "sphere_beta", _no_mu)
    assert not derive_envelope("sphere").holds
    assert derive_braking("sphere").residual != 0
    monkeypatch.setattr(obstacles, "wall_beta", _static_foot)
    assert not derive_envelope("wall").holds
    assert derive_braking("wall").residual != 0
    monkeypatch.setattr(obstacles, "wall_beta", _oblique)
    assert not derive_envelope("wall").holds
    assert GenericObstacle("wall", 2).energy_residual() != 0
    assert not theorem6_identity(2).holds


def test_a_wrong_gamma_force_leaves_a_residual(monkeypatch: pytest.MonkeyPatch) -> None:
    def linear(q_i, p_i, q_r, p_r, *, gains=GAINS):  # type: ignore[no-untyped-def]
        return -gains.c1_gamma * (q_i - q_r) - gains.c2_gamma * (p_i - p_r)

    monkeypatch.setattr(algorithm3_energy, "gamma_force", linear)
    assert not theorem6_identity(2).holds


test_bad_arguments_are_named = refused(
    (lambda: derive_envelope("cone"), "unknown kind of obstacle 'cone'"),
    (lambda: theorem6_identity(4), "m = 4: expected a dimension of 1, 2 or 3"),
)
