"""The rate of the printed energy of Algorithm 3 on states by hand: dissipation, and the pair forces' power too much."""

from math import cos, pi

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm3, Gains, LinearTarget, StaticTarget
from tests.theorems.made_up import hypothesis, judged, made_up, statuses

EPS, MATCH = np.finfo(float).eps, 3.0
LAW = Algorithm3(gains=Gains(c2_alpha=2.0, c1_gamma=1.0, c2_gamma=MATCH), target=StaticTarget((0.0, 0.0)))
APART = np.array([[0.0, 0.0], [7.5, 0.0]])  # farther than d: they pull at each other
PULL = float(Algorithm1(LAW.alpha, Gains(c2_alpha=0.0)).flow(0.0, APART, 0.0 * APART)[0][0, 0])
SHARE = float(LAW.alpha.sigma_norm(7.5)) / LAW.alpha.r_alpha
HEARD = 0.5 * (1.0 + cos(pi * (SHARE - LAW.alpha.h) / (1.0 - LAW.alpha.h)))  # a of the pair


def verdict_of(*velocities, law=LAW, q=APART):
    """Two agents along x, at samples that differ in velocity alone."""
    p = np.zeros((len(velocities), len(q), 2))
    p[:, :, 0] = velocities
    return judged("energy-printed", made_up(law, [q] * len(velocities), p))


@pytest.mark.parametrize("v", [0.5, -0.01])
def test_a_common_velocity_has_no_power(v):
    """−2 c2γ v², against as much that might cancel, and 2 F |v| that does."""
    claim = verdict_of((v, v), (v, v)).claim("printed-run")
    lost, turned = 2.0 * MATCH * v * v, 2.0 * PULL * abs(v)
    assert claim.margin == pytest.approx(lost / (lost + 2.0 * (lost + turned)), rel=1e-9)
    assert claim.error == pytest.approx((2**2 + 64) * EPS, rel=1e-3, abs=0.0)
    assert claim.status == "inconclusive"  # its samples alone are known


@pytest.mark.parametrize(
    ("w", "status"), [(0.5, "inconclusive"), (0.01, "inconclusive"), (-0.5, "refuted"), (-0.01, "refuted")]
)
def test_two_that_follow_their_pull_lose_it_twice_and_two_that_part_gain_it(w, status):
    """−2 c2γ w² − c2α a (2w)² − 2 F w, of w towards each other; where the rate is positive the energy rises."""
    claim = verdict_of((w, -w), (w, -w)).claim("printed-run")
    matched, heard, power = 2.0 * MATCH * w * w, 2.0 * HEARD * (2.0 * w) ** 2, 2.0 * PULL * w
    rate = -matched - heard - power
    assert (rate < 0.0) == (w > 0.0)
    assert claim.margin == pytest.approx(-rate / (abs(rate) + 2.0 * (matched + abs(power))), rel=1e-9)
    assert claim.status == status


def test_the_worst_of_all_samples_counts():
    one, two = (verdict_of(v, v).claim("printed-run").margin for v in ((-0.1, 0.1), (-0.05, 0.05)))
    assert verdict_of((-0.1, 0.1), (-0.05, 0.05)).claim("printed-run").margin == min(one, two)
    assert verdict_of((0.0, 0.0), (0.0, 0.0)).claim("printed-run").margin == 1.0  # nothing falls or rises


def test_the_pairs_count_once_more():
    """The printed H is the true one and c1α Σψ: it rises by that, where the true one falls as much."""
    near = np.array([[0.0, 0.0], [7.0, 0.0]])
    run = made_up(LAW, [near, APART], np.zeros((2, 2, 2)))
    claim = judged("energy-printed", run).claim("printed-run")
    pairs = 30.0 * float(LAW.alpha.potential_energy(APART))
    rise = pairs + float(run.energy()[1] - run.energy()[0])
    assert (claim.status, claim.computed) == ("refuted", pytest.approx(rise, rel=1e-9))
    assert pairs > 0.1


@pytest.mark.parametrize(
    "target", [StaticTarget((0.0, 0.0), (1.0, 0.0)), LinearTarget((0.0, 0.0), (1.0, 0.0))], ids=["told", "moving"]
)
def test_the_target_must_rest(target):
    law = Algorithm3(gains=LAW.gains, target=target)
    verdict = verdict_of((0.5, 0.5), (0.5, 0.5), law=law)
    assert set(statuses(verdict).values()) == {"vacuous"}
    assert any(h.status == "unmet" for h in verdict.hypotheses)
    assert hypothesis(verdict, "obstacle").status == "met"
