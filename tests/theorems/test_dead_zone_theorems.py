"""The dead-zone theorem, printed and corrected, on runs that decide each claim; its errata with their figures."""

from __future__ import annotations

import numpy as np
import pytest

from flockana.dynamics.simulate import simulate
from flockana.interactions import DeadZoneInteraction
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.laws.olfati_saber import Algorithm1
from flockana.laws.semi_implicit import SemiImplicitEuler
from flockana.scenarios import scenario
from flockana.theorems import verify
from flockana.theorems.dead_zone.l04 import connected_count
from flockana.theorems.dead_zone.parting import parts

ERRATA = [f"L{k}" for k in range(1, 9)]


def statuses(verdict):
    return {claim.name: claim.status for claim in verdict.claims}


@pytest.fixture(scope="module")
def parting():
    return simulate(DeadZoneFlocking(), [[0.0, 0.0], [14.0, 0.0]], [[-6.0, 0.0], [6.0, 0.0]], (0.0, 10.0))


def test_two_agents_that_part_refute_cohesion_and_one_velocity(parting):
    printed = statuses(verify("dead-zone-1-printed", parting))
    assert printed == {"cohesion": "refuted", "energy": "verified", "velocity": "refuted", "collision": "verified"}
    # the neighbours' energy falls here, by psi(r) at once when they leave range
    assert verify("dead-zone-1-corrected", parting).status == "verified"


def test_a_flock_that_contracts_refutes_the_printed_energy_only():
    rng = np.random.default_rng(4)
    q, p = rng.uniform(0.0, 20.0, (12, 2)), rng.uniform(-1.0, 1.0, (12, 2))
    run = simulate(SemiImplicitEuler(DeadZoneFlocking(), 0.01), q, p, (0.0, 200.0), t_eval=np.linspace(0.0, 200.0, 201))
    printed = verify("dead-zone-1-printed", run)
    assert statuses(printed) == {
        "cohesion": "verified",
        "energy": "refuted",
        "velocity": "verified",
        "collision": "verified",
    }
    # pairs came into range: the rise is psi(15) less what was dissipated between two samples, or a multiple of it
    far = DeadZoneInteraction().far_potential
    assert 0.5 * far < printed.claim("energy").computed < 20.0 * far
    corrected = statuses(verify("dead-zone-1-corrected", run))
    assert corrected == {"rate": "verified", "balance": "vacuous", "components": "verified", "distance": "verified"}


@pytest.mark.parametrize("end", [1e-3, 0.05, 0.08])
def test_a_run_that_is_not_over_decides_no_limit(end):
    """The start of L4, which parts for ever, while the two are in range: nothing tells it from one that does not."""
    young = simulate(DeadZoneFlocking(), [[0.0, 0.0], [14.0, 0.0]], [[-6.0, 0.0], [6.0, 0.0]], (0.0, end))
    assert statuses(verify("dead-zone-1-printed", young))["velocity"] == "inconclusive"
    assert statuses(verify("dead-zone-1-printed", young))["cohesion"] == "inconclusive"
    assert verify("dead-zone-1-corrected", young).claim("components").status == "inconclusive"


def test_the_distance_bound_bites():
    """Without damping the bound is attained; a larger energy than the run's would be refuted by it."""
    law = DeadZoneFlocking(DeadZoneInteraction(ramp=0.0, k1=0.0, k_delta=0.0), k2=0.0)
    run = simulate(law, [[0.0], [6.0]], [[20.0], [-20.0]], (0.0, 0.3))
    claim = verify("dead-zone-1-corrected", run).claim("distance")
    # ψ(ρ) = H: 1/sinh(400/400 + asinh(1/3.5)), with the pair's far potential nothing
    bound = 1.0 / np.sinh(1.0 + np.arcsinh(1.0 / 3.5))
    assert law.interaction.least_distance(400.0) == pytest.approx(bound, rel=1e-14)
    assert abs(run.closest_approach().distance - bound) < 1e-6
    assert claim.status in ("verified", "inconclusive")


def test_another_law_is_none_of_its_business():
    run = simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    for name in ("dead-zone-1-printed", "dead-zone-1-corrected"):
        assert verify(name, run).status == "vacuous"


def test_parts_tell_receding_from_approaching():
    law = DeadZoneFlocking()
    q = np.array([[0.0, 0.0], [3.5, 0.0], [50.0, 0.0], [53.5, 0.0]])
    away, back = (np.array([[-s, 0.0], [-s, 0.2], [s, 0.0], [s, 0.0]]) for s in (1.0, -1.0))
    assert (parts(q, away, law).count, parts(q, away, law).parting, parts(q, back, law).parting) == (2, True, False)
    assert parts(q, away, law).mismatch == pytest.approx(0.5 * 2 * 0.01 / 2)
    assert not parts(q[:2], away[:2], law).parting
    assert not parts(q, 0.0 * q, law).parting  # they stay apart, but at one velocity


def test_parts_may_pass_each_other_beyond_range_only():
    law, p = DeadZoneFlocking(), np.array([[1.0, 0.0], [-1.0, 0.0]])
    for offset, certain in ((15.1, True), (14.9, False)):
        assert parts(np.array([[0.0, 0.0], [100.0, offset]]), p, law).parting is certain


def test_centres_that_recede_do_not_part_what_can_still_reach_out():
    """A pair that is about to break up sends an agent after the other part, so its centre says nothing.

    Before, receding centres were enough: here they recede at 0.7, and the agents meet all the same.
    """
    law = DeadZoneFlocking(k2=0.0)
    q = np.array([[0.0, 0.0], [14.0, 0.0], [40.0, 0.0]])
    p = np.array([[-13.0, 0.0], [12.0, 0.0], [0.2, 0.0]])
    assert (parts(q, p, law).count, parts(q, p, law).parting) == (2, False)
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
    speed = np.sqrt(share * law.interaction.far_potential - law.interaction.psi(8.0))  # each of the two: ½(s² + s²)
    p = np.array([[speed, 0.0], [-speed, 0.0], [0.0, 1.0]])
    assert parts(q, p, law).parting is certain


@pytest.mark.parametrize(("distance", "certain"), [(29.9, False), (30.1, True)])
def test_a_chain_is_bound_by_its_pairs_out_of_range(distance, certain):
    """n = 3 with its ends 16 apart: H is 1.1 psi(r), so M = 1, and B = 15 (2 + 1)/3."""
    q = np.array([[-8.0, 0.0], [0.0, 0.0], [8.0, 0.0], [0.0, distance]])
    p = np.array([[0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 1.0]])
    assert parts(q, p, DeadZoneFlocking()).parting is certain


def test_what_parts_for_ever_does():
    """From a wide start: the parts that are certain to part at t = 400 are those at t = 800."""
    item = scenario("dead-zone-wide-start", seed=3)
    law = item.law.law
    run = simulate(item.law, item.q0, item.p0, (0.0, 800.0), t_eval=[0.0, 400.0, 800.0])
    middle, end = (parts(q, p, law) for q, p in zip(run.q[1:], run.p[1:], strict=True))
    assert middle.parting
    assert (end.count, end.parting) == (middle.count, True)


def test_a_flock_narrow_now_that_parts_for_ever_is_not_cohesive():
    run = simulate(DeadZoneFlocking(), [[0.0, 0.0], [16.0, 0.0]], [[-0.1, 0.0], [0.1, 0.0]], (0.0, 1.0))
    claim = verify("dead-zone-1-printed", run).claim("cohesion")
    assert (claim.status, claim.computed < 15.0) == ("refuted", True)


def test_claims_name_the_proof_of_what_they_say():
    named = {f"{key}:{claim.name}" for key in ERRATA for claim in verify(key).claims if claim.proof == "dead-zone"}
    assert named == {
        *("L2:printed", "L3:printed", "L3:corrected", "L4:printed", "L5:printed", "L5:corrected", "L6:printed"),
        *("L6:bound", "L8:printed", "L8:contact"),
    }
    run = simulate(DeadZoneFlocking(), [[0.0], [4.0]], [[0.0], [0.0]], (0.0, 1.0))
    for key, expected in (("corrected", {"rate", "distance"}), ("printed", {"energy", "collision"})):
        claims = verify(f"dead-zone-1-{key}", run).claims
        assert {claim.name for claim in claims if claim.proof == "dead-zone"} == expected


def test_errata_figures():
    assert verify("L5").claim("printed").computed == pytest.approx(
        DeadZoneInteraction(ramp=0.0).far_potential, rel=1e-9
    )
    distances = verify("L6").claim("printed").computed
    assert distances == pytest.approx([2.8460, 0.60128, 0.02761], rel=1e-3)
    chatter = verify("L7").claim("chatter").computed
    assert 0.06 < chatter[0] < 0.1  # √K̃ in the mean over time: from eight starts 0.075 to 0.086
    assert chatter[1] < 0.5 * chatter[0]
    assert verify("L8").claim("contact").computed == pytest.approx(3.49973, abs=1e-5)


def test_share_of_connected_flocks_falls_with_the_box():
    near, far = (connected_count(box, seeds=4, n=20, t_end=20.0) for box in (15.0, 150.0))
    assert (near, far) == (4, 0)
