"""The theorem on swarms: both sides of b = a, the bound and the rate against other numbers, scenarios."""

from math import exp, sqrt

import numpy as np
import pytest

import flockana as fl
from tests.theorems.made_up import statuses

Q = np.random.default_rng(5).uniform(-4.0, 4.0, (6, 2))


@pytest.mark.parametrize("side", [1.0 - 1e-12, 1.0, 1.0 + 1e-12])
def test_the_sides_of_equal_attraction_and_repulsion(side):
    verdict = fl.verify("gazi-passino", law=fl.GaziPassino(2.0, 2.0 * side, 0.3), q0=Q, t_span=(0.0, 0.5))
    told = statuses(verdict)
    assert (told["collapse"], told["apart"]) == (("vacuous", "verified") if side > 1.0 else ("verified", "vacuous"))
    assert {told[name] for name in ("centroid", "bounded", "rest", "sharp", "rate")} == {"verified"}


def test_all_at_one_place_stay_there():
    verdict = fl.verify("gazi-passino", law=fl.GaziPassino(), q0=np.ones((3, 2)), t_span=(0.0, 1.0))
    assert statuses(verdict)["apart"] == "vacuous"
    assert verdict.claim("centroid").status == "verified"


@pytest.mark.slow
def test_the_rate_is_attained_by_attraction_alone():
    """Far from each other agents come in at exactly aM."""
    law = fl.GaziPassino(0.5, 1e-9, 1e-4)
    run = fl.simulate(law, Q, None, (0.0, 2.0))
    claim = fl.verify("gazi-passino", run).claim("rate")
    radius = np.linalg.norm(Q - Q.mean(axis=0), axis=1).max()
    assert claim.stated.startswith(f"R <= {5 / 6 * 2e-9 * sqrt(5e-5) * exp(-0.5):.6g}")
    assert run.metric("cohesion_radius")[-1] == pytest.approx(radius * exp(-0.5 * 6 * 2.0), rel=1e-5)
    assert abs(claim.margin) < 1e-6


def test_what_is_known_of_the_start_alone():
    table = fl.applicable(fl.GaziPassino(), Q)
    own = table[table.theorem == "gazi-passino"].set_index("claim").status
    assert own["bounded"] == own["apart"] == "met"
    assert own["collapse"] == "unmet"
