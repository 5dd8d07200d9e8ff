"""What energy a meeting takes, of pair potentials whose least is known by hand."""

from math import inf

import numpy as np
import pytest

from flockana import Algorithm1, AlphaInteraction, DeadZoneInteraction, Gains, pair_law
from flockana.theorems.meeting_energy import least_is_known, meeting
from tests.theorems.made_up import made_up


def run_of(pair, n=4, gain=2.5):
    return made_up(Algorithm1(pair, Gains(c1_alpha=gain)), np.arange(2.0 * n).reshape(1, n, 2))


@pytest.mark.parametrize(
    ("formula", "least", "top"),
    [
        ("k*(s-d)**2*(s-r)**2/2", 0.0, 18.0),  # at d = 2, at r = 3 and beyond
        ("-k*(s-r)**2*s**2", -(1.5**4), 0.0),  # at r/2: nothing repels, and a coincident pair has as much as a far one
        ("k*(2*s-r)*(s-r)**2", -1.0, -27.0),  # at 2r/3; less at 0, which is the least
        ("k/s**2", 1.0 / 9.0, inf),  # never less than at r
    ],
)
@pytest.mark.parametrize("n", [2, 4])
def test_a_coincident_pair_against_the_least_that_any_has(formula, least, top, n):
    pair = pair_law(formula, adjacency="(1-s/r)**2", range=3.0, length=2.0, parameters={"k": 1.0})
    found, lowest = meeting(run_of(pair, n)), min(least, top)
    assert found.c_star == pytest.approx(2.5 * (top - lowest), rel=1e-12)
    assert found.floor == pytest.approx(2.5 * lowest * n * (n - 1) / 2, rel=1e-12)


@pytest.mark.parametrize("length", [1.0003, 0.7])
def test_a_narrow_well_is_seen_wherever_it_is(length):
    """(r − s)²/(1 + x²) with x = (s − c)/w is at most (r − c)² + w², by Cauchy and Schwarz; w = 1e-6."""
    pair = pair_law("-k*(s-r)**2/(1+(s-c)**2/w**2)", adjacency="(1-s/r)**2", range=3.0, length=length,
                    parameters={"k": 1.0, "w": 1e-6, "c": 1.0003})  # fmt: skip
    assert meeting(run_of(pair, 2)).floor == pytest.approx(-2.5 * (1.9997**2 + 1e-12), rel=1e-12)
    assert meeting(run_of(pair, 2)).floor <= -2.5 * (1.9997**2 + 1e-12)


def test_a_pair_that_falls_together_has_no_least_and_it_is_a_bound_where_it_is_proved():
    pair = pair_law("-k/s", adjacency=0, range=3.0, length=2.0, parameters={"k": 1.0})
    assert meeting(run_of(pair, 2)) == (0.0, -inf)
    alpha, other = AlphaInteraction(), pair_law("k*(s-r)**2", adjacency=0, range=3.0, length=2.0, parameters={"k": 1.0})
    assert meeting(run_of(alpha)) == (2.5 * alpha.c_star, 0.0)
    assert least_is_known(run_of(alpha)) == least_is_known(run_of(other)) == []
    assert [h.status for h in least_is_known(run_of(DeadZoneInteraction()))] == ["assumed"]
