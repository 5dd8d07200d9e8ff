"""Leads of a search, on motions by hand."""

import numpy as np
import pytest

from flockana import Algorithm1, AlphaInteraction
from flockana.theorems import Claim
from flockana.theorems.search_objectives import bridge, pairs_apart, squash, strained
from tests.theorems.made_up import made_up

LAW, CLAIM = Algorithm1(), Claim("of any", "inconclusive")
D, R = 7.0, 8.4


def line(*places):
    return np.array([[x, 0.0] for x in places])


def test_the_order_is_kept():
    xs = [-np.inf, -3.0, -1e-3, 0.0, 0.5, 1e9, np.inf]
    assert [squash(x) for x in xs] == sorted(squash(x) for x in xs)
    assert [squash(x) for x in (-np.inf, -1.0, 0.0, 1.0, np.inf)] == [-1.0, -0.5, 0.0, 0.5, 1.0]


def test_the_nearest_pair_that_has_not_met_over_d():
    """Over all samples: the second and the third come within 3.5, the first stays 10 and more away."""
    run = made_up(LAW, [line(0.0, 20.0, 27.0), line(0.0, 10.0, 13.5)])
    assert pairs_apart(run, CLAIM) == pytest.approx(squash(0.5))
    run = made_up(LAW, [line(0.0, 0.0, 14.0), line(0.0, 0.0, 14.0)])
    assert pairs_apart(run, CLAIM) == pytest.approx(squash(2.0))
    assert pairs_apart(made_up(LAW, [line(0.0, 0.0)] * 2), CLAIM) == 0.0


def test_the_longest_link_that_holds_the_flock_together():
    """Of a minimum tree, at the sample where it is longest: 9 and not 15, 6 and 12."""
    run = made_up(LAW, [line(0.0, 6.0, 15.0), line(0.0, 6.0, 12.0)])
    assert bridge(run, CLAIM) == pytest.approx(1.0 - squash(9.0 / R))
    assert bridge(made_up(LAW, [line(0.0)]), CLAIM) == 1.0


def test_the_mean_over_time_of_the_largest_strain():
    """0, a tenth, a tenth, at 0, 1 and 3: ¼ in 3. A pair out of range has none."""
    states = [line(0.0, D, 50.0), line(0.0, 1.1 * D, 50.0), line(0.0, 0.9 * D, 50.0)]
    run = made_up(LAW, states, t=[0.0, 1.0, 3.0])
    assert strained(run, CLAIM) == pytest.approx(1.0 - 0.25 / 3.0, rel=1e-12)
    later = made_up(LAW, states, t=[5.0, 6.0, 8.0])
    assert strained(later, CLAIM) == pytest.approx(strained(run, CLAIM), rel=1e-12)


def test_a_strain_counts_no_more_than_1():
    wide = Algorithm1(AlphaInteraction(d=1.0, r=4.0))
    assert strained(made_up(wide, [line(0.0, 3.0)] * 2), CLAIM) == pytest.approx(0.0, abs=1e-15)
    assert strained(made_up(wide, [line(0.0, 1.5)] * 2), CLAIM) == pytest.approx(0.5, rel=1e-12)
    assert strained(made_up(wide, [line(0.0)] * 2), CLAIM) == 1.0
