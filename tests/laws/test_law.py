"""The analytic Jacobians against complex steps of independent formulas, and against differences of the laws."""

from dataclasses import dataclass

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Algorithm3, Capsule, Law, LinearTarget, Polygon, StaticTarget
from flockana.base.errors import ArgumentError
from flockana.environment.obstacles import Sphere, Wall, _onto_sphere
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains
from flockana.interactions.alpha import kernel
from flockana.kernels.obstacles import lift_obstacle
from flockana.kernels.pair_kernels import lift
from flockana.sources.notebook_r2.laws import PushedAlgorithm1
from tests.refused import refused

N = 9
PER_AGENT = Gains(c1_gamma=np.linspace(0.5, 2.0, N), c2_gamma=np.linspace(3.0, 1.0, N))
WIDE = AlphaInteraction(a=1.0, b=5.0, h=0.9)
STEP = 1e-30  # of a complex step: no difference is taken, so there is nothing to cancel


def sigma(s2, eps):
    return (np.sqrt(1.0 + eps * s2) - 1.0) / eps


def bump(z, h):
    if z.real < h:
        return 1.0 + 0.0 * z
    return 0.5 * (1.0 + np.cos(np.pi * (z - h) / (1.0 - h))) if z.real < 1.0 else 0.0 * z


def reference(law, t, q, p):
    """u by the formulas, agent by agent; analytic in its arguments, which may be complex."""
    u = np.zeros(q.shape, complex)
    pair, g, n = law.alpha, law.gains, len(q)
    for i in range(n):
        for j in range(n):
            delta = q[j] - q[i]
            s2 = delta @ delta
            if i == j or s2.real >= pair.r**2:
                continue
            z = sigma(s2, pair.eps)
            rho, s = bump(z / pair.r_alpha, pair.h), z - pair.d_alpha + pair.c
            phi = 0.5 * ((pair.a + pair.b) * s / np.sqrt(1.0 + s * s) + pair.a - pair.b)
            u[i] += g.c1_alpha * rho * phi * delta / np.sqrt(1.0 + pair.eps * s2) + g.c2_alpha * rho * (p[j] - p[i])
    if isinstance(law, Algorithm1):
        return u
    q_r, p_r = law.target.state(t)
    x = q - q_r
    if isinstance(law, Algorithm3):
        for obstacle in law.obstacles:
            for i in range(n):
                u[i] += obstacle_force(law, obstacle, q[i], p[i])
        x = x / np.sqrt(1.0 + np.sum(x * x, axis=1))[:, None]
    c1, c2 = (np.broadcast_to(gain, n)[:, None] for gain in (g.c1_gamma, g.c2_gamma))
    return u - c1 * x - c2 * (p - p_r)


def obstacle_force(law, obstacle, q, p):
    beta, g = law.beta, law.gains
    if isinstance(obstacle, Wall):
        y, a = np.array(obstacle.point), np.array(obstacle.normal) / np.linalg.norm(obstacle.normal)
        foot, rate = q - (a @ (q - y)) * a, p - (a @ p) * a
    else:
        y = np.array(obstacle.centre)
        rho = np.sqrt((q - y) @ (q - y))
        mu, a = obstacle.radius / rho, (q - y) / rho
        foot, rate = mu * q + (1.0 - mu) * y, mu * (p - (a @ p) * a)
    gap = foot - q
    s2 = gap @ gap
    if s2.real >= beta.r**2:
        return 0.0 * q
    z = sigma(s2, beta.eps)
    b, s = bump(z / beta.d_beta, beta.h), z - beta.d_beta
    phi = b * (s / np.sqrt(1.0 + s * s) - 1.0)
    return g.c1_beta * phi * gap / np.sqrt(1.0 + beta.eps * s2) + g.c2_beta * b * (rate - p)


def by_complex_step(law, t, q, p):
    n = q.size
    columns = []
    for k in range(2 * n):
        z = np.concatenate([q.ravel(), p.ravel()]).astype(complex)
        z[k] += 1j * STEP
        columns.append(reference(law, t, z[:n].reshape(q.shape), z[n:].reshape(q.shape)).imag.ravel() / STEP)
    return np.array(columns).T


def laws(m):
    target = LinearTarget((3.0,) * m, (1.0,) * m)
    obstacles = (Sphere((6.0, *(0.5,) * (m - 1)), 1.5), Wall((0.0,) * m, (0.3, *(1.0,) * (m - 1))))
    beta = BetaInteraction(h=0.3)
    return {
        "Algorithm 1": Algorithm1(alpha=WIDE),
        "Algorithm 2": Algorithm2(target=target),
        "per agent": Algorithm2(target=target, gains=PER_AGENT),
        "Algorithm 3": Algorithm3(target=target, obstacles=obstacles, beta=beta),
        "Algorithm 3 per agent": Algorithm3(target=target, obstacles=obstacles, beta=beta, gains=PER_AGENT),
    }


@pytest.mark.slow
@pytest.mark.parametrize("m", [1, 2, 3])
@pytest.mark.parametrize("name", laws(1))
def test_the_jacobian_is_the_complex_step_derivative(name, m):
    """Moving agents at random, pairs and obstacles inside and before the tapers."""
    law = laws(m)[name]
    for seed in range(3):
        rng = np.random.default_rng(seed)
        q, p = rng.uniform(0.2, 6.0 + 4.0 / m, (N, m)), 3.0 * rng.standard_normal((N, m))
        found = law.jacobian(0.3, q, p)
        size = q.size
        expected = by_complex_step(law, 0.3, q, p)
        np.testing.assert_allclose(law.acceleration(0.3, q, p), reference(law, 0.3, q, p).real, rtol=1e-10, atol=1e-9)
        scale = np.abs(expected).max()
        np.testing.assert_allclose(found[size:], expected, rtol=0.0, atol=1e-12 * scale)  # asked for: 1e-9
        np.testing.assert_array_equal(found[:size], np.hstack([np.zeros((size, size)), np.eye(size)]))
        if "Algorithm 3" in name:
            near = law.obstacle_field.links(q, p)
            assert near.agent.size
            assert np.abs(law.obstacle_field.braking_blocks(q, p)[0]).max() > 0.0


@pytest.mark.slow
@pytest.mark.parametrize(
    "obstacle",
    [
        Capsule((2.0, 4.0), (6.0, 1.0), 1.0),
        Capsule((2.0, 4.0, 1.0), (6.0, 1.0, 2.0), 1.0),
        Polygon([(3.0, 3.0), (6.0, 2.0), (7.0, 6.0)]),
    ],
)
def test_bars_and_polygons_have_derivatives_too(obstacle):
    """Against differences of fourth order, good to about 1e-9 here; straight parts, caps, edges and corners."""
    m, h = obstacle.dimension, 1e-3
    law = Algorithm3(target=StaticTarget((0.0,) * m), obstacles=(obstacle,))
    rng, used = np.random.default_rng(0), 0
    while used < 20:
        q, p = rng.uniform(-2.0, 10.0, (1, m)), rng.standard_normal((1, m))
        if not 0.1 < obstacle.clearance(q)[0] < 3.9:
            continue
        used += 1
        for along in np.eye(m):
            u = [law.acceleration(0.0, q + k * h * along, p)[0] for k in (-2, -1, 1, 2)]
            expected = (u[0] - 8.0 * u[1] + 8.0 * u[2] - u[3]) / (12.0 * h)
            found = law.jacobian(0.0, q, p)[m:, :m] @ along
            np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-5)


def test_sparse_and_dense_are_the_same_and_at_rest_it_is_minus_the_stiffness():
    rng = np.random.default_rng(1)
    q = rng.uniform(0.0, 15.0, (20, 2))
    law = Algorithm2(target=StaticTarget((3.0, 4.0)))
    sparse = law.jacobian(0.0, q, 0.0 * q, sparse=True)
    np.testing.assert_array_equal(sparse.toarray(), law.jacobian(0.0, q, 0.0 * q))
    np.testing.assert_allclose(sparse[40:, :40].toarray(), -law.stiffness(q).toarray(), rtol=0.0, atol=1e-12)
    damping = law.gains.c2_alpha * law.alpha.laplacian(q).toarray() + law.gains.c2_gamma * np.eye(40)
    np.testing.assert_allclose(sparse[40:, 40:].toarray(), -damping, rtol=0.0, atol=1e-12)


def test_coincident_agents_have_a_jacobian_for_the_sigma_norm_is_smooth():
    q, p = np.zeros((2, 2)), np.array([[0.0, 0.0], [1.0, 0.0]])
    law = Algorithm1(gains=Gains(c1_alpha=1.0, c2_alpha=2.0))
    found = law.jacobian(0.0, q, p)
    stress = law.alpha.phi_alpha(0.0)  # φ_α(0)/√(1 + 0) < 0 pushes apart
    np.testing.assert_allclose(found[4:6, 2:4], stress * np.eye(2), rtol=1e-14)
    np.testing.assert_allclose(found[4:6, 6:8], 2.0 * np.eye(2), rtol=1e-14)


@dataclass(frozen=True)
class Bare(AlphaInteraction):
    """A pair law that does not tell how its adjacency falls."""

    kernels = lift(kernel.pair_alpha, kernel.pair_alpha_slope, kernel.pair_alpha_potential)


def test_a_pair_law_without_the_slope_serves_equal_velocities_only():
    q, p = np.array([[0.0, 0.0], [6.0, 0.0]]), np.ones((2, 2))
    np.testing.assert_array_equal(Algorithm1(alpha=Bare()).jacobian(0.0, q, p), Algorithm1().jacobian(0.0, q, p))
    with pytest.raises(ArgumentError, match=r"Bare gives no slope of its adjacency.*adjacency_slope"):
        Algorithm1(alpha=Bare()).jacobian(0.0, q, q)
    undamped = Algorithm1(alpha=Bare(), gains=Gains(c2_alpha=0.0))
    np.testing.assert_array_equal(undamped.jacobian(0.0, q, q), undamped.jacobian(0.0, q, p))


@dataclass(frozen=True)
class BareSphere(Sphere):
    kernels = lift_obstacle(_onto_sphere)


def test_an_obstacle_without_a_turn_serves_agents_at_rest_only():
    q = np.array([[4.0, 0.0]])
    bare, full = (
        Algorithm3(target=StaticTarget((0.0, 0.0)), obstacles=(kind((0.0, 0.0), 2.0),)) for kind in (BareSphere, Sphere)
    )
    np.testing.assert_array_equal(bare.jacobian(0.0, q, 0.0 * q), full.jacobian(0.0, q, 0.0 * q))
    with pytest.raises(ArgumentError, match=r"BareSphere.*does not say how β-agents turn.*no_turn"):
        bare.jacobian(0.0, q, q)


class Push(Law):
    """−2q³ − |p|: smooth in the positions, with a kink where an agent rests."""

    def flow(self, t, q, p):
        return -2.0 * q**3 - np.abs(p), 0.0


def test_a_law_without_derivatives_is_differentiated_by_differences():
    """∂u/∂q = −6q² and ∂u/∂p = −sign p, beside the other agent nothing."""
    A = Push().jacobian(0.0, [[0.5], [-2.0]], [[1.0], [-3.0]])
    np.testing.assert_allclose(A[2:, :2], np.diag([-1.5, -24.0]), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(A[2:, 2:], np.diag([-1.0, 1.0]), rtol=1e-9, atol=1e-9)


test_bad_input = refused(
    (lambda: Push().jacobian(0.0, [[1.0]], [[0.0]]), "Push has a kink or a jump at this state"),
    (lambda: Algorithm1().jacobian(0.0, [[0.0]], [[0.0, 0.0]]), "expected equal shapes"),
    (
        lambda: Algorithm2(target=StaticTarget((0.0,)), gains=PER_AGENT).jacobian(0.0, [[0.0]], [[0.0]]),
        "c1_gamma has 9 gains",
    ),
    (lambda: PushedAlgorithm1().jacobian(0.0, [[0.0], [0.04]], [[0.0], [0.0]]), r"closer than min_distance = 0.05"),
)


def test_a_dense_matrix_that_would_not_fit_is_refused_before_it_is_allocated():
    q = np.arange(2_000_000.0)[:, None] * 100.0
    with pytest.raises(ArgumentError, match=r"would take 1\.28e\+14 bytes.*sparse=True"):
        Algorithm1().jacobian(0.0, q, 0.0 * q)
