"""Energies of a start against c* and barriers, from tubes of two agents and of one, whose numbers are known by hand."""

from math import sqrt

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, enclose, verify
from tests.theorems.made_up import hypothesis, statuses

LAW = Algorithm1()
NEEDED = 30.0 * LAW.alpha.c_star  # c1α c*, 1571.5
SPAN = (0.0, 2.0**-7)


def tube_of(*places, speed=0.0, law=LAW, span=SPAN):
    """Agents on a line, the first and the last of which move towards each other."""
    q, p = np.array(places)[:, None], np.zeros((len(places), 1))
    p[0], p[-1] = speed, -speed
    return enclose(law, q, p, span)


@pytest.mark.slow
@pytest.mark.parametrize("speed", [0.0, 39.0, 40.0, 56.0, 57.0])
def test_the_energy_against_c_star_and_twice_it(speed):
    verdict = verify("collision-energy", tube_of(0.0, 7.0, speed=speed))
    for text, times, claim in (("H(0) < c*", 1.0, "below"), ("H(0) < 2 c*", 2.0, "twice")):
        found = hypothesis(verdict, text)
        assert found.margin == pytest.approx(times * NEEDED - speed**2, rel=1e-9)
        assert found.status == ("met" if speed**2 < times * NEEDED else "unmet")
        assert (verdict.claim(claim).status == "vacuous") == (found.status == "unmet")


@pytest.mark.slow
@pytest.mark.parametrize("speed", [0.0, 39.0, 40.0])
@pytest.mark.parametrize("name", ["os-1", "os-3"])
def test_two_coincide_with_c_star_exactly(name, speed):
    """The barrier of two is c*, from below and from above; that of one does not exist."""
    law = LAW if name == "os-1" else Algorithm2(gains=Gains(c1_gamma=2.0), target=StaticTarget((3.5,)))
    verdict = verify(name, tube_of(0.0, 7.0, speed=speed, law=law))
    pull = 0.0 if name == "os-1" else 3.5**2 * 2.0  # ½ c1γ of twice 3.5²
    barrier, low = hypothesis(verdict, "min{V"), hypothesis(verdict, "H(0) < c*")
    assert barrier.status == low.status == ("met" if speed**2 + pull < NEEDED else "unmet")
    assert barrier.margin == pytest.approx(NEEDED - speed**2 - pull, rel=1e-9)
    assert low.margin == pytest.approx(NEEDED - speed**2 - pull, rel=1e-9)
    assert barrier.detail.startswith("H(0) is at most " if barrier.status == "met" else "H(0) = ")


def test_one_agent_meets_nobody():
    tube = enclose(Algorithm2(target=StaticTarget((0.0,))), [[3.0]], [[0.0]], SPAN)
    barrier = hypothesis(verify("os-3", tube), "min{V")
    assert (barrier.status, barrier.detail) == ("met", "there is one agent")


@pytest.mark.parametrize(
    ("law", "missed"),
    [
        (Algorithm1(gains=Gains(c1_alpha=0.0)), "c1α"),
        (Algorithm1(gains=Gains(c1_alpha=0.0, c2_alpha=2.0)), "c1α"),
        (Algorithm1(gains=Gains(c2_alpha=0.0)), "c2α"),
    ],
)
def test_without_a_gain_it_says_nothing(law, missed):
    tube = tube_of(0.0, 7.0, law=law)
    one = verify("os-1", tube)
    assert next(h.name for h in one.hypotheses if h.status == "unmet").startswith(missed)
    assert set(statuses(one).values()) == {"vacuous"}
    assert (set(statuses(verify("collision-energy", tube)).values()) == {"vacuous"}) == (missed == "c1α")


@pytest.mark.parametrize("distance", [16.0, 9.0])
def test_a_flock_that_is_apart_does_not_stay_together(distance):
    verdict = verify("os-1", tube_of(0.0, distance))
    need = hypothesis(verdict, "cohesive dynamic flock")
    assert (need.status, need.margin) == ("unmet", -1.0)
    assert need.detail == "the net is certainly not connected about t = 0"
    assert set(statuses(verdict).values()) == {"vacuous"}


def test_what_has_the_energy_to_part_has_a_neighbour_in_the_set_that_does():
    """Two have 30 ψ_α(r) at rest out of range, and no less apart: a faster start has that much more."""
    far = 30.0 * float(LAW.alpha.energy(np.array([9.0]))[0])
    fast = hypothesis(verify("os-1", tube_of(0.0, 7.0, speed=sqrt(1.25 * far))), "cohesive dynamic flock")
    assert fast.status == "unmet"
    assert fast.margin == pytest.approx(-0.25 * far, rel=1e-9)
    assert fast.detail == "Ω_c holds a disconnected state at rest"


@pytest.mark.parametrize("gain", [0.5, 2.0])
def test_how_far_the_energy_lets_agents_go(gain):
    """At rest at ±3.5 about the target, H = c1γ 3.5², so that R <= √2 · 3.5."""
    law = Algorithm2(gains=Gains(c1_gamma=gain), target=StaticTarget((3.5,)))
    claim = verify("os-3", tube_of(0.0, 7.0, law=law)).claim("i")
    assert (claim.status, claim.proof) == ("verified", "cohesion")
    assert claim.computed == pytest.approx(3.5, rel=1e-3)
    assert claim.margin == pytest.approx(sqrt(2.0) * 3.5 - claim.computed, rel=1e-9)
    assert claim.stated == f"R <= sqrt(2 H_λ(0)/c1γ) = {sqrt(2.0) * 3.5:.5g}"


@pytest.mark.slow
@pytest.mark.parametrize(("speed", "least"), [(39.0, 0), (40.0, 1), (56.0, 1), (57.0, 2)])
def test_more_pairs_than_the_energy_pays_for(speed, least):
    """Of two there is one pair: (iv) as printed says something while H(0) < c*."""
    law = Algorithm2(gains=Gains(c1_gamma=1e-3), target=StaticTarget((3.5,)))
    verdict = verify("os-3", tube_of(0.0, 7.0, speed=speed, law=law))
    assert (verdict.claim("iv-printed").status == "vacuous") == (least >= 1)


@pytest.mark.slow
@pytest.mark.parametrize(("speed", "said"), [(0.0, "met"), (4.6, "met"), (4.8, "unmet")])
def test_two_that_cannot_part_stay_together(speed, said):
    """H = v² against c1α ψ_α(r_α) = 22.08, which two agents far apart have too."""
    verdict = verify("os-1", tube_of(0.0, 7.0, speed=speed))
    need = hypothesis(verdict, "cohesive dynamic flock")
    room = 30.0 * 0.73590113426239231 - speed**2
    assert (need.status, need.margin) == (said, pytest.approx(room, rel=1e-9))
    assert statuses(verdict)["ii"] == ("verified" if said == "met" else "vacuous")


def test_what_is_proved_of_every_start_needs_no_basin():
    law = Algorithm2(target=StaticTarget((0.0,)))
    verdict = verify("os-3", tube_of(0.0, 7.0, 15.0, speed=1.0, law=law))
    assert statuses(verdict)["ii"] == "inconclusive"
    assert {statuses(verdict)[name] for name in ("ii-converges", "ii-semidefinite", "iii")} == {"verified"}
