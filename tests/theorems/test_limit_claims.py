"""Claims about limits that theorems share: matched velocities and lattices, by basins and never by a look."""

from types import SimpleNamespace

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, Tolerances, simulate
from flockana.base.natural_scales import Scales
from flockana.theorems.attraction_basin import final_basin
from flockana.theorems.limit_claims import lattice_limit, settled, velocities_match
from flockana.theorems.observed_run import Observed

TOLERANCES = Tolerances()


@pytest.mark.parametrize(
    ("force", "mismatch", "expected"), [(1.0, 1.0, True), (1.01, 1.0, False), (1.0, 1.01, False), (0.0, 0.0, True)]
)
def test_settled_is_within_both_tolerances(force, mismatch, expected):
    scales = Scales(2.0, 0.5)
    state = SimpleNamespace(force=force * TOLERANCES.force, mismatch=mismatch * TOLERANCES.velocity * scales.energy)
    assert settled(state, TOLERANCES, scales) is expected


def test_velocities_match_by_a_basin_and_never_by_a_decay_alone():
    law = Algorithm1(gains=Gains(c2_alpha=2.0))
    pair = Observed.of(simulate(law, [[0.0, 0.0], [7.1, 0.0]], np.zeros((2, 2)), (0.0, 60.0)))
    claim = velocities_match(pair, [], name="ii", caught=[final_basin(pair).certificate])
    assert claim.status == "verified"
    assert claim.detail.startswith("velocity mismatch K̃ goes from 0 to ")
    assert "certified to stay near a strict minimum of U" in claim.detail
    alone = velocities_match(pair, [], name="ii")
    assert alone.status == "inconclusive"
    assert "in this run K̃ falls by a factor of" in alone.detail


def test_where_a_net_can_flex_no_basin_is_known_and_a_lattice_is_open():
    chain = np.array([[-5.0, 5.0], [0.0, 0.0], [5.0, 5.0]]) * 7.0 / np.sqrt(50.0)
    law = Algorithm1(gains=Gains(c2_alpha=2.0))
    seen = Observed.of(simulate(law, 1.03 * chain, [[0.0, 0.1], [0.0, -0.2], [0.0, 0.1]], (0.0, 400.0)))
    settles = lattice_limit(seen, [], TOLERANCES, name="i")
    assert settles.status == "inconclusive"
    assert settles.computed < 1e-9
    assert settles.witness["links"] == 2
    assert "no basin of a strict minimum is certified here" in settles.detail


def test_a_lattice_is_the_limit_of_what_stays_near_it_and_a_strained_minimum_is_none():
    law = Algorithm1()
    triangle = 7.0 * np.array([[0.0, 0.0], [1.0, 0.0], [0.5, np.sqrt(0.75)]])
    seen = Observed.of(simulate(law, 1.01 * triangle, np.zeros((3, 2)), (0.0, 60.0)))
    assert lattice_limit(seen, [], TOLERANCES, name="i").status == "verified"
    pressed = Algorithm2(target=StaticTarget((0.0, 0.0)))
    strained = Observed.of(simulate(pressed, triangle, np.zeros((3, 2)), (0.0, 60.0)))
    claim = lattice_limit(strained, [], TOLERANCES, name="i")
    assert claim.status == "refuted"
    assert claim.computed > 1e-3
    assert claim.detail.endswith("λJ compresses every link; " + final_basin(strained).certificate.text)
