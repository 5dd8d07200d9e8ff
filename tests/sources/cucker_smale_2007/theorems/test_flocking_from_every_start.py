"""β < ½, on motions by hand whose bound is an integral in closed form."""

from math import sqrt

import mpmath
import numpy as np
import pytest

from flockana import CuckerSmale, RationalWeight
from tests.theorems.made_up import judged, made_up, statuses

Q, P = np.array([[-1.0], [1.0]]), np.array([[-0.5], [0.5]])


def motion(decay, closing=1.0, times=(0.0, 1.0, 3.0)):
    """Two that are 2 apart and part at 1, ever more slowly."""
    t = np.array(times)[:, None, None]
    law = CuckerSmale(RationalWeight(strength=1.5, length=2.0, decay=decay))
    return made_up(law, Q + P * (1.0 - np.exp(-closing * t)) / closing, P * np.exp(-closing * t), t[:, 0, 0],
                   -closing * P * np.exp(-closing * t))  # fmt: skip


@pytest.mark.parametrize("decay", [0.0, 0.25, 0.49, 0.5])
def test_the_spread_stays_below_that_of_the_sharp_functional(decay):
    """∫φ from √2 to x_M is 1/√2, with φ(s) = 3 (1 + 2 s²/4)^−β, as sums of two are not divided."""
    verdict = judged("cucker-smale", motion(decay))

    def left(x):
        return mpmath.quad(lambda s: 3 * (1 + s * s / 2) ** -decay, [sqrt(2.0), x]) - sqrt(0.5)

    x_m = float(mpmath.findroot(left, 1.7))
    seen = sqrt(2.0) + sqrt(0.5) * (1.0 - np.exp(-3.0))
    bounded = verdict.claim("bounded")
    assert verdict.hypotheses[-1].margin == pytest.approx(0.5 - decay, rel=1e-14)
    assert (verdict.hypotheses[-1].name, verdict.hypotheses[-1].detail) == ("β <= ½", f"β = {decay:g}")
    assert bounded.computed == pytest.approx(seen, rel=1e-12)
    assert bounded.margin == pytest.approx(1.0 - seen / x_m, rel=1e-9)
    assert (bounded.status, bounded.contradicts) == ("inconclusive", "cucker-smale")
    assert verdict.claim("velocities").status == "verified"
    assert verdict.claim("velocities").proof == "cucker-smale"


def test_what_falls_faster_is_bounded():
    verdict = judged("cucker-smale", motion(0.25, closing=9.0))
    assert statuses(verdict) == dict.fromkeys(("bounded", "rate", "velocities"), "verified")
    assert verdict.claim("rate").computed == pytest.approx(9.0, rel=1e-9)


@pytest.mark.parametrize(("decay", "text"), [(0.500001, "0.500001"), (0.8, "0.8")])
def test_beyond_one_half_it_says_nothing(decay, text):
    verdict = judged("cucker-smale", motion(decay))
    need = verdict.hypotheses[-1]
    assert (need.status, need.margin) == ("unmet", pytest.approx(0.5 - decay, abs=1e-15))
    assert statuses(verdict) == dict.fromkeys(("bounded", "rate", "velocities"), "vacuous")
    assert verdict.claim("bounded").detail == f"β <= ½ does not hold: β = {text}"
