"""A pair in a wind that pulls it apart, against its own reduced motion: what stays near is never said to leave."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import flockana as fl
from tests.adversarial import truth
from tests.adversarial.cases import TRUE, VACUOUS, Case, hold

THEOREMS = ("disturbed-basin",)
LAW, UNTIL = fl.Algorithm1(), 10.0


def farthest(push):
    """Largest ½√2 |s(t) − d| of two agents at rest at d that are pushed apart, each with this force."""
    g, alpha = LAW.gains, LAW.alpha

    def rate(t, y):
        s, v = y
        braked = g.c1_alpha * truth.pull(s, alpha) + g.c2_alpha * truth.adjacency(s, alpha) * v
        return v, 2.0 * (push - braked)

    s = solve_ivp(rate, (0.0, UNTIL), (alpha.d, 0.0), rtol=1e-9, atol=1e-12, max_step=0.01).y[0]
    return float(np.abs(s - alpha.d).max() / np.sqrt(2.0))


@pytest.mark.parametrize("push", [1e-9, 1e-6, 1e-3, 1e-1, 1.0, 30.0, 1e3])
def test_a_pair_in_a_wind(push):
    law = fl.Disturbed(LAW, force=[[-push], [push]])
    case = Case(law, [[0.0], [LAW.alpha.d]], [[0.0], [0.0]], UNTIL)
    said = VACUOUS if farthest(push) > LAW.alpha.r else TRUE
    verdict = hold("disturbed-basin", case, {"stays": said, "ultimate": said})
    if verdict.status == "verified":
        assert farthest(push) <= float(verdict.claim("ultimate").witness["allowed by then"]) + 1e-9
    assert (push <= 1e-1) == (verdict.status == "verified")
