"""Clearance of runs between samples: exact paths, a bound that holds, and the constrained α-lattice measure."""

import math

import numpy as np
import pytest

from flockana import AlphaInteraction, BetaInteraction, Capsule, Obstacle, Polygon, Sphere, Wall
from flockana.kernels.quintic_paths import bernstein
from flockana.lattice import hexagonal_patch
from flockana.measures.clearance import bounds_over_hull, clearance, constrained_lattice, refine

OBSTACLES: tuple[Obstacle, ...] = (
    Sphere((1.0, -2.0), 1.5),
    Wall((0.0, -6.0), (1.0, 3.0)),
    Capsule((-4.0, 0.0), (-2.0, 3.0), 0.5),
    Polygon([(0.0, 3.0), (2.0, 2.0), (1.0, 5.0)]),
)


def _straight(start: list[float], end: list[float]) -> tuple[np.ndarray, ...]:
    q = np.array([[start], [end]])
    p = np.broadcast_to(q[1] - q[0], q.shape)
    return np.array([0.0, 1.0]), q, p, np.zeros_like(q)


def test_a_straight_line_past_a_sphere() -> None:
    """The 3-4-5 line at distance 5 from the centre; the closest point lies at a third of the way."""
    foot, along = np.array([3.0, 4.0]), np.array([4.0, -3.0])
    found = clearance(*_straight((foot - along).tolist(), (foot + 2.0 * along).tolist()), [Sphere((0.0, 0.0), 2.0)])
    assert found.lower == pytest.approx(3.0, abs=1e-7)
    assert found.lower <= 3.0 <= found.reached + 1e-12
    assert found.reached == pytest.approx(3.0, abs=1e-7)
    assert found.time == pytest.approx(1.0 / 3.0, abs=1e-4)
    assert (found.agent, found.obstacle) == (0, 0)


@pytest.mark.parametrize("chunk", [1, 4, 6, 100])
def test_the_closest_point_is_told_whatever_is_handled_at_once(chunk, monkeypatch) -> None:
    """Two agents in ten intervals; the second grazes the disc in the eighth, between its samples."""
    monkeypatch.setattr("flockana.measures.clearance._CHUNK", chunk)
    t = np.linspace(0.0, 10.0, 11)
    q = np.stack([np.stack([t - 7.3, np.full(11, y)], axis=1) for y in (9.0, 3.0)], axis=1)
    p = np.broadcast_to([1.0, 0.0], q.shape)
    found = clearance(t, q, p, np.zeros_like(q), [Sphere((50.0, 50.0), 1.0), Sphere((0.0, 0.0), 2.0)])
    assert found.lower == pytest.approx(1.0, abs=1e-7)
    assert found.time == pytest.approx(7.3, abs=1e-4)
    assert (found.agent, found.obstacle) == (1, 1)


def test_a_passage_through_an_obstacle_is_not_missed() -> None:
    """Both samples are outside; the path runs through the centre, or through the polygon's depth of 1.5."""
    through = clearance(*_straight([-9.0, 0.0], [8.0, 0.0]), [Sphere((0.0, 0.0), 2.0)])
    assert through.lower == pytest.approx(-2.0, abs=1e-6)
    square = Polygon([(-1.5, -1.5), (1.5, -1.5), (1.5, 1.5), (-1.5, 1.5)])
    found = clearance(*_straight([-9.0, 0.0], [8.0, 0.0]), [square])
    assert found.lower == pytest.approx(-1.5, abs=1e-6)
    assert found.reached == pytest.approx(-1.5, abs=1e-6)
    assert 8.0 / 17.0 <= found.time <= 10.0 / 17.0


@pytest.mark.parametrize("seed", range(4))
def test_the_bound_lies_below_the_true_path_and_close_to_it(seed: int) -> None:
    """Smooth random paths, finely evaluated: the bound is below by at most the interpolation allowance."""
    rng, n = np.random.default_rng(seed), 6
    amplitude, omega, phase = rng.uniform(1.0, 5.0, (n, 2)), rng.uniform(0.5, 2.0, (n, 2)), rng.uniform(0, 6, (n, 2))

    def path(t: np.ndarray) -> tuple[np.ndarray, ...]:
        angle = omega * t[:, None, None] + phase
        return amplitude * np.sin(angle), amplitude * omega * np.cos(angle), -amplitude * omega**2 * np.sin(angle)

    t = np.linspace(0.0, 6.0, 61)
    found = clearance(t, *path(t), OBSTACLES)
    fine = path(np.linspace(0.0, 6.0, 60_001))[0]
    true = np.array([o.clearance(fine.reshape(-1, 2)).min() for o in OBSTACLES])
    assert (found.lower_by_obstacle <= true + 1e-9).all()
    assert (found.lower_by_obstacle >= true - 2e-3).all()
    assert found.lower == found.lower_by_obstacle.min()
    assert found.obstacle == int(np.argmin(true))
    assert found.reached == pytest.approx(true.min(), abs=1e-4)
    here = path(np.array([found.time]))[0][0, found.agent]
    assert OBSTACLES[found.obstacle].clearance([here])[0] == pytest.approx(found.reached, abs=1e-4)


@pytest.mark.parametrize("obstacle", OBSTACLES, ids=str)
def test_one_tangent_plane_bounds_a_whole_curve(obstacle: Obstacle) -> None:
    """Without halving the bound of wide curves lies below them, and is mostly better than the Lipschitz one."""
    rng, s = np.random.default_rng(0), np.linspace(0.0, 1.0, 2001)
    bernstein = np.array([math.comb(5, k) * s**k * (1.0 - s) ** (5 - k) for k in range(6)])
    better = 0
    for curve in rng.uniform(-8.0, 8.0, (200, 1, 6, 2)):
        least = obstacle.clearance(bernstein.T @ curve[0]).min()
        middle = (bernstein.T @ curve[0])[1000:1001]
        here, (bound,) = bounds_over_hull(obstacle, curve, middle, 1e-9)
        lipschitz = here[0] - np.linalg.norm(curve[0] - middle, axis=1).max()
        assert lipschitz - 1e-9 <= bound <= least + 1e-9
        better += bound > lipschitz + 0.1
    assert better > 100


def test_the_allowance_is_taken_off() -> None:
    curve = np.linspace((-5.0, 3.0), (6.0, 3.0), 6)[None]
    found = refine(Wall((0.0, 0.0), (0.0, 1.0)), curve, np.array([0.25]), np.inf, 1e-9)
    assert found.lower == pytest.approx(2.75, abs=1e-12)
    assert found.value == pytest.approx(3.0, abs=1e-12)


def test_whom_it_passes_over_could_not_have_come_lower() -> None:
    """Against every path of every agent, halved as far as need be, from whichever end it starts far off."""
    rng, passed = np.random.default_rng(0), 0
    for _ in range(300):
        obstacle = OBSTACLES[rng.integers(len(OBSTACLES))]
        q, u = rng.uniform(-8.0, 8.0, (2, 5, 2)), rng.uniform(-20.0, 20.0, (2, 5, 2))
        p, slack = rng.uniform(-9.0, 9.0, (2, 5, 2)), rng.uniform(0.0, 3.0, (1, 5)) * rng.integers(2)
        still = slice(0, 4)  # these stand, and one of them is at times the nearest
        p[:, still], u[:, still], q[1, still], slack[:, still] = 0.0, 0.0, q[0, still], 0.0
        found = clearance(np.array([0.0, 1.0]), q, p, u, [obstacle], slack)
        curves, _, off = bernstein(1.0, q[0], p[0], u[0], q[1], p[1], u[1])
        least = obstacle.clearance(q.reshape(-1, 2)).min()
        every = refine(obstacle, curves[:, :, :2], off + slack[0], np.inf, 1e-9)
        assert found.lower == pytest.approx(min(least, every.lower), abs=1e-6)
        passed += found.lower > least - 1e-9
    assert 30 < passed < 270


def test_no_obstacles() -> None:
    found = clearance(*_straight([0.0, 0.0], [1.0, 0.0]), ())
    assert (found.lower, found.agent, found.obstacle, found.lower_by_obstacle.size) == (math.inf, -1, -1, 0)


def test_a_constrained_lattice_has_no_error() -> None:
    """A hexagon whose lowest row rests at d' above a wall."""
    alpha, beta = AlphaInteraction(), BetaInteraction()
    q = hexagonal_patch(1, 7.0)
    q[:, 1] += 4.2 - q[:, 1].min()
    wall = Wall((0.0, 0.0), (0.0, 1.0))
    found = constrained_lattice(q, [wall], alpha=alpha, beta=beta)
    assert found.alpha_error < 1e-14
    assert found.beta_error < 1e-14
    assert (found.links, found.beta_links) == (12, 2)
    q[:, 1] -= 0.25
    assert constrained_lattice(q, [wall], alpha=alpha, beta=beta).beta_error == pytest.approx(0.25, rel=1e-12)
    q[:, 1] += 0.75
    assert constrained_lattice(q, [wall], alpha=alpha, beta=beta).beta_error == pytest.approx(0.5, rel=1e-12)
    q[:, 1] += 1.0
    lone = constrained_lattice(q[:1], [wall], alpha=alpha, beta=beta)
    assert (lone.links, lone.beta_links) == (0, 0)
    assert math.isnan(lone.alpha_error)
    assert math.isnan(lone.beta_error)
