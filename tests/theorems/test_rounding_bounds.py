"""Bounds of rounding, held against numbers of fifty digits."""

import mpmath
import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Algorithm3, AlphaInteraction, Gains, Sphere, StaticTarget
from flockana.theorems.rounding_bounds import deepest_of, energy_error, frame_error, pair_force_error, spread_error
from tests.adversarial import truth

PAIRS = [
    AlphaInteraction(d=7.0, r=8.4),
    AlphaInteraction(d=7.0, r=8.4, a=1.0, b=9.0, h=0.9),
    AlphaInteraction(d=7e-6, r=8.4e-6),
    AlphaInteraction(d=7e-6, r=8.4e-6, a=1.0, b=9.0),
    AlphaInteraction(d=3e3, r=4e3, eps=0.7),
    AlphaInteraction(d=0.3, r=0.9, eps=5.0, unit=0.02),
]


def exact_force(pair, x):
    """φ_α(‖x‖_σ) x/√(1 + εx²) of a stored length x, as the definitions have it."""
    with mpmath.workdps(50):
        eps, a, b, h, area = (mpmath.mpf(each) for each in (pair.eps, pair.a, pair.b, pair.h, pair.unit**2))

        def norm(s):
            return (mpmath.sqrt(1 + eps * mpmath.mpf(s) ** 2) - 1) / eps

        z, d_alpha, r_alpha, c = norm(x), norm(pair.d), norm(pair.r), (b - a) / mpmath.sqrt(4 * a * b)
        s = (z - d_alpha) / area + c
        phi = ((a + b) * s / mpmath.sqrt(1 + s**2) + a - b) / 2
        share = z / r_alpha
        bump = mpmath.mpf(1) if share < h else (1 + mpmath.cos(mpmath.pi * (share - h) / (1 - h))) / 2
        return bump * phi * mpmath.mpf(x) / mpmath.sqrt(1 + eps * mpmath.mpf(x) ** 2)


@pytest.mark.parametrize("pair", PAIRS)
def test_the_force_of_a_pair_is_as_exact_as_is_said_and_not_much_better(pair):
    lengths = np.concatenate([np.linspace(0.02, 0.999, 300) * pair.r, pair.d * (1.0 + np.linspace(-1e-6, 1e-6, 41))])
    off = []
    for x in lengths.tolist():
        q = np.array([[0.0], [x]])
        force = Algorithm1(pair, Gains(c1_alpha=1.0, c2_alpha=0.0)).flow(0.0, q, 0.0 * q)[0][0, 0]
        off.append(abs(float(force - exact_force(pair, x))))
    assert max(off) <= pair_force_error(pair)
    assert max(off) >= 1e-3 * pair_force_error(pair)


@pytest.mark.slow
@pytest.mark.parametrize("pair", PAIRS)
def test_the_energy_of_a_flock_is_as_exact_as_is_said(pair):
    rng, law = np.random.default_rng(0), Algorithm1(pair)
    for far in (0.0, 1e4):
        q = pair.d * (far + rng.uniform(0.0, 2.0, (5, 2)))
        p = law.scales.speed * rng.normal(size=(5, 2))
        energy = law.structural_energy(q, p)
        exact = truth.structural_energy(law, q, p)
        bound = energy_error(law, q[None], p[None], np.array([energy]))[0]
        assert abs(float(energy - exact)) <= bound
        assert bound <= 1e-6 * abs(energy)


def test_the_frame_and_the_spread():
    rng = np.random.default_rng(1)
    for far in (1.0, 1e8):
        x = far + rng.normal(size=(4, 6, 2))
        with mpmath.workdps(50):
            for k, states in enumerate(x.tolist()):
                rows = [[mpmath.mpf(value) for value in row] for row in states]
                mean = [sum(column) / 6 for column in zip(*rows, strict=True)]
                own = x[k] - x[k].mean(axis=0)
                exact = [[value - c for value, c in zip(row, mean, strict=True)] for row in rows]
                worst = max(abs(float(own[i, c] - exact[i][c])) for i in range(6) for c in range(2))
                assert worst <= frame_error(x)
                half = sum(value**2 for row in exact for value in row) / 2
                assert abs(float(0.5 * np.sum(own * own) - half)) <= spread_error(x)[k]


@pytest.mark.parametrize(("n", "pairs"), [(2, 1), (3, 3), (5, 10)])
def test_what_an_energy_of_zero_at_rest_is_off_by_is_that_of_its_pairs(n, pairs):
    """Each by 1e-13 c*, and by the force times the rounding of its length; c1α times."""
    pair, eps = PAIRS[1], np.finfo(float).eps
    q = np.zeros((1, n, 1))
    q[0, -1, 0] = -50.0
    law = Algorithm1(pair, Gains(c1_alpha=2.0))
    bound = energy_error(law, q, 0.0 * q, np.zeros(1))[0]
    each = 1e-13 * pair.c_star + 8.0 * eps * 1.01 * pair.strength * (pair.range + 50.0)
    assert bound == pytest.approx(2.0 * pairs * each, rel=1e-12)
    more = energy_error(law, q, 0.0 * q, np.array([-7.0]))[0] - bound
    assert more == pytest.approx((pairs + n + 8) * eps * 7.0, rel=1e-3, abs=0.0)


def test_a_pull_and_an_obstacle_add_theirs():
    eps, q = np.finfo(float).eps, np.array([[[0.0, 0.0], [-50.0, 0.0]]])
    pull = Gains(c1_alpha=0.0, c1_gamma=3.0)
    law = Algorithm2(gains=pull, target=StaticTarget((0.0, 20.0)))
    bound = energy_error(law, q, 0.0 * q, np.zeros(1))[0]
    assert bound == pytest.approx(3.0 * (2 + 8) * eps * 70.0**2, rel=1e-12)
    among = Algorithm3(gains=pull, target=law.target, obstacles=(Sphere((100.0, 0.0), 10.0),) * 2)
    beta = among.beta
    each = 1e-13 * float(beta.psi_beta(0.0)) + 16.0 * eps * 2.0 / np.sqrt(beta.eps) * (beta.r + 70.0)
    more = energy_error(among, q, 0.0 * q, np.zeros(1))[0] - bound
    assert more == pytest.approx(2.0 * among.gains.c1_beta * 2 * each, rel=1e-9)


def test_the_depth_of_olfati_saber_s_pair_is_c_star():
    assert deepest_of(AlphaInteraction()) == AlphaInteraction().c_star
