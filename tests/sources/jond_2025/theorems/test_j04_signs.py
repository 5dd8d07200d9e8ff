"""Erratum J4: the loop with either incidence, edge by edge, and a law that is off."""

import numpy as np
import pytest

from flockana import MinimalFlocking, Tolerances, theorem
from flockana.sources.jond_2025.theorems import j04_signs as j04

TREE = ((0, 1), (1, 2), (1, 3), (0, 4))


def forces(answered):
    """What the edges do to whom receives, with μ = 0.7 and ρ = 1.3, and against it to whom sends if that is asked."""
    rng = np.random.default_rng(0)
    q, p = rng.uniform(-3.0, 3.0, (5, 2)), rng.uniform(-1.0, 1.0, (5, 2))
    u = np.zeros((5, 2))
    for j, i in TREE:
        x, v = q[j] - q[i], p[j] - p[i]
        pull = 0.7 * (1.0 - 1.3 / np.linalg.norm(x)) * x + v
        u[i] += pull
        u[j] -= answered * pull
    return u


def test_the_loop_holds_the_receivers_alone(verdict_of):
    claim = verdict_of("J4").claim("loop")
    assert (claim.status, claim.error) == ("verified", pytest.approx(1e-13, rel=1e-9))
    assert 0.0 <= claim.computed < 1e-14
    assert claim.margin == pytest.approx(1e-9, rel=1e-5, abs=0.0)
    off = np.abs(forces(True) - forces(False)).max()
    assert claim.witness == {"with D in place of D_in": pytest.approx(off, rel=1e-12)}


def test_a_law_that_is_off_is_told_by_a_share_of_the_largest_force(monkeypatch):
    class Off(MinimalFlocking):
        def acceleration(self, t, q, p):
            return 1.25 * super().acceleration(t, q, p)

    monkeypatch.setattr(j04, "MinimalFlocking", Off)
    claim = {claim.name: claim for claim in theorem("J4").examine(Tolerances())[1]}["loop"]
    largest = np.abs(forces(False)).max()
    assert (claim.status, claim.computed) == ("refuted", pytest.approx(0.25 * largest, rel=1e-12))
    assert claim.margin == pytest.approx(1e-9 - 0.2, rel=1e-12)


def test_the_two_signs_leave_twice_each_force(verdict_of):
    """Of edge (j, i) the receiver's row alone is off, by 2 k (p_i − p_j) with either sign."""
    verdict, rows = verdict_of("J4"), [f"2*k_{e}*p_{j} - 2*k_{e}*p_{i}" for e, (j, i) in enumerate(TREE)]
    assert verdict.claim("identity").witness == ["0", *rows]
    turned = [f"-2*k_{e}*p_{j} + 2*k_{e}*p_{i}" for e, (j, i) in enumerate(TREE)]
    assert verdict.claim("28").witness == ["0", *turned]
    assert verdict.claim("34").witness == ["0"] * 5
    assert {c.name: c.status for c in verdict.claims} == {
        "28": "refuted", "identity": "refuted", "34": "verified", "loop": "verified"
    }  # fmt: skip
