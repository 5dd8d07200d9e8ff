"""The link between library and proofs: a slip in a kernel, or in a formula, makes a step fail."""

from __future__ import annotations

import math
from math import pi, sin, sqrt

import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

import numpy as np
from flint import arb, ctx

from flockana.certified.intervals import AlphaParameters, BetaParameters, psi_alpha, psi_beta
from flockana.interactions import AlphaInteraction, BetaInteraction
from flockana.jit import register_jitable
from flockana.kernels import alpha, beta_slopes, scalars
from flockana.kernels import dead_zone as kernel
from proofs import library_formulas, library_pairs, library_potentials
from proofs.dead_zone_pairs import zones
from tests.proofs.steps import failing


def wrong_sigma_norm(x2, eps):
    return x2 / (sqrt(1.0 + eps * x2) + 2.0)


def wrong_action(s, par):
    return -repulsion(s, par)  # noqa: F821 the kernel's


def test_a_slip_in_a_kernel_is_told(monkeypatch):
    monkeypatch.setattr(scalars, "sigma_norm", register_jitable(wrong_sigma_norm))
    monkeypatch.setattr(scalars, "_S3", scalars._S3 * (1.0 + 2.0**-50))
    broken = failing(library_formulas._steps())
    assert [text.partition(":")[0] for text in broken] == ["σ-norm", "taper"]


def test_a_force_without_its_dead_zone_is_told(monkeypatch):
    wrong_action.__globals__["repulsion"] = kernel.repulsion
    names = zones(wide=False)
    assert all(library_formulas.force_residual(zone) == 0 for zone in names.values())
    monkeypatch.setattr(kernel, "action", register_jitable(wrong_action))
    told = {name for name, zone in names.items() if library_formulas.force_residual(zone) != 0}
    assert told == {"on the dead zone", "above d₂"}


def test_another_phi_is_told(monkeypatch):
    assert library_formulas.phi_residual(1) == 0
    monkeypatch.setattr(library_formulas, "sigma_1", lambda x: 2 * x)
    assert library_formulas.phi_residual(1) != 0


def test_the_error_of_the_taper_covers_what_is_measured():
    with ctx.workdps(30):
        bound = float(library_formulas.sine_error())
    assert 1e-17 < bound < 2e-16
    for z in (0.21, 0.5, 0.77, 0.999):
        exact = math.sin(0.5 * math.pi * (1.0 - z) / 0.8) ** 2
        assert scalars.taper(z, 0.2) == pytest.approx(exact, abs=bound + 4.0 * 2.0**-52)


def wrong_phi_slope(s, a, b, c):
    return 0.5 * (a + b) / sqrt(1.0 + (s + c) ** 2) ** 2


def wrong_bump_slope(z, h):
    return 0.5 * pi / (1.0 - h) * sin(pi * (z - h) / (1.0 - h))


def wrong_phi_integral(s, a, b, c):
    return 0.5 * (a + b) * (s / (sqrt(1.0 + (s + c) ** 2) + sqrt(1.0 + c * c))) ** 2


SLIPS = {  # in what is executed, and the steps that tell
    "another slope of the stress": (alpha, "pair_alpha_slope", alpha.pair_alpha_adjacency_slope, [5]),
    "another slope of the adjacency": (alpha, "pair_alpha_adjacency_slope", alpha.pair_alpha_slope, [6]),
    "a β-agent like an α-agent": (alpha, "pair_beta", alpha.pair_alpha, [7]),
    "another slope of a β-agent's weight": (beta_slopes, "pair_beta_slope", beta_slopes.adjacency_beta_slope, [8]),
    "another slope of its adjacency": (beta_slopes, "adjacency_beta_slope", beta_slopes.pair_beta_slope, [9]),
    "another power": (scalars, "phi_slope", register_jitable(wrong_phi_slope), [0]),
    "another sign": (scalars, "bump_slope", register_jitable(wrong_bump_slope), [1]),
    "an integral without the gap": (scalars, "phi_integral", register_jitable(wrong_phi_integral), [2, 3]),
}


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_in_a_pairs_kernel_is_told(slip, monkeypatch):
    module, name, wrong, steps = SLIPS[slip]
    monkeypatch.setattr(module, name, wrong)
    holds = [step.holds for step in library_pairs._steps()]
    assert len(holds) == library_pairs.PROOF.size
    assert [k for k, held in enumerate(holds) if held is not True] == steps


def test_slopes_of_pairs_are_derivatives_and_not_of_something_else():
    assert all(step.holds is True for step in library_pairs._steps())
    off = library_pairs.by_square(2 * library_pairs.stress())
    assert library_pairs.residual(alpha.pair_alpha_slope, library_pairs.ALPHA, off) != 0


def test_the_bound_of_the_potentials_error_covers_what_is_measured():
    for par, pair, exact, potential in (
        (AlphaParameters(), AlphaInteraction(), psi_alpha, AlphaInteraction().psi_alpha),
        (BetaParameters(), BetaInteraction(), psi_beta, BetaInteraction().psi_beta),
    ):
        with ctx.workdps(library_potentials.DIGITS):
            top = float(exact(arb(0), par))
            bound = float(library_potentials.error_of(par)) * top
            end = float(pair.panels[-1, 1])
            off = [abs(float(arb(float(potential(z))) - exact(arb(z), par))) for z in np.linspace(0.0, 1.1 * end, 40)]
        assert 1e-17 * top < bound < 1e-15 * top
        assert max(off) <= bound + 16.0 * 2.0**-53 * top  # of the evaluation


def test_a_panel_that_is_off_is_told():
    par, panels = AlphaParameters(), AlphaInteraction().panels
    with ctx.workdps(library_potentials.DIGITS):
        action = library_potentials.alpha_action(par)
        right = library_potentials.slope_error(panels[2], action)
        bent = panels[2].copy()
        bent[4] += 1e-12  # the square's coefficient
        assert float(right) < 1e-14
        assert float(library_potentials.slope_error(bent, action)) > 1.9e-12 / (bent[1] - bent[0])
        assert not library_potentials.on_circle(action, arb(14), arb(4)).is_finite()  # a pole of σ₁ is inside


def test_powers_become_chebyshev_polynomials():
    powers = [arb(3), arb(-1), arb(2), arb(5), arb(-7)]
    expected = np.polynomial.chebyshev.poly2cheb([float(x) for x in powers])
    assert [float(x) for x in library_potentials.chebyshev(powers)] == pytest.approx(expected.tolist(), rel=1e-15)


def test_potentials_hold_as_stated():
    steps = list(library_potentials.PROOF.steps())
    assert failing(steps) == []
    assert len(steps) == library_potentials.PROOF.size
    assert {k: v for step in steps for k, v in step.found.items()} == library_potentials.STATED
    assert ctx.cap == 10  # as it was
