"""Erratum E14: the force on the middle of three agents, by hand, and what moving the origin does to it."""

import pytest

from flockana import AlphaInteraction


def test_the_example_by_hand(verdict_of):
    """Links of 5 and 8: s = φ_α/(1 + ε‖·‖_σ) each; printed s_0·0 + s_2·13, in truth s_0 (0 − 5) + s_2 (13 − 5)."""
    alpha = AlphaInteraction()
    near, far = (alpha.phi_alpha(z) / (1.0 + alpha.eps * z) for z in (alpha.sigma_norm(5.0), alpha.sigma_norm(8.0)))
    verdict = verdict_of("E14")
    told = verdict.claim("translation")
    assert told.computed["here"] == pytest.approx(13.0 * far, rel=1e-13)
    assert told.computed["there"] == pytest.approx(13.0 * far + 70.0 * (near + far), rel=1e-13)
    assert f"the law gives {-5.0 * near + 8.0 * far:.4g}" in told.detail
    assert told.margin == pytest.approx(70.0 * (near + far), rel=1e-12)
    assert near < 0.0 < far
