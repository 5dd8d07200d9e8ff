"""Velocity consensus alone, on both sides of the threshold of two agents, and nets whose fate is known."""

from math import sqrt

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st

from flockana import CuckerSmale, FixedNetFlocking, LogPotential, ProximityFlocking, RationalWeight, SemiImplicitEuler
from tests.adversarial import truth
from tests.adversarial.cases import TRUE, VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers, seeds

THEOREMS = "cucker-smale", "cucker-smale-steps", "cucker-smale-pair", "ha-liu", "ha-liu-sharp", "tanner-fixed"
THEOREMS += ("tanner-switching",)
ALL = dict.fromkeys(("bounded", "rate", "flock"), TRUE)
units = st.sampled_from((1.0, 1e-6, 1e4))


@effort(0.4)
@given(st.sampled_from((0.8, 1.0, 2.0)), st.sampled_from((0.1, 1.0, 3.0)), powers(-9.0, -0.3), st.booleans(), units)
def test_two_agents_beside_their_threshold(decay, start, off, above, unit):
    law = CuckerSmale(RationalWeight(2.0, decay, unit))
    speed = truth.weight_left(start * unit, 4.0, unit, decay) * (1.0 + off if above else 1.0 - off)
    case = Case(law, [[0.0], [start * unit]], [[-0.3 * unit], [speed - 0.3 * unit]], 1.0)
    plain = VERIFIED if off > 1e-8 else TRUE
    sides = {"parts": plain, "bounded": VACUOUS} if above else {"parts": VACUOUS, "bounded": plain}
    if off > 1e-8:
        hold("cucker-smale-pair", case, {"invariant": VERIFIED} | sides)
    hold("ha-liu-sharp", case, dict.fromkeys(ALL, VACUOUS) if above and off > 1e-8 else ALL)
    hold("cucker-smale", case, dict.fromkeys(("bounded", "rate", "velocities"), VACUOUS))


@effort(0.4)
@given(st.integers(2, 6), st.integers(1, 3), st.sampled_from((0.0, 0.3, 0.5, 1.0)), powers(-6.0, 1.5), seeds, units)
def test_flocks_that_match(n, m, decay, speed, seed, unit):
    rng = np.random.default_rng(seed)
    q, p = unit * rng.normal(size=(n, m)), unit * speed * rng.normal(size=(n, m))
    case = Case(CuckerSmale(RationalWeight(1.0, decay, unit), mean=bool(seed % 2)), q, p, 1.0)
    printed, sharp = hold("ha-liu", case, ALL), hold("ha-liu-sharp", case, ALL)
    assert not (sharp.status == "vacuous" and printed.status != "vacuous")
    if decay <= 0.5:
        assert printed.status != "vacuous"
        hold("cucker-smale", case, {"bounded": TRUE, "rate": TRUE, "velocities": VERIFIED})


@effort(0.2)
@given(st.integers(2, 4), st.sampled_from((0.0, 0.5, 1.0)), powers(-2.0, 0.2), powers(-2.0, 0.5), seeds, units)
def test_flocks_in_steps(n, decay, step, speed, seed, unit):
    """h λ from 0.01 to 1.6: true while it is at most 1, beyond it the theorem says nothing."""
    assume(abs(step - 1.0) > 1e-9)
    rng = np.random.default_rng(seed)
    q, p = unit * rng.normal(size=(n, 2)), unit * speed * rng.normal(size=(n, 2))
    law = SemiImplicitEuler(CuckerSmale(RationalWeight(1.0, decay, unit)), step / n)
    case = Case(law, q, p, 30 * step / n)
    claims = ("bounded", "rate", "velocities")
    verdict = hold("cucker-smale-steps", case, dict.fromkeys(claims, VACUOUS if step > 1.0 else TRUE))
    if step < 1.0 and decay <= 0.5:
        assert verdict.claim("velocities").status == "verified"


@effort(0.3)
@given(st.integers(2, 5), st.integers(1, 2), powers(-4.0, 0.3), seeds, units, st.sampled_from((0.1, 20.0)))
def test_paths_with_a_potential(n, m, speed, seed, unit, until):
    rng = np.random.default_rng(seed)
    q = np.zeros((n, m))
    q[:, 0] = unit * np.arange(n)
    q, p = q + 0.05 * unit * rng.uniform(-1.0, 1.0, (n, m)), unit * speed * rng.normal(size=(n, m))
    edges, potential = [(k, k + 1) for k in range(n - 1)], LogPotential(unit**2, unit)
    always = {"energy": TRUE, "no-collision": TRUE, "velocities": TRUE, "critical": TRUE}
    hold("tanner-fixed", Case(FixedNetFlocking(edges, potential), q, p, until), always)
    hold("tanner-fixed", Case(FixedNetFlocking(edges[1:], potential), q, p, 0.1), dict.fromkeys(always, VACUOUS))


@effort(0.2)
@given(powers(-3.0, 1.0), units)
def test_two_agents_in_a_net_of_proximity(speed, unit):
    held = sqrt(1.6**-2 - 1.0 + 2.0 * np.log(1.6))
    assume(abs(speed / held - 1.0) > 0.01)
    law = ProximityFlocking(LogPotential(unit**2, unit), 1.6 * unit)
    p = unit * speed * np.array([[-1.0], [1.0]])
    case = Case(law, np.array([[0.0], [unit]]), p, 4.0)
    verdict = hold("tanner-switching", case, dict.fromkeys(("energy", "no-collision", "velocities", "critical"), TRUE))
    if speed < held:  # H = speed² < V(R)
        assert verdict.status != "vacuous"
        assert verdict.hypotheses[-1].status == "met"
    if speed > 4.0:  # braked by 2·(0.6 + 2/1) at most over 0.6 d, it leaves
        assert verdict.status == "vacuous"
