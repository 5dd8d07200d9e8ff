"""The link between library and proofs: a slip in a kernel, or in a formula, makes a step fail."""

import math

import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

import numpy as np
import sympy as sp
from flint import arb, ctx

from flockana.certified.balls import AlphaParameters, BetaParameters
from flockana.certified.scalar_functions_in_balls import psi_alpha, psi_beta
from flockana.interactions import AlphaInteraction, BetaInteraction
from flockana.jit import register_jitable
from flockana.kernels import scalars, sine_and_cosine
from flockana.sources.li_dead_zone.kernels import pair as kernel
from flockana.symbolic.named_functions import Phi, PhiAbove, PhiIntegral, SigmaNorm
from proofs import library_formulas, library_potentials
from proofs.dead_zone_pairs import zones
from tests.proofs.steps import failing


def wrong_action(s, par):
    return -repulsion(s, par)  # noqa: F821 the kernel's


def test_a_slip_in_a_sine_is_told(monkeypatch):
    monkeypatch.setattr(sine_and_cosine, "_S3", sine_and_cosine._S3 * (1.0 + 2.0**-50))
    assert [text.partition(":")[0] for text in failing(library_formulas._steps())] == ["taper"]


SLIPS = {
    SigmaNorm: lambda node: node.args[0] / (2 + sp.sqrt(1 + node.args[1] * node.args[0])),
    PhiAbove: lambda node: node.args[0] ** 2,
    PhiIntegral: lambda node: Phi(*node.args).formula,
}


@pytest.mark.parametrize("function", SLIPS)
def test_another_form_is_told(function, monkeypatch):
    monkeypatch.setattr(function, "stable", property(SLIPS[function]))
    told = [text.partition(",")[0].partition(":")[0] for text in failing(library_formulas._steps())]
    assert told == (["σ-norm"] if function is SigmaNorm else ["φ and ∫φ", "φ and ∫φ"])


def test_a_force_without_its_dead_zone_is_told(monkeypatch):
    wrong_action.__globals__["repulsion"] = kernel.repulsion
    names = zones(wide=False)
    assert all(library_formulas.force_residual(zone) == 0 for zone in names.values())
    monkeypatch.setattr(kernel, "action", register_jitable(wrong_action))
    told = {name for name, zone in names.items() if library_formulas.force_residual(zone) != 0}
    assert told == {"on the dead zone", "above d₂"}


def test_the_error_of_the_taper_covers_what_is_measured():
    with ctx.workdps(30):
        bound = float(library_formulas.sine_error())
    assert 1e-17 < bound < 2e-16
    for z in (0.21, 0.5, 0.77, 0.999):
        exact = math.sin(0.5 * math.pi * (1.0 - z) / 0.8) ** 2
        assert scalars.taper(z, 0.2) == pytest.approx(exact, abs=bound + 4.0 * 2.0**-52)


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
