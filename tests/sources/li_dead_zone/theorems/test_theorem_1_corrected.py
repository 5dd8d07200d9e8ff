"""The dead-zone theorem, printed and corrected, on runs that decide each claim."""

from types import SimpleNamespace

import numpy as np
import pytest

from flockana import DeadZoneFlocking, DeadZoneInteraction, simulate, verify
from flockana.sources.li_dead_zone.theorems.theorem_1_corrected import _rate
from tests.theorems.made_up import statuses


@pytest.mark.parametrize("end", [1e-3, 0.05, 0.08])
def test_a_run_that_is_not_over_decides_no_limit(end):
    """The start of L4, which parts for ever, while the two are in range: nothing tells it from one that does not."""
    young = simulate(DeadZoneFlocking(), [[0.0, 0.0], [14.0, 0.0]], [[-6.0, 0.0], [6.0, 0.0]], (0.0, end))
    assert statuses(verify("dead-zone-1-printed", young))["velocity"] == "inconclusive"
    assert statuses(verify("dead-zone-1-printed", young))["cohesion"] == "inconclusive"
    assert verify("dead-zone-1-corrected", young).claim("components").status == "inconclusive"


def test_the_distance_bound_bites():
    law = DeadZoneFlocking(DeadZoneInteraction(ramp=0.0, k1=0.0, k_delta=0.0), k2=0.0)
    run = simulate(law, [[0.0], [6.0]], [[20.0], [-20.0]], (0.0, 0.3))
    claim = verify("dead-zone-1-corrected", run).claim("distance")
    # ψ(ρ) = H: 1/sinh(400/400 + asinh(1/3.5)), with the pair's far potential nothing
    bound = 1.0 / np.sinh(1.0 + np.arcsinh(1.0 / 3.5))
    assert law.interaction.least_distance(400.0) == pytest.approx(bound, rel=1e-14)
    assert abs(run.closest_approach().distance - bound) < 1e-6
    assert claim.status in ("verified", "inconclusive")


def test_every_sample_at_which_the_energy_rises_counts_however_slowly():
    run = SimpleNamespace(energy=lambda: np.zeros(4))
    seen = SimpleNamespace(t=np.array([0.0, 1.0, 2.0, 3.0]), run=run, is_map=True)
    claim = _rate(seen, np.array([-3.0, 0.5, 1e-300, 0.0]), [])
    assert (claim.status, claim.margin, claim.computed) == ("refuted", -2.0, 0.5)
    assert claim.witness == {"time": 1.0, "samples at which it is positive": 2}
    assert _rate(seen, np.array([-3.0, -0.5, -1e-300, 0.0]), []).status == "verified"
