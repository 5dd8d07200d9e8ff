"""The components of a dead-zone flock: which are certain to part, and which are bound by their energy."""

import numpy as np
import pytest

from flockana import DeadZoneFlocking, scenario, simulate, verify
from flockana.sources.li_dead_zone.theorems.net_components import components_of


def test_parts_tell_receding_from_approaching():
    law = DeadZoneFlocking()
    q = np.array([[0.0, 0.0], [3.5, 0.0], [50.0, 0.0], [53.5, 0.0]])
    away, back = (np.array([[-s, 0.0], [-s, 0.2], [s, 0.0], [s, 0.0]]) for s in (1.0, -1.0))
    leaving, meeting = components_of(q, away, law), components_of(q, back, law)
    assert (leaving.count, leaving.separation.certain, meeting.separation.certain) == (2, True, False)
    assert components_of(q, away, law).mismatch == pytest.approx(0.5 * 2 * 0.01 / 2)
    assert not components_of(q[:2], away[:2], law).separation.certain
    assert not components_of(q, 0.0 * q, law).separation.certain  # they stay apart, but at one velocity


def test_centres_that_recede_do_not_part_what_can_still_reach_out():
    """A pair that is about to break up sends an agent after the other part, so its centre says nothing.

    Before, receding centres were enough: here they recede at 0.7, and the agents meet all the same.
    """
    law = DeadZoneFlocking(k2=0.0)
    q = np.array([[0.0, 0.0], [14.0, 0.0], [40.0, 0.0]])
    p = np.array([[-13.0, 0.0], [12.0, 0.0], [0.2, 0.0]])
    assert (components_of(q, p, law).count, components_of(q, p, law).separation.certain) == (2, False)
    run = simulate(law, q, p, (0.0, 4.0))
    assert np.linalg.norm(run.q[:, 2] - run.q[:, 1], axis=1).min() < 15.0
    assert verify("dead-zone-1-printed", run.window(0.0, 0.5)).claim("velocity").status == "inconclusive"


@pytest.mark.parametrize(
    ("share", "distance", "certain"), [(0.99, 22.6, True), (0.99, 22.4, False), (1.01, 1e4, False)]
)
def test_a_pair_is_bound_by_its_energy(share, distance, certain):
    """n = 2: no pair out of range while H < psi(r), and B = r/2 = 7.5; beyond that nothing is certain."""
    law = DeadZoneFlocking()
    q = np.array([[-4.0, 0.0], [4.0, 0.0], [0.0, distance]])
    speed = np.sqrt(share * law.interaction.far_potential - law.interaction.energy(8.0))  # each of the two: ½(s² + s²)
    p = np.array([[speed, 0.0], [-speed, 0.0], [0.0, 1.0]])
    assert components_of(q, p, law).separation.certain is certain


@pytest.mark.parametrize(("distance", "certain"), [(29.9, False), (30.1, True)])
def test_a_chain_is_bound_by_its_pairs_out_of_range(distance, certain):
    """n = 3 with its ends 16 apart: H is 1.1 psi(r), so M = 1, and B = 15 (2 + 1)/3."""
    q = np.array([[-8.0, 0.0], [0.0, 0.0], [8.0, 0.0], [0.0, distance]])
    p = np.array([[0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 1.0]])
    assert components_of(q, p, DeadZoneFlocking()).separation.certain is certain


def test_what_parts_for_ever_does():
    """From a wide start: the parts that are certain to part at t = 400 are those at t = 800."""
    item = scenario("dead-zone-wide-start", seed=3)
    law = item.law.law
    run = simulate(item.law, item.q0, item.p0, (0.0, 800.0), t_eval=[0.0, 400.0, 800.0])
    middle, end = (components_of(q, p, law) for q, p in zip(run.q[1:], run.p[1:], strict=True))
    assert middle.separation.certain
    assert (end.count, end.separation.certain) == (middle.count, True)


def test_parts_with_one_velocity_may_turn_to_meet_for_all_that_rounding_tells():
    law, q = DeadZoneFlocking(), np.array([[0.0, 0.0], [3.5, 0.0], [50.0, 0.0], [53.5, 0.0]])
    same = components_of(q, np.full((4, 2), 1.0), law)
    assert same.apart.error == pytest.approx(50.0 / law.interaction.r)
    ulp = np.full((4, 2), 1.0)
    ulp[2:, 0] += 2.0**-50
    assert components_of(q, ulp, law).apart.error == pytest.approx(50.0 / law.interaction.r)
    slow = np.full((4, 2), 1.0)
    slow[2:, 0] += 1e-9
    blur = 2.0 * 4.0 * np.finfo(float).eps * 1.0  # two means of two agents each
    expected = 50.0 * 4.0 * blur / 1e-9 / law.interaction.r
    assert components_of(q, slow, law).apart.error == pytest.approx(expected, rel=1e-6)
    assert not any(components_of(q, p, law).separation.certain for p in (np.full((4, 2), 1.0), ulp))
