"""The dead-zone law's algebra: primitives, jumps, the energy identity; and the kernels against it."""

import numpy as np
import pytest
import sympy as sp

from flockana.sources.li_dead_zone import DeadZoneInteraction
from flockana.sources.li_dead_zone import symbolic as dead

NAMES = {"d_1": "d1", "d_2": "d2", "k_1": "k1", **{name: name for name in ("r", "r_d", "k_r", "k_delta", "eta")}}


def with_numbers(expression, pair):
    parameters = expression.free_symbols - {dead.RHO}
    return expression.subs({s: sp.Rational(str(getattr(pair, NAMES[s.name]))) for s in parameters})


def test_the_primitives_are_primitives_for_eta_zero_and_positive():
    found = dead.derive_potential()
    assert found.residuals == (0, 0, 0, 0, 0)
    assert r"\operatorname{asinh}" in found.latex()


@pytest.mark.parametrize("m", [1, 2, 3])
def test_the_saturated_energy_falls_by_the_velocity_consensus_alone(m):
    assert dead.saturated_energy_identity(m).residuals == (0,)


@pytest.mark.parametrize("ramp", [0.0, 0.25])
@pytest.mark.parametrize("eta", [0.0, 1.0])
def test_the_kernel_computes_this_force(ramp, eta):
    pair = DeadZoneInteraction(ramp=ramp, eta=eta, k1=0.02)
    formula = with_numbers(dead.force(ramp=sp.Rational(str(ramp))), pair)
    for s in ("0.01", "1", "3.3", "3.4", "3.5", "8", "12.5", "12.6", "13", "14.99", "15", "20"):
        exact = float(formula.subs(dead.RHO, sp.Rational(s)))
        assert -pair.force(float(s)) == pytest.approx(exact, rel=1e-12, abs=1e-12)  # (d1 - s)/ramp rounds near its ends


@pytest.mark.parametrize("eta", [0.0, 0.04, 1.0])
def test_the_kernel_computes_this_potential(eta):
    pair = DeadZoneInteraction(ramp=0.0, eta=eta)
    symbol = sp.Integer(0) if eta == 0.0 else dead.ETA_POSITIVE
    formula = with_numbers(dead.potential(eta=symbol), pair)
    for s in ("0.0001", "0.5", "3.499", "3.5", "8", "12.5", "12.501", "14", "15", "20"):
        exact = float(formula.subs(dead.RHO, sp.Rational(s)).evalf(40))
        assert pair.energy(float(s)) == pytest.approx(exact, rel=1e-14, abs=1e-13)


def test_the_kernel_has_these_jumps():
    pair = DeadZoneInteraction(ramp=0.0)
    symbolic = dead.jumps()
    assert [jump.where for jump in pair.jumps()] == ["d1", "d2", "r"]
    for jump in pair.jumps():
        exact = [float(with_numbers(sp.sympify(side), pair)) for side in symbolic[jump.where]]
        assert [jump.below, jump.above] == pytest.approx(exact, rel=1e-12, abs=1e-12)
    # at d1 from -(2·200/12.25 + 1.3)·3.5/sqrt(13.25) + 0.035
    assert pair.jumps()[0].below == pytest.approx(-(400 / 12.25 + 1.3) * 3.5 / np.sqrt(13.25) + 0.035, rel=1e-13)
