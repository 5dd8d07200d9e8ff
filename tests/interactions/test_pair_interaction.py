"""Pair laws: exact facts, refusals, and the sums' Hessian and Laplacian by hand."""

import pickle
import re
from dataclasses import FrozenInstanceError
from math import sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import flockana as fl
from flockana.base.errors import ArgumentError
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains, PairInteraction
from flockana.kernels.neighbours import BLOCK, pair_list
from flockana.lattice import hexagonal_patch


@pytest.mark.parametrize(
    ("cls", "options", "message"),
    [
        (AlphaInteraction, {"d": 0.0}, "d = 0: expected a number > 0"),
        (AlphaInteraction, {"d": np.nan}, "d = nan: expected a finite number"),
        (AlphaInteraction, {"r": "x"}, "r = 'x': expected one real number"),
        (AlphaInteraction, {"r": 7.0}, "r = 7 and d = 7: expected r > d; the paper takes r = 1.2 d"),
        (AlphaInteraction, {"eps": -0.1}, "eps = -0.1: expected a number > 0"),
        (AlphaInteraction, {"h": 0.0}, "h = 0: expected 0 < h < 1; at h = 1 the bump jumps"),
        (AlphaInteraction, {"h": 1.0}, "h = 1: expected 0 < h < 1"),
        (AlphaInteraction, {"a": 0.0}, "a = 0: expected a number > 0"),
        (AlphaInteraction, {"a": 9.0}, "a = 9 and b = 5: expected a <= b (attraction at most repulsion)"),
        (AlphaInteraction, {"a": 1e-9, "b": 1e9}, "expected b <= 1e+12 a"),
        (AlphaInteraction, {"d": 1e200, "r": 2e200}, "expected 0 < d_sigma < r_sigma, all finite"),
        (AlphaInteraction, {"d": 1e-200, "r": 2e-200}, "their σ-norms are 0 and 0"),
        (BetaInteraction, {"d": -1.0}, "d = -1: expected a number > 0"),
        (BetaInteraction, {"r": 4.2}, "r = 4.2 and d = 4.2: expected r > d; the paper takes r' = 1.2 d'"),
        (BetaInteraction, {"h": 1.5}, "h = 1.5: expected 0 < h < 1"),
        (BetaInteraction, {"d": 1e-200}, "their σ-norms are 0"),
        (Gains, {"c2_alpha": -1.0}, "c2_alpha = -1: expected a gain >= 0; a negative one feeds energy in"),
        (Gains, {"c1_gamma": np.inf}, "c1_gamma = inf: expected a finite number"),
    ],
)
def test_bad_parameters(cls, options, message):
    with pytest.raises(ArgumentError, match=re.escape(message)):
        cls(**options)


def test_what_a_pair_law_must_define():
    wanted = {"far_potential", "length", "panels", "par", "range", "strength"}
    assert PairInteraction.__abstractmethods__ == wanted
    assert all(isinstance(vars(PairInteraction)[name], property) for name in wanted - {"range"})


def test_defaults_are_the_papers():
    alpha, beta, gains = AlphaInteraction(), BetaInteraction(), Gains()
    assert (alpha.d, alpha.r, alpha.eps, alpha.h, alpha.a, alpha.b) == (7.0, 8.4, 0.1, 0.2, 5.0, 5.0)
    assert (beta.d, beta.r, beta.eps, beta.h) == (4.2, 5.04, 0.1, 0.9)
    assert (gains.c1_alpha, gains.c2_alpha) == (30.0, 2 * sqrt(30.0))
    assert (gains.c1_beta, gains.c2_beta) == (1500.0, 2 * sqrt(1500.0))
    assert (gains.c1_gamma, gains.c2_gamma) == (1.1, 2 * sqrt(1.1))


def test_by_hand():
    """ε = 1 and r² = 24: r_α = 4; a = 1, b = 4: c = 3/4."""
    alpha = AlphaInteraction(d=sqrt(8.0), r=sqrt(24.0), eps=1.0, h=0.5, a=1.0, b=4.0)
    assert (alpha.c, alpha.d_alpha) == pytest.approx((0.75, 2.0), rel=1e-15)
    assert alpha.r_alpha == pytest.approx(4.0, rel=1e-15)
    assert alpha.kappa == pytest.approx(sqrt(3.0), rel=1e-15)
    assert alpha.sigma_norm(sqrt(15.0)) == pytest.approx(3.0, rel=1e-15)
    assert alpha.adjacency(3.0) == pytest.approx(0.5, rel=1e-14)
    s = 1.0 + 0.75
    assert alpha.phi(1.0) == pytest.approx(0.5 * (5 * s / sqrt(1 + s * s) - 3), rel=1e-14)
    assert alpha.phi_alpha(3.0) == pytest.approx(0.5 * alpha.phi(1.0), rel=1e-14)
    # below d_α the bump is 1: ψ in closed form from 0
    assert alpha.c_star == pytest.approx(0.5 * (5 * (sqrt(1 + 1.25**2) - 1.25) + 6), rel=1e-14)


def test_shapes_go_through_and_scalars_stay_scalars():
    alpha, beta = AlphaInteraction(), BetaInteraction()
    z = np.array([[0.0, 3.0], [14.0, 20.0], [1.0, 2.0]])
    methods = (alpha.sigma_norm, alpha.bump, alpha.phi, alpha.phi_alpha, alpha.psi_alpha, alpha.adjacency)
    for f in (*methods, alpha.phi_alpha_slope, beta.phi_beta, beta.psi_beta, beta.adjacency):
        values = f(z)
        assert values.shape == (3, 2)
        assert isinstance(f(3.0), float)
        assert f(3.0) == values[0, 1]
        assert np.isnan(f(np.nan)), f.__name__
        assert f(np.zeros((0,))).shape == (0,)


def test_beyond_the_range():
    alpha, beta = AlphaInteraction(), BetaInteraction()
    for z in (alpha.r_alpha, 1e3, np.inf):
        assert (alpha.phi_alpha(z), alpha.adjacency(z)) == (0.0, 0.0)
        assert alpha.psi_alpha(z) == alpha.far_potential
    assert alpha.sigma_norm(1e200) == np.inf  # its square is
    for z in (beta.d_beta, 1e3, np.inf):
        assert (beta.phi_beta(z), beta.psi_beta(z), beta.adjacency(z)) == (0.0, 0.0, 0.0)


@given(
    st.floats(0.1, 100),
    st.floats(1.01, 5),
    st.floats(1e-4, 10),
    st.floats(0.01, 0.99),
    st.floats(0.5, 10),
    st.floats(1, 5),
)
def test_signs_and_slopes_of_any_alpha(d, kappa, eps, h, a, ratio):
    """φ_α < 0 < ψ_α below d_α, φ_α > 0 above; ψ_α' = φ_α; φ_α(d_α) = 0 exactly."""
    alpha = AlphaInteraction(d, kappa * d, eps, h, a, ratio * a)
    d_alpha, r_alpha = alpha.d_alpha, alpha.r_alpha
    assert alpha.phi_alpha(d_alpha) == 0.0
    # one rounding of the largest value on the panels, which for r far beyond d is ψ(r)
    assert abs(alpha.psi_alpha(d_alpha)) <= np.finfo(float).eps * max(alpha.c_star, alpha.far_potential)
    below, above = np.linspace(0.0, d_alpha, 30)[:-1], np.linspace(d_alpha, r_alpha, 30)[1:-1]
    assert np.all(alpha.phi_alpha(below) < 0.0)
    assert np.all(alpha.phi_alpha(above) > 0.0)
    psi = alpha.psi_alpha(np.concatenate([below, [d_alpha], above]))
    assert np.all(np.diff(psi[:30]) < 0.0)
    assert np.all(np.diff(psi[29:]) >= 0.0)
    z, step = np.concatenate([below[2:], above[:-2]]), 1e-4 * min(d_alpha, r_alpha - d_alpha, 1.0)
    z = z[np.abs(z - h * r_alpha) > 3 * step]  # φ_α' jumps there
    f = alpha.psi_alpha
    difference = (8 * (f(z + step) - f(z - step)) - (f(z + 2 * step) - f(z - 2 * step))) / (12 * step)
    # rounding of ψ over the step, and the fifth derivative of the steepest taper
    noise = 4e-16 * psi.max() / step
    taper = (np.pi / (1 - h) / r_alpha) ** 4 * step**4 * alpha.b
    np.testing.assert_allclose(difference, alpha.phi_alpha(z), atol=float(20 * noise + taper + 1e-9 * alpha.b))


@given(st.floats(0.05, 100), st.floats(1e-4, 10), st.floats(0.01, 0.99))
def test_signs_of_any_beta(d, eps, h):
    beta = BetaInteraction(d, 1.2 * d, eps, h)
    z = np.linspace(0.0, beta.d_beta, 40)[:-1]
    assert np.all(beta.phi_beta(z) < 0.0)
    assert np.all(np.diff(beta.psi_beta(z)) < 0.0)
    assert beta.psi_beta(z[-1]) >= 0.0


def test_beta_by_hand():
    beta = BetaInteraction(d=sqrt(24.0), r=7.0, eps=1.0, h=0.5)
    assert beta.d_beta == pytest.approx(4.0, rel=1e-15)
    assert beta.r_beta == pytest.approx(sqrt(50.0) - 1.0, rel=1e-15)
    assert beta.phi_beta(1.0) == pytest.approx(-3.0 / sqrt(10.0) - 1.0, rel=1e-14)
    assert beta.phi_beta(3.0) == pytest.approx(0.5 * (-1.0 / sqrt(2.0) - 1.0), rel=1e-14)
    # ψ_β(0) − ψ_β(2) in closed form: √17 − √5 + 2
    assert beta.psi_beta(0.0) - beta.psi_beta(2.0) == pytest.approx(sqrt(17.0) - sqrt(5.0) + 2.0, rel=1e-14)
    assert beta.adjacency(3.0) == pytest.approx(0.5, rel=1e-14)


def test_hessian_of_a_pair_by_hand():
    """Along the pair dF/ds, across it F/s; zero row sums; beyond the range nothing."""
    alpha = AlphaInteraction()
    for gap in (3.0, 7.0, 8.0):
        z, g = alpha.sigma_norm(gap), 1.0 + 0.1 * gap**2
        along = alpha.phi_alpha_slope(z) * gap**2 / g + alpha.phi_alpha(z) / g**1.5
        across = alpha.phi_alpha(z) / sqrt(g)
        block = np.diag([along, across])
        expected = np.block([[block, -block], [-block, block]])
        computed = alpha.hessian(np.array([[0.0, 0.0], [gap, 0.0]])).toarray()
        np.testing.assert_allclose(computed, expected, atol=1e-13 * np.abs(expected).max())
    assert alpha.hessian(np.array([[0.0, 0.0], [8.4, 0.0]])).nnz == 0
    assert alpha.hessian(np.zeros((1, 3))).toarray().tolist() == np.zeros((3, 3)).tolist()


def test_pairs_that_come_in_several_blocks_are_summed_as_in_one():
    """Whose arrays are used again for the next; and none at all."""
    alpha, q = AlphaInteraction(), hexagonal_patch(45, 7.0)
    q += 0.1 * np.random.default_rng(0).normal(size=q.shape)
    i, j = pair_list(q, alpha.range)
    assert i.size > 2 * BLOCK
    for matrix in (alpha.hessian, alpha.laplacian):
        found, expected = matrix(q), matrix(q, [(i, j)])
        assert abs(found - expected).max() <= 1e-14 * abs(expected).max()
        assert found.nnz == expected.nnz == 4 * (2 * i.size + len(q))
        assert (matrix(q, []).shape, matrix(q, []).nnz) == ((2 * len(q), 2 * len(q)), 0)


def test_laplacian_of_a_path_by_hand():
    alpha = AlphaInteraction()
    q = np.array([[0.0], [5.0], [12.0]])
    a, b = (alpha.adjacency(alpha.sigma_norm(x)) for x in (5.0, 7.0))
    expected = [[a, -a, 0.0], [-a, a + b, -b], [0.0, -b, b]]
    np.testing.assert_allclose(alpha.laplacian(q).toarray(), expected, rtol=1e-15)
    q2 = np.column_stack([q, 0 * q])
    np.testing.assert_allclose(alpha.laplacian(q2).toarray(), np.kron(expected, np.eye(2)), rtol=1e-15)


def test_frozen_hashable_and_portable():
    alpha = AlphaInteraction()
    with pytest.raises(FrozenInstanceError):
        alpha.d = 3.0
    with pytest.raises(ValueError, match="read-only"):
        alpha.par[0] = 1.0
    assert hash(alpha) == hash(AlphaInteraction())
    again = pickle.loads(pickle.dumps(alpha))
    assert again == alpha
    assert again.c_star == alpha.c_star


def test_extreme_bumps_still_work():
    """A taper of no width at all, and one that begins at once."""
    steep = AlphaInteraction(h=float(np.nextafter(1.0, 0.0)))
    assert steep.far_potential == pytest.approx(5.0 * (sqrt(1 + (steep.r_alpha - steep.d_alpha) ** 2) - 1.0), rel=1e-12)
    early = AlphaInteraction(h=1e-300)
    assert 0.0 < early.c_star < AlphaInteraction().c_star


def test_a_force_without_a_limit_excludes_coincidence():
    assert [fl.AlphaInteraction().coincidence, fl.DeadZoneInteraction().coincidence] == [True, False]
    for formula in ("1/s", "log(s)", "exp(-s)"):
        assert not fl.pair_law(formula, adjacency="1-s/r", range=5.0, length=4.0).coincidence


@pytest.mark.parametrize("pair", [fl.DeadZoneInteraction(), fl.pair_law("1/s", adjacency="1-s/r", range=5.0, length=4)])
def test_coincident_agents_have_no_derivative_where_their_force_has_no_limit(pair):
    law, q, p = fl.Algorithm1(pair), [[0.0, 0.0], [0.0, 0.0], [1.0, 1.0]], [[1.0, 0.0], [0.0, 0.0], [0.0, 0.0]]
    with pytest.raises(ArgumentError, match="agents 0 and 1 coincide"):
        law.acceleration(0.0, q, p)
    for derivative in (lambda: law.jacobian(0.0, q, p), lambda: law.stiffness(q)):
        with pytest.raises(ArgumentError, match="agents 0 and 1 are 0 apart: the pair law has no derivative there"):
            derivative()
