"""The proved rate of decay: it satisfies its inequalities, exactly and sharply, and the search finds about the best."""

import numpy as np
import pytest
from flint import fmpq
from scipy.optimize import brentq

from flockana.certified.lyapunov import Bounds, decay, rate_of

BOUNDS = [
    Bounds(fmpq(1), fmpq(1, 2), fmpq(1), fmpq(1)),
    Bounds(fmpq(4), fmpq(3), fmpq(1, 2), fmpq(5)),
    Bounds(fmpq(1, 100), fmpq(1, 300), fmpq(2), fmpq(7, 2)),
]
# ε, θ, κ, τ as shares of what ε may be, 1, λ/M and √λ
CHOICES = [(0.25, 0.5, 0.25, 1.0), (0.1, 1.0, 0.5, 0.3), (0.05, 0.25, 0.1, 2.0), (0.2, 0.75, 0.11, 0.5)]


def exact(x):
    return fmpq(round(1e9 * x), 10**9)


def chosen(bounds, shares):
    root = float(bounds.curvature) ** 0.5
    kappa = shares[2] * float(bounds.curvature) / float(bounds.most)
    eps = shares[0] * min(root, float(bounds.least), 2.0 * kappa)
    return [exact(x) for x in (eps, shares[1], kappa, shares[3] * root)]


@pytest.mark.parametrize("bounds", BOUNDS)
@pytest.mark.parametrize("shares", CHOICES)
def test_the_rate_is_the_largest_that_satisfies_the_inequalities(bounds, shares):
    """As the module states them; one is an equality, or the rate is 0 and some cannot hold above it."""
    eps, theta, kappa, tau = chosen(bounds, shares)
    s, lam, mu, most = bounds.surplus, bounds.curvature, bounds.least, bounds.most
    alpha, c = rate_of(bounds, eps, theta, kappa, tau), theta * s + (1 - theta) * lam
    assert eps <= 2 * kappa
    gaps = [
        eps * theta - alpha,
        eps * (theta * lam / 2 + c - kappa * most / 2) - alpha * (lam / 2 + eps * tau / 2),
        (1 - eps / (2 * kappa)) * mu - eps - alpha * (fmpq(1, 2) + eps / (2 * tau)),
    ]
    assert alpha >= 0
    assert min(gaps) == 0 if alpha > 0 else min(gaps) <= 0


def test_outside_of_what_the_proof_allows_there_is_no_rate():
    """θ beyond [0, 1], ε beyond 2κ, and e = ε/√λ of 1 or more; at the ends of θ there is one."""
    bounds, tau = Bounds(fmpq(1), fmpq(1), fmpq(4), fmpq(4)), fmpq(1)
    eps, kappa = fmpq(1, 4), fmpq(1, 8)
    assert rate_of(bounds, eps, fmpq(1), fmpq(1, 4), tau) > 0
    assert rate_of(bounds, eps, fmpq(0), fmpq(1, 4), tau) == 0  # α <= εθ
    assert rate_of(bounds, eps, fmpq(-1, 100), fmpq(1, 4), tau) == 0
    assert rate_of(bounds, eps, fmpq(101, 100), fmpq(1, 4), tau) == 0
    assert rate_of(bounds, eps, fmpq(1, 2), kappa, tau) == 0  # ε = 2κ leaves no damping
    assert rate_of(bounds, fmpq(26, 100), fmpq(1, 2), kappa, tau) == 0
    strong = Bounds(fmpq(1), fmpq(1), fmpq(100), fmpq(101, 100))
    assert rate_of(strong, fmpq(99, 100), fmpq(1, 2), fmpq(1), tau) > 0
    assert rate_of(strong, fmpq(1), fmpq(1, 2), fmpq(1), tau) == 0


@pytest.mark.parametrize("bounds", BOUNDS)
def test_the_search_finds_about_the_best(bounds):
    """No better is any of 4000 other choices, some nearly as good; numbers are rounded to what is proved."""
    found = decay(bounds)
    alpha = rate_of(bounds, found.eps, found.theta, found.kappa, found.tau)
    assert 0 < found.rate <= alpha / 2 <= found.rate * fmpq(1011, 1000)
    share = float(found.eps) / float(bounds.curvature) ** 0.5
    assert (1 + share) / (1 - share) * (1 - 1e-12) <= float(found.overshoot) <= 1.011 * (1 + share) / (1 - share)
    tried = np.random.default_rng(0).uniform(0.02, 1.0, (4000, 4)) * [0.5, 1.0, 1.0, 3.0]
    assert max(float(rate_of(bounds, *chosen(bounds, shares))) for shares in tried) <= 1.001 * float(alpha)
    near = np.random.default_rng(1).uniform(0.95, 1.05, (500, 4))
    own = [float(x) for x in (found.eps, found.theta, found.kappa, found.tau)]
    beside = [float(rate_of(bounds, *map(exact, own * factors))) for factors in near]
    assert 0.8 * float(alpha) < max(beside) <= 1.002 * float(alpha)


def test_of_a_spring_between_its_own_inequalities():
    """x'' + x' + x = 0 with s = ½: θ = 1, α = ε, X = ½ and κ = τ = 1/(1 + ε), so 1 = ε/2 + ε (1 + (1 + ε)²/2)."""
    alpha = brentq(lambda a: 1.0 - 0.5 * a - a * (1.0 + 0.5 * (1.0 + a) ** 2), 0.1, 0.9)
    found = decay(BOUNDS[0])
    assert [float(x) for x in (found.eps, found.theta)] == pytest.approx([alpha, 1.0], rel=3e-3)
    assert found.kappa == found.tau
    assert 2.0 * float(found.rate) == pytest.approx(alpha, rel=6e-3)


def test_where_curvature_is_so_small_that_choices_are_close_there_is_a_rate_still():
    assert decay(Bounds(fmpq(1, 50), fmpq(1, 500), fmpq(3), fmpq(30))).rate > fmpq(36, 10**5)
    assert decay(Bounds(fmpq(1), fmpq(1), fmpq(1, 10**9), fmpq(1))).rate > fmpq(1, 10**10)  # next to no damping
    assert decay(Bounds(fmpq(1), fmpq(-(10**6)), fmpq(1), fmpq(10**6))).rate > fmpq(3, 10**13)
