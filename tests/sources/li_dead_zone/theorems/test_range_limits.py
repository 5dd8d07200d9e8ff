"""Planted truths of the dead-zone theorem: verdicts are right, or open, at all sizes, in all units, on any samples.

What is true or false of a start is known by algebra here; sizes go from far above to far below the numerical error.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

from flockana import DeadZoneFlocking, DeadZoneInteraction, SemiImplicitEuler, cohesion_radius, simulate
from flockana.sources.li_dead_zone.theorems.local_basin import hold
from flockana.sources.li_dead_zone.theorems.net_components import components_of
from flockana.sources.li_dead_zone.theorems.range_limits import first_entry
from flockana.theorems.observed_run import Observed
from tests.theorems.made_up import said

SIZES = [1e-1, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15]
LAW = DeadZoneFlocking()
FAR = LAW.interaction.far_potential
CONTACT = 3.4997320373195637  # where k1 presses two agents to


def small_flock(seed, n=8, box=9.0):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, box, (n, 2)), rng.uniform(-1.0, 1.0, (n, 2))


@pytest.mark.parametrize("excess", [-s for s in SIZES] + SIZES)
def test_the_energy_that_breaks_a_pair_up_is_sharp_but_for_rounding(excess):
    """Without damping the two part if and only if H̄ > ψ̄(r); with it nothing is known from H̄ alone above that."""
    pair = DeadZoneFlocking(k2=1e-3)
    speed = np.sqrt((1.0 + excess) * FAR - LAW.interaction.energy(CONTACT))
    run = simulate(pair, [[0.0], [CONTACT]], [[-speed], [speed]], (0.0, 1e-9))  # damping takes 4e-12 of H̄
    status = said("dead-zone-1-printed", run)["velocity"]
    assert status in ("verified", "inconclusive")
    if abs(excess) >= 1e-6:  # the state at the end is known to some 1e-8
        assert status == ("verified" if excess < 0.0 else "inconclusive")


@pytest.mark.parametrize("offset", [s * sign for s in (3.0, *SIZES) for sign in (1.0, -1.0)])
def test_two_agents_that_pass_at_the_edge_of_their_range(offset):
    q, p = [[0.0, 0.0], [100.0, 15.0 + offset]], [[1.0, 0.0], [-1.0, 0.0]]
    found = components_of(np.array(q), np.array(p), LAW)
    if offset > 0.0:
        assert found.separation.certain if offset >= 1e-9 else True
    else:
        assert not found.separation.certain
    run = simulate(LAW, q, p, (0.0, 10.0))
    status = said("dead-zone-1-printed", run)["velocity"]
    assert status == ("refuted" if offset >= 1e-6 else "inconclusive") or 0.0 < offset < 1e-6
    assert status != "verified"


def shaken_hexagon(seed):
    """Seven agents in contact, a stiff cluster: shaken this little they come to rest as they were."""
    rng, turn = np.random.default_rng(seed), np.arange(6) * np.pi / 3.0
    q = CONTACT * np.vstack([np.zeros(2), np.column_stack([np.cos(turn), np.sin(turn)])])
    return q + rng.uniform(-1e-3, 1e-3, q.shape), rng.uniform(-1e-2, 1e-2, q.shape)


@pytest.mark.parametrize("start", [small_flock, shaken_hexagon])
@pytest.mark.parametrize("seed", range(6))
def test_what_is_certain_at_one_instant_comes_true(seed, start):
    q, p = start(seed)
    run = simulate(LAW, q, p, (0.0, 150.0), t_eval=np.linspace(0.0, 150.0, 61))
    end, integrated = cohesion_radius(run.q[-1]), 1e-7  # places are as good as rtol = 1e-8 of some ten metres
    mismatch = run.metric("normalised_velocity_mismatch")
    held = [hold(LAW, x, v) for x, v in zip(run.q, run.p, strict=True)]
    bound = [components_of(x, v, LAW) for x, v in zip(run.q, run.p, strict=True)]
    for k in range(60):
        if held[k].certificate.margin > 0.0:
            assert abs(cohesion_radius(run.q[k]) - end) <= held[k].reach + integrated
            assert mismatch[-1] < max(1e-12, mismatch[k])
            assert held[k + 1].certificate.margin > 0.0 or held[k + 1].excess < held[k].barrier
        if bound[k].count == 1 and bound[k].members[0].radius < np.inf:
            assert max(map(cohesion_radius, run.q[k:])) <= bound[k].members[0].radius + integrated
            assert all(components_of(x, v, LAW).count == 1 for x, v in zip(run.q[k:], run.p[k:], strict=True))
    assert start is small_flock or held[-1].certificate.margin > 0.9


def test_a_saddle_holds_nothing():
    law = DeadZoneFlocking(DeadZoneInteraction(k1=0.05))
    line = np.array([[0.0, 0.0], [3.4, 0.0], [6.8, 0.0]])  # in the plane a straight chain under pressure buckles

    def push(s):
        return float(law.flow(0.0, np.array([[0.0, 0.0], [s, 0.0], [2.0 * s, 0.0]]), 0.0 * line)[0][0, 0])

    s = brentq(push, 3.3, 3.5, xtol=1e-15)
    q = np.array([[0.0, 0.0], [s, 0.0], [2.0 * s, 0.0]])
    assert np.abs(law.flow(0.0, q, 0.0 * q)[0]).max() < 1e-10
    assert hold(law, q, 0.0 * q).certificate.margin == -1.0
    assert hold(law, q[:, :1], 0.0 * q[:, :1]).certificate.margin > 0.9  # on a line it cannot buckle


@pytest.mark.parametrize("dt", [0.002, 0.02])
def test_a_map_that_chatters_is_not_taken_to_rest(dt):
    law = SemiImplicitEuler(DeadZoneFlocking(DeadZoneInteraction(ramp=0.0)), dt)
    q, p = small_flock(0)
    run = simulate(law, q, p, (0.0, 60.0))
    for k in (-1, len(run.t) - 2, len(run.t) // 2, int(np.argmin(run.metric("normalised_velocity_mismatch")))):
        one = run.window(run.t[0], run.t[k])
        assert said("dead-zone-1-corrected", one)["components"] != "verified"
        assert said("dead-zone-1-printed", one)["velocity"] != "verified"


def test_what_a_map_did_between_the_samples_that_were_kept_is_not_known():
    law = SemiImplicitEuler(LAW, 0.01)
    q, p = [[0.0, 0.0], [400.0, 14.0]], [[20.0, 0.0], [-20.0, 0.0]]
    whole, thin = (simulate(law, q, p, (0.0, 20.0), **how) for how in ({}, {"t_eval": [0.0, 9.0, 20.0]}))
    assert said("dead-zone-1-printed", whole)["energy"] == "refuted"
    assert said("dead-zone-1-printed", thin)["energy"] == "inconclusive"


@pytest.mark.parametrize("far", [0.0, 1e3, 1e6, 1e9])
@pytest.mark.parametrize("wind", [0.0, 1e3])
def test_a_flock_far_from_the_origin_or_in_a_strong_wind_is_not_misjudged(far, wind):
    q = far + np.array([[0.0, 0.0], [CONTACT, 0.0], [0.5 * CONTACT, 0.8 * CONTACT]])
    run = simulate(LAW, q, np.full((3, 2), wind), (0.0, 20.0))
    printed, corrected = said("dead-zone-1-printed", run), said("dead-zone-1-corrected", run)
    assert "refuted" not in (*printed.values(), *corrected.values())
    if far <= 1e3 and wind == 0.0:
        assert (printed["velocity"], printed["cohesion"], corrected["components"]) == ("verified",) * 3


@pytest.mark.parametrize(("law", "known"), [(LAW, 1e-7), (SemiImplicitEuler(LAW, 0.01), 1e-13)], ids=["flow", "map"])
@pytest.mark.parametrize("beyond", [0.0, 1e-15, 1e-13, 1e-11, 1e-7])
def test_what_starts_at_the_range_but_for_what_is_known_of_it_does_not_enter(law, known, beyond):
    """Places of 15 are rounded to 2e-15, and so is their difference; those of a flow are known to some 1e-9."""
    pair = (0, 1) if beyond >= known else None
    run = simulate(law, [[0.0], [15.0 * (1.0 + beyond)]], [[1.0], [-1.0]], (0.0, 0.5))
    assert first_entry(Observed.of(run), 15.0).pair == pair
