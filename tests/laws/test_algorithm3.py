"""Algorithm 3 against a dense reference, its own energy, and the symbolic expressions; bad input."""

from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp

from flockana import Algorithm3, Capsule, Obstacle, Polygon, Sphere, Target, Wall, simulate, symbolic
from flockana.base.errors import ArgumentError
from flockana.environment.targets import (
    CallableTarget,
    CircleTarget,
    LinearTarget,
    RescaledVelocity,
    SineTarget,
    StaticTarget,
)
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains
from flockana.symbolic.obstacles import sphere_beta, wall_beta
from tests.refused import refused

GAINS = Gains(c1_alpha=2.0, c2_alpha=0.3, c1_beta=7.0, c2_beta=1.1, c1_gamma=0.9, c2_gamma=0.4)
BETA = BetaInteraction(d=2.0, r=2.4, eps=0.2)
ALPHA = AlphaInteraction(d=3.0, r=3.6, eps=0.1, h=0.2, a=4.0, b=5.0)
OBSTACLES: dict[int, tuple[Obstacle, ...]] = {
    1: (Sphere((1.0,), 0.5), Wall((-6.0,), (2.0,))),
    2: (
        Sphere((1.0, -2.0), 1.5),
        Sphere((5.0, 5.0), 1.0),
        Wall((0.0, -5.0), (1.0, 3.0)),
        Capsule((-4.0, 0.0), (-2.0, 3.0), 0.5),
        Polygon([(0.0, 3.0), (2.0, 2.0), (1.0, 5.0)]),
    ),
    3: (
        Sphere((1.0, -2.0, 0.5), 1.5),
        Wall((0.0, -4.0, 1.0), (1.0, 3.0, -2.0)),
        Capsule((1.0, 0, 2), (2.0, 1, 4), 0.5),
    ),
}


def _state(m: int, n: int = 25) -> tuple[np.ndarray, np.ndarray]:
    """Random agents outside all obstacles."""
    rng = np.random.default_rng(m)
    q = rng.uniform(-7.0, 7.0, (40 * n, m))
    free = np.all([o.clearance(q) > 0.1 for o in OBSTACLES[m]], axis=0)
    return q[free][:n], rng.normal(size=(n, m))


def _law(m: int, target: Target | None = None) -> Algorithm3:
    target = target or StaticTarget(np.linspace(1.0, 2.0, m))
    return Algorithm3(alpha=ALPHA, gains=GAINS, target=target, beta=BETA, obstacles=OBSTACLES[m])


TARGETS = {
    "static": StaticTarget((1.0, 2.0)),
    "static with p_d": StaticTarget((1.0, 2.0), (0.7, -0.4)),
    "line": LinearTarget((1.0, 2.0), (0.7, -0.4)),
    "sine": SineTarget((1.0, 2.0), (0.5, 0.0), amplitude=3.0, frequency=0.2),
    "circle": CircleTarget((1.0, 2.0), 3.0, frequency=0.2),
    "wrong scale": RescaledVelocity(CircleTarget((1.0, 2.0), 3.0, frequency=0.2), 0.3),
    "hidden velocity": RescaledVelocity(LinearTarget((1.0, 2.0), (0.7, -0.4)), 0.0),
    "user's": CallableTarget(lambda t: ((t * t, 2.0), (1.0, -0.3))),
}


@pytest.mark.parametrize("target", TARGETS.values(), ids=TARGETS)
def test_energy_rate_is_the_slope_of_the_energy_along_the_flow(target: Target) -> None:
    """Central differences over a parabola through the state: error O(h²), 1e-6 here."""
    law, (q, p), t, h = _law(2, target), _state(2), 0.8, 1e-5
    u = law.acceleration(t, q, p)
    ahead, behind = (law.energy(t + s, q + s * p + 0.5 * s * s * u, p + s * u) for s in (h, -h))
    assert law.energy_rate(t, q, p) == pytest.approx((ahead - behind) / (2.0 * h), rel=1e-7, abs=1e-6)


def test_each_obstacle_kind_enters_the_rate() -> None:
    """The identity for each kind alone, so that no kind's error hides behind another's."""
    for obstacle in OBSTACLES[2]:
        law = Algorithm3(alpha=ALPHA, gains=GAINS, target=StaticTarget((0.0, 0.0)), beta=BETA, obstacles=[obstacle])
        q = _state(2, 200)[0]
        q = q[np.abs(obstacle.clearance(q)) < 1.9][:5]
        p, h = np.random.default_rng(0).normal(size=q.shape), 1e-5
        u = law.acceleration(0.0, q, p)
        ahead, behind = (law.energy(0.0, q + s * p + 0.5 * s * s * u, p + s * u) for s in (h, -h))
        assert len(q) == 5
        assert law.energy_rate(0.0, q, p) == pytest.approx((ahead - behind) / (2.0 * h), rel=1e-7, abs=1e-7)


def _psi_beta(z: sp.Expr, beta: symbolic.BetaSymbols) -> sp.Expr:
    """The integral of the symbolic φ_β from d_β to z, by thirty-digit quadrature."""
    with mpmath.workdps(30):
        s = sp.Symbol("s", nonnegative=True)
        edges = [beta.d_beta, beta.h * beta.d_beta] if z < beta.h * beta.d_beta else [beta.d_beta]
        limits = [mpmath.mpf(sp.N(edge, 30)) for edge in (*edges, z)]
        return sp.Float(mpmath.quad(sp.lambdify(s, symbolic.phi_beta(s, beta=beta), "mpmath"), limits), 30)


def _symbolic_alone(kind: str, q: list[float], p: list[float], obstacle: Any) -> tuple[np.ndarray, float, float]:
    """(u, H, dH/dt) of one agent, thirty digits, from the symbolic functions; the target at the origin at rest."""
    exact = [sp.Rational(x) for x in q], [sp.Rational(x) for x in p]
    column, speed = sp.Matrix(exact[0]), sp.Matrix(exact[1])
    rational = [sp.Matrix([sp.Rational(x) for x in vector]) for vector in obstacle[:-1]]
    last = sp.Matrix([sp.Rational(x) for x in obstacle[-1]]) if kind == "wall" else sp.Rational(obstacle[-1])
    foot, rate = (wall_beta if kind == "wall" else sphere_beta)(column, speed, *rational, last)
    eps, d = sp.Rational(BETA.eps), sp.Rational(BETA.d)
    beta = symbolic.BetaSymbols(eps=eps, h=sp.Rational(BETA.h), d=d)
    gap = foot - column
    z = symbolic.sigma_norm(gap, eps=eps)
    phi, b = symbolic.phi_beta(z, beta=beta), symbolic.bump(z / beta.d_beta, h=beta.h)
    g = {name: sp.Rational(getattr(GAINS, name)) for name in ("c1_beta", "c2_beta", "c1_gamma", "c2_gamma")}
    u = g["c1_beta"] * phi * symbolic.sigma_norm_gradient(gap, eps=eps) + g["c2_beta"] * b * (rate - speed)
    u += -g["c1_gamma"] * symbolic.sigma_1(column) - g["c2_gamma"] * speed
    energy = g["c1_beta"] * _psi_beta(z, beta) + speed.dot(speed) / 2
    energy += g["c1_gamma"] * (sp.sqrt(1 + column.dot(column)) - 1)
    closed = g["c2_beta"] * b * speed.dot(rate - speed) - g["c2_gamma"] * speed.dot(speed)
    return np.array([float(x.evalf(30)) for x in u]), float(energy.evalf(30)), float(closed.evalf(30))


@pytest.mark.parametrize(
    ("kind", "q", "obstacle"),
    [
        ("wall", [0.5, 1.25], ((0.0, -0.25), (1.0, 3.0))),
        ("wall", [0.5, 0.25, -1.0], ((0.0, -0.25, 0.0), (1.0, 3.0, -2.0))),
        ("wall", [0.5, 1.9], ((0.0, 0.0), (0.0, 1.0))),
        ("sphere", [2.0, 0.5], ((0.0, -0.25), 1.5)),
        ("sphere", [2.0, 0.5, -0.5], ((0.0, -0.25, 0.5), 1.5)),
        ("sphere", [0.5, 0.5], ((0.0, -0.25), 1.5)),
        ("sphere", [3.4375, 0.0], ((0.0, 0.0), 1.5)),
    ],
)
def test_kernel_and_symbolic_expression_agree(kind: str, q: list[float], obstacle: Any) -> None:
    """One agent, on the plateau, on the taper, inside the sphere: to rounding."""
    p = [0.75, -0.5, 0.25][: len(q)]
    solid = Wall(*obstacle) if kind == "wall" else Sphere(*obstacle)
    law = Algorithm3(alpha=ALPHA, gains=GAINS, target=StaticTarget([0.0] * len(q)), beta=BETA, obstacles=(solid,))
    u, energy, rate = _symbolic_alone(kind, q, p, obstacle)
    np.testing.assert_allclose(law.acceleration(0.0, [q], [p])[0], u, rtol=1e-12, atol=1e-13)
    assert law.energy(0.0, [q], [p]) == pytest.approx(energy, rel=1e-12)
    assert law.energy_rate(0.0, [q], [p]) == pytest.approx(rate, rel=1e-12)


test_bad_laws_are_refused = refused(
    ({"target": None}, "target = None: expected a γ-agent"),
    ({"obstacles": Sphere((0.0, 0.0), 1.0)}, r"obstacles = Sphere.*expected a sequence"),
    ({"obstacles": (Sphere((0.0, 0.0, 0.0), 1.0),)}, r"obstacles\[0\] = .* has 3 components but the target has 2"),
    ({"beta": 4.2}, "beta = 4.2: expected BetaInteraction"),
    ({"alpha": BetaInteraction()}, "expected AlphaInteraction"),
    ({"gains": 1.0}, "gains = 1.0: expected Gains"),
    make=lambda **options: Algorithm3(**({"target": StaticTarget((0.0, 0.0))} | options)),
)


def test_another_dimension_is_refused() -> None:
    law = Algorithm3(target=StaticTarget((0.0, 0.0)))
    with pytest.raises(ArgumentError, match="the target has 2 components but the agents have 3"):
        law.acceleration(0.0, [[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0]])
    with pytest.raises(ArgumentError, match=r"obstacles\[0\] = .* has 2 components but the agents have 1"):
        _law(2).energy(0.0, [[0.0]], [[0.0]])


def test_a_start_inside_an_obstacle_is_refused_before_the_run() -> None:
    law = Algorithm3(target=StaticTarget((0.0, 0.0)), obstacles=(Sphere((5.0, 0.0), 2.0),))
    q = np.array([[0.0, 0.0], [9.0, 0.0], [6.0, 0.0]])
    with pytest.raises(ArgumentError, match=r"agent 2 at \[6.0, 0.0\] starts inside obstacles\[0\] = Sphere"):
        simulate(law, q, 0.0 * q, (0.0, 1.0))
    law.check_start(q[:2], q[:2])
