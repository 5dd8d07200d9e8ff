"""The theorem on cyclic pursuit: three sides of the critical angle, starts without a part that grows, scenarios."""

import numpy as np
import pytest

import flockana as fl
from tests.theorems.made_up import statuses

Q = np.random.default_rng(5).normal(size=(10, 2))
SIDES = ("meet", "circle", "spread")


def test_a_start_that_has_no_part_in_a_growing_mode_does_not_spread():
    """At 50° of four agents the mode 3 alone grows; the corners of a square in turn are the mode 1."""
    law, square = fl.CyclicPursuit(1.0, 50.0), np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
    told = statuses(fl.verify("cyclic-pursuit", law=law, q0=square, t_span=(0.0, 5.0)))
    assert told["spread"] in ("inconclusive", "vacuous")
    told = statuses(fl.verify("cyclic-pursuit", law=law, q0=square[::-1], t_span=(0.0, 5.0)))
    assert told["spread"] == "verified"


@pytest.mark.filterwarnings("error")
def test_a_pursuit_beyond_all_numbers_ends_in_words():
    """Numbers overflow at t = 374: without a warning, and nothing is decided by the part of the run before."""
    verdict = fl.verify("cyclic-pursuit", law=fl.CyclicPursuit(1.0, 170.0), q0=Q[:5], t_span=(0.0, 600.0))
    assert {verdict.claim(name).status for name in ("centroid", "motion", "spread")} == {"inconclusive"}
    assert "the run failed" in verdict.claim("motion").detail
