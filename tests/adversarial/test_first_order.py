"""Laws of first order: swarms on both sides of b = a, and pursuit beside its critical angle, from any start."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from flockana import AverageConsensus, CyclicPursuit, DistanceFormation, GaziPassino, VelocityInTurn
from tests.adversarial.cases import TRUE, VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers, seeds

THEOREMS = ("gazi-passino", "cyclic-pursuit", "average-consensus", "average-switching", "distance-formation")


@effort(0.4)
@given(powers(-12.0, 0.0), st.booleans(), st.integers(1, 7), powers(-3.0, 3.0), powers(-3.0, 3.0), seeds)
def test_swarms_on_both_sides_of_equal_gains(off, above, n, unit, pace, seed):
    q = unit * np.random.default_rng(seed).normal(size=(n, 2))
    law = GaziPassino(pace, pace * (1.0 + off if above else 1.0 / (1.0 + off)), 0.3 * unit**2)
    always = dict.fromkeys(("bounded", "rest", "sharp"), VERIFIED) | dict.fromkeys(("centroid", "rate"), TRUE)
    side = {"collapse": VACUOUS if above else VERIFIED, "apart": VERIFIED if above and n > 1 else VACUOUS}
    hold("gazi-passino", Case(law, q, law.velocity(0.0, q), 1.0 / pace), always | side)


@effort(0.4)
@given(powers(-12.0, -0.5), st.sampled_from(["meet", "circle", "spread"]), st.sampled_from([2, 3, 4, 5, 6, 9]), seeds)
def test_pursuit_beside_its_critical_angle(off, side, n, seed):
    rng = np.random.default_rng(seed)
    share = {"meet": 1.0 - off, "circle": 1.0, "spread": 1.0 + off}[side]
    law = CyclicPursuit(rng.uniform(0.1, 9.0), rng.choice([-1.0, 1.0]) * 180.0 / n * share)
    q = rng.normal(size=(n, 2))
    known = {name: VERIFIED if name == side else VACUOUS for name in ("meet", "circle", "spread")}
    hold("cyclic-pursuit", Case(law, q, law.velocity(0.0, q), 1.0), known | {"centroid": TRUE, "motion": TRUE})


@effort(0.4)
@given(st.integers(2, 6), st.integers(0, 3), powers(-12.0, 0.0), st.booleans(), seeds)
def test_sums_of_rings_average_and_a_heavier_link_spoils_it(n, more, off, balanced, seed):
    rng = np.random.default_rng(seed)
    weights = np.zeros((n, n))
    for k in range(1 + more):  # whole weights: sums of rows and columns are equal to the bit
        order = rng.permutation(n)
        weights[order, np.roll(order, 1)] += 1.0 + k
    if not balanced:
        weights[tuple(order[[0, -1]])] += off
    law, q = AverageConsensus(weights), rng.normal(size=(n, 1))
    even = {"average": VERIFIED, "some-start": VACUOUS, "decay": TRUE}
    uneven = {"average": VACUOUS, "some-start": VERIFIED, "decay": VACUOUS}
    always = {"agreement": VERIFIED, "steps": VERIFIED}
    hold("average-consensus", Case(law, q, None, 1.0), always | (even if balanced else uneven))


@effort(0.4)
@given(st.integers(2, 6), st.integers(1, 4), powers(-12.0, 0.0), st.booleans(), seeds)
def test_rings_in_turn_average_and_one_heavier_link_spoils_it(n, count, off, balanced, seed):
    rng = np.random.default_rng(seed)
    nets = np.zeros((count, n, n))
    for net in nets:
        order = rng.permutation(n)
        net[order, np.roll(order, 1)] = rng.integers(1, 5)
    if not balanced:
        nets[rng.integers(count)][tuple(rng.permutation(n)[:2])] += off
    law = VelocityInTurn([AverageConsensus(net) for net in nets], rng.uniform(0.01, 0.5, count))
    known = {"average": VERIFIED, "decay": TRUE} if balanced else dict.fromkeys(("average", "decay"), VACUOUS)
    hold("average-switching", Case(law, rng.normal(size=(n, 1)), None, 1.0), known)


@effort(0.4)
@given(powers(-9.0, 0.0), st.booleans(), powers(-3.0, 3.0), powers(-3.0, 3.0))
def test_one_link_beside_its_neighbourhood(off, near, unit, pace):
    """σ² = 2 s² and ‖e‖ = |s² − d²| of a link s long: near if 4 |s² − d²| < 2 s², s² < 2 d² or s² > 2/3 d²."""
    s2 = 2.0 * (1.0 / (1.0 + off) if near else 1.0 + off)
    law = DistanceFormation(((0, 1),), unit, gain=pace / unit**2)
    q = unit * np.array([[0.0, 0.0], [s2**0.5, 0.0]])
    side = VERIFIED if near else VACUOUS
    known = dict.fromkeys(("formation", "nearby"), side) | {"rest": VERIFIED, "collinear": VERIFIED, "centroid": TRUE}
    hold("distance-formation", Case(law, q, law.velocity(0.0, q), 1.0 / pace), known)
