"""Erratum J14: the speeds that a pair and a flock agree on."""

import numpy as np


def test_speeds(verdict_of):
    told, alone = (verdict_of("J14").claim(f"{name}-informed").computed for name in ("one", "none"))
    np.testing.assert_allclose(told, 3.0, rtol=1e-8)
    np.testing.assert_allclose(alone, 1.5, rtol=1e-8)
    assert np.ptp(verdict_of("J14").claim("none-of-ten").witness["mean speed by seed"]) > 0.5  # each flock its own
