"""The theorems on own sums: thresholds in closed form, bounds of runs, and influences that fall slowly."""

from math import pi

import numpy as np
import pytest

import flockana as fl
from flockana import MotschTadmor, RationalWeight, verify
from flockana.scenarios import scenario
from tests.theorems.made_up import statuses

STEEP = MotschTadmor(RationalWeight(decay=1.0))
PAIR = [[0.0], [1.0]]


@pytest.mark.parametrize(("name", "bound"), [("motsch-tadmor", (pi - 2.0) / 8.0), ("motsch-tadmor-sharp", pi / 4.0)])
@pytest.mark.parametrize("side", [1.0 - 1e-6, 1.0 + 1e-6])
def test_a_pair_beside_the_threshold(name, bound, side):
    """∫φ² and ∫φ beyond 1 for φ = 1/(1 + s²)."""
    verdict = verify(name, law=STEEP, q0=PAIR, p0=[[0.0], [bound * side]], t_span=(0.0, 1.0))
    need = verdict.hypotheses[1]
    assert need.status == ("met" if side < 1.0 else "unmet")
    assert need.margin == pytest.approx(bound * (1.0 - side), rel=1e-4)
    assert set(statuses(verdict).values()) == {"verified" if side < 1.0 else "vacuous"}


def test_the_bounds_are_those_of_the_integral_in_any_unit():
    """Speed 0.5 from 1: atan x_M = π/4 + 1/2 for φ."""
    for length, time in ((1.0, 1.0), (1e3, 1e-3)):
        law = fl.rescale(STEEP, length=length, time=time)
        start = length * np.array(PAIR), length / time * np.array([[0.0], [0.5]])
        verdict = verify("motsch-tadmor-sharp", law=law, q0=start[0], p0=start[1], t_span=(0.0, 8.0 * time))
        x_m = length * np.tan(pi / 4.0 + 0.5)
        assert verdict.claim("bounded").stated.endswith(f"{x_m:.6g}")
        assert verdict.claim("bounded").margin == pytest.approx(1.0 - verdict.claim("bounded").computed / x_m, rel=1e-4)


def test_a_slow_influence_makes_every_start_a_flock():
    rng = np.random.default_rng(2)
    law = MotschTadmor(RationalWeight(decay=0.5))
    q, p = rng.uniform(-3.0, 3.0, (8, 2)), rng.uniform(-5.0, 5.0, (8, 2))
    verdict = verify("motsch-tadmor-sharp", law=law, q0=q, p0=p, t_span=(0.0, 5.0))
    assert verdict.claim("flock").status == "verified"
    assert verdict.claim("flock").proof == "own-sums"
    printed = verify("motsch-tadmor", law=law, q0=q, p0=p, t_span=(0.0, 5.0))
    assert printed.status == "vacuous"  # ∫φ² is finite


def test_scenarios_say_what_is_expected_of_them():
    for name in ("own-sums-near", "own-sums-between", "own-sums-fast", "own-sums-flock"):
        entry = scenario(name)
        assert [line for verdict in entry.verify(entry.run()) for line in entry.surprises(verdict)] == []
    fast = scenario("own-sums-fast").run()
    assert np.diff(fast.p[-1, :, 0])[0] > 1.4 - 1.3510  # what the integral 2φ/(1 + φ) cannot take away
