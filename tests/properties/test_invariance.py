"""Symmetries and identities of the laws, for any configuration."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.targets import CircleTarget, StaticTarget
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.measures import metrics

GAINS = Gains(c1_alpha=2.0, c2_alpha=0.8, c1_gamma=0.4, c2_gamma=0.6)
ALPHAS = [AlphaInteraction(), AlphaInteraction(h=0.9, a=2.0, b=7.0), AlphaInteraction(d=2.0, r=9.0, eps=1.0)]
flocks = st.tuples(st.integers(0, 2**32 - 1), st.integers(1, 25), st.integers(1, 3), st.sampled_from(ALPHAS))


def state(seed, n, m, *, spread=5.0):
    rng = np.random.default_rng(seed)
    return rng.uniform(-1, 1, (n, m)) * spread * n ** (1 / m), rng.normal(0.0, 1.0, (n, m)), rng


def settled(q, alpha, gap=2e-2):
    """No pair so near r or the kink of the taper that a difference would straddle it."""
    i, j = np.triu_indices(len(q), 1)
    s = np.linalg.norm(q[i] - q[j], axis=1)
    z = alpha.h * alpha.r_alpha
    knee = np.sqrt(z * (2.0 + alpha.eps * z))
    return bool(np.all(np.abs(s - alpha.r) > gap) and np.all(np.abs(s - knee) > gap))


@given(flocks)
def test_rigid_motions_and_relabelling(flock):
    """Translation, rotation or reflection, permutation: u turns with the flock, energies and metrics stay."""
    seed, n, m, alpha = flock
    q, p, rng = state(seed, n, m)
    law = Algorithm1(alpha, GAINS)
    turn = np.linalg.qr(rng.normal(size=(m, m)))[0]
    shift, order = rng.normal(0.0, 50.0, m), rng.permutation(n)
    q2, p2 = (q @ turn + shift)[order], (p @ turn)[order]
    u, u2 = law.acceleration(0.0, q, p), law.acceleration(0.0, q2, p2)
    np.testing.assert_allclose(u2, (u @ turn)[order], atol=1e-10 * (1 + np.abs(u).max()))
    for f in (law.energy, law.energy_rate):
        assert f(0.0, q2, p2) == pytest.approx(f(0.0, q, p), rel=1e-10, abs=1e-10)
    assert metrics.net_measures(q2, alpha.d, alpha.r) == pytest.approx(metrics.net_measures(q, alpha.d, alpha.r))
    for f in (metrics.cohesion_radius, metrics.inertia, metrics.min_distance):
        assert f(q2) == pytest.approx(f(q), rel=1e-9, abs=1e-12)
    assert metrics.velocity_mismatch(p2) == pytest.approx(metrics.velocity_mismatch(p), rel=1e-10)
    assert metrics.order(p2) == pytest.approx(metrics.order(p), rel=1e-10)


@given(flocks)
def test_action_equals_reaction(flock):
    seed, n, m, alpha = flock
    q, p, _ = state(seed, n, m)
    u = Algorithm1(alpha, GAINS).acceleration(0.0, q, p)
    assert np.abs(u.sum(axis=0)).max() <= 1e-13 * n * (1 + np.abs(u).max())


@given(flocks)
def test_force_is_minus_the_gradient_and_hessian_its_derivative(flock):
    """Fourth-order differences with step 1e-3, away from the kinks: error about 1e-8 of the largest entry."""
    seed, n, m, alpha = flock
    n = min(n, 6)
    q, _, _ = state(seed, n, m)
    if not settled(q, alpha):
        return
    law = Algorithm2(alpha, Gains(2.0, 0.0, 0.0, 0.0, 0.4, 0.0), StaticTarget(q.mean(axis=0)))
    h, still = 1e-3, np.zeros_like(q)
    force, hessian = law.acceleration(0.0, q, still), law.stiffness(q).toarray()
    gradient, columns = np.zeros(q.size), np.zeros((q.size, q.size))
    for k in range(q.size):
        step = np.zeros(q.size)
        step[k] = h
        step = step.reshape(q.shape)
        near, far = ((q + s * step, q - s * step) for s in (1, 2))
        e = [law.energy(0.0, x, still) for x in (*near, *far)]
        gradient[k] = (8 * (e[0] - e[1]) - (e[2] - e[3])) / (12 * h)
        f = [law.alpha.forces(x, still, stiffness=2.0, damping=0.0)[0] - 0.4 * x for x in (*near, *far)]
        columns[:, k] = ((8 * (f[0] - f[1]) - (f[2] - f[3])) / (12 * h)).ravel()
    # rounding of the energy is 1e-16 E/h; the taper's fifth derivative gives the rest
    scale = 1 + np.abs(force).max() + 1e-3 * abs(law.energy(0.0, q, still))
    np.testing.assert_allclose(-gradient.reshape(q.shape), force, atol=1e-7 * scale)
    np.testing.assert_allclose(-columns, hessian, atol=1e-6 * (1 + np.abs(hessian).max()))


@pytest.mark.parametrize("moving", [True, False])
@pytest.mark.parametrize("algorithm", [1, 2])
@given(flocks)
def test_energy_rate_is_the_derivative_along_the_flow(algorithm, moving, flock):
    """H(q + p s + ½u s², p + u s) has the right first derivative at s = 0, for any target."""
    seed, n, m, alpha = flock
    q, p, _ = state(seed, n, m)
    if not settled(q, alpha):
        return
    m = q.shape[1]
    circle = CircleTarget((1.0, 2.0, 3.0)[:m], 4.0, 0.3) if m > 1 else StaticTarget((1.0,), (2.0,))
    target = circle if moving else StaticTarget(np.ones(m))
    law = Algorithm1(alpha, GAINS) if algorithm == 1 else Algorithm2(alpha, GAINS, target)
    t, h = 0.7, 2e-4
    u, rate = law.acceleration(t, q, p), law.energy_rate(t, q, p)
    e = [law.energy(t + s * h, q + s * h * p + 0.5 * (s * h) ** 2 * u, p + s * h * u) for s in (-2, -1, 1, 2)]
    difference = (8 * (e[2] - e[1]) - (e[3] - e[0])) / (12 * h)
    assert rate <= 0.0
    assert difference == pytest.approx(rate, abs=1e-7 * (1 + abs(rate)) + 1e-14 * abs(e[0]) / h)


@given(flocks)
def test_the_energy_balance_of_short_runs_closes(flock):
    """Residual at rtol 1e-8 within 1e-6 of the energy."""
    seed, n, m, alpha = flock
    q, p, _ = state(seed, min(n, 8), m)
    law = Algorithm2(alpha, GAINS, StaticTarget(np.zeros(m)))
    run = simulate(law, q, p, (0.0, 0.3))
    assert np.abs(run.energy_residual).max() <= 1e-6 * (1.0 + run.energy()[0])


@settings(max_examples=10)
@given(st.integers(0, 2**32 - 1), st.integers(1, 6), st.integers(1, 3), st.integers(1, 4))
def test_files_keep_every_bit(tmp_path_factory, seed, n, m, samples):
    rng = np.random.default_rng(seed)
    q, p, u = rng.normal(0.0, 10.0 ** rng.integers(-300, 300), (3, samples, n, m))
    extra = {"work": rng.normal(size=samples), "memory": rng.normal(size=(samples, n, 2))}
    run = Trajectory(np.arange(samples) / 3.0, q, p, u, Algorithm1(), extra, "failed", "π ≠ 3", {"dt": 0.1, "x": [1]})
    again = Trajectory.load(run.save(tmp_path_factory.mktemp("run") / "run.nc"))
    for name in ("t", "q", "p", "u"):
        np.testing.assert_array_equal(getattr(again, name), getattr(run, name))
    assert set(again.extra) == set(extra)
    for name, series in extra.items():
        np.testing.assert_array_equal(again.extra[name], series)
    assert (again.law, again.status, again.message) == (run.law, "failed", "π ≠ 3")
