"""β-agents of every kind of obstacle: exact feet, brute-force closest points, derivatives, sums, bad input."""

import json
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from flockana import BetaInteraction, Capsule, Obstacle, Polygon, Sphere, Wall
from flockana.base.errors import ArgumentError
from flockana.environment.beta_agents import ObstacleField, check_free
from flockana.jit import register_jitable
from flockana.kernels.obstacles import lift_obstacle
from tests.refused import refused

SQUARE = Polygon([(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0)])
PLANE = (
    Sphere((1.0, -2.0), 1.5),
    Wall((0.0, -4.0), (1.0, 3.0)),
    Capsule((-1.0, 0.0), (2.0, 1.0), 0.5),
    SQUARE,
    Polygon([(0.0, 3.0), (-2.0, 0.0), (1.0, -1.0)]),
)
SPACE = (
    Sphere((1.0, -2.0, 0.5), 1.5),
    Wall((0.0, -4.0, 1.0), (1.0, 3.0, -2.0)),
    Capsule((-1.0, 0.0, 1.0), (2.0, 1.0, 0.0), 0.5),
)
LINE = (Sphere((1.0,), 2.0), Wall((-1.0,), (-3.0,)))
EVERY = pytest.mark.parametrize("obstacle", [*LINE, *PLANE, *SPACE], ids=str)
coordinate = st.floats(-8.0, 8.0, allow_nan=False, width=32).map(float)


def test_sphere_by_hand() -> None:
    """3-4-5: an agent 5 from the centre of a sphere of radius 2 has μ = 2/5; inside, at 1, μ = 2."""
    sphere = Sphere((1.0, 1.0), 2.0)
    agents = sphere.beta_agents([[4.0, 5.0], [1.0, 2.0]], [[5.0, 0.0], [1.0, 7.0]])
    np.testing.assert_allclose(agents.q, [[2.2, 2.6], [1.0, 3.0]], rtol=1e-15)
    np.testing.assert_allclose(agents.clearance, [3.0, -1.0], rtol=1e-15)
    # a = (3, 4)/5; Pp = (5, 0) − 3a = (3.2, −2.4)
    np.testing.assert_allclose(agents.p, [[1.28, -0.96], [2.0, 0.0]], rtol=1e-14, atol=1e-15)


def test_the_way_round_of_a_polygon_does_not_matter() -> None:
    points = np.random.default_rng(0).uniform(-5.0, 5.0, (50, 2))
    np.testing.assert_array_equal(SQUARE.clearance(points) > 0.0, np.abs(points - 0.5).max(axis=1) > 1.5)
    back = Polygon(SQUARE.vertices[::-1])
    np.testing.assert_allclose(back.clearance(points), SQUARE.clearance(points), rtol=1e-14)


def _surface(obstacle: Obstacle) -> np.ndarray:
    """Many points of the surface, written down independently of the projection."""
    m = obstacle.dimension
    rng = np.random.default_rng(1)
    directions = rng.normal(size=(40_000, m))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    if isinstance(obstacle, Sphere):
        return np.array(obstacle.centre) + obstacle.radius * directions
    if isinstance(obstacle, Capsule):
        a, b = np.array(obstacle.a), np.array(obstacle.b)
        side = b - a
        along = directions @ side
        ends = np.where(along[:, None] > 0.0, b, a) + obstacle.radius * directions
        flat = directions - np.outer(along, side) / (side @ side)
        flat /= np.linalg.norm(flat, axis=1, keepdims=True)
        share = rng.uniform(size=(len(flat), 1))
        return np.concatenate([ends, a + share * side + obstacle.radius * flat])
    if isinstance(obstacle, Wall):
        normal = np.array(obstacle.normal)
        flat = 60.0 * directions * rng.uniform(size=(len(directions), 1)) ** (1.0 / max(1, m - 1))
        return np.array(obstacle.point) + flat - np.outer(flat @ normal, normal) / (normal @ normal)
    corners = np.array(obstacle.vertices)  # type: ignore[attr-defined]
    share = np.linspace(0.0, 1.0, 2000)[:, None]
    return np.concatenate([a + share * (b - a) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)])


@pytest.mark.slow
@EVERY
def test_no_point_of_the_surface_is_closer(obstacle: Obstacle) -> None:
    """Sampled surfaces give the distance from above; the samples are dense enough for 0.1 in space."""
    q = np.random.default_rng(2).uniform(-6.0, 6.0, (60, obstacle.dimension))
    agents = obstacle.beta_agents(q, 0.0 * q)
    sampled = np.array([np.linalg.norm(_surface(obstacle) - x, axis=1).min() for x in q])
    distance = np.linalg.norm(agents.q - q, axis=1)
    np.testing.assert_allclose(np.abs(agents.clearance), distance, rtol=1e-12, atol=1e-14)
    assert (sampled - distance).min() > -1e-12
    assert (sampled - distance).max() < (0.8 if isinstance(obstacle, Wall) else 0.1)
    np.testing.assert_allclose(obstacle.clearance(agents.q), 0.0, atol=1e-14)


@EVERY
@given(data=st.data())
def test_velocity_is_the_derivative_of_the_foot_and_contracts(obstacle: Obstacle, data: Any) -> None:
    """p̂ = Dp with D symmetric, D (q̂ − q) = 0, and 0 ≤ D ≤ I outside; D from differences, order 1e-8."""
    m = obstacle.dimension
    q = np.array([data.draw(st.lists(coordinate, min_size=m, max_size=m))])
    step = 1e-6
    near = q + step * np.concatenate([np.eye(m), -np.eye(m)])
    assume(obstacle.clearance(q)[0] > 0.05)
    D = np.column_stack([obstacle.beta_agents(q, axis[None, :]).p[0] for axis in np.eye(m)])
    feet = obstacle.beta_agents(near, 0.0 * near)
    differences = (feet.q[:m] - feet.q[m:]).T / (2.0 * step)
    jumps = [obstacle.beta_agents(near, np.tile(axis, (2 * m, 1))).p for axis in np.eye(m)]
    assume(max(np.ptp(jump, axis=0).max() for jump in jumps) < 1e-4)  # a corner or cap takes over here
    np.testing.assert_allclose(D, differences, atol=1e-7)
    np.testing.assert_allclose(D, D.T, atol=1e-13)
    np.testing.assert_allclose(D @ (feet.q.mean(axis=0) - q[0]), 0.0, atol=1e-5)
    eigenvalues = np.linalg.eigvalsh(D)
    assert eigenvalues.min() > -1e-13
    assert eigenvalues.max() < 1.0 + 1e-13


@EVERY
def test_outside_an_obstacle_only_brakes_and_the_ball_holds_it(obstacle: Obstacle) -> None:
    rng = np.random.default_rng(3)
    q, p = rng.uniform(-9.0, 9.0, (500, obstacle.dimension)), rng.normal(size=(500, obstacle.dimension))
    agents = obstacle.beta_agents(q, p)
    power = np.sum(p * (agents.p - p), axis=1)
    assert power[agents.clearance > 0.0].max() <= 1e-14
    centre, radius = obstacle.ball
    assert (np.linalg.norm(agents.q - centre, axis=1) <= radius * (1.0 + 1e-12)).all()


def test_inside_a_sphere_an_obstacle_can_speed_up() -> None:
    agents = Sphere((0.0, 0.0), 2.0).beta_agents([[1.0, 0.0]], [[0.0, 1.0]])
    assert agents.p.tolist() == [[0.0, 2.0]]  # μ = 2: ⟨p, p̂ − p⟩ = +1
    inside_wall = Wall((0.0, 0.0), (1.0, 0.0)).beta_agents([[-1.0, 0.0]], [[0.3, 1.0]])
    assert inside_wall.p.tolist() == [[0.0, 1.0]]


def test_a_sphere_has_no_beta_agent_for_its_centre() -> None:
    agents = Sphere((1.0, 1.0), 2.0).beta_agents([[1.0, 1.0]], [[1.0, 0.0]])
    assert np.isnan(agents.q).all()
    assert agents.clearance.tolist() == [-2.0]


def test_a_gap_is_exact_far_from_the_origin() -> None:
    """1e-6 above a sphere 1e6 away: the clearance keeps the digits that the coordinates have."""
    assert Sphere((1e6, 0.0), 1.0).clearance([[1e6 + 1.0 + 2.0**-20, 0.0]])[0] == pytest.approx(2.0**-20, rel=1e-9)


@register_jitable
def _onto_slab(q, p, par, gap, rate):  # type: ignore[no-untyped-def]
    side = 1.0 if q[0] >= 0.0 else -1.0
    gap[:] = 0.0
    rate[:] = p
    gap[0], rate[0] = side * par[0] - q[0], 0.0
    return abs(q[0]) - par[0]


@dataclass(frozen=True)
class Slab(Obstacle):
    """|x| ≤ half: what a user's own kind looks like."""

    half: float
    kernels = lift_obstacle(_onto_slab)

    @property
    def par(self) -> np.ndarray:
        return np.array([self.half])

    @property
    def ball(self) -> tuple[np.ndarray, float]:
        return np.zeros(2), math.inf


def _dense(q: np.ndarray, p: np.ndarray, obstacles: Any, beta: BetaInteraction) -> tuple[np.ndarray, np.ndarray, Any]:
    """The sums of u^β, Σ b⟨p, p̂−p⟩ and Σψ_β by plain loops."""
    force, damping, power, potential = np.zeros_like(q), np.zeros_like(q), 0.0, 0.0
    for i in range(len(q)):
        for obstacle in obstacles:
            foot = obstacle.beta_agents(q[i : i + 1], p[i : i + 1])
            gap = foot.q[0] - q[i]
            z = (math.sqrt(1.0 + beta.eps * gap @ gap) - 1.0) / beta.eps
            b = beta.adjacency(z)
            force[i] += beta.phi_beta(z) * gap / math.sqrt(1.0 + beta.eps * gap @ gap)
            damping[i] += b * (foot.p[0] - p[i])
            power += b * p[i] @ (foot.p[0] - p[i])
            potential += beta.psi_beta(z)
    return force, damping, (power, potential)


@pytest.mark.slow
@pytest.mark.parametrize("obstacles", [LINE, PLANE, SPACE, (*PLANE, Slab(0.25), Sphere((4.0, 4.0), 0.5))])
def test_sums_over_all_kinds_are_those_of_plain_loops(obstacles: tuple[Obstacle, ...]) -> None:
    rng, m = np.random.default_rng(4), obstacles[0].dimension
    q, p = rng.uniform(-7.0, 7.0, (40, m)), rng.normal(size=(40, m))
    beta = BetaInteraction(d=2.0, r=2.4)
    force, damping, (power, potential) = _dense(q, p, obstacles, beta)
    field, u = ObstacleField(tuple(obstacles), beta), np.zeros_like(q)
    found = field.forces(q, p, u, stiffness=3.0, damping=0.7)
    np.testing.assert_allclose(u, 3.0 * force + 0.7 * damping, rtol=1e-11, atol=1e-12)
    assert found == pytest.approx(power, rel=1e-12)
    assert field.potential_energy(q) == pytest.approx(potential, rel=1e-12)
    assert np.abs(u).max() > 0.1
    links = field.links(q, p)
    expected = [(i, k) for k, o in enumerate(obstacles) for i in np.flatnonzero(np.abs(o.clearance(q)) < 2.4)]
    assert sorted(zip(links.agent, links.obstacle, strict=True)) == sorted(expected)
    for i, k, foot, rate, distance in zip(*links, strict=True):
        agents = obstacles[k].beta_agents(q[i : i + 1], p[i : i + 1])
        assert (foot.tolist(), rate.tolist()) == (agents.q[0].tolist(), agents.p[0].tolist())
        assert distance == pytest.approx(abs(agents.clearance[0]), rel=1e-15)


def test_no_obstacles_no_sums() -> None:
    field, q = ObstacleField((), BetaInteraction()), np.zeros((3, 2))
    assert field.forces(q, q, q.copy(), stiffness=1.0, damping=1.0) == 0.0
    assert field.potential_energy(q) == 0.0
    assert len(field.links(q, q).agent) == 0
    check_free(q, ())


test_bad_obstacles_are_refused = refused(
    (lambda: Wall((0.0, 0.0), (0.0, 0.0, 1.0)), "normal has 3 components: expected 2"),
    (lambda: Capsule((1.0, 1.0), (1.0, 1.0), 1.0), "expected two different points; a ball is a Sphere"),
    (lambda: Capsule((1.0,), (2.0,), 1.0), "on a line the obstacle is a Sphere"),
    (lambda: Polygon([(0.0, 0.0), (1.0, 0.0)]), r"expected \(V, 2\) with V >= 3"),
    (lambda: Polygon([(0.0, 0.0), (2.0, 0.0), (0.5, 0.5), (0.0, 2.0)]), "strictly convex polygon in order"),
    (lambda: Polygon([(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]), "does not meet itself"),
    (lambda: Polygon([(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (0.0, 2.0)]), "strictly convex polygon in order"),
    (lambda: Polygon([(np.cos(k), np.sin(k)) for k in np.arange(5) * 0.8 * np.pi]), "does not meet itself"),
    (lambda: SQUARE.clearance([[0.0, 0.0, 0.0]]), "has 2 components but the agents have 3"),
)


def test_a_start_inside_is_named_with_a_free_point() -> None:
    q = np.array([[9.0, 9.0], [1.0, -1.0], [1.2, -2.0]])
    with pytest.raises(
        ArgumentError, match=r"agent 1 at \[1.0, -1.0\] starts inside obstacles\[1\] = Sphere"
    ) as caught:
        check_free(q, (Wall((0.0, -50.0), (0.0, 1.0)), Sphere((1.0, -2.0), 1.5)))
    assert "(2 agents do)" in str(caught.value)
    free = json.loads(str(caught.value).split("outside; ")[1].removesuffix(" is free"))
    assert 0.0 < Sphere((1.0, -2.0), 1.5).clearance([free])[0] < 1e-5


@pytest.mark.parametrize("start", [[1.0, -2.0], [2.5, -2.0]])
def test_a_centre_or_a_surface_is_no_start(start: list[float]) -> None:
    with pytest.raises(ArgumentError, match=r"agent 0 at .* starts inside .* is free"):
        check_free(np.array([start]), (Sphere((1.0, -2.0), 1.5),))


def test_overlapping_obstacles_are_left_behind_or_leave_nothing() -> None:
    two = (Sphere((0.0, 0.0), 2.0), Sphere((1.0, 0.0), 2.0))
    with pytest.raises(ArgumentError, match=r"inside obstacles\[0\] .* and obstacles\[1\] .* is free") as caught:
        check_free(np.array([[0.4, 0.1]]), two)
    free = np.array([json.loads(str(caught.value).split("outside; ")[1].removesuffix(" is free"))])
    assert min(o.clearance(free)[0] for o in two) > 0.0
    facing = (Wall((1.0, 0.0), (1.0, 0.0)), Wall((-1.0, 0.0), (-1.0, 0.0)))
    with pytest.raises(ArgumentError, match=r"agent 0 .* no free point was found by pushing it out"):
        check_free(np.array([[0.0, 3.0]]), facing)
