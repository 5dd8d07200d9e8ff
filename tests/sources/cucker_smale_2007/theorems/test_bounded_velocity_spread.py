"""Both forms of the theorem of Ha and Liu against their integrals in closed form, on motions by hand."""

from math import atan, pi, sqrt, tan

import numpy as np
import pytest

from flockana import CuckerSmale, RationalWeight
from tests.theorems.made_up import hypothesis, judged, made_up, statuses

LAW = CuckerSmale(RationalWeight(strength=1.5, length=2.0, decay=1.0), mean=True)
FORMS = [("ha-liu", 2.0), ("ha-liu-sharp", sqrt(2.0))]


def motion(speed, closing=2.0, law=LAW):
    """Two that are 2 apart and part, each at this speed at first: ‖x(0)‖ = √2, and ‖v(0)‖ = √2 of it."""
    t, way = np.array([0.0, 1.0, 3.0])[:, None, None], np.array([[-1.0], [1.0]])
    fall = speed * np.exp(-closing * t)
    return made_up(law, way * (1.0 + (speed - fall) / closing), way * fall, t[:, 0, 0], -closing * way * fall)


@pytest.mark.parametrize(("name", "c"), FORMS)
@pytest.mark.parametrize("share", [0.5, 0.99, 1.01, 2.0])
def test_the_spread_of_velocities_against_the_integral(name, c, share):
    """∫φ from √2 on is λℓ/c (½π − atan(√2 c/ℓ)), with λ = 1.5 and ℓ = 2."""
    integral_to_infinity = 3.0 / c * (0.5 * pi - atan(c / sqrt(2.0)))
    verdict = judged(name, motion(share * integral_to_infinity / sqrt(2.0)))
    need = hypothesis(verdict, "∫φ")
    assert need.status == ("met" if share < 1.0 else "unmet")
    assert need.margin == pytest.approx((1.0 - share) * integral_to_infinity, rel=1e-9)
    assert [claim.name for claim in verdict.claims] == ["bounded", "rate", "flock"]
    if share > 1.0:
        assert set(statuses(verdict).values()) == {"vacuous"}
        assert verdict.claim("flock").detail.startswith("‖v(0)‖ < ∫φ from ‖x(0)‖ on does not hold: ‖v(0)‖ = ")
    else:
        x_m = 2.0 / c * tan(atan(c / sqrt(2.0)) + share * integral_to_infinity * c / 3.0)
        widest = sqrt(2.0) + share * integral_to_infinity * (1.0 - np.exp(-6.0)) / 2.0
        assert verdict.claim("bounded").margin == pytest.approx(1.0 - widest / x_m, rel=1e-8)
        assert (verdict.claim("flock").status, verdict.claim("flock").margin) == ("verified", None)
        assert verdict.claim("flock").proof == "cucker-smale"
        assert verdict.claim("rate").computed == pytest.approx(2.0, rel=1e-9)


def test_a_start_between_the_two_thresholds_is_a_flock_of_the_sharper_alone():
    """0.923 as printed, and 1.666."""
    run = motion(1.3 / sqrt(2.0), closing=9.0)
    assert set(statuses(judged("ha-liu", run)).values()) == {"vacuous"}
    assert statuses(judged("ha-liu-sharp", run)) == dict.fromkeys(("bounded", "rate", "flock"), "verified")
