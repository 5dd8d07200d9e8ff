"""Scenarios of what the bearing-distance paper says in prose: starts, settings, and reports that see what is wrong."""

from dataclasses import replace
from functools import cache
from itertools import cycle

import numpy as np
import pytest

from flockana import rescale, scenario
from flockana.base.errors import ArgumentError
from flockana.sources.jond_2025.scenarios import prose_claims
from flockana.sources.jond_2025.scenarios.prose_claims import SCENARIOS


@cache
def ran(name):
    return scenario(name).run()


def claim_of(name, run, claim):
    return scenario(name).verify(run)[-1].claim(claim)


@pytest.mark.parametrize("name", SCENARIOS)
def test_starts_follow_from_the_seed(name):
    one, again, other = scenario(name, seed=3), scenario(name, seed=3), scenario(name, seed=4)
    np.testing.assert_array_equal(one.q0, again.q0)
    assert np.array_equal(one.q0, other.q0) is (name == "zone-individual")
    assert (one.law.noise.seed == 3) is (name == "zone-51-noisy")


def test_settings_and_options():
    assert scenario("zone-51-informed").law.weights.speed == (5.0, 5.0) + (0.0,) * 8
    assert scenario("zone-51-informed", informed=4).law.weights.speed.count(5.0) == 4
    assert scenario("zone-scaled").shape == (500, 2)
    assert scenario("zone-scaled", n=30).q0.shape == (30, 2)
    assert "in 1 ± 0.2" in scenario("zone-51-noisy", weights=0.2).source
    speed = scenario("zone-gap-speed").law
    assert (speed.zone_length, speed.obstacle_force) == ("speed", "reaching")
    with pytest.raises(ArgumentError, match="zone-box has no option n"):
        scenario("zone-box", n=3)


def test_own_weights_are_heard(exact):
    """Doctored: equal weights for all give way to nobody, and other distances from the alien."""
    run = ran("zone-individual")
    kept, way = (claim_of("zone-individual", run, name) for name in ("hazards", "gives-way"))
    assert kept.status == way.status == "verified"
    assert kept.computed == pytest.approx([6.0 - 30.0 / w for w in (12.0, 15.0, 20.0)], abs=1e-6)
    np.testing.assert_allclose(way.computed, [[3.0, 3.0], [-3.0, -3.0]], rtol=1e-6)  # as who heeds less began
    turned = run.p.copy()
    turned[-1, 4] *= -1.0
    assert claim_of("zone-individual", replace(run, p=turned), "gives-way").status == "refuted"
    assert claim_of("zone-individual", replace(run, q=1.01 * run.q), "hazards").status == "refuted"
    pairs = run.q[:, 3:, 0].reshape(len(run.t), 2, 2)
    assert (pairs[:, :, 0] < pairs[:, :, 1]).all(), "they ran through each other"


def test_chance_is_told_from_none(monkeypatch):
    entry, run = scenario("zone-51-noisy"), ran("zone-51-noisy")
    assert claim_of(entry.name, run, "repeats").status == "verified"
    moved = run.q.copy()
    moved[-1, 0, 0] = np.nextafter(moved[-1, 0, 0], np.inf)
    with monkeypatch.context() as patch:
        runs = cycle([run, replace(run, q=moved)])
        patch.setattr(prose_claims, "rerun", lambda *_: next(runs))
        assert claim_of(entry.name, run, "repeats").status == "refuted"
    assert claim_of(entry.name, run.window(1.0, 20.0), "repeats").status == "inconclusive"
    quiet = scenario("zone-51-noisy", weights=0.0, velocities=0.0)
    verdict = quiet.verify(quiet.run())[-1]
    assert verdict.claim("repeats").status == "verified"
    assert verdict.claim("unpredictable").status == "refuted"


def test_in_other_units_it_is_the_same_run():
    entry = scenario("zone-51-noisy")
    odd = rescale(entry, length=2.54, time=0.37)
    np.testing.assert_allclose(odd.run().q[10] / 2.54, ran(entry.name).q[10], rtol=1e-9)
    assert odd.verify(odd.run())[-1].claim("repeats").status == "verified"


def test_finding_together(exact):
    run = ran("zone-box")
    whole, away = run.q[:1] * 0.05 + 20.0, run.q[:1].copy()
    for pattern, again, at_end in (("awa", True, False), ("aaw", True, True), ("aaa", False, False)):
        path = np.concatenate([whole if mark == "w" else away for mark in pattern])
        doctored = replace(run.window(0.0, 0.25), q=path)
        assert claim_of("zone-box", doctored, "reunites").status == ("verified" if again else "refuted"), pattern
        found = claim_of("zone-51-growing", doctored, "together").status
        assert found == ("verified" if at_end else "refuted"), pattern
    assert claim_of("zone-box", replace(run, q=run.q + np.array([30.0, 0.0])), "contained").status == "refuted"
