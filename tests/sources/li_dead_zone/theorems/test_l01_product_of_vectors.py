"""Erratum L1: forces on three agents, pair by pair, before and after the axes are turned."""

from math import hypot, sqrt

import numpy as np
import pytest

from flockana import DeadZoneFlocking, Tolerances, theorem
from flockana.sources.li_dead_zone.theorems import l01_product_of_vectors as l01

PLACES = np.array([[0.0, 0.0], [2.0, 0.5], [-1.0, 2.5]])
TURN = np.array([[0.6, -0.8], [0.8, 0.6]])


def by_components(places):
    """(Σ_j f_ij n_ij) ∘ Σ_j n_ij: the nearer two repel by f = −(400/ρ² + 1.3), the pair beyond 3.5 not at all."""
    u = []
    for i, here in enumerate(places):
        forces, ways = np.zeros(2), np.zeros(2)
        for j, there in enumerate(places):
            if i != j:
                x = there - here
                rho = hypot(*x)
                way = x / sqrt(1.0 + rho * rho)
                forces += -(400.0 / rho**2 + 1.3) * way if rho < 3.25 else 0.0 * way
                ways += way
        u.append(forces * ways)
    return np.array(u)


def test_by_components_the_axes_matter_and_with_one_sum_they_do_not(verdict_of):
    assert min(abs(hypot(*(a - b)) - 3.375) for a in PLACES for b in PLACES) > 0.125  # on no ramp
    u, turned = by_components(PLACES), by_components(PLACES @ TURN.T)
    change = np.abs(turned - u @ TURN.T).max() / np.abs(u).max()
    printed, corrected = (verdict_of("L1").claim(name) for name in ("printed", "corrected"))
    assert (printed.status, corrected.status) == ("refuted", "verified")
    assert printed.margin == pytest.approx(1e-9 - change, rel=1e-12)
    assert corrected.margin == pytest.approx(1e-9, rel=1e-5, abs=0.0)
    assert printed.error == pytest.approx(1e-12, rel=1e-3)
    assert corrected.error == pytest.approx(1e-12, rel=1e-3)
    assert (printed.disproof, corrected.proof) == ("turned-axes", "turned-axes")


def test_a_force_that_keeps_its_direction_contradicts_the_proof(monkeypatch):
    """10 along the first axis in both, where turned by (0.6, 0.8) it would be (6, 8): off by 8 of the largest."""

    class Pushed(DeadZoneFlocking):
        def acceleration(self, t, q, p):
            return super().acceleration(t, q, p) + np.array([10.0, 0.0])

    monkeypatch.setattr(l01, "DeadZoneFlocking", Pushed)
    claim = {claim.name: claim for claim in theorem("L1").examine(Tolerances())[1]}["corrected"]
    law = Pushed(l01.DeadZoneInteraction(k1=0.0))
    largest = np.abs(law.acceleration(0.0, PLACES, 0.0 * PLACES)).max()
    assert (claim.status, claim.contradicts) == ("inconclusive", "turned-axes")  # the library is at fault
    assert claim.margin == pytest.approx(1e-9 - 8.0 / largest, rel=1e-9)
