"""The link between library and proofs: a slip in a kernel, or in a formula, makes a step fail."""

from __future__ import annotations

import math

import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]
pytest.importorskip("flint")

from flint import ctx

from flockana.kernels import dead_zone as kernel
from flockana.kernels import scalars
from flockana.kernels.compiling import Inlined
from proofs import library_formulas
from proofs.dead_zone_pairs import zones
from tests.proofs.steps import failing


def wrong_sigma_norm(x2, eps):
    return x2 / (sqrt(1.0 + eps * x2) + 2.0)  # noqa: F821 the kernel's root


def wrong_action(s, par):
    return -repulsion(s, par)  # noqa: F821 the kernel's


def test_a_slip_in_a_kernel_is_told(monkeypatch):
    wrong_sigma_norm.__globals__["sqrt"] = math.sqrt
    monkeypatch.setattr(scalars, "sigma_norm", Inlined(wrong_sigma_norm))
    monkeypatch.setattr(scalars, "_S3", scalars._S3 * (1.0 + 2.0**-50))
    broken = failing(library_formulas._steps())
    assert [text.partition(":")[0] for text in broken] == ["σ-norm", "taper"]


def test_a_force_without_its_dead_zone_is_told(monkeypatch):
    wrong_action.__globals__["repulsion"] = kernel.repulsion
    names = zones(wide=False)
    assert all(library_formulas.force_residual(zone) == 0 for zone in names.values())
    monkeypatch.setattr(kernel, "action", Inlined(wrong_action))
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
