"""The printed Theorem 1 on states by hand: how far from their centre, and when the energy of neighbours jumps."""

from dataclasses import replace

import numpy as np
import pytest

from flockana import DeadZoneFlocking, DeadZoneInteraction
from flockana.sources.li_dead_zone.theorems.local_basin import hold
from tests.theorems.made_up import judged, made_up

LAW = DeadZoneFlocking()
CONTACT = 3.49973  # within 1e-5 of where repulsion and the pull k₁ balance


def of_line(*places, speeds=None, law=LAW):
    """The verdict of agents on a line that stay, or go on as they do, for a second."""
    q = np.array(places)[:, None]
    p = np.zeros_like(q) if speeds is None else np.array(speeds, dtype=float)[:, None]
    return judged("dead-zone-1-printed", made_up(law, [q, q + p], [p, p]))


def test_one_agent_is_its_own_centre_which_is_known_less_well_far_from_the_origin():
    claim = of_line(3.0).claim("cohesion")
    assert (claim.status, claim.margin, claim.computed) == ("verified", pytest.approx(1.0, abs=1e-14), 0.0)
    # Of one agent by some roundings of a place in its frame, of r = 15
    for place in (0.0, 3.0, 1e6):
        claim, eps = of_line(place).claim("cohesion"), np.finfo(float).eps
        known = 2.0 * 5.0 * eps * place / 15.0  # the last state, and the centre again
        assert known + 4.0 * eps <= 1.0 - claim.margin <= 2.0 * known + 10.0 * eps


def test_two_at_their_contact_are_half_of_it_away():
    claim = of_line(0.0, CONTACT).claim("cohesion")
    assert claim.status == "verified"
    assert claim.computed == pytest.approx(0.5 * CONTACT, rel=1e-12)
    reach = hold(LAW, np.array([[0.0], [CONTACT]]), np.zeros((2, 1))).reach  # the way to the minimum, and about it
    assert reach < 1e-4
    assert claim.margin == pytest.approx(1.0 - (0.5 * CONTACT + reach) / 15.0, rel=1e-12)


def test_two_whose_energy_binds_them_are_nowhere_beyond_half_of_the_range_and_else_nothing_is_known():
    """In the dead zone no minimum is near; none of their one pair gets out of range, so (n − 1 + 0) r/n."""
    claim = of_line(0.0, 5.0).claim("cohesion")
    assert (claim.status, claim.margin) == ("verified", pytest.approx(0.5, rel=1e-12))
    assert claim.computed == pytest.approx(2.5)
    assert of_line(0.0, 5.0, speeds=(-4.0, 4.0)).claim("cohesion").status == "inconclusive"
    assert of_line(0.0, 18.0, speeds=(1.0, -1.0)).claim("cohesion").status == "inconclusive"


@pytest.mark.parametrize("speed", [0.5, 2.0])
def test_two_that_part_refute_cohesion_by_their_clearance_or_their_drift(speed):
    claim = of_line(0.0, 16.0, speeds=(-speed, speed)).claim("cohesion")
    assert claim.status == "refuted"
    assert claim.margin == pytest.approx(-min((1.0 + 2.0 * speed) / 15.0, 0.5 * (speed / LAW.scales.speed) ** 2))
    assert claim.witness["components"] == 2


FLAT = DeadZoneFlocking(DeadZoneInteraction(r=10.0, r_b=8.0, delta=4.5, k1=0.0))  # no pull up to its range: ψ̄(r) = 0


@pytest.mark.parametrize(
    ("law", "places", "speeds", "status", "margin"),
    [
        (LAW, (0.0, 16.0), (1.0, -1.0), "refuted", -0.5),  # comes into range: H rises by ψ̄(15)
        (LAW, (0.0, 18.0), (1.0, -1.0), "verified", 0.5),  # not yet
        (LAW, (0.0, 14.0), (-1.0, 1.0), "verified", 0.5),  # leaves
        (LAW, (0.0, 14.0), (1.0, -1.0), "verified", 0.5),  # is in range all the time
        (FLAT, (0.0, 11.0), (1.0, -1.0), "verified", 0.5),  # comes in, and nothing jumps
    ],
)
def test_the_energy_of_neighbours_rises_as_a_pair_comes_into_range(law, places, speeds, status, margin):
    claim = of_line(*places, speeds=speeds, law=law).claim("energy")
    assert (claim.status, claim.margin) == (status, margin)
    assert claim.error < 1e-15
    jump = law.interaction.far_potential
    assert (jump > 0.0) == (law is LAW)
    assert claim.computed == (jump if status == "refuted" else 0.0)
    assert (f"H rises by {jump:.4g}" in claim.detail) == (status == "refuted")
    assert ("nothing jumps" in claim.detail) == (law is FLAT)


def test_pairs_at_the_range_itself_and_at_one_place():
    assert of_line(0.0, 15.0).claim("energy").status == "inconclusive"
    verdict = of_line(1.0, 1.0)
    assert {claim.status for claim in verdict.claims} == {"vacuous"}
    assert verdict.hypotheses[1].status == "unmet"


def test_the_last_claim_is_of_the_least_distance_over_the_length_of_the_law():
    for law in (LAW, replace(LAW, interaction=replace(LAW.interaction, r_b=9.0))):
        claim = of_line(0.0, 5.0, 12.0, law=law).claim("collision")
        assert claim.margin == pytest.approx(5.0 / law.scales.length, rel=1e-9)
