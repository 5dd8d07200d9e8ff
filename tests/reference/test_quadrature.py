"""ψ_α and ψ_β against 30-digit quadrature: 1e-13 of c*, at every kink, beside it and between."""

import mpmath as mp
import numpy as np
import pytest

from flockana.interactions import AlphaInteraction, BetaInteraction
from tests.reference.values import ALPHA, PARAMETERS

TOL = 1e-13  # of c*: what the interaction promises
ULPS = 4 * 2.0**-52  # of ψ itself: where ψ(r_α) is hundreds of c* (r/d = 5), 1e-13 c* is below one ulp of the value


def _sigma_norm(x, eps):
    return x * x / (mp.sqrt(1 + eps * x * x) + 1)


def _integral(function, start, end, marks):
    inside = sorted({m for m in marks if min(start, end) < m < max(start, end)}, reverse=bool(start > end))
    return mp.quad(function, [start, *inside, end]) if start != end else mp.mpf(0)


def _running(function, start, stops, marks):
    """The integral from the start to each stop, one after the other."""
    found, value, at = {}, mp.mpf(0), start
    for z in stops:
        value, at = value + _integral(function, at, z, marks), z
        found[z] = value
    return found


def _points(*specials, top):
    beside = [np.nextafter(x, s) for x in specials for s in (-np.inf, np.inf)]
    near = [x * (1 + s * 1e-6) for x in specials for s in (-1.0, 1.0)]
    fractions = [top * f for f in (1e-9, 1e-3, 0.1, 0.37, 0.62, 0.88, 0.97, 1.3)]
    return sorted({float(x) for x in (0.0, *specials, *beside, *near, *fractions) if x >= 0.0})


@pytest.mark.slow
@pytest.mark.parametrize("par", PARAMETERS)
def test_psi_alpha_to_thirteen_digits_of_c_star(par):
    alpha = AlphaInteraction(*par)
    with mp.workdps(30):
        d, r, eps, h, a, b = (mp.mpf(x) for x in par)
        c, d_alpha, r_alpha = (b - a) / mp.sqrt(4 * a * b), _sigma_norm(d, eps), _sigma_norm(r, eps)
        knee = h * r_alpha

        def phi_alpha(z):
            s, x = z - d_alpha + c, z / r_alpha
            rho = mp.mpf(1) if x < h else (1 + mp.cos(mp.pi * (x - h) / (1 - h))) / 2 if x < 1 else mp.mpf(0)
            return rho * ((a + b) * s / mp.sqrt(1 + s * s) + (a - b)) / 2

        marks = [knee, r_alpha, *(d_alpha - c + s * mp.mpf(2) ** k for k in range(-1, 17) for s in (-1, 1))]
        points = _points(alpha.d_alpha, alpha.h * alpha.r_alpha, alpha.r_alpha, top=alpha.r_alpha)
        stops = [mp.mpf(z) for z in points]
        exact = _running(phi_alpha, d_alpha, [z for z in stops if z >= d_alpha], marks)
        exact |= _running(phi_alpha, d_alpha, [z for z in stops if z < d_alpha][::-1], marks)
        c_star = float(exact[mp.mpf(0)])
        computed = alpha.psi_alpha(np.array(points))
        errors = [float(mp.mpf(y) - exact[z]) for y, z in zip(computed, stops, strict=True)]
    assert np.all(np.abs(errors) <= TOL * c_star + ULPS * computed)
    assert np.all(computed >= -8 * 2.0**-52 * c_star)  # rounding where d_α lies on the taper
    assert alpha.c_star == pytest.approx(c_star, rel=TOL)
    assert float(alpha.psi_alpha(1e300)) == alpha.far_potential


@pytest.mark.parametrize(
    "par",
    [
        (4.2, 5.04, 0.1, 0.9),
        (60.0, 72.0, 1e-4, 0.01),
        (4.2, 21.0, 10.0, 0.99),
        (0.06, 0.072, 0.1, 0.9),
        (9.0, 10.8, 0.1, 0.5),
    ],
)
def test_psi_beta_to_thirteen_digits_of_its_largest(par):
    beta = BetaInteraction(*par)
    with mp.workdps(30):
        d, _, eps, h = (mp.mpf(x) for x in par)
        d_beta = _sigma_norm(d, eps)

        def phi_beta(z):
            s, x = z - d_beta, z / d_beta
            rho = mp.mpf(1) if x < h else (1 + mp.cos(mp.pi * (x - h) / (1 - h))) / 2 if x < 1 else mp.mpf(0)
            return rho * (s / mp.sqrt(1 + s * s) - 1)

        marks = [h * d_beta, *(d_beta - mp.mpf(2) ** k for k in range(-1, 17))]
        points = _points(beta.d_beta, beta.h * beta.d_beta, top=beta.d_beta)
        exact = _running(phi_beta, d_beta, [mp.mpf(z) for z in points if z < d_beta][::-1], marks)
        computed = beta.psi_beta(np.array(points))
        errors = [float(mp.mpf(y) - exact.get(mp.mpf(z), 0)) for y, z in zip(computed, points, strict=True)]
    assert max(map(abs, errors)) <= TOL * float(exact[mp.mpf(0)])


@pytest.mark.parametrize(("par", "values"), ALPHA.items())
def test_the_tabulated_values(par, values):
    alpha = AlphaInteraction(*par)
    c, d_alpha, r_alpha, at_0, at_r = values
    assert alpha.c == pytest.approx(c, rel=4e-16)
    assert alpha.d_alpha == pytest.approx(d_alpha, rel=4e-16)
    assert alpha.r_alpha == pytest.approx(r_alpha, rel=4e-16)
    assert abs(alpha.psi_alpha(0.0) - at_0) <= TOL * at_0
    assert abs(alpha.psi_alpha(alpha.r_alpha) - at_r) <= TOL * at_0
