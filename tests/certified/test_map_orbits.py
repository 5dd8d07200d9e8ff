"""Orbits of schemes in balls, against steps of the printed formulas in mpmath with more digits than chaos eats."""

import mpmath
import numpy as np
import pytest

from flockana import (
    RK4,
    Algorithm1,
    Algorithm2,
    Algorithm3,
    CallableTarget,
    DeadZoneFlocking,
    ExplicitEuler,
    Gains,
    LinearTarget,
    SemiImplicitEuler,
    Sphere,
    StaticTarget,
    TaylorStep,
)
from flockana.certified.map_orbits import enclose_orbit, has_ball_orbit

CHAOTIC = Algorithm2(gains=Gains(c1_alpha=30.0, c2_alpha=0.0, c1_gamma=1.1, c2_gamma=0.0), target=StaticTarget((0.0,)))
Q = np.array([-4.3125, -4.140625, 2.96875, 3.921875])[:, None]
P = np.array([0.140625, 9.28125, 3.265625, -3.03125])[:, None]


def pull(s, alpha):
    """φ_α(‖s‖_σ) s/√(1 + εs²) of the paper, of binary parameters."""
    d, r, eps, h, a, b = (mpmath.mpf(x) for x in (alpha.d, alpha.r, alpha.eps, alpha.h, alpha.a, alpha.b))

    def norm(x):
        return (mpmath.sqrt(1 + eps * x * x) - 1) / eps

    z, c = norm(s) / norm(r), (b - a) / mpmath.sqrt(4 * a * b)
    if z >= 1:
        return mpmath.mpf(0)
    y = norm(s) - norm(d) + c
    action = ((a + b) * y / mpmath.sqrt(1 + y * y) + a - b) / 2
    taper = 1 if z < h else (1 + mpmath.cos(mpmath.pi * (z - h) / (1 - h))) / 2
    return action * taper * s / mpmath.sqrt(1 + eps * s * s)


def orbit(law, f, dt, steps):
    """Positions on a line after so many steps of q' = q + dt p + f dt² u, p' = p + dt u, to 120 digits."""
    with mpmath.workdps(120):
        q, p = ([mpmath.mpf(float(x)) for x in each.ravel()] for each in (Q, P))
        c1, pulls = mpmath.mpf(law.gains.c1_alpha), mpmath.mpf(law.gains.c1_gamma)
        for _ in range(steps):
            u = [-pulls * x + c1 * sum(mpmath.sign(y - x) * pull(abs(y - x), law.alpha) for y in q) for x in q]
            q = [x + dt * (v + f * dt * w) for x, v, w in zip(q, p, u, strict=True)]
            p = [v + dt * w for v, w in zip(p, u, strict=True)]
        return np.array([float(x) for x in q])


@pytest.mark.parametrize(("scheme", "f"), [(SemiImplicitEuler, 1.0), (TaylorStep, 0.5), (ExplicitEuler, 0.0)])
def test_an_orbit_is_where_mpmath_has_it_whatever_the_order_of_the_agents(scheme, f):
    steps = 300 if f else 60  # explicit Euler leaves the finite numbers' neighbourhood soon
    for order in ([0, 1, 2, 3], [3, 2, 1, 0]):
        found = enclose_orbit(scheme(CHAOTIC, 0.0625), 0.0, Q[order], P[order], [0, steps])
        assert found.known == 2
        off = np.abs(found.q[-1].ravel() - orbit(CHAOTIC, f, 0.0625, steps)[order])
        assert (off <= found.q_off[-1].ravel()).all()
        assert found.q_off[-1].max() <= 1e-9


def test_precision_is_doubled_until_the_budget_is_spent():
    law = SemiImplicitEuler(CHAOTIC, 0.0625)
    short = enclose_orbit(law, 0.0, Q, P, list(range(585)), budget=200)
    assert (short.known < 585, short.spent) == (True, 1.0)
    whole = enclose_orbit(law, 0.0, Q, P, list(range(585)))
    assert (whole.known, whole.bits) == (585, 512)
    np.testing.assert_allclose(whole.q[: short.known], short.q[: short.known], atol=1e-8)
    assert np.isnan(short.q[short.known :]).all()


def test_a_sphere_and_a_leader_in_balls():
    """One step by hand: a lone agent far from a sphere is pulled to a leader at (t, 0); c1γ = 2, c2γ = 3, ℓ = 1."""
    law = Algorithm3(gains=Gains(c1_gamma=2.0, c2_gamma=3.0), target=LinearTarget((0.0, 0.0), (1.0, 0.0)),
                     obstacles=(Sphere((50.0, 50.0), 1.0),))  # fmt: skip
    found = enclose_orbit(SemiImplicitEuler(law, 0.5), 3.0, np.zeros((1, 2)), np.zeros((1, 2)), [1])
    u = 2.0 * 3.0 / np.sqrt(10.0) + 3.0
    assert found.p[0, 0].tolist() == pytest.approx([0.5 * u, 0.0], rel=1e-15)
    assert found.q[0, 0].tolist() == pytest.approx([0.25 * u, 0.0], rel=1e-15)


@pytest.mark.parametrize(
    "law",
    [
        SemiImplicitEuler(DeadZoneFlocking(), 0.02),
        SemiImplicitEuler(Algorithm2(target=CallableTarget(lambda t: ((0.0,), (0.0,)))), 0.02),
        SemiImplicitEuler(Algorithm2(gains=Gains(c1_gamma=(1.0, 0.0)), target=StaticTarget((0.0,))), 0.02),
        Algorithm1(),
    ],
)
def test_other_maps_have_no_ball_form(law):
    assert not has_ball_orbit(law)
    assert has_ball_orbit(TaylorStep(Algorithm1(), 0.01))
    assert has_ball_orbit(RK4(Algorithm1(), 0.01))


def test_a_runge_kutta_step_by_hand():
    """x'' = −x of a lone agent: RK4 multiplies (x, v) by the Taylor polynomial of degree four of the rotation."""
    law = Algorithm2(gains=Gains(c1_gamma=1.0, c2_gamma=0.0), target=StaticTarget((0.0,)))
    found, h = enclose_orbit(RK4(law, 0.5), 0.0, np.ones((1, 1)), np.zeros((1, 1)), [1]), 0.5
    assert found.q[0, 0, 0] == pytest.approx(1.0 - h**2 / 2.0 + h**4 / 24.0, rel=1e-15)
    assert found.p[0, 0, 0] == pytest.approx(-h + h**3 / 6.0, rel=1e-15)
