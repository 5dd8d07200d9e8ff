"""The summaries' lattice: runs by hand at rest on one, on none, and of laws without the gain."""

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Algorithm3, Gains, Sphere, StaticTarget
from tests.theorems.made_up import judged, made_up, statuses

TRIANGLE = np.array([[0.0, 0.0], [7.0, 0.0], [3.5, 3.5 * np.sqrt(3.0)]])


def at_rest(law, q=TRIANGLE):
    return made_up(law, [q, q])


def test_a_triangle_at_rest_is_one():
    claim = judged("lattice-limit-printed", at_rest(Algorithm1())).claim("lattice")
    assert claim.status == "verified"
    assert claim.margin == pytest.approx(1e-6, rel=1e-3, abs=0.0)
    assert claim.witness["links"] == 3


def test_what_is_strained_and_no_equilibrium_is_open():
    claim = judged("lattice-limit-printed", at_rest(Algorithm1(), 1.01 * TRIANGLE)).claim("lattice")
    assert claim.status == "inconclusive"
    assert claim.computed == pytest.approx(0.01, rel=1e-9)


@pytest.mark.parametrize(
    ("law", "detail"),
    [
        (Algorithm1(gains=Gains(c1_alpha=0.0)), "c1α"),
        (Algorithm2(gains=Gains(c1_alpha=0.0), target=StaticTarget((0.0, 0.0))), "c1α"),
        (Algorithm3(target=StaticTarget((0.0, 0.0)), obstacles=(Sphere((90.0, 0.0), 5.0),)), "Algorithm 1 or 2"),
    ],
)
def test_without_the_gain_or_under_another_law_it_says_nothing(law, detail):
    verdict = judged("lattice-limit-printed", at_rest(law))
    assert statuses(verdict) == {"lattice": "vacuous"}
    assert detail in verdict.claim("lattice").detail
