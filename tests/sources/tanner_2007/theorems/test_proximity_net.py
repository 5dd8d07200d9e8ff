"""Whether a net of proximity stays connected: by the energy of its start, on agents at rest."""

from math import log

import numpy as np
import pytest

from flockana.sources.tanner_2007.laws import ProximityFlocking
from tests.theorems.made_up import hypothesis, judged, made_up, statuses

LAW = ProximityFlocking(r=1.6)


def potential(s):
    """V(s) = d²/s² − 1 + ln(s²/d²), with d = 1."""
    return 1.0 / s**2 - 1.0 + 2.0 * log(s)


def verdict_of(*places, p=None, law=LAW):
    q = np.array(places)[:, None]
    return judged("tanner-switching", made_up(law, [q, q], p))


@pytest.mark.parametrize("s", [0.9, 1.2, 1.5])
def test_two_are_held_by_what_they_lack_of_the_energy_at_the_range(s):
    found = hypothesis(verdict_of(0.0, s), "connected")
    assert (found.status, found.margin) == ("met", pytest.approx(1.0 - potential(s) / potential(1.6), rel=1e-9))


@pytest.mark.parametrize(
    ("s", "status"), [(0.78, "met"), (0.9, "met"), (1.3, "met"), (1.5, "assumed"), (0.6, "assumed")]
)
def test_a_chain_of_three_has_three_pairs_and_needs_two_to_break(s, status):
    energy = 2.0 * potential(s) + potential(min(2.0 * s, 1.6))
    found = hypothesis(verdict_of(0.0, s, 2.0 * s), "connected")
    assert (energy < 2.0 * potential(1.6)) == (status == "met")
    assert found.status == status
    assert status == "assumed" or found.margin == pytest.approx(1.0 - 0.5 * energy / potential(1.6), rel=1e-9)


def test_motion_counts_too():
    p = np.array([[[0.6], [-0.6]]] * 2)
    found = hypothesis(verdict_of(0.0, 1.2, p=p), "connected")
    assert potential(1.2) + 0.36 > potential(1.6) > potential(1.2)
    assert found.status == "assumed"


def test_it_is_apart_if_it_is_at_any_sample():
    q = np.array([[[0.0], [1.2]], [[0.0], [1.7]], [[0.0], [1.2]]])
    verdict = judged("tanner-switching", made_up(LAW, q))
    assert hypothesis(verdict, "connected").status == "unmet"
    assert "at t = 1" in hypothesis(verdict, "connected").detail
    assert set(statuses(verdict).values()) == {"vacuous"}


def test_at_the_range_itself_rounding_decides_neither():
    assert hypothesis(verdict_of(0.0, 1.6), "connected").status == "assumed"
    assert hypothesis(verdict_of(0.0, 1.6 * (1.0 + 1e-14)), "connected").status == "unmet"
    far = 1e9  # there a distance is known to 1e-6
    assert hypothesis(verdict_of(far, far + 1.6 + 1e-7), "connected").status == "assumed"
    assert hypothesis(verdict_of(far, far + 1.6 + 1e-5), "connected").status == "unmet"
    # 1e-6 within the range its energy lacks 1e-6 of what would break it: a link that rounding may break holds nothing
    assert hypothesis(verdict_of(far, far + 1.6 - 1e-6), "connected").status == "assumed"
    assert hypothesis(verdict_of(far, far + 1.6 - 1e-5), "connected").status == "met"


def test_the_energy_and_the_net_are_those_of_the_start():
    q = np.array([[[0.0], [1.2]], [[0.0], [1.6]]])
    found = hypothesis(judged("tanner-switching", made_up(LAW, q)), "connected")
    assert (found.status, found.margin) == ("met", pytest.approx(1.0 - potential(1.2) / potential(1.6), rel=1e-9))
    assert hypothesis(judged("tanner-switching", made_up(LAW, q[::-1])), "connected").status == "assumed"
