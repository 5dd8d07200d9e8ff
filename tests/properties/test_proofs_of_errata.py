"""Proofs behind errata and modes: a slip in a formula makes one fail, and numbers are those of the library."""

from fractions import Fraction
from math import pi

import control
import numpy as np
import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

import sympy as sp
from flint import arb, ctx

from flockana.interactions import Gains
from flockana.sources.jond_2025.theorems.j07_speed_bound import dragged_speed
from flockana.stability.centre_transfer import predicted_gain
from flockana.stability.delay import scalar_margin
from flockana.stability.norms import h2_norm, hinf_norm
from proofs import (
    constant_acceleration,
    net_measures,
    second_order_modes,
    speed_bound,
    stand_off,
    tracking_gain,
    turned_axes,
)
from tests.proofs.steps import failing

PROOFS = (constant_acceleration, net_measures, second_order_modes, speed_bound, stand_off, tracking_gain, turned_axes)


@pytest.mark.slow
@pytest.mark.parametrize("proof", PROOFS, ids=lambda module: module.PROOF.id)
def test_they_hold_and_find_what_they_state(proof):
    steps = list(proof.PROOF.steps())
    assert failing(steps) == []
    assert len(steps) == proof.PROOF.size
    found = {name: value for step in steps for name, value in step.found.items()}
    assert found == dict(proof.PROOF.values)


SLIPS = {
    "a sign in the modulus": (second_order_modes, "CROSSING", lambda m: m.W**2 - m.D**2 * m.W + m.K**2),
    "a sine without the damping": (second_order_modes, "SINE", lambda m: m.OMEGA / m.W),
    "half the frequency": (second_order_modes, "SQUARE", lambda m: m.SQUARE / 2),
    "no pull in the numerator": (tracking_gain, "transfer_function", lambda m: lambda scale: m.S / (m.S**2 + m.C1)),
    "another pull": (tracking_gain, "msn_gain", lambda m: lambda scale: arb("0.9")),
    "a condition without the factor": (tracking_gain, "falling_condition", lambda m: lambda scale: m.C2**2 - 2 * m.C1),
    "a bound that does not bend": (speed_bound, "saturation", lambda m: lambda v: v),
    "a bound of 5": (speed_bound, "LARGEST", lambda m: 5),
    "a stand-off beyond c": (stand_off, "stand_off", lambda m: lambda **_: m.C + m.V * m.G / m.W),
    "a push that forgets the inside": (stand_off, "on_symbols", lambda m: lambda f: lambda d, c, *_: d - c),
    "a speed that turns": (stand_off, "slowing", lambda m: lambda pushes: m.SLOW),
    "a triangle for a path": (
        *(net_measures, "path_matrices"),
        lambda m: lambda: (sp.ones(3, 3) - sp.eye(3), 3 * sp.eye(3) - sp.ones(3, 3)),
    ),
    "four components": (net_measures, "UNEVEN", lambda m: (1, 1, 1, 97)),
    "a step that is right": (constant_acceleration, "PRINTED", lambda m: 0.5),
    "half a step": (constant_acceleration, "CONSTANT_ACCELERATION", lambda m: 0.25),
    "a product that turns": (turned_axes, "printed", lambda m: m.corrected),
    "a product by components": (turned_axes, "corrected", lambda m: m.printed),
}


@pytest.mark.slow
@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_fails(slip, monkeypatch):
    module, name, wrong = SLIPS[slip]
    monkeypatch.setattr(module, name, wrong(module))
    steps = list(module.PROOF.steps())
    found = {name: value for step in steps for name, value in step.found.items()}
    assert failing(steps) or found != dict(module.PROOF.values)


@pytest.mark.parametrize(("k", "d"), [(4.0, 3.0), (0.1, 2.0), (50.0, 0.3)])
def test_the_closed_forms_of_modes_are_the_librarys_numbers(k, d):
    at = {second_order_modes.K: k, second_order_modes.D: d}
    delay, omega = (float(x.subs(at)) for x in second_order_modes.library_margin())
    margin = scalar_margin(k, d)
    assert (delay, omega) == (pytest.approx(margin.delay, rel=1e-14), pytest.approx(margin.frequency, rel=1e-14))
    root = -(omega**2) + (k + 1j * omega * d) * np.exp(-1j * omega * delay)
    assert abs(root) < 1e-13 * omega**2
    mode = control.ss([[0.0, 1.0], [-k, -d]], [[0.0], [1.0]], [[1.0, 0.0]], 0.0)
    peak = 1.0 / (d * np.sqrt(k - d * d / 4.0)) if d * d <= 2.0 * k else 1.0 / k
    assert hinf_norm(mode)[0] == pytest.approx(peak, rel=1e-8)
    assert h2_norm(mode) == pytest.approx(1.0 / np.sqrt(2.0 * d * k), rel=1e-10)


def test_the_projects_gains_are_the_librarys_numbers():
    gains, omega = Gains(c1_gamma=70.0, c2_gamma=2.0 * np.sqrt(70.0)), 2.0 * pi * 0.005 / 0.009
    for scale in (tracking_gain.STEP, Fraction(1)):
        with ctx.workdps(30):
            assert float(tracking_gain.msn_gain(scale)) == pytest.approx(
                predicted_gain(gains, omega, factor=float(scale)), rel=1e-13
            )
    assert tracking_gain.rounded(arb("0.8515", "1e-9")) == "in doubt"


@pytest.mark.parametrize("dt", [0.1, 0.01])
def test_the_lasting_speed_is_the_librarys_number(dt):
    with ctx.workdps(30):
        low, high = speed_bound.lasting(2 * Fraction(str(dt)), 4)
    assert float(low) < dragged_speed(dt) < float(high)
