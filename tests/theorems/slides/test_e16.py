"""Erratum E16: coincident pairs with α above γ, and agents apart with γ above α."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from flockana.scenarios import scenario
from flockana.theorems import verify


def test_neither_sufficient_nor_necessary():
    verdict = verify("E16")
    assert verdict.claim("sufficient").computed >= 1
    law = scenario("msn-static").law
    assert law.gains.c1_alpha > law.gains.c1_gamma
    assert law.gains.c2_alpha > law.gains.c2_gamma

    def pull(radius):  # the seven rest on a heptagon: six mates push an agent out, the γ-agent pulls it in by 2 R
        angle = 2.0 * np.pi * np.arange(7) / 7.0
        q = radius * np.column_stack([np.cos(angle), np.sin(angle)])
        x = q[1:] - q[0]
        s = np.linalg.norm(x, axis=1)
        weight = law.alpha.phi_alpha(law.alpha.sigma_norm(s)) / np.sqrt(1.0 + law.alpha.eps * s**2)
        return float(weight @ x[:, 0]) - 2.0 * radius

    side = 2.0 * np.sin(np.pi / 7.0) * brentq(pull, 5.0, 9.0)
    assert verdict.claim("necessary").computed == pytest.approx(side / 15.0, rel=1e-9)


def test_the_patch_at_twice_the_ratio_is_a_minimum_and_no_lattice():
    claims = {claim.name: claim.status for claim in verify("E16").claims}
    assert claims == {"sufficient": "refuted", "necessary": "refuted", "minima": "verified", "lattice": "verified"}
    assert verify("E16").claim("lattice").computed == pytest.approx(1.0 - verify("E16").claim("necessary").computed)
