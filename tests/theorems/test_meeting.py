"""What energy a meeting takes, of pair potentials whose least is known by hand."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest

from flockana import pair_law
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm1
from flockana.theorems.meeting import least_is_known, meeting
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


def test_a_narrow_well_at_the_length_of_the_law_is_seen():
    """Of a width of 1e-4 and 1.0003 from 0, where no distance is looked at but for it."""
    pair = pair_law("-k*(s-r)**2/(1+(s-d)**2/w**2)", adjacency="(1-s/r)**2", range=3.0, length=1.0003,
                    parameters={"k": 1.0, "w": 1e-4})  # fmt: skip
    assert meeting(run_of(pair, 2)).floor == pytest.approx(-2.5 * 1.9997**2, rel=1e-12)


def test_the_distances_that_are_looked_at_end_at_the_range():
    """4001 of them, so that the least, halfway, is one; of others up to 200 none is so near."""
    pair = pair_law("-k*(s-r)**2*s**2", adjacency="(1-s/r)**2", range=2.94, length=2.0, parameters={"k": 1.0})
    assert meeting(run_of(pair, 2)).floor == pytest.approx(-2.5 * 1.47**4, rel=1e-12)


def test_the_least_is_known_of_the_papers_law_alone():
    alpha, other = AlphaInteraction(), pair_law("k*(s-r)**2", adjacency=0, range=3.0, length=2.0, parameters={"k": 1.0})
    assert meeting(run_of(alpha)) == (2.5 * alpha.c_star, 0.0)
    assert least_is_known(run_of(alpha)) == []
    assert [h.status for h in least_is_known(run_of(other))] == ["assumed"]
